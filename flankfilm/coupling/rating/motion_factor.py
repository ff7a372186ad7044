"""Dynamic factor of a pair's motion with the base pitch deviation that ISO 6336-1 takes.

Without load a base pitch that differs by f_pb makes the transmission error a sawtooth of that height: a pair whose
pitch is too short takes over early, with a jump at A; one whose pitch is too long late, with a jump at E. The standard
does not say which it is, so that both are followed and the larger force counts. Every pair of teeth has the deviation,
as the standard takes it: the excitation repeats with the mesh.

Under load pairs share the force before one takes over, and which pairs do depends on the force of the moment. Where
the laws of the loaded contact are there (`coupling.contact_laws`), the force of the mesh is theirs, over position and
deflection, and the motion is followed by steps in time. Without them stiffness depends on position alone and the
sawtooth is the excitation, an upper estimate.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from base import Array, Cost, Faults, InputError, Limit, Stopwatch, quantity, record, unclocked
from base.results import EXACT
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.rating.contact_motion import EVEN, UNEQUAL, followed
from flankfilm.coupling.rating.pitch_excitation import harmonics_of, pitch_errors
from flankfilm.coupling.rating.unequal_pitches import DEVIATION
from flankfilm.coupling.speeds.sidebands import over_revolution
from flankfilm.coupling.vibration.excitation import ErrorSeries
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.resonance import vibrations

if TYPE_CHECKING:
    from flankfilm.coupling.rating.contact_laws import ContactLaws

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
    by_contact: bool = quantity(
        "1",
        "whether the force of the mesh is that of the loaded contact over position and deflection; if not, K_v is an "
        "upper estimate",
        no_error=EXACT,
    )
    swept: Array | None = quantity(
        "rad/s", "pinion speeds that are swept; None without a sweep", "sweep", shown="rpm", no_error=EXACT
    )
    factor: Array | None = quantity(
        "1",
        "maximum force over the mean one over these speeds, of sweeps up and down and both signs of the deviation the "
        "larger; of a drive train by the sawtooth the sign that counts at the speed",
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
    laws: ContactLaws | None = None,
) -> MotionFactor:
    """Dynamic factor of a pair at a speed, with a base pitch deviation.

    By laws of the contact its error adds what half as many steps in time, forces, positions and depths change, each
    alone, and what the motion has left to settle; by the sawtooth what half as many samples of a period and twice as
    many harmonics do.

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
    laws : ContactLaws, optional
        Loaded contact with this deviation; the unloaded sawtooth unless given.

    Raises
    ------
    InputError
        With every fault of the numbers; of an oscillator in its own units, and laws of another deviation.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> found = motion_factor(motion, 500.0, 5e-6)
    >>> 1.0 < found.even < found.K_v, found.by_contact
    (True, False)
    """
    watch = Stopwatch()
    with Faults() as faults:
        faults.numbers(_LIMITS, (speed, deviation))
        if laws is not None and laws.deviation != deviation:
            of = f"of {1e6 * laws.deviation:.4g} um"
            faults.add("laws", of, f"must be of the deviation, {1e6 * deviation:.4g} um", "compute them anew")
    scales, pair = motion.scales, motion.rigid.pair
    if scales is None or pair is None:
        raise InputError.at(
            "motion", "", "requires an oscillator with physical scales", "give pair and torque"
        )
    frequency = scales.frequency(speed)
    values = None if speeds is None else np.array([scales.frequency(float(omega)) for omega in speeds])
    if laws is None:
        factors = _by_sawtooth(motion, deviation, frequency, values)
    else:
        factors = _by_laws(motion, laws, frequency, values)
    swept: dict[str, Any] = dict.fromkeys(("swept", "factor", "greatest", "greatest_at", "swept_error"))
    if speeds is not None:
        peak = int(np.argmax(np.nan_to_num(factors.factor, nan=-np.inf)))
        swept = {
            "swept": np.asarray(speeds, dtype=np.float64),
            "factor": factors.factor,
            "greatest": float(factors.factor[peak]),
            "greatest_at": float(speeds[peak]),
            "swept_error": factors.swept_error,
        }
    return MotionFactor(
        speed,
        deviation,
        factors.K_v,
        factors.even,
        laws is not None,
        **swept,
        error=factors.error,
        cost=Cost(watch.seconds),
        converged=factors.followed,
        message="" if factors.followed else "some motions grow without bound; their factors are nan",
    )


class _Found(NamedTuple):
    """Dynamic factors at the speed with and without the deviation, and over the sweep (no values without one)."""

    K_v: float
    even: float
    error: float
    factor: Array
    swept_error: float
    followed: bool


def _by_laws(
    motion: PairOscillator | PairDrive, laws: ContactLaws, frequency: float, values: Array | None
) -> _Found:
    """Motions with the laws of the contact as the force of the mesh."""
    at = np.array([frequency])
    runs = [followed(motion, laws, chosen, at) for chosen in (EVEN, UNEQUAL)]
    (even, unequal), error = (float(run.factor[0]) for run in runs), max(run.error for run in runs)
    factor, swept_error = np.zeros(0), math.nan
    if values is not None:
        runs.append(followed(motion, laws, UNEQUAL, values))
        factor, swept_error = runs[-1].factor, runs[-1].error
    return _Found(unequal, even, error, factor, swept_error, all(run.followed for run in runs))


def _by_sawtooth(
    motion: PairOscillator | PairDrive, deviation: float, frequency: float, values: Array | None
) -> _Found:
    """Motions with the stiffness of equal pitches, and the sawtooth of unloaded ones as excitation."""
    pair, at = motion.rigid.pair, np.array([frequency])
    assert pair is not None
    even, order = _swept(motion, None, at), harmonics_of(frequency)
    rough, fine = (
        [_swept(motion, error, at) for error in pitch_errors(pair, deviation, count)]
        for count in (order, 2 * order)
    )
    worse = int(np.argmax([float(run.force[0]) for run in rough]))
    K_v, change = float(rough[worse].force[0]), rough[worse].change
    series = _relative(float(fine[worse].force[0]), K_v)
    runs, factor, swept_error = [even, *rough, *fine], np.zeros(0), math.nan
    if values is not None:
        errors = pitch_errors(pair, deviation, order)
        chosen = (
            errors[worse : worse + 1] if isinstance(motion, PairDrive) else errors
        )  # a drive takes minutes
        signs = [_swept(motion, error, values) for error in chosen]
        factor = np.fmax.reduce([run.force for run in signs])
        swept_error = max(run.change for run in signs) + series
        runs += signs
    well = all(run.followed for run in runs)
    return _Found(K_v, float(even.force[0]), change + series, factor, swept_error, well)


def _relative(there: float, here: float) -> float:
    """Relative change; nan of no force."""
    return abs(there / here - 1.0) if here > 0.0 else math.nan


def _swept(motion: PairOscillator | PairDrive, error: ErrorSeries | None, values: Array) -> _Run:
    """Motions at frequencies, swept up and down, the larger force of both."""
    with unclocked():
        from dynamics.motion.up_and_down import up_and_down
    oscillator: Any = motion.oscillator if error is None else over_revolution(motion, error)
    ways = list(up_and_down(oscillator, "frequency", values).values())
    shaken = vibrations(oscillator, ways, load=motion.mean_force)
    force = np.fmax(*(response.force for response in shaken))
    change = max(response.change for response in shaken)
    return _Run(force, change, all(result.converged for result in ways) and bool(np.isfinite(force).all()))
