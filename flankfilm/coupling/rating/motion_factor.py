"""Dynamic factor of a pair's motion with the base pitch deviation that ISO 6336-1 takes.

Without load a base pitch that differs by f_pb makes the transmission error a sawtooth of that height: a pair whose
pitch is too short takes over early, with a jump at A; one whose pitch is too long late, with a jump at E. The standard
does not say which it is, so that both are followed and the larger force counts. Every pair of teeth has the deviation,
as the standard takes it: the excitation repeats with the mesh.

A load rounds the sawtooth, since pairs share it before one takes over. Where the loaded contact of unequal pitches is
there, what the deviation adds to the loaded transmission error is the excitation in place of the sawtooth,

    e(theta) = D(theta; f_pb) - D(theta; 0),

so that slow teeth stand where the loaded contact has them. The stiffness stays that of equal pitches; the change by
that of unequal ones, k k_t(f_pb)/k_t(0) with the excitation that has the same static answer, is part of the error.
Without such a contact the sawtooth remains, an upper estimate.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from base import Array, Cost, Faults, InputError, Limit, Stopwatch, quantity, record, unclocked
from base.results import EXACT, ITSELF
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.rating.pitch_excitation import harmonics_of, pitch_excitations, with_stiffness
from flankfilm.coupling.rating.unequal_pitches import DEVIATION, UnequalPitches
from flankfilm.coupling.speeds.sidebands import over_revolution
from flankfilm.coupling.vibration.excitation import ErrorSeries
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.resonance import vibrations

_LIMITS = {
    "speed": Limit.above(0.0, 1e6, "rad/s", "give the pinion's speed"),
    "deviation": DEVIATION,
}


@record
class MotionFactor:
    """Dynamic factor K_v of the settled motion of a pair with a base pitch deviation."""

    headline = ("K_v",)

    speed: float = quantity("rad/s", "pinion speed", shown="rpm", no_error=EXACT)
    deviation: float = quantity("m", "base pitch deviation of the excitation", shown="um", no_error=EXACT)
    K_v: float = quantity("1", "maximum force of the mesh over the mean one, at the speed")
    even: float = quantity("1", "the same without the deviation", error="error")
    rounded: bool = quantity(
        "1",
        "whether the load rounds the excitation; without a loaded contact of unequal pitches K_v is an upper estimate",
        no_error=EXACT,
    )
    stiffness_change: float | None = quantity(
        "1",
        "relative change of K_v by the stiffness of unequal pitches, part of the error; None where the load does not "
        "round the excitation",
        no_error=ITSELF,
    )
    swept: Array | None = quantity(
        "rad/s", "pinion speeds that are swept; None without a sweep", "sweep", shown="rpm", no_error=EXACT
    )
    factor: Array | None = quantity(
        "1",
        "maximum force over the mean one over these speeds, of sweeps up and down and both signs of the deviation the "
        "larger; of a drive train the sign that counts at the speed",
        "sweep",
        error="swept_error",
    )
    greatest: float | None = quantity("1", "its maximum over the sweep", error="swept_error")
    greatest_at: float | None = quantity(
        "rad/s", "pinion speed there", shown="rpm", no_error="not estimated: speeds of a sweep"
    )
    swept_error: float | None = quantity(
        "1", "estimated relative error of the maximum over the sweep; None without one"
    )
    error: float
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed", no_error=EXACT)
    message: str = ""


class _Run(NamedTuple):
    """Maximum force over the mean one at each frequency, its error by samples, and whether all were followed."""

    force: Array
    change: float
    followed: bool


def motion_factor(
    motion: PairOscillator | PairDrive,
    speed: float,
    deviation: float,
    speeds: Array | None = None,
    pitches: UnequalPitches | None = None,
) -> MotionFactor:
    """Dynamic factor of a pair at a speed, with a base pitch deviation.

    Its error adds what half as many samples of a period change, what twice as many harmonics of the excitation do, and
    what the stiffness of unequal pitches does.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        With physical scales; its own unloaded error stays.
    speed : float
        Of the pinion [rad/s].
    deviation : float
        f_pb, after running in where the standard takes it so [m].
    speeds : ndarray, optional
        Rising speeds of the pinion that are swept as well.
    pitches : UnequalPitches, optional
        Loaded contact with this deviation, which rounds the excitation; the unloaded sawtooth unless given.

    Raises
    ------
    InputError
        With every fault of the numbers; of an oscillator in its own units, and pitches of another deviation.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> found = motion_factor(motion, 500.0, 5e-6)
    >>> 1.0 < found.even < found.K_v, found.rounded
    (True, False)
    """
    watch = Stopwatch()
    with Faults() as faults:
        faults.numbers(_LIMITS, (speed, deviation))
        if pitches is not None and pitches.deviation != deviation:
            of = f"of {1e6 * pitches.deviation:.4g} um"
            faults.add(
                "pitches", of, f"must be of the deviation, {1e6 * deviation:.4g} um", "compute them anew"
            )
    scales, pair = motion.scales, motion.rigid.pair
    if scales is None or pair is None:
        raise InputError.at(
            "motion", "", "requires an oscillator with physical scales", "give pair and torque"
        )
    at = np.array([scales.frequency(speed)])
    even, order = _swept(motion, None, at), harmonics_of(float(at[0]))
    rough, fine = (
        [_swept(motion, error, at) for error in pitch_excitations(pair, deviation, pitches, count)]
        for count in (order, 2 * order)
    )
    worse = int(np.argmax([float(run.force[0]) for run in rough]))
    K_v, change = float(rough[worse].force[0]), rough[worse].change
    series = _relative(float(fine[worse].force[0]), K_v)
    runs = [even, *rough, *fine]
    stiffness_change = None
    if pitches is not None:
        stiffer = _swept(*with_stiffness(motion, pitches, worse, 2 * order), at)
        stiffness_change = _relative(float(stiffer.force[0]), K_v)
        runs.append(stiffer)
    swept: dict[str, Any] = dict.fromkeys(("swept", "factor", "greatest", "greatest_at", "swept_error"))
    if speeds is not None:
        sweeps = _over_speeds(motion, deviation, speeds, pitches, order, worse)
        swept = sweeps.figures(series + (0.0 if sweeps.stiffer else stiffness_change or 0.0))
        runs += sweeps.runs
    converged = all(run.followed for run in runs)
    return MotionFactor(
        speed,
        deviation,
        K_v,
        float(even.force[0]),
        pitches is not None,
        stiffness_change,
        **swept,
        error=change + series + (stiffness_change or 0.0),
        cost=Cost(watch.seconds),
        converged=converged,
        message="" if converged else "some motions grow without bound; their factors are nan",
    )


def _relative(there: float, here: float) -> float:
    """Relative change; nan of no force."""
    return abs(there / here - 1.0) if here > 0.0 else math.nan


class _Sweep(NamedTuple):
    """Sweeps of both signs of the deviation, and one with the stiffness of unequal pitches where there is one."""

    speeds: Array
    signs: list[_Run]
    stiffer: _Run | None

    @property
    def runs(self) -> list[_Run]:
        return self.signs if self.stiffer is None else [*self.signs, self.stiffer]

    def figures(self, series: float) -> dict[str, Any]:
        """Figures of a `MotionFactor`; `series` is what is known of its speed alone."""
        factor = np.fmax.reduce([run.force for run in self.signs])
        peak = int(np.nanargmax(factor))
        greatest = float(factor[peak])
        off = max(run.change for run in self.signs) + series
        if self.stiffer is not None:
            off += _relative(float(np.nanmax(self.stiffer.force)), greatest)
        return {
            "swept": np.asarray(self.speeds, dtype=np.float64),
            "factor": factor,
            "greatest": greatest,
            "greatest_at": float(self.speeds[peak]),
            "swept_error": off,
        }


def _over_speeds(
    motion: PairOscillator | PairDrive,
    deviation: float,
    speeds: Array,
    pitches: UnequalPitches | None,
    order: int,
    worse: int,
) -> _Sweep:
    """Sweep both signs; the one with the larger maximum with the stiffness of unequal pitches as well.

    A sweep of a drive train takes minutes: one is made, of the sign that counts at the speed, `worse`.
    """
    scales, pair = motion.scales, motion.rigid.pair
    assert scales is not None
    assert pair is not None
    values = np.array([scales.frequency(float(omega)) for omega in speeds])
    excitations = pitch_excitations(pair, deviation, pitches, order)
    if isinstance(motion, PairDrive):
        return _Sweep(speeds, [_swept(motion, excitations[worse], values)], None)
    signs = [_swept(motion, error, values) for error in excitations]
    if pitches is None:
        return _Sweep(speeds, signs, None)
    worse = int(np.argmax([float(np.nanmax(run.force)) for run in signs]))
    return _Sweep(speeds, signs, _swept(*with_stiffness(motion, pitches, worse, order), values))


def _swept(motion: PairOscillator | PairDrive, error: ErrorSeries | None, values: Array) -> _Run:
    """Motions at frequencies, swept up and down, the larger force of both."""
    with unclocked():
        from dynamics.motion.up_and_down import up_and_down
    oscillator: Any = motion.oscillator if error is None else over_revolution(motion, error)
    ways = up_and_down(oscillator, "frequency", values).values()
    shaken = [vibrations(oscillator, result, load=motion.mean_force) for result in ways]
    force = np.fmax(*(response.force for response in shaken))
    change = max(response.change for response in shaken)
    return _Run(force, change, all(result.converged for result in ways) and bool(np.isfinite(force).all()))
