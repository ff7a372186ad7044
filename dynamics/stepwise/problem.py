"""What a continuation needs of a flow: a period map with its derivatives by state and one parameter."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from base import Array, InputError
from dynamics.special import SpecialPoint
from dynamics.stepwise.crossings import Sign, find_crossings, locate
from dynamics.stepwise.flow import NOISE, StepwiseFlow
from dynamics.stepwise.oscillator import SmoothOscillator
from dynamics.stepwise.point import MapPoint

__all__ = ["FlowProblem", "PeriodMap"]


class PeriodMap(ABC):
    """A flow seen by the continuation; to be made with `evaluate` and `states`.

    Attributes
    ----------
    parameter : str
        What is varied.
    periods : int
        n.
    low, high : float
        Range of the parameter.
    scale : float
        Size of the motion.
    """

    parameter: str
    periods: int
    low: float
    high: float
    scale: float
    maps: int = 1

    @property
    def noise(self) -> float:
        """Residual over the stretch of the map that cannot be got below."""
        return 1e-13

    @abstractmethod
    def evaluate(self, u: Array) -> MapPoint | None:
        """Image of the unknowns; None where there is none."""

    @abstractmethod
    def states(self, point: MapPoint) -> Array:
        """X and V over the scale after 1, 2, .. n periods, shape (n, 2)."""

    def refined(self) -> PeriodMap:
        """The same map, more accurately, for an error estimate."""
        return self

    def magnified(self, factor: float) -> PeriodMap | None:
        """The same with a larger scale; None if it cannot be changed."""
        return None

    def unknowns(self, state: Array, value: float) -> Array:
        """Unknowns of a state and a value of the parameter."""
        return np.array([*(state / self.scale), (value - self.low) / (self.high - self.low)])

    def phases(self, point: MapPoint) -> list[list[float]]:
        """Unknowns from each excitation period on."""
        states = self.states(point)
        rows: list[list[float]] = np.column_stack(
            [np.roll(states, 1, axis=0), np.full(len(states), point.u[2])]
        ).tolist()
        return rows

    def half_way(self, point: MapPoint) -> Array:
        """State over the scale after half the orbit's period."""
        half: Array = self.states(point)[self.periods // 2 - 1]
        return half

    def crossings(self, last: MapPoint, new: MapPoint) -> tuple[list[Sign], bool]:
        """Changes of sign between neighbours."""
        return find_crossings(last, new)

    def locate(self, last: MapPoint, new: MapPoint, crossing: Sign) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing; a determinant of 1 with real multipliers is none."""
        return locate(self, last, new, crossing)

    def correct(self, guess: Array, across: Array, limit: int = 12) -> MapPoint | None:
        """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive."""
        u, before = guess.copy(), math.inf
        for iteration in range(limit):
            point = self.evaluate(u)
            if point is None or not np.all(np.isfinite(point.derivative)):
                return None
            off = np.array([*(point.image - u[:2]), across @ (u - guess)])
            stretch = max(1.0, float(np.max(np.abs(point.derivative[:, :2]))))
            residual = float(np.max(np.abs(off[:2]))) / stretch
            matrix = np.vstack([point.derivative - np.eye(2, 3), across])
            try:
                step = np.linalg.solve(matrix, -off)
            except np.linalg.LinAlgError:
                return None
            length = float(np.max(np.abs(step)))
            small = residual <= self.noise
            if small and (residual >= 0.5 * before or length < 1e-14 or residual <= 0.02 * self.noise):
                return replace(point, iterations=iteration + 1)
            if not length < 0.3:
                return None
            before = residual
            u = u + step
        return None


@dataclass(frozen=True)
class FlowProblem(PeriodMap):
    """Periodic orbits of the stepwise flow; attributes as in `PeriodMap`."""

    oscillator: SmoothOscillator
    parameter: str
    periods: int
    low: float
    high: float
    scale: float
    tolerance: float

    @property
    def noise(self) -> float:
        """What the choice of steps leaves."""
        return NOISE * self.tolerance

    def evaluate(self, u: Array) -> MapPoint | None:
        """Image of the unknowns; None if the parameter is not allowed there or the motion is lost."""
        width = self.high - self.low
        value = float(self.low + u[2] * width)
        try:
            here = self.oscillator.with_parameter(self.parameter, value)
        except InputError:  # the continuation tries a smaller step
            return None
        flow = StepwiseFlow(here, self.tolerance, (self.parameter,), extrema=True)
        image = flow.follow(u[:2] * self.scale, self.periods)
        if image.message:
            return None
        derivative = np.column_stack([image.jacobian, image.slope * (width / self.scale)])
        turns = image.events[image.events[:, 1] == flow.levels]
        extrema = turns[:, [0, 3, 5]]
        extrema[:, 0] = np.mod(extrema[:, 0] / (2.0 * math.pi * self.periods), 1.0)
        counted = flow.surfaces[: min(flow.levels, 2)]
        upright = counted[counted[:, 1] == 0.0]
        places = upright[:, 3].astype(int)
        levels = np.where(places >= 0, upright[:, 2] * here.law.values[places], 0.0)
        counts = (int(image.counts[:, 0].sum()), int(image.counts[:, 1].sum()))
        return MapPoint(
            u.copy(), np.array([value]), here.period, image.state / self.scale, derivative,
            math.exp(image.log_determinant), counts, levels, extrema,
        )  # fmt: skip

    def states(self, point: MapPoint) -> Array:
        """X and V over the scale after each period."""
        here = self.oscillator.with_parameter(self.parameter, point.value)
        flow = StepwiseFlow(here, self.tolerance)
        image = flow.follow(point.u[:2] * self.scale, self.periods, derivatives=False)
        return image.states / self.scale

    def refined(self) -> FlowProblem:
        """The same with an eighth of the tolerance."""
        return replace(self, tolerance=max(self.tolerance / 8.0, 2e-15))

    def magnified(self, factor: float) -> FlowProblem:
        """With a larger scale."""
        return replace(self, scale=factor * self.scale)
