"""Half of a drive train: gear, shaft, bearings, coupling, and motor or load, as matrices."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import gears
from base import Array
from flankfilm.coupling.drive.bent_shaft import GearBody, bent_shaft
from gears.pair.beams import ReducedShaft, halved, node_at, reduced, shaft_nodes, torsion


class Carried(NamedTuple):
    """What a part of a side carries: factors on displacements [m] and speeds [m/s] of its freedoms."""

    name: str
    unit: str
    displacement: Array
    speed: Array


class Side(NamedTuple):
    """Half of the train: turns times base radius, then what the shaft has besides (`BentShaft`).

    Attributes
    ----------
    mass, stiffness, damping : ndarray, shape (n, n)
        Damping is that of the bearings' dampers.
    mesh, tilt : ndarray, shape (n,)
        Approach of the gear's flank at mid-face, and tilt of the gear in the plane of action [rad], by the freedoms.
    free : ndarray, shape (n,)
        Rotation of the whole side, which nothing but the mesh holds.
    torque : int
        Freedom that motor or load acts on.
    points : dict
        Names to factors on the freedoms: displacements that modes are shown by.
    carried : tuple of Carried
    shaft : ReducedShaft or None
    spin : ndarray, shape (n, n)
        Polar inertia of shaft and gear as it meets slopes: gyroscopic moments over the speed of turning. They lead
        from the plane of action to the one across it; with a helical gear both are in it, and it is skew.
    """

    mass: Array
    stiffness: Array
    damping: Array
    mesh: Array
    tilt: Array
    free: Array
    torque: int
    points: dict[str, Array]
    carried: tuple[Carried, ...]
    shaft: ReducedShaft | None
    spin: Array


def drive_side(
    shaft: gears.Shaft | None,
    gear: GearBody,
    end: float,
    coupling: float | None,
    way: float,
    refined: bool = False,
) -> Side:
    """Half of a drive train; what bearings, shafts and couplings carry is positive as the driving flanks press.

    Parameters
    ----------
    shaft : Shaft or None
        None: rigid in rigid bearings.
    gear : GearBody
    end : float
        Moment of inertia of motor or load [kg m2].
    coupling : float or None
        Stiffness between shaft and motor or load [N m/rad]; None: rigid.
    way : float
        1 of the pinion, -1 of the wheel.
    refined : bool
        Whether elements of the shaft are half as long.
    """
    nodes = np.zeros(0) if shaft is None else shaft_nodes(shaft)
    nodes = halved(nodes) if refined and shaft is not None else nodes
    twist, inertia = (np.zeros((1, 1)),) * 2 if shaft is None else torsion(shaft, nodes)
    at_gear, at_end = (0, 0) if shaft is None else (2 * node_at(nodes, x) for x in _places(shaft))
    turns = len(twist) + (coupling is not None)
    bent = None if shaft is None else bent_shaft(shaft, nodes, gear, way)
    n = turns + (0 if bent is None else len(bent.mesh))
    k, m, c, spin = (np.zeros((n, n)) for _ in range(4))
    k[: len(twist), : len(twist)], m[: len(twist), : len(twist)] = twist, inertia
    m[at_gear, at_gear] += gear.inertia
    torque = at_end if coupling is None else turns - 1
    m[torque, torque] += end
    carried, points = list[Carried](), {"gear": _unit(n, at_gear)}
    if bent is not None:
        for whole, part in zip((k, m, c, spin), bent[:4], strict=True):
            whole[turns:, turns:] = part
        for name, firm, damping, row in bent.bearings:
            moved = np.pad(row, (turns, 0))
            carried.append(Carried(name, "N", firm * moved, damping * moved))
    felt = None if shaft is None else reduced(shaft)
    springs = {}
    if felt is not None and not math.isinf(felt.torsion_stiffness):
        points["end"] = _unit(n, at_end)
        springs["shaft"] = (felt.torsion_stiffness, at_gear, at_end)
    if coupling is not None:
        at = np.array([at_end, torque])
        k[np.ix_(at, at)] += coupling * np.array([[1.0, -1.0], [-1.0, 1.0]])
        points["machine"] = _unit(n, torque)
        springs["coupling"] = (coupling, at_end, torque)
    for name, (firm, start, stop) in springs.items():
        row = way * firm / gear.radius * (_unit(n, stop) - _unit(n, start))
        carried.append(Carried(name, "N m", row, np.zeros(n)))
    k[:turns, :turns] /= gear.radius**2
    m[:turns, :turns] /= gear.radius**2
    mesh, tilt, free = _unit(n, at_gear), np.zeros(n), np.zeros(n)
    free[:turns] = 1.0
    if bent is not None:
        mesh[turns:], tilt[turns:] = bent.mesh, bent.tilt
        points |= {name: np.pad(row, (turns, 0)) for name, row in bent.points.items()}
    return Side(m, k, c, mesh, tilt, free, torque, points, tuple(carried), felt, spin)


def _places(shaft: gears.Shaft) -> tuple[float, float]:
    """Where gear and torque sit."""
    return shaft.gear_position, shaft.torque_position


def _unit(n: int, at: int) -> Array:
    """Row of n with a one."""
    row = np.zeros(n)
    row[at] = 1.0
    return row
