"""Laws of the plane asked for the cells of a face, and of cells that touch in part; line loads, and their maxima.

Where the gap that is left under load rises over a cell, the cell touches at one of its ends first, when its middle
is still r away. Over a part of the cell the load is a triangle, so that its middle approaches

    c F - r (1 - (F/F*)^(1/2))^2 ,   F < F* = r/c ,

and c F from there on, where the whole cell touches. c is what the contact's own law and waves as short as a cell yield
per force on it. Without this a cell would touch all over or nowhere, and the stiffness would leap with every cell that
comes; the mean over where contacts end is the same.
"""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from gears.sharing.staying_contacts import JointLaw

if TYPE_CHECKING:
    from fem.contact.cell_coupling import CellCoupling

__all__ = [
    "FEW_CELLS",
    "WITHIN",
    "CellLaws",
    "LawOnLines",
    "PartialCells",
    "between_middles",
    "drops_within",
    "face_load_factors",
    "gap_drops",
    "greatest_error",
    "partial_cells",
]

FEW_CELLS = 4
"""Cells that a contact needs; with fewer the result says so."""

LEFT_OF_LOAD = 0.25
"""Part that is left, in the second order, of what a maximum load changed by and a parabola did not foresee."""

WITHIN, MEAN = 4, np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
"""Parts of a cell by which the gaps in it are known, and Boole's weights of their mean."""

TANGENTS = 2
"""By which F* is found."""

SHORT = 1e-9
"""Part of a cell below which it is taken to touch over that much."""

LEAST = 1e-30
"""F* of cells that face a flank evenly [N]."""


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
class LawOnLines(JointLaw):
    """Law of cells of lines of contact, of films or flanks: (..., positions, lines cells).

    Attributes
    ----------
    whole : JointLaw
        At the places of the cells, under forces of whole faces at their line loads.
    faces : (positions, lines cells) array
        Force of a whole face at a cell's line load over that of the cell.
    part : (positions, lines cells) array or None
        Of each cell that has the law, by which it counts; all of it unless given.
    """

    whole: JointLaw
    faces: Array
    part: Array | None = None

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.whole.value_and_slope(force * self.faces)
        slope = slope * self.faces
        return (value, slope) if self.part is None else (value * self.part, slope * self.part)


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


@record
class PartialCells(JointLaw):
    """Laws of cells from where they first touch.

    Attributes
    ----------
    laws : JointLaw
        Of cells that touch all over.
    rise : (..., n) array
        r [m].
    whole : (..., n) array
        F* [N].
    """

    laws: JointLaw
    rise: Array
    whole: Array

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.laws.value_and_slope(force)
        root = np.clip(np.sqrt(force / self.whole), SHORT, 1.0)
        more = self.rise / self.whole * (1.0 / root - 1.0)
        return value + self.rise * (1.0 - (1.0 - root) ** 2), slope + more


def partial_cells(laws: JointLaw, coupling: CellCoupling, rise: Array) -> PartialCells:
    """Laws of cells whose minimum gap falls short of their mean by r (..., n) [m].

    F* is found by the laws' secant, then by tangents, to about 1e-3.
    """
    short = coupling.shortest
    whole = np.maximum(rise / short, LEAST)
    whole = np.maximum(rise / (short + laws.approach(whole) / whole), LEAST)
    for _ in range(TANGENTS):
        value, slope = laws.value_and_slope(whole)
        whole = np.maximum(whole - (short * whole + value - rise) / (short + slope), LEAST)
    return PartialCells(laws, rise, whole)


def gap_drops(gaps: Array, bends: Array) -> Array:
    """By how much each cell's minimum gap falls short of its mean, under load (..., cells) [m].

    Parameters
    ----------
    gaps : (..., WITHIN cells + 1) array
        Without load, at equal distances from one end of the face to the other [m].
    bends : (..., parts) array
        How far bodies bend away in the middles of equal parts of the face [m].
    """
    cells = gaps.shape[-1] // WITHIN
    slope = between_middles(np.gradient(bends, axis=-1), cells) * (bends.shape[-1] / cells)
    at = WITHIN * np.arange(cells)[:, None] + np.arange(WITHIN + 1)
    place = np.arange(WITHIN + 1) / WITHIN - 0.5
    return drops_within(gaps[..., at] + slope[..., None] * place)


def drops_within(gaps: Array) -> Array:
    """By how much the smallest gap at equal parts of cells (..., WITHIN + 1) falls short of their mean (...) [m]."""
    return np.asarray(gaps @ MEAN - gaps.min(axis=-1))
