"""Gears meshed, placed as they mesh at one position of a cycle, and loaded by the forces of their contacts.

The forces are consistent with the elements, f_i = integral of p N_i n ds, with Hertz's pressure p or with a line
load; n is the exact involute's normal. A tip edge has no width: its contact is a line load, at a hundredth of the
module from the corner, along the normal of the flank that it touches. Both gears stand in the common frame
(pinion's axis at the origin, the wheel's above it). SI units throughout.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, record
from fem.cycle.cycle_rows import check_row
from fem.cycle.result import MeshCycle
from fem.elasticity.flamant import hertz_half_width
from fem.elasticity.flank_samples import CORNER_CLEARANCE
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import MIRROR, PlaneElasticity, reduced_modulus
from gears.tooth.rotation import turned
from meshes import GearMesh, SectorMesh, Sizes, gear_mesh, mesh_sector

if TYPE_CHECKING:
    from gears import GearPair, ToothProfile

__all__ = [
    "FlankForce",
    "LoadedGear",
    "flank_forces",
    "frames",
    "loaded_gears",
    "nodal_forces",
    "placed_gears",
]

SPREAD_POINTS = 256
"""Line loads that stand for a Hertz pressure."""


@record
class FlankForce:
    """One contact's force on a gear, in the frame of the tooth that bears it (left flank, tooth along +y).

    Attributes
    ----------
    tooth : int
        Counted anticlockwise, 0 in the pair that entered last.
    rho : float
        Curvature radius of the involute at the middle of the contact [m].
    line_load : float
        Force per face width [N/m].
    half_width : float
        Of Hertz's pressure [m]; 0 for a line load.
    direction : (2,) array or None
        Of a line load; normal to the flank unless given.
    """

    tooth: int
    rho: float
    line_load: float
    half_width: float = 0.0
    direction: Array | None = None


@record
class LoadedGear:
    """A gear's mesh in the common frame with its nodal forces.

    Attributes
    ----------
    name : str
        ``pinion`` or ``wheel``.
    mesh : GearMesh
    axis : (2,) array
        [m]
    law : PlaneElasticity
    face_width : float
        [m]
    forces : (nodes, 2) array
        [N], of the whole face width.
    """

    name: str
    mesh: GearMesh
    axis: Array
    law: PlaneElasticity
    face_width: float
    forces: Array


def flank_forces(
    pair: GearPair, cycle: MeshCycle, row: int, spread: str = "hertz"
) -> tuple[tuple[FlankForce, ...], tuple[FlankForce, ...]]:
    """Forces on pinion and wheel at one position of a mesh cycle.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    row : int
        Position in the cycle.
    spread : {"hertz", "line"}
        Hertz's pressure, or its resultant as a line load.
    """
    _check(cycle, row, spread)
    reduced = reduced_modulus(pair, cycle.plane)
    start = pair.points.A + cycle.loaded_position[row] * pair.base_pitch
    placed = pair.placement(float(start))
    on_gears: tuple[list[FlankForce], list[FlankForce]] = ([], [])
    for column in np.flatnonzero(cycle.forces[row] > 0):
        line_load = float(cycle.forces[row, column]) / pair.face_width
        offset = int(cycle.pair_offset[column])
        rho = cycle.flank_rho[:, row, column]
        if cycle.edge[row, column]:
            corner = 1 if start + offset * pair.base_pitch < pair.points.A else 0
            touched = 1 - corner
            angles = (
                placed.pinion_angle + offset * pair.teeth_profiles[0].pitch_angle,
                placed.wheel_angle - offset * pair.teeth_profiles[1].pitch_angle,
            )
            profile = pair.teeth_profiles[corner]
            inward = _inward(pair.teeth_profiles[touched], rho[touched])
            along = turned(-inward, angles[touched] - angles[corner])
            end = np.sqrt(
                profile.flank_rho[1] ** 2 - 2 * profile.base_radius * CORNER_CLEARANCE * pair.module
            )
            for gear, at, direction in ((corner, end, along), (touched, rho[touched], None)):
                tooth = offset if gear == 0 else -offset
                on_gears[gear].append(FlankForce(tooth, float(at), line_load, 0.0, direction))
            continue
        radius = pair.path_at(cycle.rho1[row, column]).radius
        half_width = float(hertz_half_width(line_load, radius, reduced)[0]) if spread == "hertz" else 0.0
        on_gears[0].append(FlankForce(offset, float(rho[0]), line_load, half_width))
        on_gears[1].append(FlankForce(-offset, float(rho[1]), line_load, half_width))
    return tuple(on_gears[0]), tuple(on_gears[1])


def _check(cycle: MeshCycle, row: int, spread: str) -> None:
    faults = Faults()
    check_row(faults, cycle, row)
    faults.choice("spread", spread, ("hertz", "line"), "the pressure is nearer the truth")
    faults.raise_if_any()


def _inward(profile: ToothProfile, rho: float | Array) -> Array:
    """Inward unit normals of the left flank: the mirror images of the right one's."""
    return np.asarray(-profile.normal(rho) * MIRROR)


def nodal_forces(
    profile: ToothProfile, sectors: dict[int, SectorMesh], mesh: GearMesh, loads: Sequence[FlankForce]
) -> Array:
    """Consistent nodal forces (nodes, 2) per face width [N/m], tooth 0 along +y.

    Parameters
    ----------
    profile : gears.ToothProfile
    sectors : dict of int to SectorMesh
        Sector of each loaded tooth.
    mesh : GearMesh
    loads : sequence of FlankForce
    """
    low, high = profile.flank_rho
    base = profile.base_radius
    forces = np.zeros_like(mesh.points)
    for load in loads:
        # Gauss-Chebyshev of the second kind: the weight is Hertz's pressure
        angle = np.pi * np.arange(1, SPREAD_POINTS + 1) / (SPREAD_POINTS + 1)
        place, part = np.cos(angle), 2 / (SPREAD_POINTS + 1) * np.sin(angle) ** 2
        if load.half_width == 0:
            place, part = np.zeros(1), np.ones(1)
        arc = load.rho**2 / (2 * base) + load.half_width * place
        on_flank = (arc >= low**2 / (2 * base)) & (arc <= high**2 / (2 * base))
        rho = np.sqrt(2 * base * arc[on_flank])
        part = part[on_flank] / part[on_flank].sum()
        at = flank_points(sectors[load.tooth], rho)
        direction = _inward(profile, at.rho) if load.direction is None else load.direction
        lumps = (
            load.line_load * part[:, None, None] * at.weights[..., None] * np.atleast_2d(direction)[:, None]
        )
        lumps = turned(lumps.reshape(-1, 2), load.tooth * profile.pitch_angle)
        np.add.at(forces, mesh.nodes[load.tooth][at.nodes.ravel()], lumps)
    return forces


def loaded_gears(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    spread: str = "hertz",
    sizes: Sizes | None = None,
    loaded_sizes: Sizes | None = None,
    refinements: int = 1,
    neighbours: int | None = None,
) -> tuple[LoadedGear, LoadedGear]:
    """Mesh both gears, place them as they mesh at one position of a cycle, and load them.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        Of this pair.
    row : int
        Position in the cycle.
    spread : {"hertz", "line"}
    sizes : meshes.Sizes, optional
        Edge lengths of all teeth.
    loaded_sizes : meshes.Sizes, optional
        Of the loaded teeth; ``root`` and ``rim`` must be those of the others, whose cuts they meet.
    refinements : int
        How often every triangle is split in four.
    neighbours : int, optional
        Mesh only that many teeth beside the loaded ones, with free cuts; the whole gear unless given.

    Returns
    -------
    (LoadedGear, LoadedGear)

    Raises
    ------
    base.InputError
        Row or spread that make no sense, sizes whose cuts do not fit.
    """
    start = (
        pair.points.A + cycle.loaded_position[row] * pair.base_pitch
        if 0 <= row < len(cycle.position)
        else 0.0
    )
    gear_loads = flank_forces(pair, cycle, row, spread)
    gears = []
    for gear, loads in enumerate(gear_loads):
        profile = pair.teeth_profiles[gear]
        usual = mesh_sector(profile, sizes, refinements)
        fine = mesh_sector(profile, loaded_sizes, refinements) if loaded_sizes else usual
        loaded = {load.tooth: fine for load in loads}
        mesh = gear_mesh(usual, _teeth(profile.teeth, sorted(loaded), neighbours), loaded)
        forces = nodal_forces(profile, loaded, mesh, loads) * pair.face_width
        gears.append(_placed(pair, gear, float(start), cycle.plane, mesh, forces))
    return gears[0], gears[1]


def placed_gears(
    pair: GearPair, plane: str = "strain", sizes: Sizes | None = None, refinements: int = 0
) -> tuple[LoadedGear, LoadedGear]:
    """Mesh both gears without loads, as they stand with a pair of teeth at the pitch point."""
    meshes = [gear_mesh(mesh_sector(profile, sizes, refinements)) for profile in pair.teeth_profiles]
    first, second = (
        _placed(pair, gear, pair.points.C, plane, mesh, np.zeros_like(mesh.points))
        for gear, mesh in enumerate(meshes)
    )
    return first, second


def frames(pair: GearPair, rho1: float) -> tuple[tuple[float, Array], tuple[float, Array]]:
    """Angle [rad] and axis [m] of pinion and wheel in the common frame, with a pair of teeth at rho1 [m]."""
    placed = pair.placement(rho1)
    return (placed.pinion_angle, np.zeros(2)), (placed.wheel_angle, placed.wheel_centre)


def _placed(pair: GearPair, gear: int, rho1: float, plane: str, mesh: GearMesh, forces: Array) -> LoadedGear:
    """Turn a gear's mesh and its forces to their place."""
    angle, axis = frames(pair, rho1)[gear]
    here = replace(mesh, points=turned(mesh.points, angle) + axis)
    law = PlaneElasticity.of(pair.materials[gear], plane)
    return LoadedGear(("pinion", "wheel")[gear], here, axis, law, pair.face_width, turned(forces, angle))


def _teeth(count: int, loaded: Sequence[int], neighbours: int | None) -> range:
    """Successive teeth with the loaded ones in the middle: all of them, or some on either side."""
    low, high = loaded[0], loaded[-1]
    if neighbours is not None and high - low + 1 + 2 * neighbours < count:
        return range(low - neighbours, high + neighbours + 1)
    first = low - (count - (high - low + 1)) // 2
    return range(first, first + count)
