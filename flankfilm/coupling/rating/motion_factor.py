"""Dynamic factor of a pair's motion with the base pitch deviation that ISO 6336-1 takes.

A base pitch that differs by f_pb makes the unloaded transmission error a sawtooth of that height: a pair whose pitch is
too short takes over early, with a jump at A; one whose pitch is too long late, with a jump at E. The standard does not
say which it is, so that both are followed and the larger force counts. A load rounds the sawtooth, since pairs share it
before one takes over: the factor is an upper estimate.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Cost, Faults, InputError, Limit, Stopwatch, quantity, record, unclocked
from base.results import EXACT
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.speeds.sidebands import LEAST_ORDER, over_revolution
from flankfilm.coupling.vibration.excitation import POSITIONS, ErrorSeries, error_series
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.resonance import vibrations
from flankfilm.coupling.vibration.series import MOST_HARMONICS

if TYPE_CHECKING:
    import gears

ABOVE = 1.5
"""Frequency of the last harmonic over the natural one."""

_LIMITS = {
    "speed": Limit.above(0.0, 1e6, "rad/s", "give the pinion's speed"),
    "deviation": Limit(0.0, 1e-3, "m", "give the base pitch deviation in metres"),
}


@record
class MotionFactor:
    """Dynamic factor K_v of the settled motion of a pair with a base pitch deviation."""

    headline = ("K_v",)

    speed: float = quantity("rad/s", "pinion speed", shown="rpm", no_error=EXACT)
    deviation: float = quantity("m", "base pitch deviation of the excitation", shown="um", no_error=EXACT)
    K_v: float = quantity("1", "maximum force of the mesh over the mean one, at the speed")
    even: float = quantity("1", "the same without the deviation", error="error")
    swept: Array | None = quantity(
        "rad/s", "pinion speeds that are swept; None without a sweep", "sweep", shown="rpm", no_error=EXACT
    )
    factor: Array | None = quantity(
        "1",
        "maximum force over the mean one over these speeds, of sweeps up and down the greater",
        "sweep",
        error="error",
    )
    greatest: float | None = quantity("1", "its maximum over the sweep", error="error")
    greatest_at: float | None = quantity(
        "rad/s", "pinion speed there", shown="rpm", no_error="not estimated: speeds of a sweep"
    )
    error: float
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed", no_error=EXACT)
    message: str = ""


def motion_factor(
    motion: PairOscillator | PairDrive, speed: float, deviation: float, speeds: Array | None = None
) -> MotionFactor:
    """Dynamic factor of a pair at a speed, with a base pitch deviation.

    Its error adds what half as many samples of a period change, and what twice as many harmonics of the sawtooth do.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        With physical scales; its own unloaded error stays.
    speed : float
        Of the pinion [rad/s].
    deviation : float
        f_pb, after running in where the standard takes it so [m].
    speeds : ndarray, optional
        Rising speeds of the pinion that are swept as well, with the sign of the deviation that counts at `speed`.

    Raises
    ------
    InputError
        With every fault of the numbers; of an oscillator in its own units.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> found = motion_factor(motion, 500.0, 5e-6)
    >>> 1.0 < found.even < found.K_v
    True
    """
    watch = Stopwatch()
    with Faults() as faults:
        faults.numbers(_LIMITS, (speed, deviation))
    scales, pair = motion.scales, motion.rigid.pair
    if scales is None or pair is None:
        raise InputError.at(
            "motion", "", "requires an oscillator with physical scales", "give pair and torque"
        )
    at = np.array([scales.frequency(speed)])
    even, order = _swept(motion, None, at), harmonics_of(float(at[0]))
    rough = [_swept(motion, error, at) for error in pitch_errors(pair, deviation, order)]
    fine = [_swept(motion, error, at) for error in pitch_errors(pair, deviation, 2 * order)]
    worse = int(np.argmax([float(force[0]) for force, _, _ in rough]))
    K_v, change = float(rough[worse][0][0]), rough[worse][1]
    more = float(fine[worse][0][0])
    series = abs(more / K_v - 1.0) if K_v > 0.0 else math.nan
    swept: dict[str, Any] = {"swept": None, "factor": None, "greatest": None, "greatest_at": None}
    runs, off = [even, *rough, *fine], change + series
    if speeds is not None:
        error = pitch_errors(pair, deviation, order)[worse]
        over = _swept(motion, error, np.array([scales.frequency(float(omega)) for omega in speeds]))
        runs.append(over)
        off = max(off, over[1] + series)
        peak = int(np.nanargmax(over[0]))
        swept = {
            "swept": np.asarray(speeds, dtype=np.float64),
            "factor": over[0],
            "greatest": float(over[0][peak]),
            "greatest_at": float(speeds[peak]),
        }
    converged = all(followed for _, _, followed in runs)
    return MotionFactor(
        speed,
        deviation,
        K_v,
        float(even[0][0]),
        **swept,
        error=off,
        cost=Cost(watch.seconds),
        converged=converged,
        message="" if converged else "some motions grow without bound; their factors are nan",
    )


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


def _swept(
    motion: PairOscillator | PairDrive, error: ErrorSeries | None, values: Array
) -> tuple[Array, float, bool]:
    """Maximum force over the mean one, swept up and down the greater; its error by samples; whether followed."""
    with unclocked():
        from dynamics.motion.up_and_down import up_and_down
    oscillator: Any = motion.oscillator if error is None else over_revolution(motion, error)
    ways = up_and_down(oscillator, "frequency", values).values()
    shaken = [vibrations(oscillator, result, load=motion.mean_force) for result in ways]
    force = np.fmax(*(response.force for response in shaken))
    change = max(response.change for response in shaken)
    return force, change, all(result.converged for result in ways) and bool(np.isfinite(force).all())
