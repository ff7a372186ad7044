"""Both gears of a pair solved for loads that vary along the face, before a contact asks for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import Cost, Stopwatch, record
from fem.influence.gear_face import AxialHarmonics, EndCorrection
from fem.influence.gear_store import GearStore, ResultStore
from fem.influence.helix_ends import HelixEnds
from fem.influence.helix_waves import HelixHarmonics
from fem.pair.face_compliance import ends_of, waves_of
from fem.pair.face_setting import FREE_ENDS, SLICES
from fem.pair.line_compliance import gear_lines

if TYPE_CHECKING:
    from fem.pair.pair_compliance import PairCompliance

__all__ = ["FaceGears", "face_gears"]


@record
class FaceGears:
    """Both gears of a pair as they answer loads along the face, in modules and E*.

    Attributes
    ----------
    waves : (AxialHarmonics, AxialHarmonics) or (HelixHarmonics, HelixHarmonics)
        Of pinion and wheel; with a helix between any two places of a flank.
    ends : (EndCorrection, EndCorrection) or (HelixEnds, HelixEnds) or None
        What free ends add; None between walls.
    cost : Cost
        Of what was not there already.
    """

    waves: tuple[AxialHarmonics, AxialHarmonics] | tuple[HelixHarmonics, HelixHarmonics]
    ends: tuple[EndCorrection, EndCorrection] | tuple[HelixEnds, HelixEnds] | None
    cost: Cost


def face_gears(
    bodies: PairCompliance, model: str = FREE_ENDS, kept: ResultStore | None = None
) -> FaceGears | None:
    """Solve both gears of a pair for loads along the face; contacts that are asked for later find them in the process.

    Parameters
    ----------
    bodies : PairCompliance
    model : {"free-ends", "walls", "slices"}
        What couples the cells; None is the answer for slices, which need nothing.
    kept : callable, optional
        As of `fem.compliance`.

    Examples
    --------
    >>> from fem import compliance, face_gears
    >>> from gears import Gear, GearPair
    >>> bodies = compliance(GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3), tolerance=0.05)
    >>> face_gears(bodies, "walls").ends is None
    True
    """
    if model == SLICES:
        return None
    watch, gears = Stopwatch(), GearStore(kept)
    if bodies.pair.helix_angle != 0.0:
        here, there = gear_lines(bodies, bodies.pair.helix.base_tangent, model, gears)
        of_lines = None if here.ends is None or there.ends is None else (here.ends, there.ends)
        return FaceGears((here.waves, there.waves), of_lines, Cost(watch.seconds))
    pinion, wheel = bodies.meshed
    waves = waves_of(pinion, gears), waves_of(wheel, gears)
    ends = None
    if model == FREE_ENDS:
        first, second = (width / bodies.pair.module for width in bodies.pair.face_widths)
        ends = ends_of(pinion, first, gears), ends_of(wheel, second, gears)
    return FaceGears(waves, ends, Cost(watch.seconds))
