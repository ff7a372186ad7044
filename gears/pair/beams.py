r"""Shafts as beams and torsion bars: stiffness and mass by finite elements, and what gear and torque feel of them.

Bending is Timoshenko's: an element of length L with :math:`\Phi = 12 E I / (\kappa G A L^2)` is exact for loads at its
ends (Przemieniecki, Theory of Matrix Structural Analysis, 1968, 5.6), with Cowper's :math:`\kappa` of a hollow circle
(J. Appl. Mech. 33, 1966, 335, doi:10.1115/1.3625046). Its mass follows the same shapes, with the rotary inertia of the
cross-section (Friedman and Kosmatka, Computers & Structures 47, 1993, 473, doi:10.1016/0045-7949(93)90243-7).
Torsion has quadratic elements. Frequencies of torsion err by the fourth power of the elements' length, those of
bending by the second where elements are shorter than the shaft is thick.

Static stiffness follows the static deflection (Guyan, AIAA J. 3, 1965, 380, doi:10.2514/3.2874).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from base import Array
from gears.pair.shafts import Shaft, ShaftSegment
from gears.tooth.material import Material

ELEMENTS = 32
"""Elements of a shaft, and at least one between neighbouring places: these spread the mass; one is exact in statics."""


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
    nodes = shaft_nodes(shaft)
    gear, torque = (node_at(nodes, at) for at in (shaft.gear_position, shaft.torque_position))
    stiffness, mass, damping = bending(shaft, nodes)
    shape = _followed(stiffness, [2 * gear])
    shares = [shape[2 * node_at(nodes, bearing.position), 0] for bearing in shaft.bearings]
    twist, inertia = torsion(shaft, nodes)
    turns = _followed(twist, sorted({2 * gear, 2 * torque}))
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
        k, moved, turned = _beam(segment, shaft.material, right - left)
        stiffness[at, at] += k
        mass[at, at] += moved + turned
    for bearing in shaft.bearings:
        j = 2 * node_at(nodes, bearing.position)
        stiffness[j, j] += bearing.stiffness
        damping[j, j] += bearing.damping
    return stiffness, mass, damping


def rotary(shaft: Shaft, nodes: Array) -> Array:
    """Mass of the cross-sections' tilt alone, which `bending` holds too; twice it is their polar inertia."""
    mass = np.zeros((2 * len(nodes),) * 2)
    for i, (left, right) in enumerate(pairwise(nodes.tolist())):
        at = slice(2 * i, 2 * i + 4)
        mass[at, at] += _beam(shaft.segment_at(0.5 * (left + right)), shaft.material, right - left)[2]
    return mass


def torsion(shaft: Shaft, nodes: Array) -> tuple[Array, Array]:
    """Stiffness and inertia of turns at nodes and midway between them, from the left, shape (2 n - 1, 2 n - 1)."""
    return _bar(shaft, nodes, shaft.material.shear_modulus, lambda segment: 2.0 * segment.second_moment)


def tension(shaft: Shaft, nodes: Array) -> tuple[Array, Array]:
    """Stiffness and mass of axial displacements at the same places as `torsion`, axial springs of bearings included."""
    stiffness, mass = _bar(shaft, nodes, shaft.material.youngs_modulus, lambda segment: segment.area)
    for bearing in shaft.bearings:
        at = 2 * node_at(nodes, bearing.position)
        stiffness[at, at] += bearing.axial_stiffness
    return stiffness, mass


def _bar(
    shaft: Shaft, nodes: Array, modulus: float, section: Callable[[ShaftSegment], float]
) -> tuple[Array, Array]:
    """Stiffness and inertia of a bar by quadratic elements, of a modulus and of each step's section."""
    size = 2 * len(nodes) - 1
    stiffness, inertia = np.zeros((size, size)), np.zeros((size, size))
    for i, length in enumerate(np.diff(nodes)):
        own = section(shaft.segment_at(0.5 * float(nodes[i] + nodes[i + 1])))
        at = slice(2 * i, 2 * i + 3)
        stiffness[at, at] += modulus * own / (3.0 * length) * BAR
        inertia[at, at] += shaft.material.density * own * length / 30.0 * BAR_MASS
    return stiffness, inertia


BAR = np.array([[7.0, -8.0, 1.0], [-8.0, 16.0, -8.0], [1.0, -8.0, 7.0]])
BAR_MASS = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]])
"""Quadratic bar: stiffness times 3 L / (G J), mass times 30 / (rho J L); in tension E and the area for G and J."""


def shaft_nodes(shaft: Shaft, elements: int = ELEMENTS) -> Array:
    """Places of the shaft, and equal parts between them that are no longer than the shaft over `elements` [m]."""
    places = shaft.places
    parts = np.maximum(np.ceil(np.diff(places) / shaft.length * elements - 1e-9), 1.0).astype(np.int64)
    inner = [
        np.linspace(left, right, n, endpoint=False)
        for (left, right), n in zip(pairwise(places.tolist()), parts.tolist(), strict=True)
    ]
    return np.append(np.concatenate(inner), places[-1])


def halved(nodes: Array) -> Array:
    """Nodes and the middles between them."""
    return np.sort(np.append(nodes, 0.5 * (nodes[1:] + nodes[:-1])))


def node_at(nodes: Array, position: float) -> int:
    """Index of the node at a place."""
    return int(np.argmin(np.abs(nodes - position)))


def _followed(stiffness: Array, kept: list[int]) -> Array:
    """Static deflection of all freedoms for unit motions of those kept, one column each."""
    rest = np.setdiff1d(np.arange(len(stiffness)), kept)
    rows, shape = stiffness[rest], np.zeros((len(stiffness), len(kept)))
    shape[kept] = np.eye(len(kept))
    shape[rest] = -np.linalg.solve(rows[:, rest], rows[:, kept])
    return shape


def _beam(segment: ShaftSegment, material: Material, length: float) -> tuple[Array, Array, Array]:
    """Stiffness with shear, mass and rotary inertia of a beam element, in deflection and slope of both ends."""
    nu, ratio = material.poisson_ratio, (segment.bore / segment.diameter) ** 2
    grown = (1.0 + ratio) ** 2
    kappa = 6.0 * (1.0 + nu) * grown / ((7.0 + 6.0 * nu) * grown + (20.0 + 12.0 * nu) * ratio)
    bend = material.youngs_modulus * segment.second_moment
    shear = 12.0 * bend / (kappa * material.shear_modulus * segment.area * length**2)
    p, whole = shear, (1.0 + shear) ** 2
    k = _of_ends(12.0, 6.0, -12.0, 6.0, 4.0 + p, 2.0 - p, length)
    moved = _of_ends(
        13.0 / 35.0 + 0.7 * p + p**2 / 3.0,
        11.0 / 210.0 + 11.0 * p / 120.0 + p**2 / 24.0,
        9.0 / 70.0 + 0.3 * p + p**2 / 6.0,
        -13.0 / 420.0 - 3.0 * p / 40.0 - p**2 / 24.0,
        1.0 / 105.0 + p / 60.0 + p**2 / 120.0,
        -1.0 / 140.0 - p / 60.0 - p**2 / 120.0,
        length,
    )
    turned = _of_ends(
        1.2,
        0.1 - 0.5 * p,
        -1.2,
        0.1 - 0.5 * p,
        2.0 / 15.0 + p / 6.0 + p**2 / 3.0,
        -1.0 / 30.0 - p / 6.0 + p**2 / 6.0,
        length,
    )
    line = material.density / whole
    return (
        bend / (length**3 * (1.0 + shear)) * k,
        line * segment.area * length * moved,
        line * segment.second_moment / length * turned,
    )


def _of_ends(vv: float, vs: float, vw: float, vt: float, ss: float, st: float, a: float) -> Array:
    """Symmetric matrix of deflection v and slope s of one end, w and t of the other; of a mirrored element the same."""
    return np.array(
        [
            [vv, vs * a, vw, vt * a],
            [vs * a, ss * a**2, -vt * a, st * a**2],
            [vw, -vt * a, vv, -vs * a],
            [vt * a, st * a**2, -vs * a, ss * a**2],
        ]
    )
