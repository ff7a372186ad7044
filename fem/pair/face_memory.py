"""What a face takes of memory, known before anything is solved: cells that all feel each other, and free ends."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from base import Faults, free_memory
from fem.elasticity.free_ends import unknowns_along

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["check_memory", "memory_of_cells", "memory_of_ends"]

GIGABYTE = 1e9

ENDS_EACH = 360e3
"""Bytes of a section's factors with free ends, over the square of the unknowns at a node: faces of 5 to 400 modules."""

AROUND = 1.2
"""Base pitches around the path in which pairs may touch."""

HALF_AS_MANY = 1.25
"""Over the cells alone: half as many are solved for the error."""

SERIES = 2 * (3 * 49 + 10)
"""Numbers between two cells that free ends of both gears keep as series over places."""

WORK = 250e6
"""Bytes for what is put together at once, whatever the cells."""

LEAST_CELLS = 4


def memory_of_ends(width: float) -> float:
    """Bytes that a gear with free ends takes while it is solved; its face width in modules."""
    return ENDS_EACH * unknowns_along(width) ** 2


def memory_of_cells(pair: GearPair, cells: int, positions: int, free_ends: bool = True) -> float:
    """Bytes that the compliance between the cells of all pairs takes at all positions."""
    between = HALF_AS_MANY * positions * (pair.contact_ratio + AROUND) ** 2
    return 8.0 * cells**2 * (between + (SERIES if free_ends else 0.0)) + WORK


def check_memory(faults: Faults, pair: GearPair, cells: int, positions: int, model: str) -> None:
    """Note a face that takes more memory than is free.

    Parameters
    ----------
    faults : Faults
    pair : GearPair
    cells, positions : int
    model : {"free-ends", "walls", "slices"}
    """
    free, ends = free_memory(), model == "free-ends"
    if ends:
        width = max(pair.face_widths) / pair.module
        needed = memory_of_ends(width)
        if needed > free:
            allowed = (
                f"must not take more memory than is free, {_size(free)}: free ends of a face of {width:.3g} modules "
                f"take about {_size(needed)}"
            )
            faults.add(
                "face_model", repr(model), allowed, 'take "walls", which takes a tenth, or free memory'
            )
    needed = memory_of_cells(pair, cells, positions, ends)
    if needed > free:
        most = LEAST_CELLS
        if free > WORK:
            most = max(most, 2 * int(0.5 * cells * math.sqrt((free - WORK) / (needed - WORK))))
        allowed = (
            f"must not take more memory than is free, {_size(free)}: at {positions} positions they take about "
            f"{_size(needed)}"
        )
        faults.add("cells", cells, allowed, f"take {most} cells or free memory")


def _size(count: float) -> str:
    return f"{count / GIGABYTE:.2g} GB"
