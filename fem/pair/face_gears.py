"""Both gears of a pair solved for loads that vary along the face, before a contact asks for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from base import Cost, Stopwatch, record
from fem.influence.gear_face import FlankEnds, FlankWaves
from fem.influence.solved_gear import Gears, Kept
from fem.pair.face_compliance import ends_of, waves_of
from fem.pair.face_setting import FREE_ENDS, SLICES

if TYPE_CHECKING:
    from fem.pair.bodies import Compliance

__all__ = ["FaceGears", "face_gears"]


@record
class FaceGears:
    """Both gears of a pair as they answer loads along the face, in modules and E*.

    Attributes
    ----------
    waves : (FlankWaves, FlankWaves)
        Of pinion and wheel.
    ends : (FlankEnds, FlankEnds) or None
        What free ends add; None between walls.
    cost : Cost
        Of what was not there already.
    """

    waves: tuple[FlankWaves, FlankWaves]
    ends: tuple[FlankEnds, FlankEnds] | None
    cost: Cost


def face_gears(bodies: Compliance, model: str = FREE_ENDS, kept: Kept | None = None) -> FaceGears | None:
    """Solve both gears of a pair for loads along the face; contacts that are asked for later find them in the process.

    Parameters
    ----------
    bodies : Compliance
    model : {"free-ends", "walls", "slices"}
        What couples the cells; None is the answer for slices, which need nothing.
    kept : callable, optional
        As of `fem.compliance`.

    Examples
    --------
    >>> from fem import compliance, face_gears
    >>> from gears import Gear, GearPair
    >>> bodies = compliance(GearPair(Gear(teeth=20), Gear(teeth=20), module=2e-3, face_width=20e-3), tolerance=0.05)
    >>> face_gears(bodies, "walls").ends is None
    True
    """
    if model == SLICES:
        return None
    watch, gears = Stopwatch(), Gears(kept)
    pinion, wheel = bodies.meshed
    waves = waves_of(pinion, gears), waves_of(wheel, gears)
    ends = None
    if model == FREE_ENDS:
        first, second = (width / bodies.pair.module for width in bodies.pair.face_widths)
        ends = ends_of(pinion, first, gears), ends_of(wheel, second, gears)
    return FaceGears(waves, ends, Cost(watch.seconds))
