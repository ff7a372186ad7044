"""Excitation by a base pitch deviation: the sawtooth of unloaded teeth, what a load makes of it, and its stiffness."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

import dynamics
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.sidebands import LEAST_ORDER
from flankfilm.coupling.vibration.excitation import POSITIONS, ErrorSeries, error_series
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.series import MOST_HARMONICS

if TYPE_CHECKING:
    import gears
    from flankfilm.coupling.rating.unequal_pitches import UnequalPitches

ABOVE = 1.5
"""Frequency of the last harmonic over the natural one."""


def harmonics_of(frequency: float) -> int:
    """Harmonics of the sawtooth that count at a mesh over natural frequency: all up to half as much above resonance.

    Harmonic j is excited with f_pb/(pi j) and answers the most at j = 1/frequency, in proportion to the frequency. At
    slow speeds `MOST_HARMONICS` are enough: further ones change less than the error holds.

    Examples
    --------
    >>> harmonics_of(0.165), harmonics_of(1.0), harmonics_of(1e-4)
    (10, 3, 50)
    """
    return min(max(LEAST_ORDER, math.ceil(ABOVE / frequency)), MOST_HARMONICS)


def pitch_errors(pair: gears.GearPair, deviation: float, order: int) -> tuple[ErrorSeries, ErrorSeries]:
    """Unloaded error of a base pitch that is too short, with its jump at A, and too long, with its jump at E."""
    place = (np.arange(POSITIONS) + 0.5) / POSITIONS
    early = deviation * (place - 0.5)
    late = -deviation * (np.mod(place - pair.contact_ratio, 1.0) - 0.5)
    first, second = (
        error_series(curve, order=order, source="base pitch deviation") for curve in (early, late)
    )
    return first, second


def rounded_errors(pitches: UnequalPitches, order: int) -> tuple[ErrorSeries, ErrorSeries]:
    """What a base pitch that is too short, and one that is too long, add to the loaded transmission error."""
    first, second = (
        error_series(pitches.added_error(cycle), order=order, source="base pitch deviation under load")
        for cycle in pitches.unequal
    )
    return first, second


def pitch_excitations(
    pair: gears.GearPair, deviation: float, pitches: UnequalPitches | None, order: int
) -> tuple[ErrorSeries, ErrorSeries]:
    """Excitations of both signs: rounded by the load where its contact is there, else the unloaded sawtooth."""
    return pitch_errors(pair, deviation, order) if pitches is None else rounded_errors(pitches, order)


def with_stiffness(
    motion: PairOscillator | PairDrive, pitches: UnequalPitches, sign: int, order: int
) -> tuple[PairOscillator | PairDrive, ErrorSeries]:
    """Motion with the stiffness of unequal pitches, and the excitation by which slow teeth stand where they did.

    The stiffness is multiplied by the ratio of tangent stiffnesses, which follows the pairs that bear; with
    k = k_0 k_t(f_pb)/k_t(0) the excitation is D(f_pb) - D(0) - F (1/k - 1/k_0).

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        With physical scales.
    pitches : UnequalPitches
    sign : int
        0 of pitches that are too short, 1 too long.
    order : int
        Harmonics of both series.
    """
    scales, own = motion.scales, motion.oscillator
    assert scales is not None
    cycle, place = pitches.unequal[sign], pitches.even.position
    before = own.contact_stiffness(2.0 * np.pi * place)
    after = before * pitches.stiffened(cycle)
    moved = scales.length * motion.mean_force * (1.0 / after - 1.0 / before)
    error = error_series(pitches.added_error(cycle) - moved, order=order, source="unequal pitches")
    fit = error_series(after, order=order)
    series = dynamics.FourierStiffness(
        float(after.mean()), tuple(fit.amplitude.tolist()), tuple(fit.phase.tolist())
    )
    changed: Any = own.with_contact_stiffness(series)
    return replace(motion, oscillator=changed), error
