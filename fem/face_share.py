"""Load sharing over pairs and cells of the face: the plane's equations with more unknowns.

Every pair's face is divided into equal cells. With F_ic the force on a cell and n of them, n F_ic is the force that the
whole face would bear at that line load, so that laws of the plane hold for it. With z the cells' middles, T the cosine
transform over the face and k_m = m pi/b,

    approach = n T^T diag(B_ij + W_ij(k_m)) T F_j + E_ij F_j + law(n F_i) + gap_i + g_c ,

B the plane's compliance, W what waves yield beyond it (``fem.gear_face``), E what free ends add. Modes of a tip edge,
whose law holds tooth and body, change by W as those of a flank at its corner do. One active set runs over all.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record
from fem.face_compliance import pair_ends, pair_waves
from fem.face_setting import FREE_ENDS, SLICES
from fem.local_law import FilmLaw, PairLaws

if TYPE_CHECKING:
    from fem.bodies import Compliance
    from fem.contact_candidates import ContactCandidates
    from fem.setting import Setting
    from gears import LoadShare

__all__ = ["FaceShare", "cell_matrix", "share_over_face"]


@record
class CellLaws:
    """Laws of pairs, asked for the cells of their faces: (..., positions, pairs cells)."""

    whole: PairLaws | FilmLaw
    cells: int

    def approach(self, force: Array) -> Array:
        """Deflection [m]."""
        return self._apart(self.whole.approach(self._together(force)))

    def slope(self, force: Array) -> Array:
        """Its derivative [m/N]."""
        return self.cells * self._apart(self.whole.slope(self._together(force)))

    def _together(self, force: Array) -> Array:
        """Forces of whole faces at the cells' line loads (cells, ..., positions, pairs)."""
        return self.cells * np.moveaxis(force.reshape(*force.shape[:-1], -1, self.cells), -1, 0)

    def _apart(self, found: Array) -> Array:
        moved = np.moveaxis(found, 0, -1)
        return np.asarray(moved.reshape(*moved.shape[:-2], -1))


@record
class FaceShare:
    """Forces on cells.

    Attributes
    ----------
    forces : (torques, pitches, positions, pairs, cells) array
        [N]
    left : (torques, pitches, positions, pairs, cells) array
        Gap that is left under load [m]; where a cell bears, minus what the contact's own law yields.
    """

    forces: Array
    left: Array

    @property
    def open(self) -> Array:
        """Least gap that is left along the face (torques, pitches, positions, pairs) [m]."""
        return np.asarray(self.left.min(axis=-1))


def share_over_face(
    given: Setting,
    bodies: Compliance,
    whole: Array,
    where: ContactCandidates,
    kappa: Array,
    matrix: Array,
    laws: PairLaws,
    gaps: Array,
    oil: FilmLaw | None,
    levers: Array | None,
) -> tuple[LoadShare, FaceShare]:
    """Share forces over pairs and cells, arguments as of ``gears.share_load`` for whole faces.

    Returns
    -------
    LoadShare
        Of the pairs.
    FaceShare
        Of their cells.
    """
    from gears.load_sharing import LoadShare, share_load

    assert given.face is not None
    cells, pair = given.face.cells, given.pair
    radius = where.rho[0] * where.rho[1] / (where.rho[0] + where.rho[1])
    along = given.face.gaps(pair, radius)
    apart = gaps[..., None] + along
    apart = np.maximum(apart - apart.min(axis=(-2, -1), keepdims=True), 0.0)
    apart = apart.reshape(*apart.shape[:-2], -1)
    by_cells = cell_matrix(given, bodies, where, kappa, matrix)
    film = None if oil is None else CellLaws(oil, cells)
    arms = None if levers is None else np.repeat(levers, cells, axis=-1)
    plane = share_load(whole, matrix, laws, gaps, oil, levers)
    near = np.repeat(plane.forces / cells, cells, axis=-1)
    found = share_load(whole, by_cells, CellLaws(laws, cells), apart, film, arms, near)
    forces, slopes = (one.reshape(*one.shape[:-1], -1, cells) for one in (found.forces, found.pair_stiffness))
    bent = (by_cells @ found.forces[..., None])[..., 0] + apart
    if film is not None:
        bent = bent - film.approach(np.zeros_like(found.forces))
    left = bent.reshape(forces.shape) - found.transmission_error[..., None, None]
    share = LoadShare(
        forces.sum(axis=-1),
        found.transmission_error,
        found.stiffness,
        slopes.sum(axis=-1),
        found.iterations,
    )
    return share, FaceShare(forces, left)


def cell_matrix(
    given: Setting, bodies: Compliance, where: ContactCandidates, kappa: Array, matrix: Array
) -> Array:
    """Compliance between cells of all pairs (positions, pairs cells, pairs cells) [m/N]; ``matrix`` is the plane's."""
    assert given.face is not None
    cells, (positions, pairs) = given.face.cells, where.place.shape
    modes, levers = _modes(cells), kappa[..., :, None] * kappa[..., None, :]
    by_mode = np.repeat(matrix[..., None], cells, axis=-1)
    if given.face.model != SLICES:
        by_mode[..., 1:] += pair_waves(bodies, where.rho, cells) / levers[..., None]
    found = np.einsum("mc,pijm,md->picjd", modes, cells * by_mode, modes, optimize=True)
    if given.face.model == FREE_ENDS:
        found += pair_ends(bodies, where.rho, cells) / levers[:, :, None, :, None]
    size = pairs * cells
    return np.asarray(found.reshape(positions, size, size))


def _modes(cells: int) -> Array:
    """Orthonormal cosines over the cells (modes, cells)."""
    m, c = np.arange(cells)[:, None], np.arange(cells) + 0.5
    found = np.cos(np.pi * m * c / cells) * np.sqrt(2.0 / cells)
    found[0] = np.sqrt(1.0 / cells)
    return np.asarray(found)
