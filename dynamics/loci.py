"""Curves of saddle nodes, period doublings and grazings in the plane of two parameters."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from dynamics.conditions import Condition, special_orbit
from dynamics.corrector import OrbitProblem, Point
from dynamics.cost import Cost
from dynamics.crossings import match_extrema
from dynamics.errors import Faults
from dynamics.oscillator import GearOscillator
from dynamics.shooting import floquet_multipliers, motion_label
from dynamics.special import SpecialPoint

__all__ = ["CODIMENSION_TWO", "DoublePoint", "Locus", "continue_locus"]

FloatArray = npt.NDArray[np.float64]
CODIMENSION_TWO = ("cusp", "saddle-node and grazing", "period-doubling and grazing", "double grazing")


@dataclass(frozen=True, eq=False)
class DoublePoint:
    """A point of a locus at which a second condition is met.

    Parameters
    ----------
    kind : str
        "cusp" (two saddle-node curves meet), "saddle-node and grazing", "period-doubling and grazing", "double
        grazing" (two extrema touch). Both multipliers 1 or -1 needs a determinant of 1, that is no damping.
    values : ndarray, shape (2,)
        The parameters.
    state : ndarray, shape (2,)
        X and V at tau = 0.
    error : float
        Largest change of a parameter, relative, from the last step of the search.
    """

    kind: str
    values: FloatArray
    state: FloatArray
    error: float


@dataclass(frozen=True, eq=False)
class Locus:
    """A curve of special points in two parameters.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling" or "grazing".
    boundary : int
        At a grazing 1 for X = D, -1 for X = -D; else 0.
    parameters : tuple of str
        The two parameters.
    periods : int
        Period of the orbits, in excitation periods.
    values : ndarray, shape (m, 2)
        Parameters along the curve.
    states : ndarray, shape (m, 2)
        X and V at tau = 0.
    multipliers : ndarray of complex, shape (m, 2)
        Floquet multipliers.
    labels : tuple of str
        n-p-q.
    points : tuple of DoublePoint
        Points of codimension two in their order along the curve.
    ended : tuple of str
        Why the curve ended at its first and at its last point.
    error : float
        Largest estimated relative error of a point of codimension two.
    cost : Cost
        Effort.
    converged : bool
        Whether both ends are at a bound, at the start again, or at a grazing that ends the curve.
    message : str
        What happened.
    """

    kind: str
    boundary: int
    parameters: tuple[str, str]
    periods: int
    values: FloatArray
    states: FloatArray
    multipliers: npt.NDArray[np.complex128]
    labels: tuple[str, ...]
    points: tuple[DoublePoint, ...]
    ended: tuple[str, str]
    error: float
    cost: Cost
    converged: bool
    message: str

    def special(self, kind: str) -> list[DoublePoint]:
        """Points of codimension two of one kind.

        Parameters
        ----------
        kind : str
            One of `CODIMENSION_TWO`.

        Raises
        ------
        DynamicsError
            If there is no such kind.
        """
        faults = Faults()
        if kind not in CODIMENSION_TWO:
            faults.add("kind", kind, ", ".join(CODIMENSION_TWO), "name one of these")
        faults.raise_if_any()
        return [p for p in self.points if p.kind == kind]

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """The two parameters, shape (m, 2)."""
        return self.values.astype(dtype if dtype is not None else np.float64)


def continue_locus(
    oscillator: GearOscillator,
    point: SpecialPoint,
    parameters: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    *,
    step: float = 0.005,
    max_step: float = 0.02,
    min_step: float = 1e-7,
    max_points: int = 2000,
    progress: Callable[[int, FloatArray], None] | None = None,
) -> Locus:
    """Follow a special point in two parameters, both ways.

    Unknowns are X, V and both parameters, equations that the orbit closes and that the special point's condition
    holds; all derivatives are exact, from the second derivatives of the map and those of the extrema.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator of the point: its value of the first parameter is replaced by the point's.
    point : SpecialPoint
        A saddle node, period doubling or grazing found in the first parameter.
    parameters : tuple of str
        The two parameters, as in `GearOscillator.with_parameter`.
    bounds : tuple
        Range of each parameter.
    step, max_step, min_step : float
        First, largest and smallest step, over the size of the motion and the width of the bounds.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameters.

    Returns
    -------
    Locus
        The curve and its points of codimension two.

    Raises
    ------
    DynamicsError
        If an argument is out of range, or the point cannot be met again.
    """
    began = time.perf_counter()
    faults = Faults()
    start = oscillator.with_parameter(parameters[0], point.parameter)
    if parameters[0] == parameters[1]:
        faults.add("parameters", parameters, "two different parameters", "name another one")
    low, high = np.empty(2), np.empty(2)
    for k in range(2):
        low[k], high[k] = (faults.number(f"bounds[{k}][{i}]", bounds[k][i]) for i in range(2))
        value = start.get(parameters[k])
        if not low[k] < high[k]:
            faults.add(f"bounds[{k}]", bounds[k], "the lower value first", "give (low, high)")
        elif not low[k] <= value <= high[k]:
            faults.add("point", value, f"{parameters[k]} within bounds", "widen the bounds")
    limit = faults.whole("max_points", max_points, 1, 10**6, "2000 is usual")
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(point.state))), start.half_backlash, 1e-300)
    problem = OrbitProblem(start, parameters, point.periods, low, high, scale)
    phase = 0.0 if math.isnan(point.tau) else (point.tau / (point.periods * start.period)) % 1.0
    condition = Condition(
        point.kind, point.boundary, 0 if point.kind != "grazing" else int(np.sign(point.acceleration)), phase
    )
    guess = problem.unknowns(point.state, [start.get(name) for name in parameters])
    first = special_orbit(problem, condition, guess, np.array([0.0, 0.0, 0.0, 1.0]))
    if first is None:
        faults.add(
            "point", point.parameter, "a point that can be met again", "next to a grazing, start elsewhere"
        )
        faults.raise_if_any()
        raise AssertionError
    tracers = []
    for sign in (-1.0, 1.0):
        tracer = _Tracer(problem, condition, first, sign, (step, max_step, min_step), limit, progress)
        tracer.run()
        tracers.append(tracer)
        if tracer.ended == "closed":
            break
    return _locus(problem, condition, tracers, began)


class _Tracer:
    """Steps along a locus in one direction until a reason to end."""

    def __init__(
        self, problem: OrbitProblem, condition: Condition, start: Point, sign: float,
        steps: tuple[float, float, float], limit: int, progress: Callable[[int, FloatArray], None] | None,
    ) -> None:  # fmt: skip
        self.problem, self.condition, self.limit, self.progress = problem, condition, limit, progress
        self.step, self.max_step, self.min_step = steps
        self.points = [start]
        self.double: list[DoublePoint] = []
        tangent = self._tangent(start, np.array([0.0, 0.0, 1.0, 1e-3]))
        self.tangent = tangent * sign
        self.null = _cusp(start, np.ones(2))[1]
        self.ended = ""

    def run(self) -> None:
        """Step until the locus ends."""
        start, away = self.points[0], False
        while not self.ended:
            if len(self.points) > self.limit:
                self.ended = f"{self.limit} points: raise max_points"
                return
            last = self.points[-1]
            new = self._try(last)
            if new is None:
                self.step *= 0.5
                if self.step < self.min_step:
                    self.ended = self._why(last)
                continue
            self._accept(last, new)
            distance = float(np.linalg.norm(new.u - start.u))
            away = away or distance > 4.0 * self.max_step
            if away and distance < self.step and (start.u - last.u) @ (new.u - last.u) > 0.0:
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
        if abs(tangent @ self.tangent) < 0.9 and self.step > 16.0 * self.min_step:
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
        self.step = min(1.3 * self.step, self.max_step)
        if self.progress is not None:
            self.progress(len(self.points), new.values)

    def _phase(self, point: Point) -> float:
        return float(point.extrema[self.condition.nearest(point), 0])

    def _tangent(self, point: Point, along: FloatArray) -> FloatArray:
        """Null vector of the three equations, turned to the side of `along`."""
        rows = np.array([*(point.derivative - np.eye(2, 4)), self.condition.gradient(self.problem, point)])
        way = np.linalg.svd(rows)[2][-1]
        return np.asarray(way if way @ along >= 0.0 else -way)

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
        for i, j in match_extrema(a, b) if min(floor) > 0.0 else []:
            for boundary in (1,) if self.problem.oscillator.one_sided else (1, -1):
                if (
                    kind == "grazing"
                    and boundary == self.condition.boundary
                    and i == self.condition.nearest(a)
                ):
                    continue
                name = "double grazing" if kind == "grazing" else f"{kind} and grazing"
                tests.append(
                    (
                        name,
                        float(a.extrema[i, 1]) - boundary * floor[0],
                        float(b.extrema[j, 1]) - boundary * floor[1],
                    )
                )
        return tests

    def _mark(self, kind: str, a: Point, b: Point, before: float, after: float) -> None:
        """Close in on a point of codimension two by the secant rule on the locus."""
        chord = b.u - a.u
        row = chord / np.linalg.norm(chord)
        ends = [(0.0, a, before), (1.0, b, after)]
        middle = a
        error = float(np.max(np.abs(b.values - a.values)))
        for trial in range(60):
            (s0, p0, f0), (s1, _, f1) = ends
            share = f0 / (f0 - f1) if trial % 3 < 2 else 0.5  # secant, now and then a bisection
            s = s0 + min(max(share, 0.01), 0.99) * (s1 - s0)
            found = special_orbit(self.problem, self.condition, a.u + s * chord, row)
            if found is None:
                break
            value = self._again(kind, p0, found, f0)
            if not math.isfinite(value):
                break
            error = float(
                np.max(np.abs(found.values - middle.values) / np.maximum(np.abs(found.values), 1e-300))
            )
            middle = found
            if value * f0 > 0.0:
                ends[0] = (s, found, value)
            else:
                ends[1] = (s, found, value)
            if value == 0.0 or ends[1][0] - ends[0][0] < 1e-14 or error < 1e-15:
                break
        if middle is not a:
            self.double.append(DoublePoint(kind, middle.values.copy(), middle.state.copy(), error))

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


def _cusp(point: Point, reference: FloatArray) -> tuple[float, FloatArray]:
    """Second derivative of the map along its null vector, projected on the left one, and the null vector.

    Its sign is that of the null vector, which is turned to the side of a reference, that of a neighbour.
    """
    left, _, right = np.linalg.svd(point.jacobian - np.eye(2))
    w, q = left[:, 1], right[1] if right[1] @ reference >= 0.0 else -right[1]
    value = float(w @ np.einsum("k,kij,j->i", q, point.second[:2], q))
    return value if w @ q >= 0.0 else -value, q


def _locus(problem: OrbitProblem, condition: Condition, tracers: list[_Tracer], began: float) -> Locus:
    """Join the two directions into one record."""
    back = tracers[0]
    points, double = back.points[::-1], back.double[::-1]
    ended = [back.ended]
    if len(tracers) == 2:
        points, double = points + tracers[1].points[1:], double + tracers[1].double
    ended.append(tracers[-1].ended)
    good = all(e in ("bound", "closed", "ends at a grazing", "the extremum that touches ends") for e in ended)
    first, second = problem.parameters
    return Locus(
        condition.kind, condition.boundary, (first, second), problem.periods,
        np.array([p.values for p in points]), np.array([p.state for p in points]),
        np.array([floquet_multipliers(p.trace, p.determinant) for p in points], dtype=np.complex128),
        tuple(motion_label(problem.periods, p.counts) for p in points), tuple(double), (ended[0], ended[1]),
        max((p.error for p in double), default=0.0),
        Cost(time.perf_counter() - began, 4, len(points), 4 * problem.periods * len(points)), good,
        f"{len(points)} points, {len(double)} of codimension two; ended: {ended[0]}, {ended[1]}",
    )  # fmt: skip
