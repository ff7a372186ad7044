"""Contacts that end within a cell of the face: cells that touch over a part of their length.

Where the gap that is left under load rises over a cell, the cell touches at one of its ends first, when its middle
is still r away. Over a part of the cell the load is a triangle, so that its middle approaches

    c F - r (1 - (F/F*)^(1/2))^2 ,   F < F* = r/c ,

and c F from there on, where the whole cell touches. c is what the contact's own law and waves as short as a cell yield
per force on it. Without this a cell would touch all over or nowhere, and the stiffness would leap with every cell that
comes; the mean over where contacts end is the same.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.contact.cell_laws import between_middles
from gears.sharing.staying_contacts import JointLaw

if TYPE_CHECKING:
    from fem.contact.cell_coupling import CellCoupling

__all__ = ["WITHIN", "PartialCells", "drops_within", "gap_drops", "partial_cells"]

WITHIN, MEAN = 4, np.array([7.0, 32.0, 12.0, 32.0, 7.0]) / 90.0
"""Parts of a cell by which the gaps in it are known, and Boole's weights of their mean."""

TANGENTS = 2
"""By which F* is found."""

SHORT = 1e-9
"""Part of a cell below which it is taken to touch over that much."""

LEAST = 1e-30
"""F* of cells that face a flank evenly [N]."""


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
