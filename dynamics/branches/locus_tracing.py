"""Steps along a curve of special points in two parameters, and the points of codimension two on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from base import Array, quantity, record
from dynamics.branches.branch_problem import MapPoint, Steps, match_extrema
from dynamics.branches.locus_predictor import Tracer
from dynamics.branches.roots import bracketed
from dynamics.branches.special_orbits import Condition, special_orbit
from dynamics.model.protocol import EPS
from dynamics.model.reasons import FLOW


@record
class DoublePoint:
    """A point of a locus at which a second condition is met.

    Both multipliers 1 or -1 needs a determinant of 1, that is no damping.
    """

    no_error = FLOW

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


class LocusTracer(Tracer):
    """Steps along a locus; `double` are the points of codimension two that they met."""

    flat = 1e-12

    def __init__(
        self, problem: Any, condition: Condition, start: MapPoint, sign: float,
        steps: Steps, progress: Callable[[int, Array], None] | None,
    ) -> None:  # fmt: skip
        super().__init__(problem, start, steps)
        self.condition, self.progress = condition, progress
        self.double: list[DoublePoint] = []
        self.tangent = self._tangent(start, np.append(np.zeros(start.size), [1.0, 1e-3])) * sign
        self.null = _null(start, np.ones(start.size))[1]

    def attempt(self, last: MapPoint) -> MapPoint | None:
        """Next point; at a bound, the point on it."""
        last = self.measured(last)
        if last is None:
            return None
        aim = self.aimed(last, last.u + self.step * self.tangent)
        if aim is None:
            return None
        guess, row = aim
        new: MapPoint | None = special_orbit(self.problem, self.condition, guess, row)
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

    def met_again(self, larger: Any, last: Any, along: Array) -> Any:
        """The special orbit in the plane across the curve."""
        return special_orbit(larger, self.condition, larger.unknowns(last.state, last.values), along)

    def rescale(self, again: MapPoint, along: Array, factor: float) -> None:
        """The tangent alone is kept."""
        self.tangent = self._tangent(again, along)

    def accept(self, last: MapPoint, reached: MapPoint) -> None:
        """Take a point, mark what changes sign before it, choose the next step."""
        for kind, before, after in self._tests(last, reached):
            if before * after < 0.0:
                self._mark(kind, last, reached, before, after)
        self.null = _null(reached, self.null)[1]
        self.points.append(reached)
        self.tangent = self._tangent(reached, reached.u - last.u)
        if self.condition.kind == "grazing":
            self.condition = replace(self.condition, phase=self._phase(reached))
        self.step = min(1.3 * self.step, self.steps.most)
        if self.progress is not None:
            self.progress(len(self.points), reached.values)

    def why(self, last: MapPoint) -> str:
        """What lies beyond."""
        if self.condition.kind == "grazing":
            flat = abs(float(last.extrema[self.condition.nearest(last), 2]))
            return "the extremum that touches ends" if flat < 1e-2 else "Newton's method did not arrive"
        gaps = (abs(abs(x) - float(last.levels[0])) for x in last.extrema[:, 1].tolist())
        touching = min(gaps, default=1.0) / self.problem.scale < 1e-4
        return "ends at a grazing" if touching else "Newton's method did not arrive"

    def _phase(self, point: MapPoint) -> float:
        return float(point.extrema[self.condition.nearest(point), 0])

    def _tangent(self, point: MapPoint, along: Array) -> Array:
        """Null vector of the three equations, turned to the side of `along`."""
        rows = self.condition.rows(self.problem, point)
        null = np.linalg.svd(rows)[2][-1]
        return np.asarray(null if null @ along >= 0.0 else -null)

    def _tests(self, a: MapPoint, b: MapPoint) -> list[tuple[str, float, float]]:
        """Functions of codimension two at two neighbours, with their kinds."""
        kind = self.condition.kind
        tests: list[tuple[str, float, float]] = []
        if kind == "saddle-node":
            tests.append(("cusp", self._cusp(a), self._cusp(b)))
        if kind == "grazing":
            tests.append(("saddle-node and grazing", a.fold, b.fold))
            tests.append(("period-doubling and grazing", a.flip, b.flip))
        own = (self.condition.nearest(a), self.condition.boundary) if kind == "grazing" else None
        name = "double grazing" if kind == "grazing" else f"{kind} and grazing"
        for i, j in match_extrema(a, b) if min(a.levels[0], b.levels[0]) > 0.0 else []:
            for boundary, level_a, level_b in zip((1, -1), a.levels, b.levels, strict=False):
                if (i, boundary) != own:
                    before, after = a.extrema[i, 1] - level_a, b.extrema[j, 1] - level_b
                    tests.append((name, float(before), float(after)))
        return tests

    def _cusp(self, point: MapPoint) -> float:
        """Second derivative of the map along its null vector, projected on the left one.

        Its sign is that of the null vector, which is turned to the side of that of a neighbour.
        """
        w, q = _null(point, self.null)
        second = self.problem.bend(point).second[: point.size]
        value = float(w @ np.einsum("k,kij,j->i", q, second, q))
        return value if w @ q >= 0.0 else -value

    def _mark(self, kind: str, a: MapPoint, b: MapPoint, before: float, after: float) -> None:
        """Close in on a point of codimension two between two neighbours: Brent's method along their chord."""
        chord = b.u - a.u
        row = chord / np.linalg.norm(chord)
        seen: list[Any] = []
        residuals: list[float] = []

        def measure(share: float) -> float:
            if share in (0.0, 1.0):
                return before if share == 0.0 else after
            point = special_orbit(self.problem, self.condition, a.u + share * chord, row)
            value = math.nan if point is None else self._again(kind, a, point, before)
            if point is not None and math.isfinite(value):
                seen.append(point)
                residuals.append(value)
            return value

        root = bracketed(measure, 0.0, 1.0, xtol=1e-15)
        if root is not None:  # if not, the last point says how far it is
            measure(root)
        if seen:
            last, rest = seen[-1].values, abs(residuals[-1] / (after - before))
            error = float(np.max(rest * np.abs(b.values - a.values) / np.maximum(np.abs(last), 1e-300)))
            self.double.append(DoublePoint(kind, last.copy(), seen[-1].state.copy(), max(error, EPS)))

    def _again(self, kind: str, a: MapPoint, b: MapPoint, before: float) -> float:
        """The same test function at a point between, nan if it is not found again."""
        for name, first, second in self._tests(a, b):
            if name == kind and math.isclose(first, before, rel_tol=1e-6, abs_tol=1e-300):
                return second
        return math.nan


def _null(point: MapPoint, reference: Array) -> tuple[Array, Array]:
    """Left and right null vector of the map less the state, the right one turned to the side of a reference."""
    left, _, right = np.linalg.svd(point.jacobian - np.eye(point.size))
    return left[:, -1], right[-1] if right[-1] @ reference >= 0.0 else -right[-1]
