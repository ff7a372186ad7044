"""Keys of how the axes stand to each other, and of how the face is looked at."""

from __future__ import annotations

from typing import ClassVar, Literal

from pydantic import model_validator

import gears
from base import Limit
from fem.pair.face_setting import CELLS, FREE_ENDS, USUAL
from flankfilm.scene.sections.key import Traits, key
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.tooth.face import ALIGNMENT_LIMITS

__all__ = ["AlignmentSection"]

TOLERANCE = Limit(0.0, ALIGNMENT_LIMITS["in_plane"].high, "m")
"""What the tolerance of the alignment may be."""


TWICE = Traits(beside_segments="gives the alignment twice")


class AlignmentSection(Section):
    """Axes out of parallel, as deviations over the face width that are zero at mid-face, and cells of the face."""

    ground: ClassVar[Limits] = {**ALIGNMENT_LIMITS, "cells": CELLS}

    in_plane_um: float | None = key(
        "axes out of parallel in the plane of action, over the face width: opens the gap of the loaded flanks towards "
        "one end of the face, the one where lead_slope_um removes material; 0 if left out",
        None,
        such_as=20,
        traits=TWICE,
    )
    out_of_plane_um: float | None = key(
        "axes out of parallel across the plane of action, over the face width, which opens gaps by its square alone; 0 "
        "if left out",
        None,
        such_as=0,
        traits=TWICE,
    )
    in_plane_tolerance_um: float = key(
        "how much in_plane_um may be more or less, for the output robust_face_load_factor of studies and optimisations",
        0.0,
        of=None,
        limit=TOLERANCE,
        such_as=10,
    )
    cells: int = key("number of equal cells of the face, an even number", USUAL, of=None, limit=CELLS)
    face_model: Literal["free-ends", "walls"] = key(
        "what couples the cells: gears with free ends, or gears between frictionless walls, quicker and too stiff "
        "at the ends",
        FREE_ENDS,
        of=None,
    )

    @model_validator(mode="after")
    def _even_cells(self) -> AlignmentSection:
        if self.cells % 2:
            raise refused(
                "must be even: mid-face lies between two cells",
                f"Take {self.cells + 1}",
                key="cells",
                value=f"{self.cells}",
            )
        return self

    def alignment(self) -> gears.Alignment:
        """Alignment in SI."""
        return gears.Alignment(**self.si())
