"""What a continuation needs of a flow: a period map with its derivatives by state and one parameter."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
import numpy.typing as npt

from base import InputError
from dynamics.smooth.flow import follow
from dynamics.smooth.oscillator import Engine, SmoothOscillator
from dynamics.smooth.shooting import NOISE

__all__ = ["FlowProblem", "MapPoint", "PeriodMap", "correct", "tangent"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MapPoint:
    """A state and its image under the map of n periods, at one value of the parameter.

    Parameters
    ----------
    u : ndarray, shape (3,)
        Unknowns: X and V over the scale, the parameter as a fraction of its range.
    value : float
        The parameter.
    period : float
        Excitation period, in tau.
    image : ndarray, shape (2,)
        Image of X and V over the scale.
    derivative : ndarray, shape (2, 3)
        Of the image with respect to the unknowns; its first two columns are the Jacobian.
    determinant : float
        Of the Jacobian.
    counts : tuple of int
        p and q.
    levels : ndarray, shape (s,)
        Values of X at which crossings are counted.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of n periods, X, X'' at every extremum of X.
    iterations : int
        Newton iterations spent.
    """

    u: FloatArray
    value: float
    period: float
    image: FloatArray
    derivative: FloatArray
    determinant: float
    counts: tuple[int, int]
    levels: FloatArray
    extrema: FloatArray
    iterations: int = 0

    @property
    def trace(self) -> float:
        """Trace of the Jacobian."""
        return float(self.derivative[0, 0] + self.derivative[1, 1])

    @property
    def fold(self) -> float:
        """Product of (1 - multiplier): zero at a saddle node."""
        return 1.0 + self.determinant - self.trace

    @property
    def flip(self) -> float:
        """Product of (1 + multiplier): zero at a period doubling."""
        return 1.0 + self.determinant + self.trace

    @property
    def torus(self) -> float:
        """Product of the multipliers less 1: zero at a Neimark-Sacker point, if they are a pair."""
        return self.determinant - 1.0


class PeriodMap(Protocol):
    """A flow seen by the continuation.

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
    noise : float
        Residual over the stretch of the map that cannot be got below.
    """

    @property
    def parameter(self) -> str: ...  # noqa: D102

    @property
    def periods(self) -> int: ...  # noqa: D102

    @property
    def low(self) -> float: ...  # noqa: D102

    @property
    def high(self) -> float: ...  # noqa: D102

    @property
    def scale(self) -> float: ...  # noqa: D102

    @property
    def noise(self) -> float: ...  # noqa: D102

    def evaluate(self, u: FloatArray) -> MapPoint | None:
        """Image of the unknowns; None where there is none."""
        ...

    def states(self, point: MapPoint) -> FloatArray:
        """X and V over the scale after 1, 2, .. n periods, shape (n, 2)."""
        ...

    def refined(self) -> PeriodMap:
        """The same map, more accurately, for an error estimate."""
        ...


@dataclass(frozen=True)
class FlowProblem:
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

    def evaluate(self, u: FloatArray) -> MapPoint | None:
        """Image of the unknowns; None if the parameter is not allowed there or the motion is lost."""
        width = self.high - self.low
        value = float(self.low + u[2] * width)
        try:
            here = self.oscillator.with_parameter(self.parameter, value)
        except InputError:  # the continuation tries a smaller step
            return None
        engine = Engine(here, self.tolerance, (self.parameter,), turning=True)
        image = follow(engine, u[:2] * self.scale, self.periods)
        if image.message:
            return None
        derivative = np.column_stack([image.jacobian, image.slope * (width / self.scale)])
        turns = image.events[image.events[:, 1] == engine.levels]
        extrema = turns[:, [0, 3, 5]]
        extrema[:, 0] = np.mod(extrema[:, 0] / (2.0 * math.pi * self.periods), 1.0)
        counted = engine.surfaces[: min(engine.levels, 2)]
        upright = counted[counted[:, 1] == 0.0]
        places = upright[:, 3].astype(int)
        levels = np.where(places >= 0, upright[:, 2] * here.law.values[places], 0.0)
        counts = (int(image.counts[:, 0].sum()), int(image.counts[:, 1].sum()))
        return MapPoint(
            u.copy(), value, here.period, image.state / self.scale, derivative, math.exp(image.log_determinant), counts,
            levels, extrema,
        )  # fmt: skip

    def states(self, point: MapPoint) -> FloatArray:
        """X and V over the scale after each period."""
        here = self.oscillator.with_parameter(self.parameter, point.value)
        engine = Engine(here, self.tolerance)
        return follow(engine, point.u[:2] * self.scale, self.periods, derivatives=False).states / self.scale

    def refined(self) -> FlowProblem:
        """The same with an eighth of the tolerance."""
        return replace(self, tolerance=max(self.tolerance / 8.0, 2e-15))


def correct(problem: PeriodMap, guess: FloatArray, across: FloatArray, limit: int = 12) -> MapPoint | None:
    """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive."""
    u, before = guess.copy(), math.inf
    for iteration in range(limit):
        point = problem.evaluate(u)
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
        small = residual <= problem.noise
        if small and (residual >= 0.5 * before or length < 1e-14 or residual <= 0.02 * problem.noise):
            return replace(point, iterations=iteration + 1)
        if not length < 0.3:
            return None
        before = residual
        u = u + step
    return None


def tangent(point: MapPoint, along: FloatArray) -> FloatArray:
    """Unit vector along the branch, turned to the side of `along`."""
    a, b = point.derivative - np.eye(2, 3)
    way = np.cross(a, b)
    size = math.sqrt(float(way @ way))
    if not size > 0.0:
        return np.asarray(along / np.linalg.norm(along))
    return np.asarray(way / (size if way @ along >= 0.0 else -size))
