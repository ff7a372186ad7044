"""Keys of how the axes stand to each other, and of how the face is looked at."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, Literal

from pydantic import model_validator

from base import Fault, Limit
from fem.pair.face_setting import CELLS, FREE_ENDS, USUAL
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.section import Limits, Section, refused
from gears.tooth.face import ALIGNMENT_LIMITS

__all__ = ["LEAD_KEYS", "AlignmentSection", "faults_of_leads"]

TOLERANCE = Limit(0.0, ALIGNMENT_LIMITS["in_plane"].high, "m")
"""What the tolerance of the alignment may be."""

LEAD_KEYS = ("crowning_um", "lead_slope_um", "end_relief_um")
"""Keys of a gear that make its flanks differ along the face."""


def faults_of_leads(raw: Mapping[str, Any]) -> Iterator[Fault]:
    """End relief without a length, in the unchecked file: it is listed beside faults of other keys."""
    pair = raw.get("pair")
    for gear in ("pinion", "wheel"):
        keys = pair.get(gear) if isinstance(pair, Mapping) else None
        if not isinstance(keys, Mapping) or not isinstance(keys.get("end_relief_um"), int | float):
            continue
        if keys["end_relief_um"] > 0.0 and not keys.get("end_relief_length_mm"):
            allowed = "must be more than 0 mm with end_relief_um"
            remedy = "Give its length from either end"
            yield Fault(f"pair.{gear}.end_relief_length_mm", "0", allowed, remedy)


class AlignmentSection(Section):
    """Axes out of parallel, as deviations over the face width that are zero at mid-face, and cells of the face."""

    ground: ClassVar[Limits] = {**ALIGNMENT_LIMITS, "cells": CELLS}

    in_plane_um: float | None = key(
        "axes out of parallel in the plane of action, over the face width: opens the gap of the loaded flanks towards "
        "one end of the face, the one where lead_slope_um removes material; 0 if left out",
        None,
        such_as=20,
    )
    out_of_plane_um: float | None = key(
        "axes out of parallel across the plane of action, over the face width, which opens gaps by its square alone; 0 "
        "if left out",
        None,
        such_as=0,
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
