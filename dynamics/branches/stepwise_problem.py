"""What a continuation needs of a flow: a period map with its derivatives by state and one parameter."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace

import numpy as np

from base import Array, InputError
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, MapPoint
from dynamics.branches.crossings import Crossing, bracketed_orbit, special_point
from dynamics.flow.stepwise_flow import NOISE, StepwiseFlow
from dynamics.model.options import OPTIONS
from dynamics.model.smooth_oscillator import SmoothOscillator

AHEAD = 1e-6  # along a branch, for slopes of its multipliers
XTOL = 1e-14  # width of the bracket of a special point, over the chord


@dataclass(frozen=True, eq=False)
class PeriodMap(BranchProblem):
    """A flow over one parameter, to be made with `evaluate` and `flow`; attributes as in `BranchProblem`."""

    @property
    def noise(self) -> float:
        """Residual over the stretch of the map that cannot be got below."""
        return 1e-13

    @abstractmethod
    def evaluate(self, u: Array) -> MapPoint | None:
        """Image of the unknowns; None where there is none."""

    def trends(self, point: MapPoint, tangent: Array) -> tuple[float, float]:
        """Slopes of `fold` and `flip` along the branch of one parameter, by a difference; 0 where the map ends."""
        beside = self.evaluate(point.u + AHEAD * tangent)
        if beside is None:
            return 0.0, 0.0
        return (beside.fold - point.fold) / AHEAD, (beside.flip - point.flip) / AHEAD

    def refined(self) -> PeriodMap:
        """The same map, more accurately, for an error estimate."""
        return self

    def locate(self, last: MapPoint, new: MapPoint, crossing: Crossing) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing; a determinant of 1 with real multipliers is none, and that is no failure."""
        located = bracketed_orbit(self, (last, new), crossing, XTOL)
        if located is None:
            return None, False
        point, condition = located
        if condition.kind == "neimark-sacker" and not point.turning:
            return None, True
        finer, error = self.refined(), math.inf
        row = (new.u - last.u) / np.linalg.norm(new.u - last.u)
        ends = [p for p in (finer.correct(end.u, row) for end in (last, new)) if p is not None]
        if len(ends) == 2 and (there := bracketed_orbit(finer, ends, crossing, XTOL)) is not None:
            error = abs(there[0].value - point.value)
        return special_point(self, point, condition, (last, new), error), True

    def correct(self, guess: Array, across: Array, limit: int = 12) -> MapPoint | None:
        """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive."""
        u, before = guess.copy(), math.inf
        for iteration in range(limit):
            point = self.evaluate(u)
            if point is None or not np.all(np.isfinite(point.derivative)):
                return None
            off = np.array([*(point.image - u[: point.size]), across @ (u - guess)])
            stretch = max(1.0, float(np.max(np.abs(point.jacobian))))
            residual = float(np.max(np.abs(off[: point.size]))) / stretch
            matrix = np.vstack([point.derivative - np.eye(point.size, len(u)), across])
            try:
                step = np.linalg.solve(matrix, -off)
            except np.linalg.LinAlgError:
                return None
            length = float(np.max(np.abs(step)))
            noise = self.noise * max(1.0, float(np.max(np.abs(u))))  # a small motion may lie far out
            small = residual <= noise
            if small and (residual >= 0.5 * before or length < 1e-14 or residual <= 0.02 * noise):
                return replace(point, iterations=iteration + 1)
            if not length < 0.3:
                return None
            before = residual
            u = u + step
        return None


@dataclass(frozen=True, eq=False)
class FlowProblem(PeriodMap):
    """Periodic orbits of the stepwise flow; attributes as in `BranchProblem`."""

    oscillator: SmoothOscillator

    @property
    def step_tolerance(self) -> float:
        """Tolerance of a step."""
        return OPTIONS.step_tolerance if self.tolerance is None else self.tolerance

    @property
    def noise(self) -> float:
        """What the choice of steps leaves."""
        return NOISE * self.step_tolerance

    def evaluate(self, u: Array) -> MapPoint | None:
        """Image of the unknowns; None if the parameter is not allowed there or the motion is lost."""
        try:
            here = self.at(u)
        except InputError:  # the continuation tries a smaller step
            return None
        flow = StepwiseFlow(here, self.step_tolerance, self.parameters, extrema=True)
        image = flow.follow(u[:2] * self.scale, self.periods)
        if image.message:
            return None
        derivative = np.column_stack([image.jacobian, image.slope * ((self.high - self.low) / self.scale)])
        turns = image.events[image.events[:, 1] == flow.levels]
        extrema = turns[:, [0, 3, 5]]
        extrema[:, 0] = np.mod(extrema[:, 0] / (2.0 * math.pi * self.periods), 1.0)
        counted = flow.surfaces[: min(flow.levels, 2)]
        upright = counted[counted[:, 1] == 0.0]
        places = upright[:, 3].astype(int)
        levels = np.where(places >= 0, upright[:, 2] * here.law.values[places], 0.0)
        return MapPoint(
            u.copy(), self.values(u), here.period, image.state / self.scale, derivative,
            math.exp(image.log_determinant), image.impacts, levels, extrema,
        )  # fmt: skip

    def flow(self, point: MapPoint) -> StepwiseFlow:
        """Flow of the oscillator of a point."""
        return StepwiseFlow(self.at(point.u), self.step_tolerance)

    def refined(self) -> FlowProblem:
        """The same with an eighth of the tolerance."""
        return replace(self, tolerance=max(self.step_tolerance / 8.0, 2e-15))
