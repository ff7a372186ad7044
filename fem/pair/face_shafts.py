r"""Shafts under a face: what they give way under the loads on its cells, and the mesh between the bodies on them.

A load f on the cells moves the flanks apart by u = S f, S = S_1 + S_2 of both shafts. With the pinion's turn D, and the
bodies' compliance C and the contacts' laws between the flanks,

.. math:: C f + \mathrm{law}(f) + g + u = D , \qquad F = \sum f_c , \qquad M = \sum f_c z_c ,

the energy of bodies, contacts and shafts changes by F dD, and that of bodies and contacts by F dD - f . du: with the
shafts held where the load has brought them, force and deflection are conjugate. The mesh between bodies that turn,
translate and tilt is therefore the symmetric matrix

.. math:: \begin{pmatrix} dF \\ dM \end{pmatrix} =
   \begin{pmatrix} 1^T J^{-1} 1 & 1^T J^{-1} z \\ z^T J^{-1} 1 & z^T J^{-1} z \end{pmatrix}
   \begin{pmatrix} d\delta \\ d\psi \end{pmatrix} , \qquad J = C + \mathrm{law}' \text{ among cells that bear},

by the approach delta + psi z of the flanks. Its first entry is the tangent. What the shafts add is in series with it,

.. math:: (X^T (J + S)^{-1} X)^{-1} - (X^T J^{-1} X)^{-1} \ge 0 , \qquad X = (1, z) ,

so that no shaft makes a mesh stiffer. u = a + phi z + r, r orthogonal to 1 and z: f . u = F a + M phi + f . r.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.pair.face_setting import PLACES, FaceSetting

if TYPE_CHECKING:
    from gears import GearPair, LoadShare, Shaft

__all__ = ["HeldShafts", "ShaftsUnderFace", "joined", "shafts_under_face"]


@record
class HeldShafts:
    """Shafts where a load has brought them; leading dimensions (torques, pitches, positions).

    Attributes
    ----------
    deflection : (..., 2) array
        By which pinion and wheel give way along the line of action, mean over the face: a [m].
    tilt : (..., 2) array
        Mean slope of that over the face: phi [rad].
    touch : (...) array
        Turn at which the flanks touch without load on shafts that are held so, beyond that on straight ones [m].
    mesh : (..., 2, 2) array
        Of (F, M) [N, N m] by the approach at mid-face and its slope over the face [m, rad].
    most : (...) array
        Largest on the face of what both give way together, over the module.
    """

    deflection: Array
    tilt: Array
    touch: Array
    mesh: Array
    most: Array

    @property
    def tilt_touch(self) -> Array:
        """What of the touch is by tilt and bend over the face (...) [m]."""
        return np.asarray(self.touch - self.deflection.sum(axis=-1))

    def at(self, torque: int) -> HeldShafts:
        """Of a single torque, position after position."""
        several = self.touch[torque].size
        return HeldShafts(
            self.deflection[torque].reshape(several, 2),
            self.tilt[torque].reshape(several, 2),
            self.touch[torque].ravel(),
            self.mesh[torque].reshape(several, 2, 2),
            self.most[torque].ravel(),
        )


@record
class ShaftsUnderFace:
    """Flexibility of both shafts along the line of action, between middles of cells.

    Attributes
    ----------
    between : (2, cells, cells) array
        Of pinion's and wheel's shaft [m/N]; zero of rigid ones.
    middles : (cells,) array
        z [m].
    gaps : (PLACES,) array
        Along the face without load, beyond the smallest of them [m].
    module : float
        [m]
    """

    between: Array
    middles: Array
    gaps: Array
    module: float

    @property
    def compliance(self) -> Array:
        """S of both shafts (cells, cells) [m/N]."""
        return np.asarray(self.between.sum(axis=0))

    def levers(self, kappa: Array) -> Array:
        """z/kappa (positions, pairs cells) [m]: what a tilt closes, and the moment of forces kappa F."""
        return np.asarray((self.middles / kappa[..., None]).reshape(len(kappa), -1))

    def bent(self, forces: Array, kappa: Array) -> Array:
        """What either shaft gives way at the cells (..., 2, cells) [m] by forces kappa F (..., pairs, cells)."""
        loads = (forces / kappa[..., None]).sum(axis=-2)
        return np.asarray(np.einsum("gcd,...d->...gc", self.between, loads, optimize=True))

    def held(
        self,
        share: LoadShare,
        kappa: Array,
        gaps: Array,
        slopes: tuple[Array, Array],
        arms: Array | float = 1.0,
    ) -> tuple[LoadShare, HeldShafts]:
        """Measure a share from the first touch on shafts that are held where its loads bring them; no force changes.

        Parameters
        ----------
        share : LoadShare
            Of cells (..., pairs cells), its deflection counted with the shafts.
        kappa : (positions, pairs) array
            Levers of the normals in whose forces it is.
        gaps : (..., pairs) array
            Of pairs, beyond that of the pair that touches first [m].
        slopes : two (..., pairs cells) arrays
            J^-1 1 and J^-1 z of its cells, with the shafts held [N/m, N].
        arms : (..., pairs cells) array or float
            Levers of further forces over those for which F is given.
        """
        levers = self.levers(kappa)
        rows = arms, levers
        mesh = [[np.sum(row * slope, axis=-1) for slope in slopes] for row in rows]
        bent = self.bent(share.forces.reshape(*share.forces.shape[:-1], -1, len(self.middles)), kappa)
        touch = self._touch(bent.sum(axis=-2), kappa, gaps)
        held_shafts = HeldShafts(
            bent.mean(axis=-1),
            bent @ self.middles / (self.middles @ self.middles),
            touch,
            np.moveaxis(np.array(mesh), (0, 1), (-2, -1)),
            np.abs(bent.sum(axis=-2)).max(axis=-1) / self.module,
        )
        return (
            replace(
                share,
                transmission_error=share.transmission_error - touch,
                stiffness=mesh[0][0],
                pair_stiffness=slopes[0],
            ),
            held_shafts,
        )

    def _touch(self, bent: Array, kappa: Array, gaps: Array) -> Array:
        """Minimum gap along the face of all pairs (...), less the give of the shafts at the cells (..., cells) [m]."""
        straight = not self.gaps.any()  # then it is at a middle or at an end of the face
        along = bent @ (_ends(bent.shape[-1]) if straight else _between_middles(bent.shape[-1]))
        least, beyond = np.full(bent.shape[:-1], np.inf), 0.0 if straight else self.gaps
        on_path = np.min(along + beyond, axis=-1)
        for lever, gap in zip(kappa.T, np.moveaxis(gaps, -1, 0), strict=True):
            if np.isfinite(gap).any():
                here = np.flatnonzero(lever != 1.0)
                first = on_path.copy()
                first[..., here] = np.min(along[..., here, :] / lever[here, None] + beyond, axis=-1)
                least = np.minimum(least, first + gap)
        return least


def shafts_under_face(face: FaceSetting, pair: GearPair) -> ShaftsUnderFace | None:
    """Bend and twist the shafts of a face; None where both are rigid."""
    if all(shaft is None for shaft in face.shafts):
        return None
    between = np.zeros((2, face.cells, face.cells))
    z = face.middles(pair.face_width)
    for gear, shaft in enumerate(face.shafts):
        if shaft is not None:
            on_face = pair.base_radii[gear], pair.face_offsets[gear], pair.face_width
            between[gear] = _between_cells(shaft, face.cells, *on_face)
    gaps = face.gaps_along(pair)
    return ShaftsUnderFace(between, z, gaps - gaps.min(), pair.module)


def joined(parts: Sequence[HeldShafts], order: Integers) -> HeldShafts:
    """Shafts of some torques each, as those of all in an order."""
    names = [field.name for field in fields(HeldShafts)]
    return HeldShafts(*(np.concatenate([getattr(part, name) for part in parts])[order] for name in names))


@lru_cache(maxsize=32)
def _between_cells(shaft: Shaft, cells: int, radius: float, offset: float, width: float) -> Array:
    """S of a shaft between the cells of its gear's face (cells, cells) [m/N], kept for what follows."""
    from gears.pair.shaft_face import shaft_over_face

    z = ((np.arange(cells) + 0.5) / cells - 0.5) * width
    return shaft_over_face(shaft, z, radius, offset, width).between


@lru_cache(maxsize=8)
def _ends(cells: int) -> Array:
    """Places of cells' middles and of both ends of the face, by values in the middles (cells, cells + 2)."""
    ends = _between_middles(cells)[:, [0, -1]]
    return np.concatenate([np.eye(cells), ends], axis=1)


@lru_cache(maxsize=8)
def _between_middles(cells: int) -> Array:
    """Straight lines through values in the middles of cells, at PLACES along the face (cells, PLACES)."""
    at = np.linspace(-0.5, cells - 0.5, PLACES)
    first = np.clip(np.floor(at).astype(int), 0, cells - 2)
    weights, place = np.zeros((cells, PLACES)), np.arange(PLACES)
    weights[first, place], weights[first + 1, place] = 1.0 - (at - first), at - first
    return weights
