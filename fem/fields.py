"""Displacement and stress of both gears at one mesh position, placed as they mesh.

The finite elements give the regular part; the near field of each contact is added back in closed form: Hertz
(McEwen) within a few half-widths, Flamant beyond, blended between. Stresses of the regular part are averaged
at the nodes.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem import flamant
from fem.compliance import Compliance, mesh_and_factor
from fem.compliance import compliance as _compliance
from fem.contact import MeshCycle
from fem.elasticity import PlaneElasticity, nodal_stress_matrix
from fem.errors import Fault, FemError
from fem.flexibility import CORNER_CLEARANCE
from fem.line_load import FlankPoints, flank_points, line_loads
from fem.picture import Picture, picture_of
from fem.ring import Ring

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["GearField", "loaded_fields"]

Array = NDArray[np.float64]

NEAR, FAR = 4.0, 8.0
"""Hertz within NEAR half-widths of a contact, Flamant beyond FAR."""


@dataclass(frozen=True, eq=False)
class GearField:
    """Fields of one gear in the common frame (pinion's axis at the origin, wheel's axis above it).

    Attributes
    ----------
    points : (n, 2) array
        Unloaded positions [m]; points of neighbouring sectors are not joined.
    cells : (m, 6) array
        Second-order triangles.
    tooth : (m,) array of int
        Tooth of each cell, 0 in the pair that entered last, counted anticlockwise.
    displacement_m : (n, 2) array
        Against the held hub.
    stress_Pa : (n, 4) array
        sigma_xx, sigma_yy, sigma_zz, tau_xy.
    von_mises_Pa : (n,) array
    principal_Pa : (n, 2) array
        Larger and smaller principal stress in the plane.
    energy_density_J_per_m3 : (n,) array
        Strain energy per volume.
    """

    points: Array
    cells: NDArray[np.int64]
    tooth: NDArray[np.int64]
    displacement_m: Array
    stress_Pa: Array
    von_mises_Pa: Array
    principal_Pa: Array
    energy_density_J_per_m3: Array

    @property
    def point_data(self) -> Mapping[str, Array]:
        """The fields by name, for files."""
        names = ("displacement_m", "stress_Pa", "von_mises_Pa", "principal_Pa", "energy_density_J_per_m3")
        return MappingProxyType({name: getattr(self, name) for name in names})


@dataclass(frozen=True, eq=False)
class _Contact:
    """One contact on a gear: tooth, place, line load [N/m] and half-width [m]."""

    tooth: int
    at: FlankPoints
    line_load: float
    half_width: float


def loaded_fields(
    pair: GearPair,
    cycle: MeshCycle,
    position: int,
    compliance: Compliance | None = None,
    rings: tuple[Ring, Ring] | None = None,
) -> tuple[GearField, GearField]:
    """Fields of pinion and wheel at one position of a mesh cycle.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    position : int
        Row of the cycle.
    compliance : Compliance, optional
        The one that the cycle was computed with.
    rings : tuple of Ring, optional
        Factorised gears of ``fem.compliance.mesh_and_factor``, to save time over several positions.

    Returns
    -------
    (GearField, GearField)
    """
    if not 0 <= position < len(cycle.position):
        allowed = f"0 to {len(cycle.position) - 1}"
        raise FemError(Fault("position", f"{position!r}", allowed, "give a row of the cycle"))
    bodies = compliance or _compliance(pair, plane=cycle.plane)
    if rings is None:
        rings, _ = mesh_and_factor(pair, bodies.plane, bodies.sizes, bodies.refinements)
    start = pair.points.A + cycle.position[position] * pair.base_pitch
    placed = pair.placement(float(start))
    turns = ((placed.pinion_angle, np.zeros(2)), (placed.wheel_angle, placed.wheel_centre))
    fields = []
    for gear, (ring, (angle, centre)) in enumerate(zip(rings, turns, strict=True)):
        contacts = _contacts(pair, cycle, position, ring, gear, bodies)
        fields.append(_gear_field(ring, contacts, angle, centre))
    return fields[0], fields[1]


def _contacts(
    pair: GearPair, cycle: MeshCycle, position: int, ring: Ring, gear: int, bodies: Compliance
) -> list[_Contact]:
    """List the loads on one gear; a tip edge presses at the least distance from the corner."""
    contacts = []
    flexible = (bodies.pinion, bodies.wheel)[gear]
    for column in np.flatnonzero(cycle.forces[position] > 0):
        line_load = float(cycle.forces[position, column]) / pair.face_width
        rho = float(cycle.flank_rho[gear][position, column])
        if cycle.edge[position, column]:
            half_width = CORNER_CLEARANCE * pair.module
        else:
            radius = pair.path_at(cycle.rho1[position, column]).radius
            laws = bodies.pinion.law, bodies.wheel.law
            reduced = 2 / sum(1 / law.plane_modulus for law in laws)
            half_width = float(flamant.hertz_half_width(np.array([line_load]), radius, reduced)[0])
        offset = int(cycle.pair_offset[column])
        at = flank_points(ring.mesh, np.array([min(rho, flexible.rho_range[1])]))
        contacts.append(_Contact(offset if gear == 0 else -offset, at, line_load, half_width))
    return contacts


def _gear_field(ring: Ring, contacts: list[_Contact], angle: float, centre: Array) -> GearField:
    mesh, z = ring.mesh, ring.mesh.teeth
    cuts = np.zeros((z, len(ring.cut)))
    inner = np.zeros((z, len(ring.inner)))
    loaded: dict[int, _Contact] = {}
    for contact in contacts:
        loads = line_loads(ring, contact.at)
        cuts += np.roll(ring.all_interfaces(loads.cut_force[:, 0]), contact.tooth, axis=0) * contact.line_load
        inner[contact.tooth % z] += loads.own_inner[:, 0] * contact.line_load
        loaded[contact.tooth % z] = contact
    nodal = np.zeros((z, mesh.unknowns))
    nodal[:, ring.cut] = cuts @ ring.polar.T
    nodal[:, ring.inner] = inner - nodal[:, ring.cut] @ ring.inner_by_cut.T
    for tooth, contact in loaded.items():
        nodal[tooth] -= _singular_on_edges(ring, contact)
    smooth = nodal_stress_matrix(mesh.points, mesh.triangles, ring.law)
    stress = np.asarray(smooth @ nodal.T).T.reshape(z, -1, 3)
    whole = picture_of(mesh)
    parts = []
    for k in range(-(z // 2), z - z // 2):
        contact_here = loaded.get(k % z)
        picture = whole
        if contact_here is not None:
            picture = picture_of(mesh, (contact_here.at.points[0], 0.35 * contact_here.half_width))
        sector = _Sector(nodal[k % z].reshape(-1, 2), stress[k % z], contact_here, picture)
        parts.append(_sector_field(ring, sector, angle + k * 2 * np.pi / z, centre, k))
    return _joined(parts, ring.law)


def _singular_on_edges(ring: Ring, contact: _Contact) -> Array:
    """u_s on the cuts and the hub of a loaded sector, zero inside: there u_r = u - u_s is the unknown."""
    singular = np.zeros(ring.mesh.unknowns)
    for unknowns in (ring.cut, ring.hub):
        points = ring.mesh.points[unknowns[::2] // 2]
        load = contact.at.points[0], contact.at.inward[0]
        singular[unknowns] = flamant.displacement(points, *load, ring.law, ring.mesh.module).ravel()
    return contact.line_load * singular


@dataclass(frozen=True, eq=False)
class _Sector:
    """Regular displacement (n, 2) and nodal stress (n, 3) of a sector, its contact, and what to draw."""

    moved: Array
    stress: Array
    contact: _Contact | None
    picture: Picture


def _sector_field(
    ring: Ring, sector: _Sector, angle: float, centre: Array, tooth: int
) -> tuple[Array, NDArray[np.int64], NDArray[np.int64], Array, Array]:
    """Points, cells, tooth, displacement and in-plane stress of one sector in the common frame."""
    picture = sector.picture
    points = picture.interpolate(ring.mesh.points)
    moved, components = picture.interpolate(sector.moved), picture.interpolate(sector.stress)
    stress = components[:, [[0, 2], [2, 1]]]
    if sector.contact is not None:
        near_displacement, near_stress = _near_field(points, sector.contact, ring.law, ring.mesh.module)
        moved, stress = moved + near_displacement, stress + near_stress
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c, -s], [s, c]])
    return (
        points @ turn.T + centre,
        picture.cells,
        np.full(len(picture.cells), tooth),
        moved @ turn.T,
        turn @ stress @ turn.T,
    )


def _near_field(points: Array, contact: _Contact, law: PlaneElasticity, length: float) -> tuple[Array, Array]:
    """Displacement and stress of the contact itself."""
    load, inward = contact.at.points[0], contact.at.inward[0]
    a, w = contact.half_width, contact.line_load
    r = np.linalg.norm(points - load, axis=1)
    inside = np.clip((FAR - r / a) / (FAR - NEAR), 0.0, 1.0)
    far = r > 0.5 * a  # inside this Hertz alone counts
    displacement, stress = np.zeros_like(points), np.zeros((len(points), 2, 2))
    displacement[far] = w * flamant.displacement(points[far], load, inward, law, length)
    stress[far] = w * flamant.stress(points[far], load, inward)
    close = inside > 0
    share = inside[close, None]
    spread = _hertz_displacement(points[close], contact, law, length)
    displacement[close] = (1 - share) * displacement[close] + share * spread
    pressed = flamant.hertz_stress(points[close], load, inward, a, 2 * w / (np.pi * a))
    stress[close] = (1 - share[..., None]) * stress[close] + share[..., None] * pressed
    return displacement, stress


def _hertz_displacement(points: Array, contact: _Contact, law: PlaneElasticity, length: float) -> Array:
    """Spread Flamant's displacement over the Hertz pressure by Gauss quadrature with weight sqrt(1 - t^2)."""
    n = 24
    angle = np.pi * np.arange(1, n + 1) / (n + 1)
    load, inward = contact.at.points[0], contact.at.inward[0]
    side = np.array([-inward[1], inward[0]])
    total = np.zeros_like(points)
    for t, weight in zip(np.cos(angle), 2 / (n + 1) * np.sin(angle) ** 2, strict=True):
        source = load + t * contact.half_width * side
        # a point that falls on a source is moved by much less than the sources are apart
        apart = points + 1e-3 * contact.half_width * inward
        total += weight * flamant.displacement(apart, source, inward, law, length)
    return contact.line_load * total


def _joined(
    parts: list[tuple[Array, NDArray[np.int64], NDArray[np.int64], Array, Array]], law: PlaneElasticity
) -> GearField:
    points, cells, tooth, moved, stress = zip(*parts, strict=True)
    starts = np.cumsum([0, *(len(p) for p in points[:-1])])
    plane = np.concatenate(stress)
    xx, yy, xy = plane[:, 0, 0], plane[:, 1, 1], plane[:, 0, 1]
    zz = law.out_of_plane_stress(plane)
    middle, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    mises = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)
    squares = xx**2 + yy**2 + zz**2 - 2 * law.nu * (xx * yy + yy * zz + zz * xx)
    energy = (squares + 2 * (1 + law.nu) * xy**2) / (2 * law.E)
    return GearField(
        np.concatenate(points),
        np.concatenate([cell + start for cell, start in zip(cells, starts, strict=True)]),
        np.concatenate(tooth),
        np.concatenate(moved),
        np.column_stack([xx, yy, zz, xy]),
        mises,
        np.column_stack([middle + radius, middle - radius]),
        energy,
    )
