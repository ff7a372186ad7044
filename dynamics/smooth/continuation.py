"""Continuation of a branch of periodic orbits of any period map, through folds and grazings."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from dynamics.continuation import MEETS, Branch
from dynamics.cost import Cost
from dynamics.errors import Faults
from dynamics.shooting import floquet_multipliers, is_stable, motion_label
from dynamics.smooth.crossings import Sign, find_crossings, locate
from dynamics.smooth.problem import FlowProblem, MapPoint, PeriodMap, correct, tangent
from dynamics.smooth.shooting import SmoothOrbit
from dynamics.special import SpecialPoint

__all__ = ["continue_branch", "follow_branch"]

FloatArray = npt.NDArray[np.float64]


def continue_branch(
    orbit: SmoothOrbit,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.1, 2.1),
    *,
    step: float = 0.005,
    max_step: float = 0.02,
    min_step: float = 1e-8,
    max_points: int = 5000,
    progress: Callable[[int, float], None] | None = None,
) -> Branch:
    """Follow a periodic orbit in a parameter, both ways from where it is.

    Parameters
    ----------
    orbit : SmoothOrbit
        A converged orbit within the bounds; its tolerance is kept.
    parameter : str
        As in `SmoothOscillator.parameters`.
    bounds : tuple of float
        Range of the parameter.
    step, max_step, min_step : float
        First, largest and smallest step along the branch, over the size of the motion and the width of the bounds.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameter value.

    Returns
    -------
    Branch
        Points, stability and special points: saddle nodes, period doublings, grazings, Neimark-Sacker points.

    Raises
    ------
    DynamicsError
        If an argument is out of range, or the orbit has not converged or lies outside the bounds.
    """
    faults = Faults()
    low, high = (faults.number(f"bounds[{i}]", bounds[i]) for i in range(2))
    if not low < high:
        faults.add("bounds", bounds, "the lower value first", "give (low, high)")
    if not orbit.converged:
        faults.add("orbit", orbit.message, "a converged orbit", "find the orbit first")
    value = orbit.oscillator.get(parameter)
    if not low <= value <= high:
        faults.add("orbit", value, f"{parameter} within bounds", "widen the bounds")
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(orbit.state))), orbit.oscillator.size)
    problem = FlowProblem(orbit.oscillator, parameter, orbit.periods, low, high, scale, orbit.tolerance)
    return follow_branch(
        problem, orbit.state, value, (step, max_step, min_step), max_points=max_points, progress=progress
    )


def follow_branch(
    problem: PeriodMap,
    state: FloatArray,
    value: float,
    steps: tuple[float, float, float] = (0.005, 0.02, 1e-8),
    *,
    max_points: int = 5000,
    progress: Callable[[int, float], None] | None = None,
) -> Branch:
    """Do the same for any `PeriodMap`, from a periodic orbit at a value of its parameter.

    Raises
    ------
    DynamicsError
        If an argument is out of range, or Newton's method does not arrive at the start.
    """
    began = time.perf_counter()
    faults = Faults()
    for name, number in zip(("step", "max_step", "min_step"), steps, strict=True):
        faults.number(name, number, "between 0 and 0.5", "0.005 is usual", lambda s: 0.0 < s < 0.5)
    limit = faults.whole("max_points", max_points, 1, 10**7, "5000 is usual")
    faults.raise_if_any()
    flat = np.array([0.0, 0.0, 1.0])
    fraction = (value - problem.low) / (problem.high - problem.low)
    start = correct(problem, np.append(state / problem.scale, fraction), flat)
    if start is None:
        faults.add("orbit", value, "an orbit that can be continued", "at a fold, start beside it")
        faults.raise_if_any()
        raise AssertionError
    walkers = []
    for way in (-1.0, 1.0):
        walker = _Walker(problem, start, way * flat, steps, limit, progress)
        walker.run()
        walkers.append(walker)
        if walker.ended == "closed":
            break
    return _branch(problem, walkers, began)


class _Walker:
    """Steps from a start in one direction until a reason to end."""

    def __init__(
        self, problem: PeriodMap, start: MapPoint, along: FloatArray, steps: tuple[float, float, float], limit: int,
        progress: Callable[[int, float], None] | None,
    ) -> None:  # fmt: skip
        self.problem, self.limit, self.progress = problem, limit, progress
        self.step, self.max_step, self.min_step = steps
        self.points, self.special = [start], list[SpecialPoint]()
        self.tangent = tangent(start, along)
        states = problem.states(start)
        self.phases = np.column_stack([np.roll(states, 1, axis=0), np.full(len(states), start.u[2])])
        self.half = self._half(start)
        self.ended, self.refused = "", ""
        self.missed: list[float] = []
        self.iterations = 0

    def run(self) -> None:
        """Step until the branch ends."""
        while not self.ended:
            if len(self.points) > self.limit:
                self.ended = f"{self.limit} points: raise max_points"
                return
            last = self.points[-1]
            taken = self._try(last)
            if taken is None:
                self.step *= 0.5
                if self.step < self.min_step and not self.ended:
                    self.ended = f"{self.refused} at a step of {self.step:.0e}"
                continue
            new, way, found, explained = taken
            half = self._half(new)
            if half @ self.half < 0.0:  # the two halves of the orbit have changed places
                self.ended = MEETS
                return
            self.half = half
            if not explained:
                self.missed.append(new.value)
            self._take(last, new, way, found)
            if len(self.points) > 3 and self._closed(last, new):
                self.ended = "closed"
            elif float(np.max(np.abs(new.u[:2]))) > 1e6:
                self.ended = "the motion grows without bound"

    def _half(self, point: MapPoint) -> FloatArray:
        """From the state to the state half the orbit's period later; 0 if n is odd."""
        n = self.problem.periods
        return np.zeros(2) if n % 2 else self.problem.states(point)[n // 2 - 1] - point.u[:2]

    def _closed(self, last: MapPoint, new: MapPoint) -> bool:
        """Tell whether a step passes the start, at any of the n phases of its orbit."""
        chord, back = new.u - last.u, self.phases - last.u
        along = back @ chord / (chord @ chord)
        beside = np.linalg.norm(back - along[:, None] * chord, axis=1)
        return bool(np.any((along > 0.0) & (along <= 1.0) & (beside < 0.1 * math.sqrt(chord @ chord))))

    def _try(self, last: MapPoint) -> tuple[MapPoint, FloatArray, list[Sign], bool] | None:
        """Next point, or None if the step is too long; at a bound, the point on it."""
        guess, row = last.u + self.step * self.tangent, self.tangent
        bound = 1.0 if guess[2] > 1.0 else 0.0 if guess[2] < 0.0 else math.nan
        if not math.isnan(bound):
            if last.u[2] == bound:
                self.ended = "bound"
                return None
            guess = last.u + (bound - last.u[2]) / self.tangent[2] * self.tangent
            guess[2] = bound
            row = np.array([0.0, 0.0, 1.0])
        self.refused = "Newton's method did not arrive"
        new = correct(self.problem, guess, row)
        if new is None or new.iterations > 8:
            return None
        chord = new.u - last.u
        if math.sqrt(chord @ chord) > 2.0 * self.step and math.isnan(bound):
            return None
        way = tangent(new, chord)
        patient = self.step > 16.0 * self.min_step
        self.refused = "the branch has a corner"
        if way @ self.tangent < 0.9 and patient:
            return None
        self.refused = "the multipliers jump"
        if abs(new.trace - last.trace) > 0.3 * max(1.0, abs(last.trace)) and patient:
            return None
        found, explained = find_crossings(last, new)
        if not explained and patient:
            return None
        return new, way, found, explained

    def _take(self, last: MapPoint, new: MapPoint, way: FloatArray, found: list[Sign]) -> None:
        """Take a point, locate what lies between, choose the next step."""
        chord, special = new.u - last.u, list[tuple[float, SpecialPoint]]()
        for sign in found:
            point, u, arrived = locate(self.problem, last, new, sign)
            if not arrived:
                self.missed.append(new.value)
            elif point is not None and u is not None:
                special.append((float((u - last.u) @ chord), point))
        self.special += [point for _, point in sorted(special, key=lambda pair: pair[0])]
        self.points.append(new)
        self.iterations += new.iterations
        self.tangent = way
        if new.u[2] in (0.0, 1.0):
            self.ended = "bound"
        if new.iterations <= 4:
            self.step = min(1.4 * self.step, self.max_step)
        if self.progress is not None:
            self.progress(len(self.points), new.value)


def _branch(problem: PeriodMap, walkers: list[_Walker], began: float) -> Branch:
    """Join the two directions into one record."""
    back = walkers[0]
    points, special, ended = back.points[::-1], back.special[::-1], [back.ended]
    if len(walkers) == 2:
        points, special = points + walkers[1].points[1:], special + walkers[1].special
    ended.append(walkers[-1].ended)
    pairs = [floquet_multipliers(p.trace, p.determinant) for p in points]
    stable = [is_stable(m) for m in pairs]
    missed = [v for w in walkers for v in w.missed]
    good = all(reason in ("bound", "closed", MEETS) for reason in ended) and not missed
    message = f"{len(points)} points, {len(special)} special; ended: {ended[0]}, {ended[1]}"
    if missed:
        message += f"; not located near {problem.parameter} = {missed[0]:.10g}: lower min_step"
    iterations = sum(w.iterations for w in walkers)
    return Branch(
        problem.parameter,
        problem.periods,
        np.array([p.value for p in points]),
        np.array([p.u[:2] * problem.scale for p in points]),
        np.array(pairs, dtype=np.complex128),
        np.array(stable),
        tuple(motion_label(problem.periods, p.counts, s) for p, s in zip(points, stable, strict=True)),
        tuple(special),
        (ended[0], ended[1]),
        max((p.error for p in special), default=0.0),
        Cost(time.perf_counter() - began, 3, iterations, problem.periods * iterations),
        good,
        message,
    )
