"""Cells of lines of contact over the positions of a mesh cycle: where they are, and what they carry."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from base import Array, Booleans, part, quantity, record
from base.results import EXACT
from fem.contact.line_contact import WINDOW
from fem.laws.line_candidates import part_on_path

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["IN_SINGLE_CELLS", "CellsOfLines"]

IN_SINGLE_CELLS = "not estimated cell by cell; line_load_error is that of the largest"


@record
class CellsOfLines:
    """Places on lines of contact and their line loads, with which every record over lines begins.

    Where a line has fewer cells than others, further ones are nan. Loads are per length of the line of contact, which
    is 1/cos(beta_b) of that along the axis.
    """

    headline: ClassVar[tuple[str, ...]] = ()

    position: Array = quantity(
        "1",
        "base pitches from A, of the pair that entered last at mid-face",
        "position",
        no_error=EXACT,
    )
    z: Array = quantity(
        "m",
        "middles of the cells along the face, 0 at mid-face",
        "position pair cell",
        shown="mm",
        no_error=EXACT,
    )
    travel: Array = quantity(
        "m",
        "travel of each cell along the transverse path of contact, from A",
        "position pair cell",
        shown="mm",
        no_error=EXACT,
    )
    length: Array = quantity(
        "m",
        "length of a cell along its line of contact; zero where a line does not touch",
        "position pair",
        shown="mm",
        no_error=EXACT,
    )
    line_load: Array = quantity(
        "N/m",
        "normal force per length of the line of contact; zero where flanks stand clear",
        "position pair cell",
        shown="N/mm",
        no_error=IN_SINGLE_CELLS,
    )
    pair: GearPair = part("the gears")
    ends: tuple[float, float] = part("curvature radii on the pinion between which flanks touch flanks [m]")

    @property
    def cells(self) -> dict[str, Any]:
        """These alone, as keyword arguments of another record of the same cells."""
        return {field.name: getattr(self, field.name) for field in fields(CellsOfLines)}

    @property
    def rho(self) -> Array:
        """Curvature radii on pinion and wheel (2, positions, pairs, cells) [m]; of edges at the ends of the path."""
        rho1 = np.clip(self.travel + self.pair.points.A, *self.ends)
        return np.stack([rho1, self.pair.line_of_action - rho1])

    @property
    def unlimited_rho(self) -> Array:
        """The same on involutes without ends, along which lines go on beyond the path."""
        rho1 = self.travel + self.pair.points.A
        return np.stack([rho1, self.pair.line_of_action - rho1])

    def within(self, gear: int, rho: Array) -> Array:
        """Curvature radii on a gear, held to the path; ``rho`` (...) [m]."""
        low, high = self.ends
        line = self.pair.line_of_action
        return np.asarray(np.clip(rho, low, high) if gear == 0 else np.clip(rho, line - high, line - low))

    @property
    def on_path(self) -> Array:
        """Part of each cell between the ends of the path (positions, pairs, cells); 0 where there is none."""
        helix = self.pair.helix
        across = self.length[..., None] * helix.base_cosine * abs(helix.base_tangent)
        place = np.nan_to_num(self.travel) + self.pair.points.A
        return np.asarray(np.isfinite(self.z) * part_on_path(place, across, self.ends))

    @property
    def inside(self) -> Booleans:
        """Cells at least half a module of the line from both its ends on the path (positions, pairs, cells).

        Nearer to them loads of single cells go with their length, and a line of contact that begins is none yet. Of
        lines that are nowhere so long, all cells.
        """
        part = self.on_path
        there, along = part > 0.0, np.cumsum(part, axis=-1) - 0.5 * part
        away = np.minimum(along, part.sum(axis=-1, keepdims=True) - along) * self.length[..., None]
        inside = there & (away >= WINDOW * self.pair.module)
        return inside if inside.any() else there

    @property
    def force(self) -> Array:
        """Normal force on each cell (positions, pairs, cells) [N]; zero where there is none."""
        return np.nan_to_num(self.line_load) * self.length[..., None]
