"""Errors by the cells of a face and by its free ends: what half as many cells change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.face_setting import FREE_ENDS, WALLS

if TYPE_CHECKING:
    from fem.cell_contact import CellContact, CellShare
    from fem.face_setting import FaceSetting
    from gears import LoadShare

__all__ = ["CellErrors", "cell_errors", "face_load_factors", "half_as_many"]

LEFT, LEFT_OF_LOAD, LEFT_AT_END = 0.9, 0.7, 1.0
"""Part of what twice as many cells changed that is left: all of it in the first order, a third in the second.

Of stiffness and deflection, whose changes are irregular, of the greatest load within the face, and of that at an end,
which is found in the first order.
"""

FAR = 4.0
"""Times what neighbouring cells say of halving them that the change from half as many is believed."""

ENDS_ERROR = 0.03
"""Part of what free ends do that their coarse section leaves uncertain: 0.02 beside three-dimensional elements."""


@record
class CellErrors:
    """Errors by the cells of every torque.

    Attributes
    ----------
    factor : (torques,) array
        Of the greatest face-load factor.
    relative : (torques,) array
        Of stiffness and deflection at a position, in the mean over positions.
    ends : (torques,) array
        Further one of both by what free ends leave uncertain, alike at all positions.
    scatter : dict of (2, torques) arrays
        As of ``gears.mesh_figures.FewerCells``.
    """

    factor: Array
    relative: Array
    ends: Array
    scatter: Mapping[str, Array]

    def of(self, torque: int) -> dict[str, tuple[float, float]]:
        """Scatter of a single torque."""
        return {name: (float(both[0, torque]), float(both[1, torque])) for name, both in self.scatter.items()}


def half_as_many(face: FaceSetting) -> tuple[FaceSetting, float]:
    """The face with half as many cells, and which part of what that changes is error."""
    few = max(2 * (face.cells // 4), 2)  # two cells have no half: nobody asks for their error
    return replace(face, cells=few), LEFT / (max(face.cells / few, 2.0) - 1)


def cell_errors(over: CellContact, face: FaceSetting, fine: CellShare, coarse: CellShare) -> CellErrors:
    """Estimate errors of cycles with cells by those with half as many."""
    _, rest = half_as_many(face)
    scatter, relative = {}, np.zeros(len(over.whole))
    both = [_curves(over.whole, one.share) for one in (fine, coarse)]
    for name, curve in both[0].items():
        change = rest * (both[1][name] - curve)
        varying = change - change.mean(axis=(1, 2), keepdims=True)
        scatter[name] = np.stack([np.abs(one).mean(axis=(1, 2)) for one in (change, varying)])
        if name != "secant_stiffness":
            relative = np.maximum(relative, np.abs(change / curve).mean(axis=(1, 2)))
    each = [_factor_error(over, face, fine, coarse, torque) for torque in range(len(over.whole))]
    factor, ends = np.array(each).T
    return CellErrors(factor, relative, ends, scatter)


def _curves(whole: Array, share: LoadShare) -> dict[str, Array]:
    """Curves of a cycle (torques, pitches, positions), deflection for transmission error."""
    moved = share.transmission_error
    return {"stiffness": share.stiffness, "transmission_error": moved, "secant_stiffness": whole / moved}


def _factor_error(
    over: CellContact, face: FaceSetting, fine: CellShare, coarse: CellShare, torque: int
) -> tuple[float, float]:
    """Error of the greatest face-load factor, and the relative one of stiffness and deflection by free ends."""
    (few, rest), kappa = half_as_many(face), over.kappa[..., None]
    loads, fewer = (one.forces[torque] / kappa for one in (fine, coarse))
    factors, half = face_load_factors(loads), face_load_factors(fewer)
    pitch, position = (int(k) for k in np.unravel_index(int(np.argmax(factors)), factors.shape))
    cells = loads[pitch, position]
    most = cells[int(np.argmax(cells.sum(axis=-1)))]
    at_end = int(np.argmax(most)) in (0, len(most) - 1)
    settled = (
        rest
        / LEFT
        * (LEFT_AT_END if at_end else LEFT_OF_LOAD)
        * abs(float(np.max(factors)) - float(np.max(half)))
    )
    between = _between(most)
    found, ends = float(np.clip(settled, between, FAR * between)), 0.0
    if face.model == FREE_ENDS:
        at = over.at(torque, pitch, position)
        walls = at.shared(replace(few, model=WALLS), coarse.forces[torque, pitch, position][None, None, None])
        without = float(face_load_factors(walls.forces / at.kappa[..., None])[0, 0, 0])
        found += ENDS_ERROR * abs(float(half[pitch, position]) - without)
        for name in ("stiffness", "transmission_error"):
            free, held = (
                getattr(coarse.share, name)[torque, pitch, position],
                getattr(walls.share, name)[0, 0, 0],
            )
            ends = max(ends, ENDS_ERROR * abs(float(held / free) - 1.0))
    return found, ends


def face_load_factors(forces: Array) -> Array:
    """Greatest force on a cell of the most loaded pair over that pair's mean (...) of forces (..., pairs, cells)."""
    most = np.argmax(forces.sum(axis=-1), axis=-1)[..., None, None]
    chosen = np.take_along_axis(forces, most, axis=-2)[..., 0, :]
    return np.asarray(chosen.max(axis=-1) / chosen.mean(axis=-1))


def _between(cells: Array) -> float:
    """What halving changes of the greatest cell over their mean, by a parabola through three or at an end a line."""
    k = int(np.argmax(cells))
    if k in (0, len(cells) - 1):
        change = (cells[k] - cells[1 if k == 0 else k - 1]) / 4
    else:
        change = (2 * cells[k] - cells[k - 1] - cells[k + 1]) / 16
    return float(change / cells.mean())
