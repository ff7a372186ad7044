"""Steps along a curve of special points in two parameters, and the points of codimension two on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from base import Array, quantity, record
from dynamics.branch_problem import Steps, match_extrema
from dynamics.conditions import Condition, special_orbit
from dynamics.corrector import OrbitProblem, Point, passes
from dynamics.protocol import EPS
from dynamics.roots import bracketed

__all__ = ["DoublePoint", "Tracer"]


@record
class DoublePoint:
    """A point of a locus at which a second condition is met.

    Both multipliers 1 or -1 needs a determinant of 1, that is no damping.
    """

    headline = ("kind",)

    kind: str = quantity(
        "",
        "cusp (two saddle-node curves meet), saddle-node and grazing, period-doubling and grazing, double grazing (two "
        "extrema touch)",
    )
    values: Array = quantity("1", "the parameters", "parameter", error="error")
    state: Array = quantity("1", "X and V at tau = 0", "state")
    error: float = quantity(
        "1", "relative error of a parameter that what is left of the second condition stands for"
    )


class Tracer:
    """Steps along a locus in one direction until a reason to end; `points` and `double` are what it met."""

    def __init__(
        self, problem: OrbitProblem, condition: Condition, start: Point, sign: float,
        steps: Steps, progress: Callable[[int, Array], None] | None,
    ) -> None:  # fmt: skip
        self.problem, self.condition, self.steps, self.progress = problem, condition, steps, progress
        self.step = steps.first
        self.points = [start]
        self.phases = problem.phases(start)
        self.double: list[DoublePoint] = []
        tangent = self._tangent(start, np.array([0.0, 0.0, 1.0, 1e-3]))
        self.tangent = tangent * sign
        self.null = _cusp(start, np.ones(2))[1]
        self.ended = ""

    def run(self) -> None:
        """Step until the locus ends."""
        while not self.ended:
            if len(self.points) > self.steps.points:
                self.ended = f"{self.steps.points} points: raise max_points"
                return
            last = self.points[-1]
            new = self._try(last)
            if new is None:
                self.step *= 0.5
                if self.step < self.steps.least:
                    self.ended = self._why(last)
                continue
            self._accept(last, new)
            if len(self.points) > 3 and passes(last.u, new.u, self.phases):  # however small the loop
                self.ended = "closed"

    def _try(self, last: Point) -> Point | None:
        guess = last.u + self.step * self.tangent
        row = self.tangent
        for k in (2, 3):
            bound = 1.0 if guess[k] > 1.0 else 0.0 if guess[k] < 0.0 else math.nan
            if not math.isnan(bound):
                if last.u[k] == bound or abs(self.tangent[k]) < 1e-12:
                    self.ended = "bound"
                    return None
                guess = last.u + (bound - last.u[k]) / self.tangent[k] * self.tangent
                guess[k] = bound
                row = np.eye(4)[k]
        new = special_orbit(self.problem, self.condition, guess, row)
        if new is None or float(np.linalg.norm(new.u - last.u)) > 2.0 * self.step:
            return None
        if np.any(row == 1.0):
            new.u[row == 1.0] = guess[row == 1.0]
        tangent = self._tangent(new, new.u - last.u)
        if abs(tangent @ self.tangent) < 0.9 and self.step > 16.0 * self.steps.least:
            return None
        if self.condition.kind == "grazing":
            turn = abs(self._phase(new) - self.condition.phase + 0.5) % 1.0 - 0.5
            if abs(turn) > 0.05:
                return None
        return new

    def _accept(self, last: Point, new: Point) -> None:
        tangent = self._tangent(new, new.u - last.u)
        for kind, before, after in self._tests(last, new):
            if before * after < 0.0:
                self._mark(kind, last, new, before, after)
        self.null = _cusp(new, self.null)[1]
        self.points.append(new)
        self.tangent = tangent
        if self.condition.kind == "grazing":
            self.condition = replace(self.condition, phase=self._phase(new))
        if np.any((new.u[2:] == 0.0) | (new.u[2:] == 1.0)):
            self.ended = "bound"
        self.step = min(1.3 * self.step, self.steps.most)
        if self.progress is not None:
            self.progress(len(self.points), new.values)

    def _phase(self, point: Point) -> float:
        return float(point.extrema[self.condition.nearest(point), 0])

    def _tangent(self, point: Point, along: Array) -> Array:
        """Null vector of the three equations, turned to the side of `along`."""
        rows = np.array([*(point.derivative - np.eye(2, 4)), self.condition.gradient(self.problem, point)])
        null = np.linalg.svd(rows)[2][-1]
        return np.asarray(null if null @ along >= 0.0 else -null)

    def _tests(self, a: Point, b: Point) -> list[tuple[str, float, float]]:
        """Functions of codimension two at two neighbours, with their kinds."""
        kind = self.condition.kind
        tests: list[tuple[str, float, float]] = []
        if kind == "saddle-node":
            tests.append(("cusp", _cusp(a, self.null)[0], _cusp(b, self.null)[0]))
        if kind == "grazing":
            tests.append(("saddle-node and grazing", a.fold, b.fold))
            tests.append(("period-doubling and grazing", a.flip, b.flip))
        floor = [float(self.problem.packed(p.u)[6]) for p in (a, b)]
        own = (self.condition.nearest(a), self.condition.boundary) if kind == "grazing" else None
        name = "double grazing" if kind == "grazing" else f"{kind} and grazing"
        for i, j in match_extrema(a, b) if min(floor) > 0.0 else []:
            for boundary in (1,) if self.problem.oscillator.one_sided else (1, -1):
                if (i, boundary) != own:
                    before = float(a.extrema[i, 1]) - boundary * floor[0]
                    tests.append((name, before, float(b.extrema[j, 1]) - boundary * floor[1]))
        return tests

    def _mark(self, kind: str, a: Point, b: Point, before: float, after: float) -> None:
        """Close in on a point of codimension two between two neighbours: Brent's method along their chord."""
        chord = b.u - a.u
        row = chord / np.linalg.norm(chord)
        seen: list[Point] = []
        left: list[float] = []

        def measure(share: float) -> float:
            if share in (0.0, 1.0):
                return before if share == 0.0 else after
            found = special_orbit(self.problem, self.condition, a.u + share * chord, row)
            value = math.nan if found is None else self._again(kind, a, found, before)
            if found is not None and math.isfinite(value):
                seen.append(found)
                left.append(value)
            return value

        root = bracketed(measure, 0.0, 1.0, xtol=1e-15)
        if root is not None:  # if not, the last point says how far it is
            measure(root)
        if seen:
            last, rest = seen[-1].values, abs(left[-1] / (after - before))
            error = float(np.max(rest * np.abs(b.values - a.values) / np.maximum(np.abs(last), 1e-300)))
            self.double.append(DoublePoint(kind, last.copy(), seen[-1].state.copy(), max(error, EPS)))

    def _again(self, kind: str, a: Point, b: Point, before: float) -> float:
        """The same test function at a point between, nan if it is not found again."""
        for name, first, second in self._tests(a, b):
            if name == kind and math.isclose(first, before, rel_tol=1e-6, abs_tol=1e-300):
                return second
        return math.nan

    def _why(self, last: Point) -> str:
        """Why no further step was possible."""
        floor = float(self.problem.packed(last.u)[6])
        gap = (
            min((abs(abs(x) - floor) for x in last.extrema[:, 1].tolist()), default=1.0) / self.problem.scale
        )
        if self.condition.kind == "grazing":
            flat = abs(float(last.extrema[self.condition.nearest(last), 2]))
            return "the extremum that touches ends" if flat < 1e-2 else "Newton's method did not arrive"
        return "ends at a grazing" if gap < 1e-4 else "Newton's method did not arrive"


def _cusp(point: Point, reference: Array) -> tuple[float, Array]:
    """Second derivative of the map along its null vector, projected on the left one, and the null vector.

    Its sign is that of the null vector, which is turned to the side of a reference, that of a neighbour.
    """
    left, _, right = np.linalg.svd(point.jacobian - np.eye(2))
    w, q = left[:, 1], right[1] if right[1] @ reference >= 0.0 else -right[1]
    value = float(w @ np.einsum("k,kij,j->i", q, point.second[:2], q))
    return value if w @ q >= 0.0 else -value, q
