"""Compliance between the cells of the face of all pairs in contact, kept for loads and alignments that follow."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from fem.cell_coupling import CellCoupling
from fem.face_compliance import pair_ends, pair_waves
from fem.face_setting import FREE_ENDS, SLICES, FaceSetting
from fem.solved_gear import Gears

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from gears import GearPair

__all__ = ["cell_coupling", "cell_matrix"]

MOST_KEPT = 8_000_000
"""Numbers of a compliance up to which it is kept."""


def cell_coupling(
    face: FaceSetting, bodies: Compliance, where: ContactCandidates, kappa: Array, matrix: Array
) -> CellCoupling:
    """Compliance between cells of pairs that may touch, arguments as of ``cell_matrix``."""
    size = int(np.sum((where.touchable.sum(axis=-1) * face.cells) ** 2))

    def cut() -> CellCoupling:
        whole, own = cell_matrix(face, bodies, where.rho, kappa, matrix), np.arange(face.cells)
        cells = tuple((np.flatnonzero(row)[:, None] * face.cells + own).ravel() for row in where.touchable)
        blocks = tuple(one[at[:, None], at] for one, at in zip(whole, cells, strict=True))
        return CellCoupling(cells, blocks, whole.shape[-1])

    if size > MOST_KEPT:
        return cut()
    laws = (bodies.pinion.law.plane_modulus, bodies.wheel.law.plane_modulus)
    arrays = (where.rho, where.touchable, kappa, matrix)
    size_of = (bodies.pair.module, bodies.pair.face_width, bodies.reach)
    key = (bodies.meshed, laws, size_of, face.coupled, *(one.tobytes() for one in arrays))
    return Gears().over_face("cells", key, cut)


def cell_matrix(face: FaceSetting, bodies: Compliance, rho: Array, kappa: Array, matrix: Array) -> Array:
    """Compliance between cells of all pairs (positions, pairs cells, pairs cells) [m/N].

    Parameters
    ----------
    face : FaceSetting
    bodies : Compliance
    rho : (2, positions, pairs) array
        Curvature radii [m].
    kappa : (positions, pairs) array
        Levers of the normals about the pinion's axis over its base radius.
    matrix : (positions, pairs, pairs) array
        The plane's compliance of forces kappa F [m/N].
    """
    cells, (positions, pairs) = face.cells, kappa.shape
    modes, levers = _modes(cells), kappa[..., :, None] * kappa[..., None, :]
    by_mode = np.repeat(matrix[..., None], cells, axis=-1)
    if face.model != SLICES:
        by_mode[..., 1:] += pair_waves(bodies, rho, cells, face.strip) / levers[..., None]
    found = np.einsum("mc,pijm,md->picjd", modes, cells * by_mode, modes, optimize=True)
    if face.model == FREE_ENDS:
        edges = face.edges(bodies.pair)
        found += pair_ends(bodies, rho, (edges, edges), _widths(bodies.pair)) / levers[:, :, None, :, None]
    size = pairs * cells
    return np.asarray(found.reshape(positions, size, size))


def _widths(pair: GearPair) -> tuple[float, float]:
    return pair.face_width, pair.face_width


def _modes(cells: int) -> Array:
    """Orthonormal cosines over the cells (modes, cells)."""
    m, c = np.arange(cells)[:, None], np.arange(cells) + 0.5
    found = np.cos(np.pi * m * c / cells) * np.sqrt(2.0 / cells)
    found[0] = np.sqrt(1.0 / cells)
    return np.asarray(found)
