"""The motion swept up and down, portraits of what the sweeps met, and where contact is first lost."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import ArrayLike

import dynamics
from base import Array, Cost, Result, Stopwatch, part, quantity, record, unclocked
from base.results import ITSELF
from flankfilm.coupling.speeds.both_ways import LEFT, SweptForce, both_ways, frequencies_of
from flankfilm.coupling.speeds.swept_truncation import grazing_errors, longer_changes
from flankfilm.coupling.vibration.contact_loss_error import grazing_budget
from flankfilm.coupling.vibration.oscillator import PairOscillator
from flankfilm.coupling.vibration.resonance import vibrations

MOST_PORTRAITS = 6


@dataclass(frozen=True)
class Portrait:
    """A settled motion at one parameter value.

    Attributes
    ----------
    frequency : float
        Mesh frequency over the natural frequency.
    direction : str
        Sweep that met it, ``"up"`` or ``"down"``.
    label : str
        Motion n-p-q.
    displacement, velocity : ndarray
        Trajectory, dimensionless.
    section : ndarray, shape (points, 2)
        States at tau = 0.
    """

    frequency: float
    direction: str
    label: str
    displacement: Array
    velocity: Array
    section: Array


SCALED = "not estimated: the backlash over the length scale, which follows from the mean stiffness"


@record
class SpeedSweep(SweptForce):
    """Motion of a pair on rigid shafts swept up and down in speed.

    ``states`` and ``labels`` go by direction, ``"up"`` and ``"down"``.
    """

    headline = ("least_grazing", "half_backlash")

    states: Mapping[str, Array] = quantity(
        "1", "displacement and velocity at tau = 0", "frequency kept state", error="error"
    )
    grazings: Array = quantity(
        "1",
        "where the orbit that never leaves contact touches the backlash",
        "grazing",
        error="grazing_error",
        no_error="rounding of the exact flow, for the stiffness as given",
    )
    half_backlash: float = quantity("1", "half the backlash D", no_error=SCALED)
    spread: Mapping[str, Array] = quantity(
        "1", "root mean square of the displacement about its mean", "frequency", error="sampling_error"
    )
    operating_frequency: float = quantity(
        "1", "mesh frequency over natural frequency of the oscillator at its own speed", no_error=SCALED
    )
    operating_force_factor: float = quantity(
        "1",
        "maximum force over the mean force at that speed, the motion settled from rest in contact",
        error="sampling_error",
    )
    grazing_budget: Mapping[str, float] = part(
        "source of error to relative error of the lowest speed at which contact is lost: stiffness, truncation, flow"
    )
    grazing_error: Array | None = quantity(
        "1",
        "relative change of the frequency of the touch by the longer series; infinite where it has none near",
        "grazing",
    )
    spread_change: Mapping[str, Array] | None = quantity(
        "1",
        LEFT.format("the displacement's root mean square"),
        "checked",
        no_error=ITSELF,
    )
    portraits: tuple[Portrait, ...] = part("settled motions at chosen values")
    error: float
    cost: Cost
    messages: tuple[str, ...] = part("what the solvers have to report")

    @property
    def least_grazing(self) -> float | None:
        """Lowest frequency at which contact is lost."""
        return float(self.grazings.min()) if self.grazings.size else None

    @property
    def least_grazing_error(self) -> float | None:
        """Relative error of the lowest speed at which contact is lost; None where there is none, or it is not known."""
        known = self.grazing_budget
        return math.fsum(known.values()) if "stiffness" in known or set(known) == {"flow"} else None

    @property
    def greatest_factor_error(self) -> float | None:
        """Relative error of the maximum force by samples and the series' order, near it; None without a motion."""
        factors = np.array([*self.force_factor.values()])
        if not np.isfinite(factors).any():
            return None
        way, at = np.unravel_index(int(np.nanargmax(factors)), factors.shape)
        change = 0.0
        if self.force_change is not None and self.checked is not None:
            nearest = int(np.argmin(np.abs(self.checked - self.frequency[at])))
            change = float(self.force_change[[*self.force_factor][way]][nearest])
        return self.sampling_error + change

    @property
    def converged(self) -> bool:
        """Whether no solver has anything to report."""
        return not self.messages

    @property
    def message(self) -> str:
        """All messages in one."""
        return "; ".join(self.messages)


def speed_sweep(
    motion: PairOscillator,
    speed: ArrayLike | None = None,
    *,
    frequency: ArrayLike | None = None,
    portraits: Sequence[float] = (),
) -> SpeedSweep:
    """Sweep the speed up and down.

    Parameters
    ----------
    motion : PairOscillator
    speed : array_like, shape (values,)
        Pinion speeds [rad/s], rising.
    frequency : array_like, shape (values,)
        Instead of them: mesh frequencies over the natural one.
    portraits : sequence of float
        Frequencies of the portraits; one for each kind of motion where there are none.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> from flankfilm.coupling import PairOscillator, given_series
    >>> series = given_series(1.0, [0.18], [0.0])
    >>> oscillator = GearOscillator(series.stiffness, 0.05, 0.1, 0.2, 0.5, 0.2)
    >>> swept = speed_sweep(PairOscillator(oscillator, None, series), frequency=[0.6, 0.65, 0.7])
    >>> [label for label in swept.labels["up"]], round(swept.least_grazing, 4)
    (['1-0-0', '1-1-0', '1-1-1'], 0.6335)
    """
    with unclocked():
        from dynamics import contact_grazing, sweep
    watch = Stopwatch()
    values, speeds = frequencies_of(motion, speed, frequency)
    oscillator = motion.oscillator
    swept = both_ways(motion, values)
    grazing = contact_grazing(oscillator, "frequency", (float(values[0]), float(values[-1])))
    (operating,) = vibrations(oscillator, [sweep(oscillator, "frequency", [oscillator.frequency])])
    solved: list[Result] = [*swept.sweeps.values(), grazing]
    touched = grazing.columns()
    changes = longer_changes(motion, swept.sweeps, swept.shaken)
    left_out = None if changes is None else grazing_errors(changes.longer, touched)
    return SpeedSweep(
        **swept.figures(changes, operating),
        speed=speeds,
        states={direction: result.states for direction, result in swept.sweeps.items()},
        portraits=tuple(
            _portrait(oscillator, swept.sweeps[direction], direction, index)
            for direction, index in _choices(values, portraits, swept.sweeps)
        ),
        grazings=touched,
        half_backlash=oscillator.half_backlash,
        spread={direction: response.spread for direction, response in swept.shaken.items()},
        operating_frequency=oscillator.frequency,
        operating_force_factor=float(operating.force[0]),
        grazing_budget=_first_loss(motion, touched, left_out, grazing.error),
        grazing_error=left_out,
        spread_change=None if changes is None else changes.each("spread"),
        error=swept.error,
        cost=Cost(watch.seconds, periods=swept.periods),
        messages=tuple(solution.message for solution in solved if not solution.converged),
    )


def _first_loss(
    motion: PairOscillator, touched: Array, left_out: Array | None, flow: float
) -> Mapping[str, float]:
    """Error budget of the lowest speed at which contact is lost; empty where it never is."""
    if not touched.size:
        return {}
    first = int(np.argmin(touched))
    truncation = None if left_out is None else float(left_out[first])
    return grazing_budget(motion, float(touched[first]), flow, truncation)


def _choices(
    frequency: Array, wanted: Sequence[float], sweeps: Mapping[str, dynamics.SweepResult]
) -> list[tuple[str, int]]:
    """Choose direction and index of each portrait: those asked for, else one for each kind of motion."""
    if wanted:
        nearest = [int(np.argmin(np.abs(frequency - w))) for w in wanted]
        return [(d, i) for i in nearest for d in _different(sweeps, i)]
    longest: dict[str, tuple[int, str, int]] = {}
    for direction, result in sweeps.items():
        at = 0
        for label, run in groupby(result.labels):
            length = len(list(run))
            if length > longest.get(label, (0, "", 0))[0]:
                longest[label] = (length, direction, at + length // 2)
            at += length
    kept = sorted(longest.values(), reverse=True)[:MOST_PORTRAITS]
    return sorted(((d, i) for _, d, i in kept), key=lambda choice: choice[1])


def _different(sweeps: Mapping[str, dynamics.SweepResult], index: int) -> tuple[str, ...]:
    """Directions whose motions differ at a value: one where both sweeps met the same."""
    labels = {result.labels[index] for result in sweeps.values()}
    return ("up",) if len(labels) == 1 else ("up", "down")


def _portrait(
    oscillator: dynamics.GearOscillator, result: dynamics.SweepResult, direction: str, index: int
) -> Portrait:
    frequency = float(result.values[index])
    states = result.states[index]
    periods = int(result.periods[index]) or 60
    here = oscillator.with_parameter("frequency", frequency)
    motion = dynamics.trajectory(here, states[-1], periods=periods)
    return Portrait(frequency, direction, result.labels[index], motion.x, motion.v, motion.poincare)
