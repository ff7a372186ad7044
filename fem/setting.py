"""How a pair is set up for contact: teeth that meet first, rounded tips, deviations; all checked at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from numbers import Integral, Real
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fem.errors import Fault, FemError
from fem.tip_contact import Removed
from fem.tip_geometry import TipRound, tip_round

if TYPE_CHECKING:
    from gears import GearDeviations, GearPair

__all__ = ["Deviations", "Setting", "setting"]

Array = NDArray[np.float64]
Deviations = Sequence["GearDeviations | None"]

LARGEST_ROUND = 0.2
"""Largest part of the flank [modules] that a rounding of the tip may take."""


@dataclass(frozen=True)
class Setting:
    """How a pair stands and what its flanks are like, checked; see ``mesh_cycle`` for the terms."""

    pair: GearPair
    positions: int
    pitches: int
    first_teeth: tuple[int, int]
    beyond_path: bool
    rounds: tuple[TipRound, TipRound]
    deviations: tuple[GearDeviations | None, GearDeviations | None]

    @property
    def ends(self) -> tuple[float, float]:
        """rho1 at which contact of the two involutes starts and ends [m]: A and E but for roundings."""
        first, second = self.rounds
        return self.pair.line_of_action - second.rho, first.rho

    @property
    def removed(self) -> tuple[Removed, Removed] | None:
        """Material missing from pinion's and wheel's flank at curvature radii; None if there is none."""
        profiles = self.pair.teeth_profiles
        curves = [some is not None and some.profile is not None for some in self.deviations]
        if not any(curves) and all(profile.tip_relief is None for profile in profiles):
            return None

        def missing(gear: int) -> Removed:
            some, relief = self.deviations[gear], profiles[gear].relief
            if some is None or not curves[gear]:
                return relief
            return lambda rho: np.asarray(relief(rho) - some.excess(rho))

        return missing(0), missing(1)

    def pitch_gap(self, teeth: NDArray[np.int64], wheel_ahead: int = 0) -> Array:
        """Gap along the line of action by pitch deviations of teeth (2, ...) [m].

        A tooth of the pinion that comes late opens the gap, one of the wheel closes it.
        """
        first, second = self.deviations
        gap = np.zeros(teeth.shape[1:])
        if first is not None:
            gap += first.late(teeth[0])
        if second is not None:
            gap -= second.late(teeth[1] + wheel_ahead)
        return np.asarray(gap * cos(self.pair.rack.alpha))


def setting(
    pair: GearPair,
    positions: int,
    pitches: int = 1,
    first_teeth: tuple[int, int] = (0, 0),
    beyond_path: bool = True,
    tip_rounding: float | tuple[float, float] = 0.0,
    deviations: Deviations | None = None,
    others: Sequence[Fault] = (),
) -> Setting:
    """Check everything that ``mesh_cycle`` and ``unloaded_transmission_error`` are given in common.

    Raises
    ------
    FemError
        With all faults, ``others`` first.
    """
    faults = list(others)
    for name, value, remedy in (
        ("positions", positions, "40 resolve the usual harmonics"),
        ("pitches", pitches, "as many as teeth of the pinion for its revolution"),
    ):
        if isinstance(value, bool) or not isinstance(value, Integral) or value < 1:
            faults.append(Fault(name, f"{value!r}", "a whole number >= 1", remedy))
    both = tuple(first_teeth) if isinstance(first_teeth, Sequence) else ()
    if len(both) != 2 or any(isinstance(n, bool) or not isinstance(n, Integral) for n in both):
        faults.append(Fault("first_teeth", f"{first_teeth!r}", "two whole numbers", "number from 0"))
    rounds, bad = _rounds(pair, tip_rounding)
    faults += bad
    some = (None, None) if deviations is None else tuple(deviations)
    if len(some) != 2:
        faults.append(
            Fault("deviations", f"{len(some)} gears", "of pinion and wheel", "give None for a perfect one")
        )
    else:
        for k, (gear, spec) in enumerate(zip(some, (pair.pinion, pair.wheel), strict=True)):
            faults += () if gear is None else gear.faults(f"deviations[{k}]", spec.teeth)
    if faults:
        raise FemError(*faults)
    found = Setting(
        pair, int(positions), int(pitches), (both[0], both[1]), beyond_path, rounds, (some[0], some[1])
    )
    start, end = found.ends
    if end - start < pair.base_pitch and not beyond_path:
        remedy = "round the tips less, or let tip edges touch"
        raise FemError(Fault("tip_rounding", f"{tip_rounding!r}", "a contact ratio above 1", remedy))
    return found


def _rounds(
    pair: GearPair, tip_rounding: float | tuple[float, float]
) -> tuple[tuple[TipRound, TipRound], list[Fault]]:
    radii = tip_rounding if isinstance(tip_rounding, Sequence) else (tip_rounding, tip_rounding)
    profiles = pair.teeth_profiles
    numbers = [isinstance(r, Real) and not isinstance(r, bool) and np.isfinite(r) and r >= 0 for r in radii]
    if len(radii) != 2 or not all(numbers):
        allowed = "a radius >= 0 m, or one for each gear"
        fault = Fault("tip_rounding", f"{tip_rounding!r}", allowed, "give metres; 0 is sharp")
        return (tip_round(profiles[0], 0.0), tip_round(profiles[1], 0.0)), [fault]
    rounds = tip_round(profiles[0], float(radii[0])), tip_round(profiles[1], float(radii[1]))
    faults = []
    for k, (one, profile) in enumerate(zip(rounds, profiles, strict=True)):
        if one.radius == 0.0:
            continue
        land = profile.tip_radius * sin(max(profile.tip_half_angle, 0.0))
        # with a chamfer the arc is between flank and chamfer, and must end on it
        length = float(np.linalg.norm(np.diff(profile.chamfer(np.array([0.0, 1.0])), axis=0)))
        room = min(LARGEST_ROUND * profile.module, length if length > 0 else land)
        if one.start > room:
            most = f"at most {room * one.radius / one.start:.3g} m"
            faults.append(Fault(f"tip_rounding[{k}]", f"{one.radius:g} m", most, "round the tip less"))
    return rounds, faults
