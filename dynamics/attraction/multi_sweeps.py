"""Sweeps from many starts: the attractors that one sweep up and one down would pass by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, quantity, record
from dynamics.attraction.basins import basins
from dynamics.model.limits import checked_grid
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.model.states import apart, scale_of
from dynamics.motion.sweeps import APERIODIC, DIVERGED, SweepResult, sweep
from dynamics.orbits.starting import reach

CHUNK = 16  # values swept before it is looked whether the motions are known


@record
class Motion:
    """An attractor at one value of the parameter."""

    no_error = FLOW

    headline = ("value", "label")

    value: float = quantity("1", "value of the parameter")
    label: str = quantity("", "n-p-q, aperiodic or diverged")
    periods: int = quantity("1", "n; 0 if aperiodic")
    states: Array = quantity("1", "state at tau = 0 mod the excitation period", "kept state")
    directions: frozenset[str] = quantity("", "directions of the sweeps that met it: up, down")


@record
class MultiSweep:
    """Attractors over one parameter."""

    no_error = FLOW

    headline = ("parameter", "message")

    parameter: str = quantity("", "what was varied")
    values: Array = quantity("1", "values of the parameter, rising", "value")
    motions: tuple[tuple[Motion, ...], ...] = quantity("", "attractors met at each value")
    sweeps: int = quantity("1", "sweeps made, in either direction")
    error: float = quantity("1", "as of `sweep`, the largest of all")
    cost: Cost
    converged: bool = quantity("1", "whether every motion stayed bounded")
    message: str

    def at(self, value: float) -> tuple[Motion, ...]:
        """Motions at the value nearest to one given."""
        return self.motions[int(np.argmin(np.abs(self.values - value)))]

    def ranges(self, label: str) -> list[tuple[float, float]]:
        """First and last value of every run of neighbouring values at which a motion of this label was met."""
        has = np.array([any(m.label == label for m in here) for here in self.motions], dtype=np.int64)
        edge = np.diff(np.concatenate([[0], has, [0]]))
        return [
            (float(self.values[i]), float(self.values[j - 1]))
            for i, j in zip(np.flatnonzero(edge == 1), np.flatnonzero(edge == -1), strict=True)
        ]

    def most(self) -> int:
        """Largest number of attractors met at one value."""
        return max(len(here) for here in self.motions)


@periodic_only
def multi_sweep(
    oscillator: PeriodicOscillator,
    parameter: str = "frequency",
    values: npt.ArrayLike = (),
    *,
    seeds: int = 9,
    starts: int = 6,
    limit: int = 1000,
    max_period: int = 16,
    progress: Callable[[int, int], None] | None = None,
) -> MultiSweep:
    """Sweep a parameter up and down from many starts.

    One sweep begins at rest at either end. At `seeds` values in between a grid of starts is followed to its
    attractors, and from each that no sweep has met there one sweep goes up and one down, until they meet nothing new.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        As in `GearOscillator.with_parameter`.
    values : array_like, shape (m,)
        Parameter values.
    seeds : int
        Values at which a grid of starts is followed. An attractor that exists between two of them only is missed
        unless another one leads to it.
    starts : int
        Starts along each side of the grid, which covers somewhat more than long motions do.
    limit : int
        Periods that a start is given, as in `basins`. A chaotic transient that lasts longer counts as aperiodic.
    max_period : int
        Longest period that is recognised.
    progress : callable, optional
        Called with the number of seeds done and the number of all.

    Returns
    -------
    MultiSweep
        The attractors at every value.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, multi_sweep
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> sweeps = multi_sweep(osc, "frequency", [0.58, 0.6, 0.62], seeds=1, starts=3)
    >>> [motion.label for motion in sweeps.at(0.6)]
    ['1-0-0', '1-1-1']
    """
    watch = Stopwatch()
    with Faults() as faults:
        grid = np.unique(checked_grid(faults, "values", values))
        number = faults.whole("seeds", seeds, 0, 10_000, "9 is usual")
        side = faults.whole("starts", starts, 1, 1000, "6 is usual")
    met = _Met(oscillator, parameter, grid, max_period)
    for direction, i in (("up", 0), ("down", len(grid) - 1)):
        met.follow(direction, i, met.at(i).rest_state(), whole=True)
    for done in range(number):
        i = int((done + 0.5) / number * len(grid))
        here = met.at(i)
        (x0, x1), (v0, v1) = reach(here)
        reached = basins(here, (x0, x1, side), (v0, v1, side), limit=limit, max_period=max_period)
        met.periods += reached.cost.periods
        for attractor in reached.attractors:
            if attractor.share > 0.0 and not met.knows(i, attractor.label, attractor.states):
                for direction in ("up", "down"):
                    met.follow(direction, i, attractor.states[-1], whole=False)
        if progress is not None:
            progress(done + 1, number)
    return met.result(watch)


class _Met:
    """Motions met so far."""

    def __init__(self, oscillator: PeriodicOscillator, parameter: str, grid: Array, max_period: int) -> None:
        self.oscillator, self.parameter, self.grid, self.longest = oscillator, parameter, grid, max_period
        self.motions: list[list[Motion]] = [[] for _ in grid]
        self.size = scale_of(oscillator, self.at(0).rest_state())
        self.sweeps = self.periods = 0
        self.error, self.bounded = 0.0, True

    def at(self, i: int) -> PeriodicOscillator:
        """Oscillator at a value."""
        return self.oscillator.with_parameter(self.parameter, float(self.grid[i]))

    def follow(self, direction: str, i: int, state: Array, whole: bool) -> None:
        """Sweep from a value on; unless the whole range is wanted, until a chunk of values brings nothing new."""
        path = np.arange(i, len(self.grid)) if direction == "up" else np.arange(i, -1, -1)
        self.sweeps += 1
        for part in np.split(path, range(CHUNK, len(path), CHUNK)):
            swept = sweep(
                self.oscillator, self.parameter, self.grid[part], direction, initial=state, max_period=self.longest,
                keep=max(64, 2 * self.longest),
            )  # fmt: skip
            self.periods += swept.cost.periods
            self.error, self.bounded = max(self.error, swept.error), self.bounded and swept.converged
            new = [self._note(int(k), swept, j, direction) for j, k in enumerate(part)]
            if not (whole or any(new)):
                return
            state = swept.states[-1, -1]
            if not _bounded(state, self.size):
                if not whole:
                    return
                state = self.at(part[-1]).rest_state()

    def knows(self, i: int, label: str, states: Array) -> bool:
        """Whether a motion has been met at a value."""
        return any(_same(m, label, states) for m in self.motions[i])

    def _note(self, i: int, swept: SweepResult, j: int, direction: str) -> bool:
        """Note a motion; whether it is new."""
        here, label, n = self.motions[i], swept.labels[j], int(swept.periods[j])
        if not _bounded(swept.states[j], self.size):
            label, n, self.bounded = DIVERGED, 0, False
        for k, motion in enumerate(here):
            if _same(motion, label, swept.states[j]):
                here[k] = replace(motion, directions=motion.directions | {direction})
                return False
        here.append(Motion(float(self.grid[i]), label, n, swept.states[j], frozenset({direction})))
        return True

    def result(self, watch: Stopwatch) -> MultiSweep:
        """Assemble the record."""
        motions = tuple(tuple(here) for here in self.motions)
        most = max(range(len(motions)), key=lambda i: len(motions[i]))
        message = (
            f"{len(self.grid)} values, {self.sweeps} sweeps, up to {len(motions[most])} attractors "
            f"({self.parameter} = {self.grid[most]:g})"
        )
        if not self.bounded:
            message += "; some motions grow without bound: check the parameters there"
        cost = Cost(watch.seconds, 0, self.sweeps, self.periods)
        return MultiSweep(
            self.parameter, self.grid, motions, self.sweeps, self.error, cost, self.bounded, message
        )


def _bounded(states: Array, size: float) -> bool:
    """Whether states are finite and of no size that only unlimited growth leads to."""
    return bool(np.max(np.abs(states)) <= OPTIONS.unbounded * size)  # False for nan


def _same(motion: Motion, label: str, states: Array) -> bool:
    """Whether a motion has the label and the states of another."""
    if motion.label != label or label == DIVERGED:
        return motion.label == label
    if label == APERIODIC:
        return _overlap(motion.states, states) > OPTIONS.shared_box
    return bool(apart(states[-1], motion.states) < OPTIONS.same_motion * np.max(np.abs(motion.states)))


def _overlap(a: Array, b: Array) -> float:
    """Part that the boxes around two sets of states share, of that which they cover together."""
    low, high = np.maximum(a.min(axis=0), b.min(axis=0)), np.minimum(a.max(axis=0), b.max(axis=0))
    shared = float(np.prod(np.maximum(high - low, 0.0)))
    union = sum(float(np.prod(np.ptp(s, axis=0))) for s in (a, b)) - shared
    return shared / union if union > 0.0 else 1.0
