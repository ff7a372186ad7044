r"""Shafts under lines of contact: what they give way by under normal forces that are inclined to the section.

A normal force N on a cell at z, where the contact is rho along the line of action from the foot of the axis on it, has
the part N cos beta_b in the section and N sin beta_b along the axis. On a shaft it is the force N cos beta_b at z, and
two couples: N s sin beta_b rho in the plane of line of action and axis, N sin beta_b r_b in the plane at right angles
to it; s = 1 of a right-handed pinion, -1 of its wheel. A section that deflects by v with the slope v' in the first
plane, has the slope w' in the second one and turns by theta moves the flank along the normal by

.. math:: u = \cos\beta_b\,(v + r_b \theta) + \sin\beta_b\,(s \rho v' + r_b w') ,

so that with X the rows of what a unit force loads the beam by, S = X Phi X^T is symmetric: the displacement along the
normal of a cell by a unit force on another is that of the other by a unit force on the one. In the transverse line of
action u counts as u/cos beta_b. Between nodes on the face v, v', w' and theta are straight lines.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import lru_cache
from math import hypot
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Booleans, record
from fem.pair.face_shafts import HeldShafts
from gears.pair.tilting_shaft import TiltingShaft, tilting_shaft

if TYPE_CHECKING:
    from fem.pair.face_setting import FaceSetting
    from gears import GearPair, LoadShare, Shaft

__all__ = ["PlacesOnLines", "ShaftsUnderLines", "shafts_under_lines"]

NODES = 65
"""Of a beam on the face."""


@record
class PlacesOnLines:
    """Places on the lines of contact of n positions, m each.

    Attributes
    ----------
    z : (n, m) array
        Along the face [m].
    rho : (2, n, m) array
        Curvature radii on pinion and wheel there [m].
    used : (n, m) boolean array
        Those that there are.
    length : (n, m) array
        Of a line that each stands for [m].
    gaps : (pitches, n, m) array
        In the section without load [m].
    """

    z: Array
    rho: Array
    used: Booleans
    length: Array
    gaps: Array


@record
class ShaftsUnderLines:
    """Both shafts of a helical pair under the cells of its lines of contact.

    Attributes
    ----------
    shafts : two TiltingShaft or None
        Between NODES equal places on the face; None is rigid.
    radii : (float, float)
        Base radii [m].
    slope : float
        d rho1/dz along a line, tan(beta_b): above 0 on the loaded flanks of a right-handed pinion.
    face_width, module : float
        [m]
    cells : PlacesOnLines
        Middles of the cells.
    seen : PlacesOnLines
        Where the first touch is looked for.
    """

    shafts: tuple[TiltingShaft | None, TiltingShaft | None]
    radii: tuple[float, float]
    slope: float
    face_width: float
    module: float
    cells: PlacesOnLines
    seen: PlacesOnLines

    @property
    def cosine(self) -> float:
        """Of the base helix angle."""
        return 1.0 / hypot(1.0, self.slope)

    def compliances(self) -> Iterator[Array]:
        """S of both shafts between the cells that there are, position after position (m, m) [m/N]."""
        for position, used in enumerate(self.cells.used):
            between = np.zeros((used.sum(), used.sum()))
            for gear, shaft in enumerate(self.shafts):
                if shaft is not None:
                    along, tilts, turns = self._loads(self.cells, gear, position, used)
                    between += along @ shaft.bent.reshape(along.shape[1], -1) @ along.T
                    between += tilts @ shaft.bent[1, :, 1] @ tilts.T + turns @ shaft.twisted @ turns.T
            yield 0.5 * (between + between.T)

    def _loads(
        self, places: PlacesOnLines, gear: int, position: int, used: Booleans
    ) -> tuple[Array, Array, Array]:
        """What unit normal forces load a beam's nodes by.

        Forces and couples in the plane of the line of action (m, 2 NODES), couples in the other one and torques
        (m, NODES).
        """
        weights = self._weights(places.z[position, used])
        rho, sine = places.rho[gear, position, used, None], self.slope * self.cosine
        couples = (sine if gear == 0 else -sine) * rho * weights
        radius = self.radii[gear]
        return (
            np.concatenate([self.cosine * weights, couples], axis=1),
            sine * radius * weights,
            self.cosine * radius * weights,
        )

    def _weights(self, z: Array) -> Array:
        """Of nodes, at places (m, NODES): straight lines between them."""
        place = np.clip((z / self.face_width + 0.5) * (NODES - 1), 0.0, NODES - 1.0)
        first = np.minimum(place.astype(int), NODES - 2)
        weights, rows = np.zeros((len(z), NODES)), np.arange(len(z))
        weights[rows, first], weights[rows, first + 1] = 1.0 - (place - first), place - first
        return weights

    def give(self, forces: Array, places: PlacesOnLines) -> Array:
        """What either shaft gives way by along the transverse line of action at places (..., n, 2, m) [m].

        Parameters
        ----------
        forces : (..., n, cells) array
            [N]
        places : PlacesOnLines
        """
        moved = np.zeros((*forces.shape[:-1], 2, places.z.shape[-1]))
        for position, (used, at) in enumerate(zip(self.cells.used, places.used, strict=True)):
            loads = forces[..., position, used]
            for gear, shaft in enumerate(self.shafts):
                if shaft is not None:
                    of_cells = self._loads(self.cells, gear, position, used)
                    there = self._loads(places, gear, position, at)
                    flexible = (
                        shaft.bent.reshape(2 * NODES, -1), shaft.bent[1, :, 1], shaft.twisted,
                    )  # fmt: skip
                    moved[..., position, gear, at] = sum(
                        ((loads @ load) @ matrix) @ point.T
                        for load, matrix, point in zip(of_cells, flexible, there, strict=True)
                    )
        return np.asarray(moved / self.cosine)

    def parting(self, forces: Array, count: int) -> Array:
        """What both give way by at the cells along the normals (..., n, m) [m], by forces on them [N].

        Parameters
        ----------
        forces : (..., n, m) array
        count : int
            Lines on the loaded side: all.
        """
        del count
        return np.asarray(self.cosine * self.give(forces, self.cells).sum(axis=-2))

    def levers(self, pairs: int, count: int) -> Array:
        """Cos(beta_b) z of the cells of all lines (n, m) [m]: what a slope over the face closes, moments of forces.

        Parameters
        ----------
        pairs, count : int
            All lines, and those on the loaded side: the same.
        """
        del pairs, count
        return self.cosine * self.cells.z

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
        """Measure a share from the first touch on shafts that are held where loads bring them.

        Parameters and result as of ``fem.pair.face_shafts.ShaftsUnderFace.held``; deflection and tilt are the straight
        line, of least squares over the lengths of all lines, through what they give way by.
        """
        rows = levers, self.levers(lever_ratios.shape[-1], count)
        mesh = [[np.sum(row * slope, axis=-1) for slope in slopes] for row in rows]
        forces = share.forces if brought is None else np.broadcast_to(brought, share.forces.shape)
        bent = self.give(forces, self.cells)
        deflection, tilt = self._straight(bent)
        touch = self._touch(forces)
        held_shafts = HeldShafts(
            deflection,
            tilt,
            touch,
            np.moveaxis(np.array(mesh), (0, 1), (-2, -1)),
            np.asarray(np.abs(bent.sum(axis=-2)).max(axis=-1) / self.module),
            np.zeros_like(touch),
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

    def _straight(self, bent: Array) -> tuple[Array, Array]:
        """Value at mid-face and slope of the straight line through a motion of cells (..., n, 2, m)."""
        weights, z = self.cells.length[:, None], self.cells.z[:, None]
        weights = weights / weights.sum(axis=-1, keepdims=True)
        centre = np.sum(weights * z, axis=-1, keepdims=True)
        mean = np.sum(weights * bent, axis=-1)
        tilt = np.sum(weights * (z - centre) * bent, axis=-1)
        tilt = tilt / np.sum(weights * (z - centre) ** 2, axis=-1)
        return np.asarray(mean - tilt * centre[..., 0]), np.asarray(tilt)

    def _touch(self, forces: Array) -> Array:
        """Turn at which a flank touches first beside bent shafts, beyond that on straight ones (...) [m]."""
        apart = np.where(self.seen.used, self.seen.gaps, np.inf)
        bent = self.give(forces, self.seen).sum(axis=-2)
        return np.asarray((bent + apart).min(axis=-1) - apart.min(axis=-1))


def shafts_under_lines(
    face: FaceSetting, pair: GearPair, slope: float, cells: PlacesOnLines, seen: PlacesOnLines
) -> ShaftsUnderLines | None:
    """Bend, tilt and twist the shafts of a helical pair; None where both are rigid.

    Parameters
    ----------
    face : FaceSetting
    pair : GearPair
    slope : float
        d rho1/dz along a line of contact.
    cells, seen : PlacesOnLines
        Middles of the cells, and places at which the first touch is looked for.
    """
    if not face.on_shafts:
        return None
    first, second = (
        None if shaft is None else _between_nodes(shaft, pair.face_width, pair.face_offsets[gear])
        for gear, shaft in enumerate(face.shafts)
    )
    return ShaftsUnderLines(
        (first, second), pair.base_radii, slope, pair.face_width, pair.module, cells, seen
    )


@lru_cache(maxsize=32)
def _between_nodes(shaft: Shaft, width: float, offset: float) -> TiltingShaft:
    """A shaft between NODES equal places on the face, kept."""
    return tilting_shaft(shaft, (np.linspace(-0.5, 0.5, NODES)) * width, offset, width)
