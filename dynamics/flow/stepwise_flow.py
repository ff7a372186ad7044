"""The stepwise flow: period map with derivatives, sampled motion with events, growth of directions."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np

from base import Array, Cost, Faults, Integers, Stopwatch
from dynamics.flow.protocol import Flow, MapResult, Stretches, lost_motion
from dynamics.model.limits import STEP_TOLERANCE
from dynamics.model.options import OPTIONS
from dynamics.model.smooth_oscillator import SmoothOscillator

NOISE = 50.0  # residual over tolerance and stretch of the map that the choice of steps leaves
TURNING = np.array([[0.0, 1.0, 0.0, -1.0]])  # the surface V = 0
REASONS = {
    1: "the motion grew beyond 1e150",
    2: "more than 100 000 crossings in a period",
    3: "more than a million steps in a period, or one below 1e-14 of a radian: the law is not smooth, or its "
    "derivatives are wrong",
    4: "the motion sticks to a switching surface, which this flow does not follow",
}


class StepwiseFlow(Flow):
    """An oscillator made ready for the kernels.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    tolerance : float, optional
        Of a step, relative to the size of the motion and of each derivative, 2e-15 to 0.1; 1e-12 unless given.
    parameters : tuple of str
        Parameters to differentiate by.
    extrema : bool
        Whether extrema of X are met and noted, like crossings.

    Raises
    ------
    InputError
        If the tolerance is out of range, or there is no such parameter.
    """

    def __init__(
        self,
        oscillator: SmoothOscillator,
        tolerance: float | None = None,
        parameters: tuple[str, ...] = (),
        extrema: bool = False,
    ) -> None:
        with Faults() as faults:
            self.oscillator, self.extrema = oscillator, extrema
            self.tolerance = faults.number(
                "tolerance", OPTIONS.step_tolerance if tolerance is None else tolerance, STEP_TOLERANCE
            )
        self.noise = NOISE * self.tolerance
        self.model = oscillator.model(parameters)
        levels = oscillator.surfaces
        self.levels = len(levels)
        self.surfaces = np.vstack([levels, TURNING]) if extrema else levels
        self.columns = 2 + len(parameters)
        self.size = 1e-2 * oscillator.floor

    def finer(self) -> StepwiseFlow:
        """The same with a smaller tolerance, without derivatives by parameters."""
        tolerance = max(self.tolerance / 32.0, 4e-15) if self.tolerance > 4e-15 else 2e-15
        return StepwiseFlow(self.oscillator, tolerance, (), self.extrema)

    def slopes(self, parameters: tuple[str, ...] = (), extrema: bool = False) -> StepwiseFlow:
        """The same with derivatives by parameters, and with extrema met and noted."""
        return StepwiseFlow(self.oscillator, self.tolerance, parameters, extrema)

    def follow(self, state: Array, periods: int = 1, skip: int = 0, derivatives: bool = True) -> MapResult:
        """Follow a state; the derivatives cover the periods skipped, too."""
        from dynamics.kernels.stepwise.propagating import iterate

        watch = Stopwatch()
        room = 32 * (skip + periods)
        while True:
            y = self._vector(state, derivatives)
            going, on = self._going()
            states, counts = np.empty((periods, 2)), np.zeros((periods, 2), dtype=np.int64)
            events = np.empty((room, 6 + (self.columns if derivatives else 0)))
            flag = int(iterate(*self._fixed, y, going, on, skip, states, counts, events))
            met = int(going[2])
            if met <= room:
                break
            room = met
        if flag:
            states[:] = np.nan
            y[:] = np.nan
        rest = y[3:].reshape(-1, 2).T if derivatives else np.full((2, self.columns), np.nan)
        return MapResult(
            states,
            rest[:, :2].copy(),
            float(y[2]) if derivatives else math.nan,
            counts,
            REASONS.get(flag, ""),
            Cost(watch.seconds, periods=skip + periods, counts={"evaluations of the law": int(going[3])}),
            rest[:, 2:].copy(),
            events[:met],
        )

    def sampled(self, state: Array, periods: int, points: int) -> tuple[Array, Array, Array]:
        """Samples, extrema and crossings of the first two surfaces; a step ends at each sample."""
        flow = self if self.extrema else StepwiseFlow(self.oscillator, self.tolerance, (), extrema=True)
        samples, events = flow._walk(state, periods, points)
        turns = events[:, 1] == flow.levels
        met, tau = events[~turns], 1.0 / self.oscillator.frequency
        entered = np.where(met[:, 1] == 0, np.maximum(met[:, 2], 0), np.minimum(met[:, 2], 0))
        crossings = np.column_stack([met[:, 0] * tau, met[:, 3], met[:, 4], entered])
        extrema = np.column_stack([events[turns, 0] * tau, events[turns, 3], events[turns, 5]])
        return samples, extrema, crossings

    def stretches(self, state: Array, sizes: Sequence[int], keep: bool = False) -> Stretches:
        """Growth of two directions, made orthonormal so often that no stretch between is large."""
        from dynamics.kernels.stepwise.propagating import stretch

        pieces = max(1, math.ceil(self.oscillator.period / 1.5))
        y, (going, on) = self._vector(state, derivatives=True), self._going()
        logs, states, flag = np.zeros((len(sizes), 3)), [], 0
        for row, size in zip(logs, sizes, strict=True):
            for each in [1] * size if keep else [size]:
                flag = flag or int(stretch(*self._fixed, y, going, on, each, pieces, row))
                states.append(y[:2].copy())
        kept = np.array(states if keep else states[-1:])
        osc = self.oscillator
        damped = 2.0 * osc.damping_ratio * osc.period * np.asarray(sizes, dtype=np.float64)
        return Stretches(logs[:, :2], kept, damped, REASONS.get(flag, ""))

    @cached_property
    def _fixed(self) -> tuple[Any, Array, float, float]:
        """What every kernel takes first."""
        return self.model, self.surfaces, self.tolerance, self.size

    def _vector(self, state: Array, derivatives: bool) -> Array:
        """State with the unit matrix as its derivative."""
        y = np.zeros(3 + 2 * self.columns if derivatives else 2)
        y[:2] = state
        if derivatives:
            y[3] = y[6] = 1.0
        return y

    def _going(self) -> tuple[Array, Integers]:
        """What passes from call to call, at a start; the second figure is the angle of the first try."""
        first = min(0.1, 0.1 * self.oscillator.frequency)
        return np.array([-1.0, first, 0.0, 0.0]), np.zeros(len(self.surfaces), dtype=np.int64)

    def _walk(self, state: Array, periods: int, points: int) -> tuple[Array, Array]:
        """Samples and events, as the kernels note them."""
        from dynamics.kernels.stepwise.propagating import propagate

        y, (going, on) = self._vector(state, derivatives=False), self._going()
        samples, unseen = np.empty((periods * points + 1, 2)), np.zeros(2, dtype=np.int64)
        samples[0] = y
        noted: list[Array] = []
        angles = (2.0 * math.pi * np.arange(points + 1) / points).tolist()
        for i in range(periods * points):
            going[2], place = 0.0, i % points
            room = np.empty((256, 6))
            flag = int(
                propagate(
                    *self._fixed, angles[place], angles[place + 1], y, going, on, unseen, room, i // points
                )
            )
            if flag or going[2] > len(room):
                raise lost_motion(state, REASONS.get(flag, "more than 256 events between two samples"))
            noted.append(room[: int(going[2])])
            samples[i + 1] = y
        return samples, np.concatenate(noted)
