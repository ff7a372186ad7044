r"""Shafts as beams and torsion bars: stiffness and mass by finite elements, reduced to gear and torque.

Bending is Timoshenko's: an element of length L with :math:`\Phi = 12 E I / (\kappa G A L^2)` is exact for loads at its
ends (Przemieniecki, Theory of Matrix Structural Analysis, 1968, 5.6), with Cowper's :math:`\kappa` of a hollow circle
(J. Appl. Mech. 33, 1966, 335, doi:10.1115/1.3625046). Reduction to a few freedoms follows the static deflection
(Guyan, AIAA J. 3, 1965, 380, doi:10.2514/3.2874): it keeps every static answer, and the mass that goes along.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from base import Array
from gears.material import Material
from gears.shafts import Shaft, ShaftSegment

PARTS = 8
"""Elements between neighbouring places: the mass is spread by them, the static deflection is exact with one."""


@dataclass(frozen=True, eq=False)
class ReducedShaft:
    """Shaft as its gear and its torque feel it.

    Attributes
    ----------
    bending_stiffness : float
        Force over deflection of the gear [N/m], bearings included.
    bending_damping : float
        Of the bearings, at the gear [N s/m].
    bending_mass : float
        Of the shaft, at the gear [kg].
    bearing_shares : ndarray, shape (bearings,)
        Deflection in each bearing over that of the gear.
    slope : float
        Tilt of the shaft at the gear over the gear's deflection [rad/m].
    torsion_stiffness : float
        Torque over twist between gear and torque [N m/rad]; infinite where they sit at one place.
    inertia : ndarray, shape (2, 2)
        Of the shaft, for the turns of gear and torque's end [kg m2].
    """

    bending_stiffness: float
    bending_damping: float
    bending_mass: float
    bearing_shares: Array
    slope: float
    torsion_stiffness: float
    inertia: Array


def reduced(shaft: Shaft) -> ReducedShaft:
    """Reduce a shaft to the deflection of its gear and the turns of gear and torque's end.

    Parameters
    ----------
    shaft : Shaft
        The shaft.

    Examples
    --------
    >>> from gears import Bearing, Shaft, ShaftSegment
    >>> shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.0, 1e12), Bearing(0.2, 1e12)), 0.1, 0.0)
    >>> round(1e-6 * reduced(shaft).bending_stiffness, 1)  # 48 E I / L^3 = 49.1 N/um, with shear
    46.8
    """
    nodes = _nodes(shaft)
    gear, torque = (int(np.argmin(np.abs(nodes - at))) for at in (shaft.gear_position, shaft.torque_position))
    stiffness, mass, damping = bending(shaft, nodes)
    shape = _followed(stiffness, [2 * gear])
    shares = [shape[2 * int(np.argmin(np.abs(nodes - bearing.position))), 0] for bearing in shaft.bearings]
    twist, inertia = torsion(shaft, nodes)
    turns = _followed(twist, sorted({gear, torque}))
    if gear == torque:
        turns, firm = np.hstack([turns, np.zeros_like(turns)]), np.inf
    else:
        turns = turns if gear < torque else turns[:, ::-1]
        firm = float((turns.T @ twist @ turns)[0, 0])
    return ReducedShaft(
        bending_stiffness=float((shape.T @ stiffness @ shape)[0, 0]),
        bending_damping=float((shape.T @ damping @ shape)[0, 0]),
        bending_mass=float((shape.T @ mass @ shape)[0, 0]),
        bearing_shares=np.array(shares),
        slope=float(shape[2 * gear + 1, 0]),
        torsion_stiffness=firm,
        inertia=np.asarray(turns.T @ inertia @ turns),
    )


def bending(shaft: Shaft, nodes: Array) -> tuple[Array, Array, Array]:
    """Stiffness, mass and damping of deflections and slopes at nodes, shape (2 n, 2 n), bearings included."""
    size = 2 * len(nodes)
    stiffness, mass, damping = (np.zeros((size, size)) for _ in range(3))
    for i, (left, right) in enumerate(pairwise(nodes.tolist())):
        segment = shaft.segment_at(0.5 * (left + right))
        at = slice(2 * i, 2 * i + 4)
        k, m = _beam(segment, shaft.material, right - left)
        stiffness[at, at] += k
        mass[at, at] += m
    for bearing in shaft.bearings:
        j = 2 * int(np.argmin(np.abs(nodes - bearing.position)))
        stiffness[j, j] += bearing.stiffness
        damping[j, j] += bearing.damping
    return stiffness, mass, damping


def torsion(shaft: Shaft, nodes: Array) -> tuple[Array, Array]:
    """Stiffness and inertia of turns at nodes, shape (n, n)."""
    stiffness, inertia = np.zeros((len(nodes),) * 2), np.zeros((len(nodes),) * 2)
    for i, length in enumerate(np.diff(nodes)):
        segment = shaft.segment_at(0.5 * float(nodes[i] + nodes[i + 1]))
        polar, at = 2.0 * segment.second_moment, slice(i, i + 2)
        spring = shaft.material.shear_modulus * polar / length
        stiffness[at, at] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
        inertia[at, at] += shaft.material.density * polar * length / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])
    return stiffness, inertia


def _nodes(shaft: Shaft) -> Array:
    """Places of the shaft and equal parts between them."""
    places = shaft.places
    inner = np.linspace(places[:-1], places[1:], PARTS, endpoint=False).T.ravel()
    return np.append(inner, places[-1])


def _followed(stiffness: Array, kept: list[int]) -> Array:
    """Static deflection of all freedoms for unit motions of those kept, one column each."""
    rest = np.setdiff1d(np.arange(len(stiffness)), kept)
    rows, shape = stiffness[rest], np.zeros((len(stiffness), len(kept)))
    shape[kept] = np.eye(len(kept))
    shape[rest] = -np.linalg.solve(rows[:, rest], rows[:, kept])
    return shape


def _beam(segment: ShaftSegment, material: Material, length: float) -> tuple[Array, Array]:
    """Stiffness with shear and consistent mass of a beam element, in deflection and slope of both ends."""
    nu, ratio = material.poisson_ratio, (segment.bore / segment.diameter) ** 2
    grown = (1.0 + ratio) ** 2
    kappa = 6.0 * (1.0 + nu) * grown / ((7.0 + 6.0 * nu) * grown + (20.0 + 12.0 * nu) * ratio)
    bend = material.youngs_modulus * segment.second_moment
    shear = 12.0 * bend / (kappa * material.shear_modulus * segment.area * length**2)
    a = length
    k = np.array(
        [
            [12.0, 6.0 * a, -12.0, 6.0 * a],
            [6.0 * a, (4.0 + shear) * a**2, -6.0 * a, (2.0 - shear) * a**2],
            [-12.0, -6.0 * a, 12.0, -6.0 * a],
            [6.0 * a, (2.0 - shear) * a**2, -6.0 * a, (4.0 + shear) * a**2],
        ]
    )
    m = np.array(
        [
            [156.0, 22.0 * a, 54.0, -13.0 * a],
            [22.0 * a, 4.0 * a**2, 13.0 * a, -3.0 * a**2],
            [54.0, 13.0 * a, 156.0, -22.0 * a],
            [-13.0 * a, -3.0 * a**2, -22.0 * a, 4.0 * a**2],
        ]
    )
    line = material.density * segment.area
    return bend / (a**3 * (1.0 + shear)) * k, line * a / 420.0 * m
