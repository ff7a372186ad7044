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

Where shafts stay held where a load f_0 has brought them, whatever bears now, u = S f_0 is a gap as any other:
C f + law(f) + g + S f_0 = D is the force of the mesh over the approach of its bodies, with the slope 1^T J^-1 1 at f_0.

Where flanks on both sides of the teeth bear, a load on one side bends the shafts along its own line of action and
twists them its own way. The normals of both sides, away from the flanks, are n and n' with n.n' = -cos 2 alpha_w, and
the torques are opposed: with S = B + T of bending and twist,

.. math:: u = S f + S_\times f' , \qquad u' = S_\times f + S f' , \qquad S_\times = -(B \cos 2\alpha_w + T) .

The turn opens the gaps of the other side: with signs s = 1 and -1 of the contacts on either side, 1 and z become s and
s z in the matrix of the mesh, which is that of bodies whose turn differs by psi along the face.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.pair.face_setting import PLACES, FaceSetting

if TYPE_CHECKING:
    from gears import GearPair, LoadShare, Shaft

__all__ = ["HeldShafts", "ShaftsUnderFace", "joined", "shafts_under_face"]

BY_LOADS = "gcd,...d->...gc"
"""Index of what both shafts give way by at the cells, by loads on cells."""


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
    behind : (...) array
        Touch of the flanks on the other side, by the turn that closes their gaps [m]; 0 where there are none.
    """

    deflection: Array
    tilt: Array
    touch: Array
    mesh: Array
    most: Array
    behind: Array

    @property
    def opposite(self) -> HeldShafts:
        """Of the flanks on the other side, but for what shafts give way by along the line of action of these."""
        return replace(self, touch=self.behind, behind=self.touch)

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
            self.behind[torque].ravel(),
        )

    def merged(self, other: HeldShafts, choose: Callable[[Array, Array], Array]) -> HeldShafts:
        """What is chosen from each array and that of others."""
        names = [field.name for field in fields(HeldShafts)]
        return HeldShafts(*(choose(getattr(self, name), getattr(other, name)) for name in names))


@record
class ShaftsUnderFace:
    """Flexibility of both shafts along the lines of action, between middles of cells.

    Pairs on the loaded side of the teeth come first, those on the other side after them.

    Attributes
    ----------
    between : (2, 2, 2, cells, cells) array
        What gives way on either side by loads on either side, of pinion's and wheel's shaft [m/N]; zero of rigid ones.
    middles : (cells,) array
        z [m].
    gaps : (2, PLACES) array
        Along the face without load, of either side, beyond the smallest of them [m].
    module : float
        [m]
    """

    between: Array
    middles: Array
    gaps: Array
    module: float

    @property
    def compliance(self) -> Array:
        """S of both shafts between the cells of either side (2, 2, cells, cells) [m/N]."""
        return np.asarray(self.between.sum(axis=2))

    def levers(self, pairs: int, count: int) -> Array:
        """S z of the cells of all pairs (pairs cells,) [m]: what a tilt closes, and the moment of forces."""
        sign = np.where(np.arange(pairs) < count, 1.0, -1.0)
        return np.asarray(sign[:, None] * self.middles).ravel()

    def bent(self, forces: Array, count: int, side: int = 0) -> Array:
        """What either shaft gives way at the cells (..., 2, cells) [m] along the line of action of a side.

        Parameters
        ----------
        forces : (..., pairs, cells) array
            [N]
        count : int
            Pairs on the loaded side.
        side : {0, 1}
            The loaded one, or the other.
        """
        own, other = (forces[..., pairs, :].sum(axis=-2) for pairs in (slice(count), slice(count, None)))
        return np.asarray(
            np.einsum(BY_LOADS, self.between[side, 0], own, optimize=True)
            + np.einsum(BY_LOADS, self.between[side, 1], other, optimize=True)
        )

    def give(self, forces: Array, count: int) -> Array:
        """What both give way by at the cells of each pair, along the line of action of its side (..., pairs, cells)."""
        sides = (self.bent(forces, count, side).sum(axis=-2)[..., None, :] for side in (0, 1))
        first, second = sides
        return np.asarray(np.where(np.arange(forces.shape[-2])[:, None] < count, first, second))

    def parting(self, forces: Array, count: int) -> Array:
        """What both give way by at cells along the normals (..., pairs cells) [m], by forces on cells alike [N]."""
        moved = self.give(forces.reshape(*forces.shape[:-1], -1, len(self.middles)), count)
        return moved.reshape(forces.shape)

    def held(
        self,
        share: LoadShare,
        lever_ratios: Array,
        gaps: Array,
        slopes: tuple[Array, Array],
        levers: Array,
        count: int,
        brought: Array | None = None,
    ) -> tuple[LoadShare, HeldShafts]:
        """Measure a share from the first touch on shafts that are held where loads bring them; no force changes.

        Parameters
        ----------
        share : LoadShare
            Of cells (..., pairs cells), its deflection counted with the shafts.
        lever_ratios : (positions, pairs) array
            Of the normals.
        gaps : (..., pairs) array
            Of pairs along them, where the first pair touches [m].
        slopes : two (..., pairs cells) arrays
            J^-1 s kappa and J^-1 s z of its cells, kappa the lever ratios, with the shafts held [N/m, N].
        levers : (..., pairs cells) array
            Levers of further forces over those for which F is given, below 0 on the other side.
        count : int
            Pairs on the loaded side.
        brought : (..., pairs cells) array, optional
            Forces that have brought the shafts where they are [N]; those of the share unless given.
        """
        rows = levers, self.levers(lever_ratios.shape[-1], count)
        mesh = [[np.sum(row * slope, axis=-1) for slope in slopes] for row in rows]
        forces = share.forces if brought is None else np.broadcast_to(brought, share.forces.shape)
        forces = forces.reshape(*forces.shape[:-1], -1, len(self.middles))
        bent = self.bent(forces, count)
        touch, behind = self.touches(forces, lever_ratios, gaps, count)
        held_shafts = HeldShafts(
            bent.mean(axis=-1),
            bent @ self.middles / (self.middles @ self.middles),
            touch,
            np.moveaxis(np.array(mesh), (0, 1), (-2, -1)),
            self._most(forces, count),
            behind,
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

    def _most(self, forces: Array, count: int) -> Array:
        """Largest on the face of what both give way together, along either line of action, over the module."""
        sides = range(1 if count == forces.shape[-2] else 2)
        bent = [self.bent(forces, count, side).sum(axis=-2) for side in sides]
        return np.asarray(np.max([np.abs(along).max(axis=-1) for along in bent], axis=0) / self.module)

    def touches(self, forces: Array, lever_ratios: Array, gaps: Array, count: int) -> tuple[Array, Array]:
        """Turns at which the flanks on either side touch without load on shafts that forces have bent (...) [m].

        Beyond those on straight ones, each by the turn that closes the gaps of its side; arguments as of ``held``, with
        forces on cells (..., pairs, cells).
        """
        touches = [np.zeros(forces.shape[:-2]) for _ in range(2)]
        for side, pairs in enumerate((slice(count), slice(count, forces.shape[-2]))):
            if pairs.start != pairs.stop:
                own = gaps[..., pairs] / lever_ratios[:, pairs]
                bent = self.bent(forces, count, side).sum(axis=-2)
                clear = own - own.min(axis=-1, keepdims=True) if side else own
                touches[side] = self._touch(bent, lever_ratios[:, pairs], clear, self.gaps[side])
        return touches[0], touches[1]

    def _touch(self, bent: Array, lever_ratios: Array, gaps: Array, face_gaps: Array) -> Array:
        """Turn that closes the smallest gap along the face of all pairs (...), beside the give at the cells [m]."""
        straight = not face_gaps.any()  # then it is at a middle or at an end of the face
        along = bent @ (_ends(bent.shape[-1]) if straight else _between_middles(bent.shape[-1]))
        least, beyond = np.full(bent.shape[:-1], np.inf), 0.0 if straight else face_gaps
        on_path = np.min(along + beyond, axis=-1)
        for lever, gap in zip(lever_ratios.T, np.moveaxis(gaps, -1, 0), strict=True):
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
    between = np.zeros((2, 2, 2, face.cells, face.cells))
    z, angle = face.middles(pair.face_width), pair.working_pressure_angle
    for gear, shaft in enumerate(face.shafts):
        if shaft is not None:
            on_face = pair.base_radii[gear], pair.face_offsets[gear], pair.face_width
            own, across = _between_cells(shaft, face.cells, *on_face, 2.0 * angle)
            between[:, :, gear] = np.array([[own, across], [across, own]])
    gaps = np.stack([side.gaps_along(pair) for side in (face, face.opposite(angle))])
    return ShaftsUnderFace(between, z, gaps - gaps.min(axis=-1, keepdims=True), pair.module)


def joined(parts: Sequence[HeldShafts], order: Integers) -> HeldShafts:
    """Shafts of some torques each, as those of all in an order."""
    names = [field.name for field in fields(HeldShafts)]
    return HeldShafts(*(np.concatenate([getattr(part, name) for part in parts])[order] for name in names))


@lru_cache(maxsize=32)
def _between_cells(
    shaft: Shaft, cells: int, radius: float, offset: float, width: float, apart: float
) -> tuple[Array, Array]:
    """S of a shaft between the cells of its gear's face (cells, cells) [m/N], on one side and across, kept."""
    from gears.pair.shaft_face import shaft_over_face

    z = ((np.arange(cells) + 0.5) / cells - 0.5) * width
    on_face = shaft_over_face(shaft, z, radius, offset, width)
    return on_face.between, on_face.across(apart)


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
