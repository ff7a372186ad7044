"""Run-up and coast-down of a pair: rms, peaks and orders of its motion over the speed, as a test rig shows them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

import dynamics
from base import Array, Cost, Faults, InputError, Stopwatch, described, quantity, record
from base.results import EXACT
from dynamics.model.limits import PERIODS, POSITIVE
from flankfilm.coupling.drive.pair_drive import PairDrive
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.part_loads import greatest, output_rows, part_figures


@record
class SpeedRunUp:
    """Motion of a pair while its speed rises evenly in time, and while it falls; blocks of 16 mesh periods.

    Mappings go by direction, ``"up"`` and ``"down"``.
    """

    headline = ("periods", "rate")

    frequency: Mapping[str, Array] = quantity(
        "1", "mesh frequency over natural frequency of each block", "block", no_error=EXACT
    )
    speed: Mapping[str, Array] | None = quantity(
        "rad/s", "pinion speed of each block", "block", shown="rpm", no_error=EXACT
    )
    spread: Mapping[str, Array] = quantity(
        "1",
        "root mean square of the displacement about its mean, over the length scale",
        "block",
        error="rms_error",
    )
    peak: Mapping[str, Array] = quantity(
        "1", "maximum displacement over the length scale", "block", error="peak_error"
    )
    force_factor: Mapping[str, Array] = quantity(
        "1", "maximum force over the mean force", "block", error="peak_error"
    )
    force_rms: Mapping[str, Array] = quantity(
        "1", "root mean square of the force about its mean, over the mean force", "block", error="rms_error"
    )
    separated: Mapping[str, Array] = quantity(
        "1", "part of each block without contact of the driving flanks", "block", shown="%", error="error"
    )
    order: Array = quantity("1", "mesh order of the lines", "line", no_error=EXACT)
    order_force: Mapping[str, Array] = quantity(
        "1", "amplitude of the force over the mean force by block and order", "block line", error="error"
    )
    order_displacement: Mapping[str, Array] = quantity(
        "1",
        "amplitude of the displacement over the length scale by block and order",
        "block line",
        error="error",
    )
    bearings: tuple[str, ...] = quantity(
        "", "bearings of a drive train, in the order of their forces", "bearing"
    )
    bearing_force: Mapping[str, Array] = quantity(
        "N", "maximum modulus of the force of bearings", "block bearing", error="error"
    )
    bearing_force_swing: Mapping[str, Array] = quantity(
        "N", "root mean square about the mean force of bearings", "block bearing", error="error"
    )
    shafts: tuple[str, ...] = quantity(
        "", "shafts and couplings of a drive train, in the order of their torques", "shaft"
    )
    shaft_torque: Mapping[str, Array] = quantity(
        "N m", "maximum modulus of the torque of shafts and couplings", "block shaft", error="error"
    )
    shaft_torque_swing: Mapping[str, Array] = quantity(
        "N m", "root mean square about the mean torque of shafts and couplings", "block shaft", error="error"
    )
    periods: int = quantity("1", "mesh periods of each direction", no_error=EXACT)
    seconds: float | None = quantity("s", "time of each direction", no_error=EXACT)
    rate: float = quantity(
        "1",
        "change of the frequency in one decay time over the width of a resonance; where it is small the motion follows",
        no_error=EXACT,
    )
    rms_error: Mapping[str, Array] = quantity(
        "1", "estimated relative error of each block's root mean squares, by steps of the speed", "block"
    )
    peak_error: Mapping[str, Array] = quantity(
        "1", "estimated relative error of each block's peaks, by steps of the speed and by samples", "block"
    )
    greatest_error: float = quantity(
        "1", "estimated relative error of the maximum displacement, force or torque of a direction"
    )
    error: float = quantity(
        "1", "largest of the blocks' errors: where the motion jumps it may do so a block earlier or later"
    )
    cost: Cost
    converged: bool = quantity("1", "whether the motion stayed bounded in both directions", no_error=EXACT)
    message: str

    @described("N", error="greatest_error")
    def greatest_bearing_force(self) -> float | None:
        """Maximum force of a bearing in run-up and coast-down; None without bearings."""
        return greatest(self.bearing_force)

    @described("N m", error="greatest_error")
    def greatest_shaft_torque(self) -> float | None:
        """Maximum torque of a shaft or coupling in run-up and coast-down; None without one that yields."""
        return greatest(self.shaft_torque)


def speed_run_up(
    motion: PairOscillator | PairDrive,
    speed: tuple[float, float] | None = None,
    *,
    frequency: tuple[float, float] | None = None,
    seconds: float | None = None,
    periods: int = 8000,
    progress: Callable[[str, int, int], None] = lambda what, done, every: None,
) -> SpeedRunUp:
    """Run a pair up through a range of speeds, evenly in time, and down again.

    Parameters
    ----------
    motion : PairOscillator or PairDrive
        On rigid shafts, or with its drive train.
    speed : (float, float)
        Pinion speeds, from and to, rising [rad/s].
    frequency : (float, float)
        Instead of them: mesh frequencies over the natural one.
    seconds : float, optional
        Time of a run-up [s], for a pair with physical scales.
    periods : int
        Mesh periods of a run-up where no time is given.
    progress : callable
        Called with what is counted, how many are done, and of how many, of run-up and coast-down together.

    Raises
    ------
    InputError
        With what is out of range.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from flankfilm.coupling import given_series, pair_oscillator
    >>> pair = GearPair(pinion=Gear(teeth=20), wheel=Gear(teeth=30), module=2e-3, face_width=20e-3)
    >>> motion = pair_oscillator(pair.with_backlash(50e-6), given_series(4e8, [0.2]), 100.0, 500.0)
    >>> found = speed_run_up(motion, (500.0, 700.0), periods=320)
    >>> sorted(found.force_factor), len(found.force_factor["up"]), found.seconds > 0.0
    (['down', 'up'], 20, True)
    """
    watch, scales = Stopwatch(), motion.scales
    if (speed is None) == (frequency is None):
        raise InputError.at("speed", "", "or frequency must be given, one of both")
    if scales is None and (speed is not None or seconds is not None):
        raise InputError.at(
            "speed", "", "requires an oscillator with physical scales", "give frequency and periods"
        )
    with Faults() as faults:
        bounds = speed or frequency or (0.0, 0.0)
        low, high = (faults.number(f"range[{k}]", bounds[k], POSITIVE) for k in range(2))
        if not low < high:
            faults.add("range", tuple(bounds), "must rise", "the way down is run as well")
        number = faults.whole("periods", periods, *PERIODS)
        if seconds is not None:
            faults.number("seconds", seconds, POSITIVE.in_unit(1.0, "s"))
    ends = (low, high) if speed is None or scales is None else (scales.frequency(low), scales.frequency(high))
    per_tau = 0.5 * (ends[0] + ends[1]) / (2.0 * math.pi)  # mesh periods in a unit of dimensionless time
    if seconds is not None and scales is not None:
        number = faults_of_time(seconds * scales.omega_n * per_tau)
    rows = output_rows(motion.outputs, motion.oscillator.dimension)
    up = dynamics.run_up(
        motion.oscillator,
        ends,
        number,
        outputs=rows,
        progress=lambda done, all_: progress(BLOCKS, done, 2 * all_),
    )
    down = dynamics.run_up(
        motion.oscillator,
        ends[::-1],
        number,
        outputs=rows,
        progress=lambda done, all_: progress(BLOCKS, all_ + done, 2 * all_),
    )
    each, mean = {"up": up, "down": down}, motion.mean_force or np.nan
    said = [f"{way}: {run.message}" for way, run in each.items()]
    return SpeedRunUp(
        frequency={way: run.frequency for way, run in each.items()},
        speed=None
        if scales is None
        else {way: scales.speed(1.0) * run.frequency for way, run in each.items()},
        spread={way: run.rms for way, run in each.items()},
        peak={way: run.peak for way, run in each.items()},
        force_factor={way: run.force_peak / mean for way, run in each.items()},
        force_rms={way: run.force_rms / abs(mean) for way, run in each.items()},
        separated={way: run.separated for way, run in each.items()},
        order=up.order,
        order_force={way: run.force_order / abs(mean) for way, run in each.items()},
        order_displacement={way: run.displacement_order for way, run in each.items()},
        **part_figures(
            motion.outputs,
            {
                "": {way: run.output_peak for way, run in each.items()},
                "_swing": {way: run.output_rms for way, run in each.items()},
            },
        ),
        periods=up.periods,
        seconds=None if scales is None else up.periods / per_tau / scales.omega_n,
        rate=max(up.rate, down.rate),
        rms_error={way: run.rms_error for way, run in each.items()},
        peak_error={way: run.peak_error for way, run in each.items()},
        greatest_error=max(up.greatest_error, down.greatest_error),
        error=max(up.error, down.error),
        cost=Cost(watch.seconds, periods=up.cost.periods + down.cost.periods),
        converged=up.converged and down.converged,
        message="; ".join(said),
    )


BLOCKS = "blocks of 16 mesh periods"
"""What progress counts."""

MOST = 2_000_000
"""Mesh periods of a run-up: a quarter of an hour of computing."""


def faults_of_time(periods: float) -> int:
    """Whole number of mesh periods of a time.

    Raises
    ------
    InputError
        Where these are fewer than a block, or too many.
    """
    if not 16 <= periods <= MOST:
        allowed = f"must be 16 to {MOST} mesh periods (this is {periods:.3g})"
        raise InputError.at(
            "seconds", "", allowed, "give another time: slower than a few seconds changes little"
        )
    return round(periods)
