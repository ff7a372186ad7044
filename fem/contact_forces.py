"""The contacts of one mesh position as points with force vectors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array, Faults, Integers
from fem.cycle import MeshCycle, check_row
from fem.fields import contact_half_width

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["ContactForces", "contact_forces"]

MIRROR: Array = np.array([-1.0, 1.0])


@dataclass(frozen=True, eq=False)
class ContactForces:
    """Contact forces on both gears in the common frame; each contact is listed once for each gear.

    Attributes
    ----------
    points : (n, 2) array
        Where the flanks touch [m].
    force_N : (n, 2) array
        On the gear of that row.
    gear : (n,) array of int
        0 the pinion, 1 the wheel.
    pair : (n,) array of int
        Base pitches that the pair of teeth is ahead of the one that entered last.
    tip_edge : (n,) array of int
        1 where a tip edge touches, outside the path of contact.
    pressure_Pa : (n,) array
        Greatest Hertz pressure; nan at tip edges, whose pressure has no such maximum.
    half_width_m : (n,) array
        Of the pressure; nan at tip edges.
    """

    points: Array
    force_N: Array
    gear: Integers
    pair: Integers
    tip_edge: Integers
    pressure_Pa: Array
    half_width_m: Array

    @property
    def point_data(self) -> Mapping[str, NDArray[np.generic]]:
        """The fields by name, for files."""
        names = ("force_N", "pressure_Pa", "half_width_m", "gear", "pair", "tip_edge")
        return MappingProxyType({name: getattr(self, name) for name in names})


def contact_forces(pair: GearPair, cycle: MeshCycle, row: int) -> ContactForces:
    """Contacts that bear at one position, with the normals of the flanks that are touched.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    row : int
        Of the cycle.

    Raises
    ------
    base.InputError
        A row that the cycle does not have, or that has no finite forces.
    """
    found = Faults()
    check_row(found, cycle, row)
    found.raise_if_any()
    columns = np.flatnonzero(cycle.forces[row] > 0)
    points, normals = np.empty((len(columns), 2)), np.empty((len(columns), 2))
    for i, column in enumerate(columns):
        points[i], normals[i] = _touched(pair, cycle, row, int(column))
    size = cycle.forces[row, columns]
    half = np.array([contact_half_width(pair, cycle, row, int(column)) for column in columns])
    edge = cycle.edge[row, columns]
    half = np.where(edge, np.nan, half)
    peak = 2 * size / (np.pi * half * pair.face_width)
    on_wheel = size[:, None] * normals
    return ContactForces(
        np.concatenate([points, points]),
        np.concatenate([-on_wheel, on_wheel]),
        np.repeat([0, 1], len(columns)),
        np.tile(cycle.pair_offset[columns], 2),
        np.tile(edge.astype(np.int64), 2),
        np.tile(peak, 2),
        np.tile(half, 2),
    )


def _touched(pair: GearPair, cycle: MeshCycle, row: int, column: int) -> tuple[Array, Array]:
    """Place of a contact, and the normal along the force on the wheel."""
    start = float(pair.points.A + cycle.position[row] * pair.base_pitch)
    placed = pair.placement(start)
    offset = int(cycle.pair_offset[column])
    # a tip edge touches the other gear's flank: the wheel's, when it comes after E
    after = bool(cycle.edge[row, column]) and start + offset * pair.base_pitch > pair.points.E
    touched = 1 if after else 0
    profile = pair.teeth_profiles[touched]
    rho = cycle.flank_rho[touched][row, column]
    angle = (placed.pinion_angle, placed.wheel_angle)[touched]
    angle += (offset if touched == 0 else -offset) * profile.pitch_angle
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    point = turn @ (profile.involute(rho) * MIRROR)
    normal = turn @ (profile.normal(rho) * MIRROR)
    if touched == 0:
        return point, normal
    return point + placed.wheel_centre, -normal
