"""One point of a branch or locus of periodic orbits: evaluation with exact derivatives, Newton corrector, tangent."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from base import Array, Integers
from dynamics.branch_problem import PlanePoint
from dynamics.flow import DEGREE, tabulated
from dynamics.motions import period_map
from dynamics.oscillator import MAX_CELLS, GearOscillator, cells_per_period
from dynamics.protocol import EPS

__all__ = ["OrbitProblem", "Point", "passes", "rounding"]

ROOM = 64  # extrema expected at most; more are asked for if there are more


@dataclass(frozen=True, eq=False)
class Point(PlanePoint):
    """A periodic orbit, or a state near one, with the derivatives of its map.

    Parameters
    ----------
    u : ndarray, shape (2 + m,)
        Unknowns: X and V over the scale, each parameter as a fraction of its range.
    values : ndarray, shape (m,)
        The parameters.
    state, image : ndarray, shape (2,)
        X and V at tau = 0 and after the orbit's period.
    derivative : ndarray, shape (2, 2 + m)
        Of the image with respect to the unknowns, both over the scale; its first two columns are the Jacobian.
    second : ndarray, shape (2 + m, 2, 2)
        Derivative of the Jacobian with respect to the unknowns.
    determinant : float
        Exact determinant of the Jacobian.
    determinant_slope : ndarray, shape (2 + m,)
        Its derivative with respect to the unknowns.
    counts : tuple of int
        Exits from X > D and entries into X < -D.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of the orbit's period, X, X'' at every extremum of X.
    extrema_slope : ndarray, shape (k, 2 + m)
        Derivative of X there, over the scale, with respect to the unknowns.
    residual : float
        Of the map, over the scale.
    iterations : int
        Newton iterations.
    """

    u: Array
    values: Array
    state: Array
    image: Array
    derivative: Array
    second: Array
    determinant: float
    determinant_slope: Array
    counts: tuple[int, int]
    extrema: Array
    extrema_slope: Array
    residual: float
    iterations: int

    @property
    def jacobian(self) -> Array:
        """Derivative of the map with respect to the state."""
        return self.derivative[:, :2]

    @property
    def trace_slope(self) -> Array:
        """Its derivative with respect to the unknowns."""
        return self.second[:, 0, 0] + self.second[:, 1, 1]


@dataclass(frozen=True, eq=False)
class OrbitProblem:
    """Periodic orbits of n periods in dependence on one or two parameters.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    parameters : tuple of str
        As in `GearOscillator.with_parameter`.
    periods : int
        n.
    low, high : ndarray, shape (m,)
        Range of each parameter.
    scale : float
        Size of the motion, by which the state is measured.
    """

    oscillator: GearOscillator
    parameters: tuple[str, ...]
    periods: int
    low: Array
    high: Array
    scale: float

    @cached_property
    def origin(self) -> Array:
        """Packed parameters of the oscillator with every parameter at its lower bound."""
        packed = self.oscillator.packed()
        for name, low in zip(self.parameters, self.low, strict=True):
            packed[self.oscillator.place(name)] = low
        return packed

    @cached_property
    def ways(self) -> Array:
        """Change of the packed parameters over the range of each parameter, shape (m, any)."""
        ways = np.zeros((len(self.parameters), len(self.origin)))
        for row, name, width in zip(ways, self.parameters, self.high - self.low, strict=True):
            row[self.oscillator.place(name)] = width
        return ways

    def packed(self, u: Array) -> Array:
        """Packed parameters of the unknowns."""
        return self.origin + u[2:] @ self.ways

    def at(self, u: Array) -> GearOscillator:
        """Oscillator of the unknowns."""
        here = self.oscillator
        for name, value in zip(self.parameters, self.values(u), strict=True):
            here = here.with_parameter(name, float(value))
        return here

    def values(self, u: Array) -> Array:
        """Parameters of the unknowns."""
        return np.asarray(self.low + u[2:] * (self.high - self.low))

    def unknowns(self, state: Array, values: npt.ArrayLike) -> Array:
        """Unknowns of a state and the parameter values."""
        fraction = (np.atleast_1d(np.asarray(values, dtype=np.float64)) - self.low) / (self.high - self.low)
        return np.concatenate([np.asarray(state) / self.scale, fraction])

    def evaluate(self, u: Array, refinement: int = 1) -> Point | None:
        """Image of the state and everything that `Point` holds; None if the parameters are not allowed there."""
        from dynamics.kernels.correcting import evaluate

        store = _Store(len(self.parameters), ROOM * self.periods)
        cells = self._cells(u, refinement)
        if cells == 0:
            return None
        while True:
            flag, turned, residual = evaluate(
                self.origin, self.ways, self._order, cells, DEGREE, u, self.scale, self.periods, *store.arrays
            )
            if flag != 0:
                return None
            if turned <= len(store.turns):
                return self._point(u.copy(), store, turned, residual, 0)
            store = _Store(len(self.parameters), turned)

    def correct(self, guess: Array, across: Array, refinement: int = 1, limit: int = 12) -> Point | None:
        """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive.

        For one parameter.
        """
        from dynamics.kernels.correcting import correct

        store = _Store(1, ROOM * self.periods)
        cells = self._cells(guess, refinement)
        if cells == 0:
            return None
        u = guess.copy()
        flag, turned, iterations, residual = correct(
            self.origin, self.ways, self._order, cells, DEGREE, u, across, self.scale, self.periods, limit,
            *store.arrays,
        )  # fmt: skip
        if flag != 0:
            return None
        if turned > len(store.turns):
            return self.evaluate(u, refinement)
        return self._point(u, store, turned, residual, iterations)

    def phases(self, point: Point) -> list[list[float]]:
        """Unknowns of a point, its orbit taken from each excitation period on, one row each."""
        states = period_map(self.at(point.u), point.state, self.periods).states
        rest = np.broadcast_to(point.u[2:], (self.periods, len(point.u) - 2))
        rows: list[list[float]] = np.hstack([np.roll(states, 1, axis=0) / self.scale, rest]).tolist()
        return rows

    def half_way(self, point: Point) -> Array:
        """Unknowns X and V after half the orbit's period; n must be even."""
        half = self.periods // 2
        flow = tabulated(self.packed(point.u), self._cells(point.u, 1))
        return flow.follow(point.state, 1, half - 1, derivatives=False).state / self.scale

    @cached_property
    def _order(self) -> int:
        return self.oscillator.stiffness.order

    def _cells(self, u: Array, refinement: int) -> int:
        packed = self.packed(u)
        if not (packed[4] > 0.0 and np.all(np.isfinite(packed))):
            return 0
        cells = cells_per_period(packed)
        return math.ceil(cells) * refinement if cells <= MAX_CELLS else 0

    def _point(self, u: Array, store: _Store, turned: int, residual: float, iterations: int) -> Point:
        turns = store.turns[:turned]
        amounts = u[2:].tolist()
        damping, frequency = (self._along(place, amounts) for place in (1, 4))
        # log det = -4 pi zeta n / omega
        decay = 4.0 * math.pi * self.periods / frequency
        determinant = math.exp(-decay * damping)
        change = [0.0, 0.0]
        change += [-decay * determinant * (way[1] - damping / frequency * way[4]) for way in self._way_rows]
        p, q = store.counts.tolist()
        return Point(
            u, self.low + u[2:] * (self.high - self.low), u[:2] * self.scale, store.image, store.lin, store.bend,
            determinant, np.array(change), (p, q), turns[:, :3], turns[:, 5:], residual, iterations,
        )  # fmt: skip

    @cached_property
    def _way_rows(self) -> list[list[float]]:
        rows: list[list[float]] = self.ways.tolist()
        return rows

    def _along(self, place: int, amounts: list[float]) -> float:
        """One packed parameter of the unknowns."""
        ways = zip(self._way_rows, amounts, strict=True)
        return float(self.origin[place]) + sum(amount * way[place] for way, amount in ways)

    def play(self, u: Array) -> float:
        """D of the unknowns."""
        return self._along(6, u[2:].tolist())


class _Store:
    """Arrays that the kernels fill."""

    def __init__(self, parameters: int, room: int) -> None:
        m = 2 + parameters
        self.image, self.lin, self.bend = np.empty(2), np.empty((2, m)), np.empty((m, 2, 2))
        self.counts, self.turns = np.empty(2, dtype=np.int64), np.empty((room, 5 + m))

    @property
    def arrays(self) -> tuple[Array, Array, Array, Integers, Array]:
        """In the order of the kernels."""
        return self.image, self.lin, self.bend, self.counts, self.turns


def passes(last: Array, new: Array, places: list[list[float]]) -> bool:
    """Whether the step from one place to another in the space of unknowns passes one of several."""
    start = last.tolist()
    chord = [b - a for a, b in zip(start, new.tolist(), strict=True)]
    square = sum(c * c for c in chord)
    for place in places:
        back = [p - u for p, u in zip(place, start, strict=True)]
        along = sum(b * c for b, c in zip(back, chord, strict=True)) / square
        if 0.0 < along <= 1.0:
            beside = sum((b - along * c) ** 2 for b, c in zip(back, chord, strict=True))
            if beside < 0.01 * square:
                return True
    return False


def rounding(point: Point, periods: int) -> float:
    """Residual that rounding leaves: it grows with the state, with its derivative and with every period."""
    size = max(1.0, float(np.max(np.abs(point.u[:2]))))
    return 64.0 * EPS * size * periods * max(1.0, float(np.max(np.abs(point.jacobian))))
