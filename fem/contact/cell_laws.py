"""Laws of the plane asked for the cells of a face; line loads between the middles of cells, and their maxima."""

from __future__ import annotations

from math import hypot

import numpy as np

from base import Array, record
from gears.sharing.staying_contacts import JointLaw

__all__ = ["FEW_CELLS", "CellLaws", "LineFilmLaw", "between_middles", "face_load_factors", "greatest_error"]

FEW_CELLS = 4
"""Cells that a contact needs; with fewer the result says so."""

LEFT_OF_LOAD = 0.25
"""Part that is left, in the second order, of what a maximum load changed by and a parabola did not foresee."""


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


@record
class LineFilmLaw(JointLaw):
    """Films on cells of lines of contact: (..., positions, lines cells).

    Attributes
    ----------
    whole : JointLaw
        Films at the places of the cells, under forces of whole faces at their line loads.
    faces : (positions, lines cells) array
        Force of a whole face at a cell's line load over that of the cell.
    """

    whole: JointLaw
    faces: Array

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.whole.value_and_slope(force * self.faces)
        return value, slope * self.faces


def between_middles(values: Array, cells: int) -> Array:
    """Values in the middles of equal cells (..., cells), by those of fewer or more (..., parts)."""
    parts = values.shape[-1]
    middles, asked = ((np.arange(count) + 0.5) / count for count in (parts, cells))
    hats = np.array([np.interp(asked, middles, hat) for hat in np.eye(parts)])
    return np.asarray(values @ hats)


def greatest_error(cells: Array, fewer: Array) -> float:
    """Relative error of the largest of line loads (cells,), by those with half as many.

    Within the face it is what the largest cell lacks to the top of a parabola through it and its neighbours, and a
    part of what the last doubling changed beyond what the parabola there foresaw. At an end, and where few cells bear,
    all that the doubling changed is left, in the first order, or what the parabola foresees, if more.
    """
    k, most = int(np.argmax(cells)), float(cells.max())
    change = (most - float(fewer.max())) / max(len(cells) / len(fewer) - 1.0, 1.0)
    if k in (0, len(cells) - 1) or np.count_nonzero(cells) < FEW_CELLS:
        return max(abs(change), abs(_foreseen(cells))) / most
    bend, slope = 2.0 * cells[k] - cells[k - 1] - cells[k + 1], cells[k + 1] - cells[k - 1]
    lacking = bend / 24.0 + slope**2 / (8.0 * bend)
    return float(hypot(lacking, LEFT_OF_LOAD * (change - _foreseen(fewer))) / most)


def _foreseen(cells: Array) -> float:
    """What halving the cells adds to the largest, by a parabola with the means of three."""
    k, last = int(np.argmax(cells)), len(cells) - 1
    if last < 2:
        return 0.0
    if k in (0, last):
        first, second, third = cells[:3] if k == 0 else cells[:-4:-1]
        return float(3.0 * first - 4.0 * second + third) / 8.0
    return abs(float(cells[k + 1] - cells[k - 1])) / 8.0


def face_load_factors(forces: Array) -> Array:
    """Maximum force on a cell of the most loaded pair over that pair's mean (...) of forces (..., pairs, cells)."""
    most = np.argmax(forces.sum(axis=-1), axis=-1)[..., None, None]
    chosen = np.take_along_axis(forces, most, axis=-2)[..., 0, :]
    return np.asarray(chosen.max(axis=-1) / chosen.mean(axis=-1))
