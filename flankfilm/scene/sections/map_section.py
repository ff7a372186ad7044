"""Keys of measured maps of flanks, over profile and face."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Literal

from pydantic import Field

import gears
from base import Fault, Limit
from flankfilm.scene.sections.curve_sections import EXCESS, POSITIONS, CurveSection
from flankfilm.scene.sections.key import key
from flankfilm.scene.sections.point_sections import Beyond, Numbers, not_rising, outside, points

PLACES = {"z_mm": Limit(-1e4, 1e4, "mm", "give places in millimetres from the middle of the face")}
"""Keys of where points along the face are, and what they may be."""


class MapSection(CurveSection):
    """Measured map of a gear's flanks, over profile and face."""

    values = ("material_um", EXCESS)

    file: str | None = key(
        "CSV file beside the scene instead of points: columns z_mm, position, material_um, rows of a full grid",
        None,
        such_as="pinion_map.csv",
        max_length=1000,
    )
    z_mm: Numbers | None = points(
        "places along the face, rising, 0 at the middle of this gear's face", such_as=(-20.0, 0.0, 20.0)
    )
    material_um: Annotated[tuple[Numbers, ...], Field(strict=False)] | None = key(
        "deviations normal to the flank, a row of all places along the face for each position; positive: too much "
        "material",
        None,
        of=None,
        such_as=((-6.0, 0.0, -9.0), (-8.0, -2.0, -11.0), (-12.0, -6.0, -15.0)),
        min_length=2,
        max_length=1000,
    )
    beyond: Beyond = key(
        "where the map leaves out more than a twentieth of face or active profile: refuse it, or hold its value",
        "refuse",
    )

    twist: Literal["left-out", "kept"] = key(
        "what becomes of the rest of the map, which its mean profile and its mean lead do not have: left out with a "
        "warning that says its size, or kept as a topography; shafts that give way under the face exclude it",
        "left-out",
    )

    def _faults(self) -> Iterator[Fault]:
        """What is wrong with the places, and rows that do not fit them."""
        by, rows, places = self.given_keys(*POSITIONS), self.material_um, self.z_mm
        if len(by) != 1 or rows is None or places is None:
            keys = ", ".join(POSITIONS)
            yield Fault(
                "", " and ".join(by), f"must have one of {keys}, z_mm, and material_um", "Give all three"
            )
            return
        over = getattr(self, by[0])
        for name, values, limit in ((by[0], over, POSITIONS[by[0]]), ("z_mm", places, PLACES["z_mm"])):
            yield from outside(name, values, limit)
            yield from not_rising(name, values)
        wrong = [k for k, row in enumerate(rows, start=1) if len(row) != len(places)]
        if len(rows) != len(over) or wrong:
            value = f"{len(rows)} rows" + (
                f", row {wrong[0]} of {len(rows[wrong[0] - 1])} values" if wrong else ""
            )
            allowed = (
                f"must have a row for each of {len(over)} {by[0]} with a value for each of {len(places)} z_mm"
            )
            yield Fault("material_um", value, allowed, "Give a full grid")
        for row in rows:
            yield from outside("material_um", row, EXCESS)

    def flank_map(self, base_radius: float) -> gears.FlankMap:
        """Profile, lead and rest, of a gear of a base radius [m], in SI."""
        rho = self.radii(base_radius)
        return gears.flank_map(rho, self.value("z_mm"), self.value("material_um"), self.form)
