"""Laws of the plane asked for the cells of a face, and line loads between the middles of cells."""

from __future__ import annotations

import numpy as np

from base import Array, record
from gears.sharing.staying_contacts import JointLaw

__all__ = ["CellLaws", "between_middles"]


@record
class CellLaws(JointLaw):
    """Laws of pairs, asked for the cells of their faces: (..., positions, pairs cells)."""

    whole: JointLaw
    cells: int

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.whole.value_and_slope(self._together(force))
        return self._apart(value), self.cells * self._apart(slope)

    def _together(self, force: Array) -> Array:
        """Forces of whole faces at the cells' line loads (cells, ..., positions, pairs)."""
        first = force.reshape(-1, self.cells).T
        return self.cells * first.reshape(self.cells, *force.shape[:-1], -1)

    def _apart(self, values: Array) -> Array:
        last = values.reshape(self.cells, -1).T
        return last.reshape(*values.shape[1:-1], -1)


def between_middles(values: Array, cells: int) -> Array:
    """Values in the middles of equal cells (..., cells), by those of fewer or more (..., parts)."""
    parts = values.shape[-1]
    middles, asked = ((np.arange(count) + 0.5) / count for count in (parts, cells))
    hats = np.array([np.interp(asked, middles, hat) for hat in np.eye(parts)])
    return np.asarray(values @ hats)
