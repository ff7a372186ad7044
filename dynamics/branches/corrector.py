"""One point of a curve of periodic orbits of the exact flow: evaluation with exact derivatives, Newton corrector."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from base import Array, Integers
from dynamics.branches.bends import Bend
from dynamics.branches.branch_problem import BranchProblem, MapPoint, match_extrema
from dynamics.branches.step_rules import touches_twice
from dynamics.flow.exact_flow import DEGREE, ExactFlow, tabulated
from dynamics.model.oscillator import MAX_CELLS, GearOscillator, cells_per_period
from dynamics.model.protocol import EPS

ROOM = 64  # extrema expected at most; more are asked for if there are more
LIMIT = 12  # of Newton iterations


@dataclass(frozen=True, eq=False, kw_only=True)
class Point(MapPoint):
    """A periodic orbit, or a state near one, with the second derivatives of its map.

    Parameters
    ----------
    state : ndarray, shape (2,)
        X and V at tau = 0.
    second : ndarray, shape (2 + m, 2, 2)
        Derivative of the Jacobian with respect to the unknowns.
    determinant_slope : ndarray, shape (2 + m,)
        Derivative of the determinant with respect to the unknowns.
    extrema_slope : ndarray, shape (k, 2 + m)
        Derivative of X at the extrema, over the scale, with respect to the unknowns.
    residual : float
        Of the map, over the scale.
    """

    state: Array
    second: Array
    determinant_slope: Array
    extrema_slope: Array
    residual: float

    @property
    def trace_slope(self) -> Array:
        """Derivative of the trace with respect to the unknowns."""
        return self.second[:, 0, 0] + self.second[:, 1, 1]


@dataclass(frozen=True, eq=False)
class OrbitProblem(BranchProblem):
    """Periodic orbits of the exact flow; attributes as in `BranchProblem`."""

    oscillator: GearOscillator

    maps = 3

    @cached_property
    def origin(self) -> Array:
        """Packed parameters of the oscillator with every parameter at its lower bound."""
        packed = self.oscillator.packed()
        for name, low in zip(self.parameters, self.low, strict=True):
            packed[self.oscillator.places(name)] = low
        return packed

    @cached_property
    def ways(self) -> Array:
        """Change of the packed parameters over the range of each parameter, shape (m, any)."""
        ways = np.zeros((len(self.parameters), len(self.origin)))
        for row, name, width in zip(ways, self.parameters, self.high - self.low, strict=True):
            row[self.oscillator.places(name)] = width
        return ways

    @cached_property
    def _rooms(self) -> dict[int, Any]:
        """Tables and room of the corrector for numbers of cells: what a parameter does not touch stays tabulated."""
        return {}

    @cached_property
    def _reaches(self) -> dict[int, tuple[float, float]]:
        """Ranges of the parameter for numbers of cells, see `reach`."""
        return {}

    @cached_property
    def even(self) -> bool:
        """Whether the damping in the dead zone changes as that in contact."""
        return np.array_equal(self.ways[:, 1], self.ways[:, 9])

    def evaluate(self, u: Array, refinement: int = 1) -> Point | None:
        """Image of the state and everything that `Point` holds; None if the parameters are not allowed there."""
        return self._corrected(u, np.zeros(3), refinement, 0)

    def correct(self, guess: Array, across: Array, refinement: int = 1, limit: int = LIMIT) -> Point | None:
        """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive.

        For one parameter.
        """
        return self._corrected(guess, across, refinement, limit)

    def trends(self, point: Point, tangent: Array) -> tuple[float, float]:
        """Slopes of `fold` and `flip` along the branch of one parameter, exact."""
        shrinking, turning = float(point.determinant_slope @ tangent), float(point.trace_slope @ tangent)
        return shrinking - turning, shrinking + turning

    def grazes(self, last: Point, along: Array, new: Point, tangent: Array, length: float) -> bool:
        """As of `BranchProblem.grazes`, for one parameter, by exact slopes."""
        levels = last.levels.tolist(), new.levels.tolist()
        if len(levels[0]) == 2 and min(levels[0][0], levels[1][0]) == 0.0:
            return False
        rates = self.rates(last.extrema_slope, along), self.rates(new.extrema_slope, tangent)
        heights = [[row[1] for row in point.extrema.tolist()] for point in (last, new)]
        plays = self.widening * float(along[-1]), self.widening * float(tangent[-1])
        return any(
            touches_twice(
                heights[0][i], rates[0][i], heights[1][j], rates[1][j], levels, plays, self.scale, length
            )
            for i, j in match_extrema(last, new)
        )

    def rates(self, slopes: Array, tangent: Array) -> list[float]:
        """Slopes of extrema along the branch of one parameter, over the scale."""
        slopes_along: list[float] = (slopes @ tangent).tolist()
        return slopes_along

    @cached_property
    def widening(self) -> float:
        """Change of half the backlash over the range of the one parameter, over the scale."""
        return float(self.ways[0, 6]) / self.scale

    @property
    def widenings(self) -> Array:
        """Change of half the backlash over the range of each parameter."""
        return np.asarray(self.ways[:, 6])

    def bend(self, point: Point) -> Bend:
        """Derivatives of the Jacobian and of what it singles out, all exact."""
        shrinking, turning = point.determinant_slope, point.trace_slope
        fold, flip = shrinking - turning, shrinking + turning
        return Bend(point.derivative, point.second, fold, flip, shrinking, point.extrema_slope)

    def flow(self, point: MapPoint) -> ExactFlow:
        """Tables of the oscillator of a point."""
        return tabulated(self._packed(point.u), self._cells(point.u, 1))

    def reach(self, u: Array) -> tuple[float, float]:
        """Range of the one parameter, around that of the unknowns, in which a period has as many cells.

        They grow towards one end or both, so that between ends of one number none needs more.
        """
        cells, at = self._cells(u, 1), min(max(float(u[2]), 0.0), 1.0)
        low, high = self._reaches.get(cells, (1.0, 0.0))
        if not low <= at <= high:
            low, high = self._reaches[cells] = (
                self._last_of(cells, at, 0.0),
                self._last_of(cells, at, 1.0),
            )
        return low, high

    def _last_of(self, cells: int, inside: float, end: float) -> float:
        """A place towards an end of the range with so many cells, near where their number changes."""
        if self._cells(np.array([0.0, 0.0, end]), 1) == cells:
            return end
        for _ in range(10):
            middle = 0.5 * (inside + end)
            if self._cells(np.array([0.0, 0.0, middle]), 1) == cells:
                inside = middle
            else:
                end = middle
        return inside

    def rooms(self, u: Array, refinement: int = 1) -> Any:
        """Tables and room of the corrector for the unknowns; None if the parameters are not allowed there."""
        from dynamics.kernels.correcting import rooms_of

        cells = self._cells(u, refinement)
        if cells and cells not in self._rooms:
            self._rooms[cells] = rooms_of(len(self.parameters), len(self.origin), cells, DEGREE)
        return self._rooms.get(cells)

    def _corrected(self, guess: Array, across: Array, refinement: int, limit: int) -> Point | None:
        """Point after Newton iterations up to a limit; that of the guess itself if it is 0."""
        from dynamics.kernels.correcting import correct

        rooms, room, m = self.rooms(guess, refinement), ROOM * self.periods, 2 + len(self.parameters)
        while rooms is not None:
            u, counts, clock = guess.copy(), np.empty(2, dtype=np.int64), np.empty(1)
            image, lin, bend, turns = (
                np.empty(2),
                np.empty((2, m)),
                np.empty((m, 2, 2)),
                np.empty((room, 5 + m)),
            )
            flag, turned, iterations, residual = correct(
                self.origin, self.ways, u, across, self.scale, self.periods, limit, image, lin, bend, counts, turns,
                clock, rooms,
            )  # fmt: skip
            if flag != 0:
                return None
            if turned <= room:
                contact = float(clock[0])
                return self.point(u, image, lin, bend, counts, contact, turns[:turned], iterations, residual)
            room = turned
        return None

    def _packed(self, u: Array) -> Array:
        """Packed parameters of the unknowns."""
        return self.origin + u[2:] @ self.ways

    def _cells(self, u: Array, refinement: int) -> int:
        """Cells of a period; 0 if the parameters are not allowed."""
        packed = self._packed(u)
        if not (packed[4] > 0.0 and math.isfinite(float(packed @ packed))):
            return 0
        cells = cells_per_period(packed)
        return math.ceil(cells) * refinement if cells <= MAX_CELLS else 0

    def determinant(self, packed: list[float], contact: float) -> float:
        """Determinant of the map by the time in contact: log det = -4 pi zeta n/omega, and the difference there."""
        damping, frequency, free = packed[1], packed[4], packed[9]
        return math.exp(-4.0 * math.pi * self.periods / frequency * free - 2.0 * (damping - free) * contact)

    def point(
        self, u: Array, image: Array, lin: Array, bend: Array, counts: Integers, contact: float, turns: Array,
        iterations: int, residual: float,
    ) -> Point:  # fmt: skip
        """Point of what the kernel `correct` fills; its time in contact as a number."""
        packed = self._packed(u).tolist()
        damping, frequency, play, free = packed[1], packed[4], packed[6], packed[9]
        determinant = self.determinant(packed, contact)
        change = np.zeros(len(u))
        if self.even and damping == free:
            decay = 4.0 * math.pi * self.periods / frequency
            change[2:] = -decay * determinant * (self.ways[:, 1] - damping / frequency * self.ways[:, 4])
        else:  # as exact as the entries of the Jacobian
            (a, b), (c, d) = lin[:, :2].tolist()
            change = d * bend[:, 0, 0] + a * bend[:, 1, 1] - c * bend[:, 0, 1] - b * bend[:, 1, 0]
        p, q = counts.tolist()
        return Point(
            u, self.values(u), 2.0 * math.pi / frequency, image / self.scale, lin, determinant, (p, q),
            np.array([play] if self.oscillator.one_sided else [play, -play]), turns[:, :3], iterations,
            state=u[:2] * self.scale, second=bend, determinant_slope=change, extrema_slope=turns[:, 5:],
            residual=residual,
        )  # fmt: skip


def rounding(point: MapPoint, periods: int) -> float:
    """Residual that rounding leaves: it grows with the state, with its derivative and with every period."""
    size = max(1.0, float(np.max(np.abs(point.u[: point.size]))))
    return 64.0 * EPS * size * periods * max(1.0, float(np.max(np.abs(point.jacobian))))
