"""One point of a branch of periodic orbits: evaluation, Newton corrector and tangent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.errors import DynamicsError
from dynamics.flow import MapResult, Tables, period_map, tables, turning_points
from dynamics.oscillator import GearOscillator
from dynamics.shooting import EPS, exact_determinant

__all__ = ["BranchProblem", "Point"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Point:
    """A periodic orbit on a branch.

    Parameters
    ----------
    u : ndarray, shape (3,)
        Unknowns: X and V over the scale, the parameter as a fraction of its range.
    value : float
        The parameter.
    state : ndarray, shape (2,)
        X and V at tau = 0.
    jacobian : ndarray, shape (2, 2)
        Derivative of the map over the orbit's period.
    determinant : float
        Its exact determinant.
    counts : tuple of int
        Exits from X > D and entries into X < -D.
    slope : ndarray, shape (2,)
        Derivative of the map with respect to the third unknown.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of the orbit's period, X, X'' at every extremum of X.
    residual : float
        Of the map, over the scale.
    iterations : int
        Newton iterations.
    """

    u: FloatArray
    value: float
    state: FloatArray
    jacobian: FloatArray
    determinant: float
    counts: tuple[int, int]
    slope: FloatArray
    extrema: FloatArray
    residual: float
    iterations: int

    @property
    def trace(self) -> float:
        """Trace of the Jacobian."""
        return float(np.trace(self.jacobian))

    @property
    def fold(self) -> float:
        """Product of (1 - multiplier): zero at a saddle node."""
        return 1.0 + self.determinant - self.trace

    @property
    def flip(self) -> float:
        """Product of (1 + multiplier): zero at a period doubling."""
        return 1.0 + self.determinant + self.trace


@dataclass(frozen=True, eq=False)
class BranchProblem:
    """Periodic orbits of n periods in dependence on one parameter.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    parameter : str
        As in `GearOscillator.with_parameter`.
    periods : int
        n.
    low, high : float
        Range of the parameter.
    scale : float
        Size of the motion, by which the state is measured.
    """

    oscillator: GearOscillator
    parameter: str
    periods: int
    low: float
    high: float
    scale: float

    def value(self, u: FloatArray) -> float:
        """Parameter of the unknowns."""
        return self.low + float(u[2]) * (self.high - self.low)

    def at(self, u: FloatArray) -> GearOscillator:
        """Oscillator of the unknowns."""
        return self.oscillator.with_parameter(self.parameter, self.value(u))

    def unknowns(self, state: FloatArray, value: float) -> FloatArray:
        """Unknowns of a state and a parameter value."""
        return np.array([*(state / self.scale), (value - self.low) / (self.high - self.low)])

    def image(self, u: FloatArray, refinement: int = 1) -> tuple[MapResult, Tables]:
        """Image of the state under the map."""
        table = tables(self.at(u), refinement)
        return period_map(table, u[:2] * self.scale, self.periods), table

    def slope(self, u: FloatArray) -> FloatArray:
        """Derivative of the map with respect to the third unknown, by a central difference.

        Only the rate at which Newton's method converges depends on it, not where it converges to.
        """
        shift = np.array([0.0, 0.0, 1e-6])
        try:
            ahead, behind = self.image(u + shift)[0].state, self.image(u - shift)[0].state
        except DynamicsError:  # the shifted parameter is not allowed, as next to a frequency of zero
            return np.full(2, np.nan)
        return (ahead - behind) / (2e-6 * self.scale)

    def correct(
        self, guess: FloatArray, row: FloatArray, refinement: int = 1, limit: int = 12
    ) -> Point | None:
        """Periodic orbit in the plane row . (u - guess) = 0, or None if Newton's method does not arrive."""
        u = guess.copy()
        try:
            image, table = self.image(u, refinement)
        except DynamicsError:
            return None
        slope = self.slope(u)
        best = self._residual(image, u)
        iterations = 0
        while iterations < limit and np.all(np.isfinite(slope)) and np.isfinite(best):
            matrix = np.vstack([np.column_stack([image.jacobian - np.eye(2), slope]), row])
            gap = np.array([*(image.state / self.scale - u[:2]), row @ (u - guess)])
            if not np.all(np.isfinite(matrix)) or np.linalg.cond(matrix) > 1e15:
                return None
            step = np.linalg.solve(matrix, -gap)
            if np.max(np.abs(step)) > 0.5:
                return None
            trial = u + step
            try:
                image_there, table_there = self.image(trial, refinement)
            except DynamicsError:
                return None
            size = self._residual(image_there, trial)
            small = float(np.max(np.abs(step))) < 1e-11
            if not size < best and (small or iterations > 3):
                break
            iterations += 1
            u, image, table, best = trial, image_there, table_there, size
            if size == 0.0:
                break
            if float(np.max(np.abs(step))) > 1e-6:  # an old slope would slow Newton's method down
                slope = self.slope(u)
        if not best <= 64.0 * EPS * max(1.0, float(np.max(np.abs(image.jacobian)))):
            return None
        return self._point(u, image, table, slope, best, iterations)

    def tangent(self, point: Point, along: FloatArray) -> FloatArray:
        """Unit vector along the branch, turned to the side of `along`."""
        matrix = np.column_stack([point.jacobian - np.eye(2), self.slope(point.u)])
        direction = np.cross(matrix[0], matrix[1])
        size = float(np.linalg.norm(direction))
        if not size > 0.0:
            return along / np.linalg.norm(along)
        return np.asarray(direction / size * (1.0 if direction @ along >= 0.0 else -1.0))

    def _residual(self, image: MapResult, u: FloatArray) -> float:
        return float(np.max(np.abs(image.state / self.scale - u[:2])))

    def _point(
        self,
        u: FloatArray,
        image: MapResult,
        table: Tables,
        slope: FloatArray,
        residual: float,
        iterations: int,
    ) -> Point:
        here = self.at(u)
        state = u[:2] * self.scale
        turns = turning_points(table, state, self.periods)
        phase = np.mod(turns[:, 0] / (self.periods * here.period), 1.0)
        counts = (int(image.counts[:, 0].sum()), int(image.counts[:, 1].sum()))
        return Point(
            u, self.value(u), state, image.jacobian, exact_determinant(here, self.periods), counts, slope,
            np.column_stack([phase, turns[:, 1:3]]), residual, iterations,
        )  # fmt: skip
