"""Displacement and stress of both gears at one mesh position, placed as they mesh.

The finite elements give the regular part; the near field of each contact is added back in closed form
(``fem.fields.near_field``). Stresses of the regular part are averaged at the nodes, across the cuts between sectors
too, and on free edges follow from the tangential strain (``fem.elasticity.recovery``).
"""

from __future__ import annotations

from collections.abc import Mapping
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
from fem.fields.corner_contacts import corner_contact, near_corner
from fem.fields.drawing import DrawnSector, GearDrawing, gear_drawing
from fem.fields.loaded_gears import frames
from fem.fields.near_field import Contact
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
    principal_direction: Array = quantity("1", "unit vector along the larger one", "point axis")
    energy_density_J_per_m3: Array = quantity("J/m3", "strain energy per volume", "point")

    @described("Pa", shown="MPa")
    def greatest_von_mises_Pa(self) -> float:
        """Maximum von Mises stress, but for places where stresses are only indicative."""
        return float(self.von_mises_Pa[self.cells[self.indicative == 0]].max())

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
        pinion, wheel = compliance.rings()
    else:
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
    fields = []
    for gear, (drawing, (angle, centre)) in enumerate(zip(drawn, turns, strict=True)):
        contacts = _contacts(pair, cycle, row, drawing.ring, gear, bodies)
        sectors = drawing.sectors(contacts)
        parts = [_Part.of(sector, angle, centre, pair.teeth_profiles[gear]) for sector in sectors]
        fields.append(_joined(parts, drawing.ring.law))
    return fields[0], fields[1]


def contact_half_width(pair: GearPair, cycle: MeshCycle, row: int, column: int) -> float:
    """Half-width of a contact's pressure [m]; an assumed one for a tip edge, that of the corner's clearance."""
    if cycle.edge[row, column]:
        return CORNER_CLEARANCE * pair.module
    radius = pair.path_at(cycle.rho1[row, column]).radius
    line_load = np.array([cycle.forces[row, column] / pair.face_width])
    return float(flamant.hertz_half_width(line_load, radius, reduced_modulus(pair, cycle.plane))[0])


def _contacts(
    pair: GearPair, cycle: MeshCycle, row: int, ring: Ring, gear: int, bodies: PairCompliance
) -> list[Contact]:
    """List the loads on one gear; at a tip corner those of the strips that bear."""
    contacts = []
    flexible = (bodies.pinion, bodies.wheel)[gear]
    for column in np.flatnonzero(cycle.forces[row] > 0):
        rho = float(cycle.flank_rho[gear][row, column])
        offset = int(cycle.pair_offset[column])
        tooth, line_load = (
            offset if gear == 0 else -offset,
            float(cycle.forces[row, column]) / pair.face_width,
        )
        at = flank_points(ring.mesh, np.array([min(rho, flexible.rho_range[1])]))
        half_width, edge = contact_half_width(pair, cycle, row, int(column)), bool(cycle.edge[row, column])
        corner = near_corner(cycle, row, int(column), half_width, bodies)
        if corner is None:
            unresolved = INDICATIVE * pair.module if edge else 0.0
            contacts.append(Contact(tooth, at, line_load, half_width, unresolved=unresolved))
        else:
            contacts.append(corner_contact(cycle, row, int(column), bodies, ring, gear, corner))
    return contacts


@record
class _Part:
    """One sector in the common frame."""

    points: Array
    cells: Integers
    tooth: Integers
    region: Integers
    indicative: Integers
    moved: Array
    stress: Array

    @classmethod
    def of(cls, sector: DrawnSector, angle: float, centre: Array, profile: ToothProfile) -> _Part:
        """Turn a sector to its place and number its cells."""
        whole = angle + sector.tooth * profile.pitch_angle
        c, s = np.cos(whole), np.sin(whole)
        turn = np.array([[c, -s], [s, c]])
        cells = sector.picture.cells
        middle = sector.points[cells[:, :3]].mean(axis=1)
        circles = np.array([profile.root_radius, profile.form_radius])
        near = np.zeros(len(cells), dtype=np.int64)
        if sector.contact is not None:
            away = np.linalg.norm(middle - sector.contact.sharp, axis=1)
            near[away < sector.contact.unresolved] = 1
        return cls(
            sector.points @ turn.T + centre,
            cells,
            np.full(len(cells), sector.tooth),
            np.searchsorted(circles, np.linalg.norm(middle, axis=1)),
            near,
            sector.displacement @ turn.T,
            turn @ sector.stress @ turn.T,
        )


def _von_mises(plane: Array, law: PlaneElasticity) -> Array:
    xx, yy, xy = plane[:, 0, 0], plane[:, 1, 1], plane[:, 0, 1]
    zz = law.out_of_plane_stress(plane)
    return np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)


def _joined(parts: list[_Part], law: PlaneElasticity) -> GearField:
    def all_of(name: str) -> Array:
        return np.concatenate([getattr(part, name) for part in parts])

    starts = np.cumsum([0, *(len(part.points) for part in parts[:-1])])
    cells = np.concatenate([part.cells + start for part, start in zip(parts, starts, strict=True)])
    plane, indicative = all_of("stress"), all_of("indicative").astype(np.int64)
    # stress that is only indicative is drawn no greater than the maximum elsewhere, which sets the range of colours
    size = _von_mises(plane, law)
    plane = (
        plane * np.minimum(1.0, size[cells[indicative == 0]].max() / np.maximum(size, 1e-300))[:, None, None]
    )
    xx, yy, xy = plane[:, 0, 0], plane[:, 1, 1], plane[:, 0, 1]
    zz = law.out_of_plane_stress(plane)
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    lean = 0.5 * np.arctan2(2 * xy, xx - yy)
    squares = xx**2 + yy**2 + zz**2 - 2 * law.nu * (xx * yy + yy * zz + zz * xx)
    return GearField(
        points=all_of("points"),
        cells=cells,
        tooth=all_of("tooth").astype(np.int64),
        region=all_of("region").astype(np.int64),
        indicative=indicative,
        displacement_m=all_of("moved"),
        stress_Pa=np.column_stack([xx, yy, zz, xy]),
        von_mises_Pa=_von_mises(plane, law),
        principal_Pa=np.column_stack([middle + radius, middle - radius]),
        principal_direction=np.column_stack([np.cos(lean), np.sin(lean)]),
        energy_density_J_per_m3=(squares + 2 * (1 + law.nu) * xy**2) / (2 * law.E),
    )
