"""Errors by the cells of a face and by its free ends: what half as many cells change."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.face_setting import FREE_ENDS, WALLS

if TYPE_CHECKING:
    from fem.cell_contact import CellContact, CellShare
    from fem.face_setting import FaceSetting

__all__ = ["cell_errors", "face_load_factors", "half_as_many"]

LEFT = 0.6
"""Part of what twice as many cells changed that is left: all of it in the first order, a third in the second."""

FAR = 4.0
"""Times what neighbouring cells say of halving them that the change from half as many is believed."""

ENDS_ERROR = 0.1
"""Part of what free ends do that their coarse section leaves uncertain."""


def half_as_many(face: FaceSetting) -> tuple[FaceSetting, float]:
    """The face with half as many cells, and which part of what that changes is error."""
    few = max(2 * (face.cells // 4), 2)  # two cells have no half: nobody asks for their error
    return replace(face, cells=few), LEFT / (max(face.cells / few, 2.0) - 1)


def cell_errors(
    over: CellContact, face: FaceSetting, fine: CellShare, coarse: CellShare
) -> tuple[Array, Array]:
    """Errors of every torque: of the greatest face-load factor, and relative of stiffness and deflection."""
    (few, rest), kappa = half_as_many(face), over.kappa[..., None]
    loads, fewer = fine.forces / kappa, coarse.forces / kappa
    factors, half = face_load_factors(loads), face_load_factors(fewer)
    stiffness = np.zeros(len(loads))
    for name in ("stiffness", "transmission_error"):
        many, some = getattr(fine.share, name), getattr(coarse.share, name)
        stiffness = np.maximum(stiffness, rest * np.abs(some / many - 1.0).mean(axis=(1, 2)))
    factor = np.zeros(len(loads))
    for torque, found in enumerate(factors):
        pitch, position = (int(k) for k in np.unravel_index(int(np.argmax(found)), found.shape))
        cells = loads[torque, pitch, position]
        settled = rest * abs(float(np.max(found)) - float(np.max(half[torque])))
        between = _between(cells[int(np.argmax(cells.sum(axis=-1)))])
        factor[torque] = np.clip(settled, between, FAR * between)
        if face.model == FREE_ENDS:
            at = over.at(torque, pitch, position)
            walls = at.shared(
                replace(few, model=WALLS), coarse.forces[torque, pitch, position][None, None, None]
            )
            there = float(half[torque, pitch, position])
            without = float(face_load_factors(walls.forces / at.kappa[..., None])[0, 0, 0])
            factor[torque] += ENDS_ERROR * abs(there - without)
    return factor, stiffness


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
