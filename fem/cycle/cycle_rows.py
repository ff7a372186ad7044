"""Rows of a mesh cycle of which fields and stresses can be drawn: those with finite forces on one side of the teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Faults, Limit
from gears.pair.spur_only import check_spur

if TYPE_CHECKING:
    from fem.cycle.result import MeshCycle

__all__ = ["check_row", "require_row"]


def check_row(
    faults: Faults, cycle: MeshCycle, row: int, *, over_face: bool = False, on_lines: bool = False
) -> None:
    """Note a row that the cycle does not have, that has no finite forces, or with flanks that bear on both sides.

    Of fields over the face also one without cells, of others one with them; lines of contact are those of a helical
    pair, which others do not know.
    """
    if not on_lines:
        check_spur(faults, cycle.pair, "fields and forces on meshes")
    elif cycle.lines is None:
        faults.add(
            "cycle", "of a spur pair", "must have lines of contact", "take face_fields or loaded_fields"
        )
    last = len(cycle.position) - 1
    known = np.isfinite(
        faults.number("row", row, Limit(0, last, remedy="give a row of the cycle", whole=True))
    )
    if known and not np.all(np.isfinite(cycle.forces[row])):
        faults.add("cycle", f"row {row} without forces", "must have converged", cycle.message)
    elif known and over_face and cycle.face is None:
        faults.add(
            "cycle", "without cells", "must have cells of the face", "give cells, or take loaded_fields"
        )
    elif known and cycle.face is not None and not over_face:
        remedy = "leave cells, alignment and leads out"
        faults.add(
            "cycle", "with cells of the face", "must be even along the face for fields and stresses", remedy
        )
    elif known and cycle.opposite_force[row] > 0.0:
        allowed = "must have flanks that bear on one side of the teeth, where fields and stresses are wanted"
        faults.add("cycle", f"row {row} with flanks that bear on both sides", allowed, "give more backlash")


def require_row(cycle: MeshCycle, row: int) -> None:
    """Raise unless the cycle has that row, with finite forces."""
    faults = Faults()
    check_row(faults, cycle, row)
    faults.raise_if_any()
