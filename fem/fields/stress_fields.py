"""Displacement and stress of both gears at one mesh position, placed as they mesh.

The finite elements give the regular part; the near field of each contact is added back in closed form
(``fem.fields.near_field``). Stresses of the regular part are averaged at the nodes, across the cuts between sectors
too, and on free edges follow from the tangential strain (``fem.elasticity.recovery``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Integers, described, quantities, quantity, record
from fem.cycle.cycle_rows import require_row
from fem.cycle.result import MeshCycle
from fem.elasticity import flamant
from fem.elasticity.flank_samples import CORNER_CLEARANCE
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, reduced_modulus
from fem.elasticity.ring import Ring, mesh_and_factor
from fem.elasticity.support import held_profiles
from fem.fields.corner_contacts import CornerPressure, corner_contact, corner_pressure
from fem.fields.drawing import DrawnSector, GearDrawing, gear_drawing
from fem.fields.loaded_gears import frames
from fem.fields.near_field import Contact
from fem.fields.turn import Turn
from fem.influence.gear_store import GearStore
from fem.pair.compliance import compliance as _compliance
from fem.pair.pair_compliance import PairCompliance

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile

__all__ = ["REGIONS", "GearField", "draw_gears", "loaded_fields", "of_axis"]

REGIONS = ("rim", "fillet", "flank")
"""Names of the numbers in ``GearField.region``: inside the root circle, up to the form circle, beyond it."""

INDICATIVE = 0.3
"""Distance from a tip edge pressed over an assumed width within which stresses are only indicative, in modules."""


@record
class GearField:
    """Fields of one gear in the common frame (pinion's axis at the origin, wheel's axis above it)."""

    no_error = "not estimated; cells next to a contact are marked indicative"

    headline = ("greatest_von_mises_Pa",)

    points: Array = quantity(
        "m", "unloaded position; points of neighbouring sectors are not joined", "point axis"
    )
    cells: Integers = quantity("1", "points of each second-order triangle", "cell node")
    tooth: Integers = quantity("1", "tooth, 0 in the pair that entered last, counted anticlockwise", "cell")
    region: Integers = quantity("1", "index into REGIONS", "cell")
    indicative: Integers = quantity(
        "1",
        "1 beside a tip corner that presses, where stress is unbounded, or has an assumed width of pressure",
        "cell",
    )
    displacement_m: Array = quantity("m", "displacement against the held hub", "point axis")
    stress_Pa: Array = quantity("Pa", "sigma_xx, sigma_yy, sigma_zz, tau_xy", "point component")
    von_mises_Pa: Array = quantity("Pa", "von Mises stress", "point")
    principal_Pa: Array = quantity("Pa", "larger and smaller principal stress in the plane", "point which")
    energy_density_J_per_m3: Array = quantity("J/m3", "strain energy per volume", "point")

    @described("Pa", shown="MPa")
    def greatest_von_mises_Pa(self) -> float:
        """Maximum von Mises stress, but for places where stresses are only indicative."""
        return float(self.von_mises_Pa[self.cells[self.indicative == 0]].max())

    @described("1", "point axis")
    def principal_direction(self) -> Array:
        """Unit vector along the larger principal stress."""
        xx, yy, _, xy = self.stress_Pa.T
        lean = 0.5 * np.arctan2(2 * xy, xx - yy)
        return np.stack([np.cos(lean), np.sin(lean)], axis=1)

    @property
    def point_data(self) -> Mapping[str, Array]:
        """The fields by name, for files."""
        return of_axis(self, "point")

    @property
    def cell_data(self) -> Mapping[str, Integers]:
        """Numbers of the cells by name, for files."""
        return of_axis(self, "cell")


def of_axis(fields: object, axis: str) -> Mapping[str, Any]:
    """Figures of a record along an axis by name, without the points and cells themselves."""
    entries = quantities(fields).items()
    return MappingProxyType(
        {
            name: entry.value
            for name, entry in entries
            if entry.figure.dims[:1] == (axis,) and name not in ("points", "cells")
        }
    )


def draw_gears(
    pair: GearPair, compliance: PairCompliance, refinements: int | None = None
) -> tuple[GearDrawing, GearDrawing]:
    """Mesh and factorise both gears and prepare their drawing, for any number of positions.

    Parameters
    ----------
    pair : gears.GearPair
    compliance : PairCompliance
        Whose sizes and refinements are used.
    refinements : int, optional
        Other ones.
    """
    if refinements is None or refinements == compliance.refinements:
        # parts of a series come with copies of the pair: what draws its gears is found again
        first, second = (
            GearStore().drawing((meshed, compliance.pair.module, ring.law), partial(gear_drawing, ring))
            for meshed, ring in zip(compliance.meshed, compliance.rings(), strict=True)
        )
        return first, second
    profiles = held_profiles(pair, compliance.supports)
    pinion, wheel = mesh_and_factor(pair, compliance.plane, compliance.sizes, refinements, profiles)
    return gear_drawing(pinion), gear_drawing(wheel)


def loaded_fields(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    compliance: PairCompliance | None = None,
    drawings: tuple[GearDrawing, GearDrawing] | None = None,
) -> tuple[GearField, GearField]:
    """Fields of pinion and wheel at one position of a mesh cycle.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    row : int
        Of the cycle.
    compliance : PairCompliance, optional
        The one that the cycle was computed with.
    drawings : tuple of GearDrawing, optional
        Of ``draw_gears``, to save time over several positions.

    Returns
    -------
    (GearField, GearField)

    Raises
    ------
    base.InputError
        A row that the cycle does not have, or that has no finite forces.
    """
    require_row(cycle, row)
    bodies = compliance or _compliance(pair, plane=cycle.plane)
    drawn = drawings or draw_gears(pair, bodies)
    turns = frames(pair, float(pair.points.A + cycle.loaded_position[row] * pair.base_pitch))
    loads, fields = _loads(pair, cycle, row, bodies), []
    for gear, (drawing, (angle, centre)) in enumerate(zip(drawn, turns, strict=True)):
        places = cycle.flank_rho[gear][row]
        contacts = [_contact(load, gear, float(places[load.column]), drawing.ring, bodies) for load in loads]
        sectors = drawing.sectors(contacts)
        fields.append(_placed(sectors, angle, centre, pair.teeth_profiles[gear], drawing.ring.law))
    return fields[0], fields[1]


def contact_half_width(pair: GearPair, cycle: MeshCycle, row: int, column: int) -> float:
    """Half-width of a contact's pressure [m]; an assumed one for a tip edge, that of the corner's clearance."""
    if cycle.edge[row, column]:
        return CORNER_CLEARANCE * pair.module
    radius = pair.path_at(cycle.rho1[row, column]).radius
    line_load = np.array([cycle.forces[row, column] / pair.face_width])
    return float(flamant.hertz_half_width(line_load, radius, reduced_modulus(pair, cycle.plane))[0])


@record
class _Load:
    """One loaded pair of teeth, as both gears have it."""

    column: int
    ahead: int
    line_load: float
    half_width: float
    edge: bool
    near: CornerPressure | None


def _loads(pair: GearPair, cycle: MeshCycle, row: int, bodies: PairCompliance) -> list[_Load]:
    """List the pairs that bear; at a tip corner with the strips that do."""
    loads = []
    for column in np.flatnonzero(cycle.forces[row] > 0).tolist():
        half_width = contact_half_width(pair, cycle, row, column)
        near = corner_pressure(cycle, row, column, half_width, bodies)
        line_load, edge = float(cycle.forces[row, column]) / pair.face_width, bool(cycle.edge[row, column])
        loads.append(_Load(column, int(cycle.pair_offset[column]), line_load, half_width, edge, near))
    return loads


def _contact(load: _Load, gear: int, rho: float, ring: Ring, bodies: PairCompliance) -> Contact:
    """Load on one gear at a curvature radius of its flank [m], or where the strips press."""
    tooth = load.ahead if gear == 0 else -load.ahead
    if load.near is not None:
        return corner_contact(load.near, tooth, gear, ring, bodies)
    end = (bodies.pinion, bodies.wheel)[gear].rho_range[1]
    at = flank_points(ring.mesh, np.array([min(rho, end)]))
    unresolved = INDICATIVE * bodies.pair.module if load.edge else 0.0
    return Contact(tooth, at, load.line_load, load.half_width, unresolved=unresolved)


def _placed(
    sectors: Sequence[DrawnSector], angle: float, centre: Array, profile: ToothProfile, law: PlaneElasticity
) -> GearField:
    """Turn all sectors of a gear to their places and number their cells."""
    counts = [len(sector.points) for sector in sectors]
    starts = np.cumsum([0, *counts[:-1]])
    cells = np.concatenate(
        [sector.picture.cells + start for sector, start in zip(sectors, starts, strict=True)]
    )
    teeth = np.array([sector.tooth for sector in sectors])
    turn = Turn.by(np.repeat(angle + teeth * profile.pitch_angle, counts))
    points = np.concatenate([sector.points for sector in sectors])
    middles = np.mean([points[corner] for corner in cells[:, :3].T], axis=0)
    indicative = np.zeros(len(cells), dtype=np.int64)
    tooth = np.repeat(teeth, [len(sector.picture.cells) for sector in sectors])
    for sector in sectors:
        if sector.contact is not None:
            own = np.flatnonzero(tooth == sector.tooth)
            away = np.linalg.norm(middles[own] - sector.contact.sharp, axis=1)
            indicative[own[away < sector.contact.unresolved]] = 1
    circles = np.array([profile.root_radius, profile.form_radius])
    stress = turn.stresses(np.concatenate([sector.stress for sector in sectors]))
    # stress that is only indicative is drawn no greater than the maximum elsewhere, which sets the range of colours
    size = _von_mises(stress, law)
    drawn = np.minimum(size, size[cells[indicative == 0]].max())
    xx, yy, xy = (stress * (drawn / np.maximum(size, 1e-300))[:, None]).T
    zz = law.out_of_plane_stress(xx + yy)
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    # of changes of shape and of volume
    energy = (1 + law.nu) / (3 * law.E) * drawn**2 + (1 - 2 * law.nu) / (6 * law.E) * (xx + yy + zz) ** 2
    return GearField(
        points=turn.vectors(points) + centre,
        cells=cells,
        tooth=tooth,
        region=np.searchsorted(circles, np.linalg.norm(middles, axis=1)),
        indicative=indicative,
        displacement_m=turn.vectors(np.concatenate([sector.displacement for sector in sectors])),
        stress_Pa=np.column_stack([xx, yy, zz, xy]),
        von_mises_Pa=drawn,
        principal_Pa=np.column_stack([middle + radius, middle - radius]),
        energy_density_J_per_m3=energy,
    )


def _von_mises(stress: Array, law: PlaneElasticity) -> Array:
    """Von Mises stress (n,) of sigma_xx, sigma_yy, tau_xy (n, 3)."""
    xx, yy, xy = stress.T
    zz = law.out_of_plane_stress(xx + yy)
    return np.asarray(np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2))
