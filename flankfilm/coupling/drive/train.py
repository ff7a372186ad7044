"""Unreduced drive train: both sides with all freedoms of their shafts, joined by the mesh, and its modes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag, eigh
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import eigsh, splu

from base import Array, Integers
from flankfilm.coupling.drive.drive_side import Side
from flankfilm.coupling.vibration.part_loads import DriveOutput

SIDES = ("pinion", "wheel")
DENSE = 300
"""Freedoms up to which all modes are computed at once."""

ROUNDED = 1e-12
"""What joins two freedoms by less, over the root of the product of what holds both, is rounding."""


@dataclass(frozen=True, eq=False)
class Train:
    """Drive train with all freedoms of its shafts.

    Attributes
    ----------
    mass, stiffness, dampers : sparse array, shape (n, n)
        Without the mesh but for its resistance to tilt; dampers are those of bearings.
    direction : ndarray, shape (n,)
        g: approach of the flanks where the mesh force acts, by the freedoms.
    tilt : ndarray, shape (n,)
        Tilt of the pinion's flank against the wheel's [rad].
    rotation : ndarray, shape (n,)
        Of the whole train, free.
    load : ndarray, shape (n,)
        Forces of motor and load that carry a mesh force of one.
    points : dict
        Names of displacements to factors on the freedoms.
    outputs : tuple of DriveOutput
    sides : (Side, Side)
    mesh_stiffness : float
        Mean of the mesh [N/m], with which the train is in contact.
    tilt_stiffness : float
        Of the mesh [N m/rad].
    """

    mass: Any
    stiffness: Any
    dampers: Any
    direction: Array
    tilt: Array
    rotation: Array
    load: Array
    points: dict[str, Array]
    outputs: tuple[DriveOutput, ...]
    sides: tuple[Side, Side]
    mesh_stiffness: float
    tilt_stiffness: float

    @property
    def in_contact(self) -> Any:
        """Stiffness with that of the mesh."""
        g = sparse.csc_array(self.direction[:, None])
        return (self.stiffness + self.mesh_stiffness * (g @ g.T)).tocsc()

    @property
    def out_of_mesh(self) -> Any:
        """Stiffness of shafts, bearings and couplings alone."""
        t = sparse.csc_array(self.tilt[:, None])
        return (self.stiffness - self.tilt_stiffness * (t @ t.T)).tocsc()

    @property
    def tilting_gain(self) -> float:
        """Moment that makes the train tilt as its shafts and bearings alone would under a moment of one.

        The mesh resists tilt about the loaded state, whose tilt the travelling load of the mesh cycle has brought: the
        moment that the train is driven by is as much larger as that resistance takes of it.
        """
        yields = float(self.tilt @ self.held().solve(self.tilt))
        return 1.0 / (1.0 - self.tilt_stiffness * yields)

    def held(self) -> Any:
        """Factors of the stiffness in contact, with the free rotation held at one freedom."""
        held = self.in_contact.tolil()
        at = int(np.argmax(self.rotation))
        held[at, at] += self.mesh_stiffness
        return splu(held.tocsc())


def joined(
    sides: tuple[Side, Side], mesh_stiffness: float, tilt_stiffness: float = 0.0, load_centre: float = 0.0
) -> Train:
    r"""Join both sides by the mesh.

    The mesh is a stiffness between (approach, tilt) and (force, tilting moment),
    :math:`k \, (1, z)^T (1, z) + \mathrm{diag}(0, k_\psi)`: a force at z from mid-face, and a resistance to tilt about
    that place.

    Parameters
    ----------
    sides : (Side, Side)
    mesh_stiffness : float
        Mean k [N/m].
    tilt_stiffness : float
        :math:`k_\psi` [N m/rad].
    load_centre : float
        z [m].
    """
    first, second = sides
    n, m = len(first.free), len(second.free)
    tilt = np.concatenate([first.tilt, -second.tilt])
    g = np.concatenate([first.mesh, -second.mesh]) + load_centre * tilt
    mass, firm, dampers = (
        sparse.csc_array(block_diag(*(getattr(side, name) for side in sides)))
        for name in ("mass", "stiffness", "damping")
    )
    load = np.zeros(n + m)
    load[first.torque], load[n + second.torque] = 1.0, -1.0
    t = sparse.csc_array(tilt[:, None])
    outputs, points = list[DriveOutput](), dict[str, Array]()
    for which, side, room in zip(SIDES, sides, ((0, m), (n, 0)), strict=True):
        points |= {f"{which} {name}": np.pad(row, room) for name, row in side.points.items()}
        for output in side.carried:
            rows = np.pad(output.displacement, room), np.pad(output.speed, room)
            outputs.append(DriveOutput(f"{which} {output.name}", output.unit, *rows))
    return Train(
        mass,
        (firm + tilt_stiffness * (t @ t.T)).tocsc(),
        dampers,
        g,
        tilt,
        np.concatenate([first.free, second.free]),
        load,
        points,
        tuple(outputs),
        sides,
        mesh_stiffness,
        tilt_stiffness,
    )


def lowest_modes(stiffness: Any, mass: Any, count: int, about: float) -> tuple[Array, Array]:
    """Squares of the lowest frequencies, rising, and modes of a mass of one, one column each.

    Parameters
    ----------
    stiffness, mass : sparse array, shape (n, n)
    count : int
    about : float
        Square of a frequency in the middle of those wanted, by which a free motion is distinguished from others.
    """
    n = stiffness.shape[0]
    if n <= DENSE or 3 * count > n:
        squares, modes = eigh(stiffness.toarray(), mass.toarray(), subset_by_index=(0, min(count, n) - 1))
        return np.asarray(squares), np.asarray(modes)
    apart = _apart(stiffness, mass)
    if len(apart) == 1:
        squares, modes = eigsh(stiffness, count, mass, sigma=-1e-3 * about, v0=np.ones(n))
    else:  # planes of a shaft and shafts alike have frequencies in common, of which one start finds one mode alone
        each = [
            lowest_modes(stiffness[at][:, at], mass[at][:, at], min(count, len(at)), about) for at in apart
        ]
        squares, modes = np.concatenate([part for part, _ in each]), block_diag(*(part for _, part in each))
        modes = modes[np.argsort(np.concatenate(apart))]
    order = np.argsort(squares)[:count]
    return np.asarray(squares[order]), np.asarray(modes[:, order])


def _apart(stiffness: Any, mass: Any) -> list[Integers]:
    """Freedoms of each part that neither stiffness nor mass joins to others but by rounding."""
    rows, columns = list[Integers](), list[Integers]()
    for matrix in (stiffness.tocoo(), mass.tocoo()):
        size = np.sqrt(np.abs(matrix.diagonal()))
        joins = np.abs(matrix.data) > ROUNDED * size[matrix.row] * size[matrix.col]
        rows.append(matrix.row[joins])
        columns.append(matrix.col[joins])
    ends = np.concatenate(rows), np.concatenate(columns)
    graph = sparse.coo_array((np.ones(len(ends[0])), ends), stiffness.shape)
    count, labels = connected_components(graph, directed=False)
    return [np.flatnonzero(labels == part) for part in range(count)]


@dataclass(frozen=True, eq=False)
class ShaftDamping:
    r"""Damping of shafts, bearings and couplings, as it projects to a few shapes.

    By modes without the mesh, :math:`C = M \Phi \, \mathrm{diag}(2 \zeta \omega) \, \Phi^T M`, where those beyond the
    ones computed have the rate of the highest of these; or after Rayleigh, without the free rotations. Dampers of
    bearings come on top.

    Attributes
    ----------
    train : Train
    modes : ndarray, shape (n, m)
        Of a mass of one.
    rates : ndarray, shape (m,)
        2 zeta omega [rad/s].
    rayleigh : (float, float), optional
    """

    train: Train
    modes: Array
    rates: Array
    rayleigh: tuple[float, float] | None = None

    def of(self, shapes: Array) -> Array:
        """Damping between shapes, one column each."""
        train = self.train
        damping = shapes.T @ (train.dampers @ shapes)
        if self.rayleigh is not None:
            n = len(train.sides[0].free)
            free = np.zeros((len(train.rotation), 2))
            free[:n, 0], free[n:, 1] = train.rotation[:n], train.rotation[n:]
            pushed = train.mass @ free
            part = pushed.T @ shapes
            held = shapes.T @ (train.mass @ shapes) - part.T @ np.linalg.solve(free.T @ pushed, part)
            alpha, beta = self.rayleigh
            return np.asarray(damping + alpha * held + beta * shapes.T @ (train.out_of_mesh @ shapes))
        part = self.modes.T @ (train.mass @ shapes)
        beyond = float(self.rates[-1]) if len(self.rates) < len(train.rotation) else 0.0
        rest = shapes.T @ (train.mass @ shapes) - part.T @ part
        return np.asarray(damping + part.T @ (self.rates[:, None] * part) + beyond * rest)


def shaft_damping(
    train: Train, ratios: Sequence[float], rayleigh: tuple[float, float] | None, count: int, about: float
) -> ShaftDamping:
    """Damping by modes, of ratios from the lowest on and the last for all above, or after Rayleigh."""
    squares, modes = lowest_modes(train.out_of_mesh, train.mass, count, about)
    frequencies = np.sqrt(np.maximum(squares, 0.0))
    each = np.append(ratios, np.full(len(frequencies), ratios[-1]))
    moving = np.arange(len(frequencies)) > 1  # both sides turn freely
    rates = np.where(moving, 2.0 * frequencies * each[np.maximum(np.arange(len(frequencies)) - 2, 0)], 0.0)
    return ShaftDamping(train, modes, rates, rayleigh)
