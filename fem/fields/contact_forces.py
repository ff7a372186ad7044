"""The contacts of one mesh position as points with force vectors."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Integers, quantity, record
from fem.cycle.cycle_rows import require_row
from fem.cycle.result import MeshCycle
from fem.elasticity.plane_elasticity import MIRROR
from fem.fields.loaded_gears import frames
from fem.fields.stress_fields import contact_half_width, of_axis
from gears.tooth.rotation import turned

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["ContactForces", "contact_forces"]


@record
class ContactForces:
    """Contact forces on both gears in the common frame; each contact is listed once for each gear."""

    no_error = "not estimated for single contacts; the cycle has errors of its means and extremes"

    points: Array = quantity("m", "where the flanks touch", "point axis")
    force_N: Array = quantity("N", "force on the gear of that row", "point axis")
    pressure_Pa: Array = quantity(
        "Pa", "maximum Hertz pressure; nan at tip edges, whose pressure has no such maximum", "point"
    )
    half_width_m: Array = quantity("m", "half-width of the pressure; nan at tip edges", "point")
    gear: Integers = quantity("1", "0 the pinion, 1 the wheel", "point")
    pair: Integers = quantity(
        "1", "base pitches that the pair of teeth is ahead of the one that entered last", "point"
    )
    tip_edge: Integers = quantity("1", "1 where a tip edge touches, outside the path of contact", "point")

    @property
    def point_data(self) -> Mapping[str, Any]:
        """The fields by name, for files."""
        return of_axis(self, "point")


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
    require_row(cycle, row)
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
        points=np.concatenate([points, points]),
        force_N=np.concatenate([-on_wheel, on_wheel]),
        pressure_Pa=np.tile(peak, 2),
        half_width_m=np.tile(half, 2),
        gear=np.repeat([0, 1], len(columns)),
        pair=np.tile(cycle.pair_offset[columns], 2),
        tip_edge=np.tile(edge.astype(np.int64), 2),
    )


def _touched(pair: GearPair, cycle: MeshCycle, row: int, column: int) -> tuple[Array, Array]:
    """Place of a contact, and the normal along the force on the wheel."""
    start = float(pair.points.A + cycle.loaded_position[row] * pair.base_pitch)
    offset = int(cycle.pair_offset[column])
    # a tip edge touches the other gear's flank: the wheel's, when it comes after E
    after = bool(cycle.edge[row, column]) and start + offset * pair.base_pitch > pair.points.E
    touched = 1 if after else 0
    profile = pair.teeth_profiles[touched]
    rho = cycle.flank_rho[touched][row, column]
    angle, axis = frames(pair, start)[touched]
    ahead = 1 if touched == 0 else -1
    at = np.stack([profile.involute(rho), profile.normal(rho)]) * MIRROR
    point, normal = turned(at, angle + ahead * offset * profile.pitch_angle)
    return point + axis, ahead * normal
