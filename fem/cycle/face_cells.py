"""Cells of the face over the positions of a mesh cycle: where they are, and what they bear."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar

from base import Array, part, quantity, record
from base.results import EXACT

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["IN_SINGLE_CELLS", "FaceCells"]

IN_SINGLE_CELLS = "not estimated cell by cell; the face-load factor of the cycle has an error"


@record
class FaceCells:
    """Places on the face and their line loads, with which every record over the face begins."""

    headline: ClassVar[tuple[str, ...]] = ()

    face_position: Array = quantity(
        "m", "middles of the cells, 0 at mid-face", "cell", shown="mm", no_error=EXACT
    )
    travel: Array = quantity(
        "m",
        "travel of each pair along the path of contact from A, beyond it where a tip edge touches; nan where a pair "
        "cannot touch",
        "position pair",
        shown="mm",
        no_error=EXACT,
    )
    line_load: Array = quantity(
        "N/m",
        "line load: force per length of face; zero where flanks stand clear",
        "position pair cell",
        shown="N/mm",
        no_error=IN_SINGLE_CELLS,
    )
    pair: GearPair = part("the gears")

    @property
    def cells(self) -> dict[str, Any]:
        """These alone, as keyword arguments of another record of the same cells."""
        return {field.name: getattr(self, field.name) for field in fields(FaceCells)}
