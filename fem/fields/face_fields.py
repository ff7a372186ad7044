"""Teeth and flanks of a loaded face in three dimensions, both gears as they mesh at a position."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Faults, Integers, quantity, record
from fem.cycle.cycle_rows import check_row
from fem.cycle.result import MeshCycle
from fem.fields.face_waves import BESIDE, FaceWaves, GearPrisms, gear_prisms, on_flank
from fem.fields.flank_patches import FlankField, FlankPatch, Place, joined
from fem.fields.loaded_gears import frames

if TYPE_CHECKING:
    from fem.fields.helix_solids import TwistedGear
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = ["FaceField", "ToothField", "face_fields", "tooth_field"]


@record
class ToothField:
    """Solid of the teeth in mesh of one gear and of some beside them, in the common frame; z is 0 at mid-face."""

    no_error = "not estimated: it is for pictures"

    points: Array = quantity("m", "unloaded position", "point space")
    cells: Integers = quantity("1", "points of each wedge, a triangle along the face", "cell corner")
    displacement_m: Array = quantity(
        "m",
        "elastic displacement of a gear on a hub that stands still: of a spur gear between frictionless walls, of a "
        "helical one with free ends",
        "point space",
    )
    tooth: Integers = quantity("1", "tooth, 0 in the pair that entered last, counted anticlockwise", "cell")


@record
class FaceField:
    """One gear at one position.

    Attributes
    ----------
    teeth : ToothField
    flanks : FlankField
    """

    teeth: ToothField
    flanks: FlankField


def face_fields(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    bodies: PairCompliance,
    prisms: tuple[GearPrisms, GearPrisms] | None = None,
) -> tuple[FaceField, FaceField]:
    """Teeth and flanks of pinion and wheel at one position of a mesh cycle with cells of the face.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
        With cells.
    row : int
        Of the cycle.
    bodies : PairCompliance
        The one that the cycle was computed with.
    prisms : tuple of GearPrisms, optional
        Of ``gear_prisms``, to save time over several positions.

    Returns
    -------
    (FaceField, FaceField)

    Raises
    ------
    base.InputError
        A row that the cycle does not have, or that has no finite forces; a cycle without cells.
    """
    faults = Faults()
    check_row(faults, cycle, row, over_face=True)
    faults.raise_if_any()
    ready = prisms or gear_prisms(bodies)
    first, second = (_face_field(pair, cycle, row, bodies, gear, ready[gear]) for gear in (0, 1))
    return first, second


def _face_field(
    pair: GearPair, cycle: MeshCycle, row: int, bodies: PairCompliance, gear: int, ready: GearPrisms
) -> FaceField:
    module, flexible = pair.module, (bodies.pinion, bodies.wheel)[gear]
    loaded = np.flatnonzero(cycle.forces[row] > 0.0)
    tooth_of = (1 if gear == 0 else -1) * cycle.pair_offset
    teeth = range(int(tooth_of[loaded].min()) - BESIDE, int(tooth_of[loaded].max()) + BESIDE + 1)
    waves = FaceWaves.of(pair, cycle, row, loaded)
    places = [on_flank(ready.mesh, rho / module) for rho in cycle.flank_rho[gear][row, loaded]]
    apart = [[tooth - own for tooth in teeth] for own in tooth_of[loaded].tolist()]
    moved = waves.moved(ready, places, apart)
    moved /= flexible.law.plane_modulus
    angle, centre = frames(pair, float(pair.points.A + cycle.loaded_position[row] * pair.base_pitch))[gear]
    pitch = pair.teeth_profiles[gear].pitch_angle
    stands = [Place(angle + tooth * pitch, centre) for tooth in teeth]
    parts = []
    for column in np.flatnonzero(np.isfinite(cycle.gaps[row]) & np.isin(tooth_of, teeth)).tolist():
        tooth = int(tooth_of[column])
        patch = FlankPatch.of(pair, cycle, row, column, gear, ready.mesh)
        index = tooth - teeth[0]
        parts.append(patch.placed(stands[index], waves.layers, moved[index], tooth))
    return FaceField(tooth_field(ready, waves.layers, moved, stands, teeth, module), joined(parts))


def tooth_field(
    ready: GearPrisms | TwistedGear,
    z: Array,
    moved: Array,
    place: Sequence[Place],
    teeth: Sequence[int],
    module: float,
) -> ToothField:
    """Wedges of all teeth that are drawn, each with separate points.

    Parameters
    ----------
    ready : GearPrisms or TwistedGear
    z : (layers,) array
        [m]
    moved : (teeth, layers, nodes, 3) array
        Displacements in the section of each tooth [m].
    place : sequence of Place
        Of each tooth.
    teeth : sequence of int
    module : float
        [m]
    """
    used, triangles = np.unique(ready.triangles, return_inverse=True)
    triangles = triangles.reshape(-1, 3)
    layer = len(used) * np.arange(len(z) - 1)[:, None, None]
    wedges = np.concatenate([triangles + layer, triangles + layer + len(used)], axis=-1).reshape(-1, 6)
    size = len(used) * len(z)
    section = module * ready.points[used]
    return ToothField(
        np.concatenate([stand.points(section, z) for stand in place]),
        np.concatenate([wedges + size * i for i in range(len(teeth))]),
        np.concatenate([stand.vectors(own[:, used], z) for stand, own in zip(place, moved, strict=True)]),
        np.repeat(np.array(teeth), len(wedges)),
    )
