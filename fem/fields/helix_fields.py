"""Twisted teeth, flanks and lines of contact of a loaded helical pair, both gears as they mesh at a position."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Faults, record
from fem.cycle.cycle_rows import check_row
from fem.cycle.result import MeshCycle
from fem.fields.face_fields import FaceField, tooth_field
from fem.fields.face_waves import BESIDE
from fem.fields.flank_patches import Place, joined
from fem.fields.helix_flanks import LineField, LineOnGear
from fem.fields.helix_solids import CellLoads, TwistedGear, twisted_gears
from fem.fields.loaded_gears import frames

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance
    from gears import GearPair

__all__ = ["HelixFields", "helix_fields"]

LAYERS = 18
"""Layers of the solid along the face."""


@record
class HelixFields:
    """Both gears of a helical pair at one position.

    Attributes
    ----------
    pinion, wheel : FaceField
    lines : LineField
        Lines of contact, once for each gear.
    """

    pinion: FaceField
    wheel: FaceField
    lines: LineField


def helix_fields(
    pair: GearPair,
    cycle: MeshCycle,
    row: int,
    bodies: PairCompliance,
    solids: tuple[TwistedGear, TwistedGear] | None = None,
) -> HelixFields:
    """Teeth, flanks and lines of contact at one position of a mesh cycle of a helical pair.

    The displacement is that of solids with free ends under the line loads of the cycle; stress is not found.

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    row : int
        Of the cycle.
    bodies : PairCompliance
        The one that the cycle was computed with.
    solids : tuple of TwistedGear, optional
        Of ``twisted_gears``, to save time over several positions.

    Returns
    -------
    HelixFields

    Raises
    ------
    base.InputError
        A row that the cycle does not have, or that has no finite forces; a spur pair.
    """
    faults = Faults()
    check_row(faults, cycle, row, on_lines=True)
    faults.raise_if_any()
    assert cycle.lines is not None  # checked
    ready = solids or twisted_gears(bodies, cycle.lines.slope)
    (pinion, first), (wheel, second) = (_on_gear(pair, cycle, row, gear, ready[gear]) for gear in (0, 1))
    return HelixFields(pinion, wheel, joined([first, second]))


def _on_gear(
    pair: GearPair, cycle: MeshCycle, row: int, gear: int, ready: TwistedGear
) -> tuple[FaceField, LineField]:
    lines = cycle.lines
    assert lines is not None  # of a helical pair
    columns = np.flatnonzero(np.isfinite(lines.z[row]).any(axis=-1)).tolist()
    on_gear = [LineOnGear.of(lines, row, column, gear, int(cycle.pair_offset[column])) for column in columns]
    numbers = [line.tooth for line in on_gear]
    teeth = range(min(numbers) - BESIDE, max(numbers) + BESIDE + 1)
    angle, centre = frames(pair, float(pair.points.A + cycle.loaded_position[row] * pair.base_pitch))[gear]
    profile = pair.teeth_profiles[gear]
    twist = on_gear[0].slope / profile.base_radius
    stands = [Place(angle + tooth * profile.pitch_angle, centre, twist) for tooth in teeth]
    middle, width = pair.face_offsets[gear], pair.face_widths[gear]
    loads = [CellLoads(line.rho, line.z - middle, line.force, line.length) for line in on_gear]
    moved = ready.moved(loads, numbers, teeth)
    z = np.linspace(-0.5, 0.5, LAYERS + 1) * width
    along = ready.pieces.values(z / ready.module)
    layers = np.einsum("lp,tnpa->tlna", along, moved, optimize=True)
    solid = tooth_field(ready, middle + z, layers, stands, teeth, ready.module)
    ends, cell = middle + np.array([-0.5, 0.5]) * width, pair.face_width / lines.setting.cells
    places = [(line, line.tooth - teeth[0]) for line in on_gear]
    flanks = [line.flank(stands[index], ready, moved[index], ends, cell) for line, index in places]
    return FaceField(solid, joined(flanks)), joined([line.segments(stands[index]) for line, index in places])
