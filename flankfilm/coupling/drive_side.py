"""Half of a drive train: gear, shaft, bearings, coupling, and motor or load, as matrices along the line of action."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

import gears
from base import Array
from gears.beams import ReducedShaft, reduced


class Carried(NamedTuple):
    """What a part of a side carries: factors on displacements [m] and speeds [m/s] along the line of action."""

    name: str
    unit: str
    displacement: Array
    speed: Array


class Side(NamedTuple):
    """Half of the train, in turns times base radius and the gear's deflection along the line of action."""

    names: tuple[str, ...]
    mass: Array
    stiffness: Array
    damping: Array
    mesh: Array
    torque: int
    shaft: ReducedShaft | None
    carried: tuple[Carried, ...]

    @property
    def free(self) -> Array:
        """The rotation of the whole side, which nothing but the mesh holds."""
        return np.array([0.0 if name == "deflection" else 1.0 for name in self.names])


def drive_side(
    shaft: gears.Shaft | None,
    radius: float,
    inertia: float,
    mass: float,
    end: float,
    coupling: float | None,
    way: float,
) -> Side:
    """Half of a drive train; what bearings, shafts and couplings carry is positive as the driving flanks press.

    Parameters
    ----------
    shaft : Shaft or None
        None: rigid in rigid bearings.
    radius : float
        Of the gear's base circle [m].
    inertia, mass : float
        Of the gear [kg m2], [kg].
    end : float
        Moment of inertia of motor or load [kg m2].
    coupling : float or None
        Stiffness between shaft and motor or load [N m/rad]; None: rigid.
    way : float
        1 of the pinion, -1 of the wheel.
    """
    felt = None if shaft is None else reduced(shaft)
    twists = felt is not None and not math.isinf(felt.torsion_stiffness)
    turning = ("gear", *(["end"] if twists else []), *(["machine"] if coupling is not None else []))
    names = turning if felt is None else (*turning, "deflection")
    turns, n = len(turning), len(names)
    m, k, c = (np.zeros((n, n)) for _ in range(3))
    m[0, 0] = inertia / radius**2
    m[turns - 1, turns - 1] += end / radius**2
    carried: list[Carried] = []
    if felt is not None and shaft is not None:
        at = 2 if twists else 1
        m[:at, :at] += felt.inertia[:at, :at] / radius**2
        m[-1, -1], k[-1, -1], c[-1, -1] = (
            mass + felt.bending_mass, felt.bending_stiffness, felt.bending_damping
        )  # fmt: skip
        for i, (bearing, share) in enumerate(zip(shaft.bearings, felt.bearing_shares.tolist(), strict=True)):
            push, drag = np.zeros(n), np.zeros(n)
            push[-1], drag[-1] = -way * bearing.stiffness * share, -way * bearing.damping * share
            carried.append(Carried(f"bearing {i + 1}", "N", push, drag))
        if twists:
            carried.append(_spring("shaft", felt.torsion_stiffness, 0, radius, k, way))
    if coupling is not None:
        carried.append(_spring("coupling", coupling, turns - 2, radius, k, way))
    mesh = np.zeros(n)
    mesh[0] = mesh[-1 if felt is not None else 0] = 1.0
    return Side(names, m, k, c, mesh, turns - 1, felt, tuple(carried))


def _spring(name: str, firm: float, first: int, radius: float, stiffness: Array, way: float) -> Carried:
    """Torsional spring between a turn and the next, put into the stiffness, and the torque that it carries."""
    at = slice(first, first + 2)
    stiffness[at, at] += firm / radius**2 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    twist = np.zeros(len(stiffness))
    twist[at] = way * firm / radius * np.array([-1.0, 1.0])
    return Carried(name, "N m", twist, np.zeros(len(stiffness)))
