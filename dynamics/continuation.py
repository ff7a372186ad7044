"""Continuation of a branch of periodic orbits in one parameter, through folds and grazings."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.corrector import OrbitProblem, Point
from dynamics.cost import Cost
from dynamics.crossings import Crossing, find_crossings, locate
from dynamics.errors import Faults
from dynamics.flow import period_map
from dynamics.shooting import Orbit, floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["KINDS", "Branch", "continue_branch"]

FloatArray = npt.NDArray[np.float64]
MEETS = "meets the branch of half the period"
KINDS = ("saddle-node", "period-doubling", "grazing")


@dataclass(frozen=True, eq=False)
class Branch:
    """A branch of periodic orbits.

    Parameters
    ----------
    parameter : str
        What was varied.
    periods : int
        Period of the orbits, in excitation periods.
    values : ndarray, shape (m,)
        Parameter along the branch.
    states : ndarray, shape (m, 2)
        X and V at tau = 0.
    multipliers : ndarray of complex, shape (m, 2)
        Floquet multipliers.
    stable : ndarray of bool, shape (m,)
        Stability.
    labels : tuple of str
        n-p-q or Un-p-q.
    points : tuple of SpecialPoint
        Special points in their order along the branch.
    ended : tuple of str
        Why the branch ended at its first and at its last point.
    error : float
        Largest estimated relative error of a special point's parameter.
    cost : Cost
        Effort.
    converged : bool
        Whether both ends were reached for a good reason (a bound, the start again, the branch of half the period)
        and every special point seen was located.
    message : str
        What happened, with a remedy if not converged.
    """

    parameter: str
    periods: int
    values: FloatArray
    states: FloatArray
    multipliers: npt.NDArray[np.complex128]
    stable: npt.NDArray[np.bool_]
    labels: tuple[str, ...]
    points: tuple[SpecialPoint, ...]
    ended: tuple[str, str]
    error: float
    cost: Cost
    converged: bool
    message: str

    def special(self, kind: str) -> list[SpecialPoint]:
        """Special points of one kind, in their order along the branch.

        Parameters
        ----------
        kind : str
            "saddle-node", "period-doubling" or "grazing"; "neimark-sacker", which the exact flow never meets.

        Raises
        ------
        DynamicsError
            If there is no such kind.
        """
        faults = Faults()
        known = (*KINDS, "neimark-sacker")
        if kind not in known:
            faults.add("kind", kind, ", ".join(known), "name one of these")
        faults.raise_if_any()
        return [p for p in self.points if p.kind == kind]

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Columns parameter, X, V."""
        return np.column_stack([self.values, self.states]).astype(dtype if dtype is not None else np.float64)


def continue_branch(
    orbit: Orbit,
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

    Pseudo-arclength continuation: predictor along the tangent of the branch at the last point, corrector by
    Newton's method in the plane across it, so that folds are no obstacle. Steps shrink where the branch bends,
    where the multipliers change fast (as the square root of the penetration does, next to a grazing) and where
    the extrema that crossed the limits of the backlash do not account for the change of the label.

    Parameters
    ----------
    orbit : Orbit
        A converged orbit within the bounds.
    parameter : str
        As in `GearOscillator.with_parameter`.
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
        Points, stability and special points.

    Raises
    ------
    DynamicsError
        If an argument is out of range, or the orbit has not converged or lies outside the bounds.
    """
    began = time.perf_counter()
    faults = Faults()
    low, high = (faults.number(f"bounds[{i}]", bounds[i]) for i in range(2))
    if not low < high:
        faults.add("bounds", bounds, "the lower value first", "give (low, high)")
    if not orbit.converged:
        faults.add("orbit", orbit.message, "a converged orbit", "find the orbit first")
    value = orbit.oscillator.get(parameter)
    if not low <= value <= high:
        faults.add("orbit", value, f"{parameter} within bounds", "widen the bounds")
    for name, number in (("step", step), ("max_step", max_step), ("min_step", min_step)):
        faults.number(name, number, "between 0 and 0.5", "0.005 is usual", lambda s: 0.0 < s < 0.5)
    limit = faults.whole("max_points", max_points, 1, 10**7, "5000 is usual")
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(orbit.state))), orbit.oscillator.half_backlash, 1e-300)
    problem = OrbitProblem(
        orbit.oscillator, (parameter,), orbit.periods, np.array([low]), np.array([high]), scale
    )
    flat = np.array([0.0, 0.0, 1.0])
    start = problem.correct(problem.unknowns(orbit.state, value), flat)
    if start is None:
        faults.add("orbit", value, "an orbit that can be continued", "at a fold, start beside it")
        faults.raise_if_any()
        raise AssertionError
    walkers = []
    for way in (-1.0, 1.0):
        walker = _Walker(problem, start, way * flat, (step, max_step, min_step), limit, progress)
        walker.run()
        walkers.append(walker)
        if walker.ended == "closed":
            break
    return _branch(problem, walkers, began)


class _Walker:
    """Steps from a start in one direction until a reason to end."""

    def __init__(
        self, problem: OrbitProblem, start: Point, along: FloatArray, steps: tuple[float, float, float],
        limit: int, progress: Callable[[int, float], None] | None,
    ) -> None:  # fmt: skip
        self.problem, self.limit, self.progress = problem, limit, progress
        self.step, self.max_step, self.min_step = steps
        self.points = [start]
        self.special: list[SpecialPoint] = []
        self.tangent = problem.tangent(start, along)
        self.bend = np.zeros(3)
        even = problem.periods % 2 == 0
        self.phases = self._phases(start)
        self.half = problem.half_way(start) - start.u[:2] if even else np.zeros(2)
        self.ended = ""
        self.missed: list[float] = []
        self.iterations = 0
        self.refused = ""

    def run(self) -> None:
        """Step until the branch ends."""
        while not self.ended:
            if len(self.points) > self.limit:
                self.ended = f"{self.limit} points: raise max_points"
                return
            last = self.points[-1]
            step = self._try(last)
            if step is None:
                self.step *= 0.5
                if self.step < self.min_step:
                    self.ended = f"{self.refused} at a step of {self.step:.0e}"
                continue
            new = step.point
            if self.problem.periods % 2 == 0:
                half = self.problem.half_way(new) - new.u[:2]
                if half @ self.half < 0.0:  # the two halves of the orbit have changed places
                    self.ended = MEETS
                    return
                self.half = half
            self._accept(last, step)
            if len(self.points) > 3 and self._closed(last, new):  # however small the loop
                self.ended = "closed"
            elif float(np.max(np.abs(new.u[:2]))) > 1e6:
                self.ended = "the motion grows without bound"

    def _phases(self, start: Point) -> list[list[float]]:
        """Unknowns of the start, its orbit taken from each excitation period on."""
        n = self.problem.periods
        states = period_map(self.problem.at(start.u), start.state, n).states
        value = np.full((n, 1), start.u[2])
        phases: list[list[float]] = np.hstack(
            [np.roll(states, 1, axis=0) / self.problem.scale, value]
        ).tolist()
        return phases

    def _closed(self, last: Point, new: Point) -> bool:
        """Tell whether a step passes the start, at any of the n phases of its orbit."""
        chord = (new.u - last.u).tolist()
        square = sum(c * c for c in chord)
        for phase in self.phases:
            back = [p - u for p, u in zip(phase, last.u.tolist(), strict=True)]
            along = sum(b * c for b, c in zip(back, chord, strict=True)) / square
            if 0.0 < along <= 1.0:
                beside = sum((b - along * c) ** 2 for b, c in zip(back, chord, strict=True))
                if beside < 0.01 * square:
                    return True
        return False

    def _try(self, last: Point) -> _Step | None:
        """Next point, or None if the step is too long; at a bound, the point on it."""
        guess = last.u + self.step * (self.tangent + self.step * self.bend)
        row = self.tangent
        bound = 1.0 if guess[2] > 1.0 else 0.0 if guess[2] < 0.0 else math.nan
        if not math.isnan(bound):
            if last.u[2] == bound:
                self.ended = "bound"
                return None
            guess = last.u + (bound - last.u[2]) / self.tangent[2] * self.tangent
            guess[2] = bound
            row = np.array([0.0, 0.0, 1.0])
        self.refused = "Newton's method did not arrive"
        new = self.problem.correct(guess, row)
        if new is None or new.iterations > 8:
            return None
        chord = new.u - last.u
        if math.sqrt(chord @ chord) > 2.0 * self.step and math.isnan(bound):
            return None
        tangent = self.problem.tangent(new, chord)
        patient = self.step > 16.0 * self.min_step
        self.refused = "the branch has a corner"
        if tangent @ self.tangent < 0.9 and patient:
            return None
        self.refused = "the multipliers jump"
        if abs(new.trace - last.trace) > 0.3 * max(1.0, abs(last.trace)) and patient:
            return None
        crossings, explained = find_crossings(self.problem, last, new)
        if not explained and patient:
            return None
        return _Step(new, tangent, crossings, explained)

    def _accept(self, last: Point, step: _Step) -> None:
        """Take a point, locate what lies between, choose the next step."""
        new = step.point
        if not step.explained:
            self.missed.append(new.value)
        found = []
        for crossing in step.crossings:
            special = locate(self.problem, last, new, crossing)
            if special is None:
                self.missed.append(new.value)
            else:
                found.append(special)
        chord = new.u - last.u
        found.sort(key=lambda p: float((self.problem.unknowns(p.state, p.parameter) - last.u) @ chord))
        self.special += found
        self.points.append(new)
        self.iterations += new.iterations
        # half the curvature, for the predictor: none from so short a step that the difference is rounding
        length = math.sqrt(chord @ chord)
        self.bend = 0.5 / length * (step.tangent - self.tangent) if length > 1e-5 else np.zeros(3)
        self.tangent = step.tangent
        if new.u[2] in (0.0, 1.0):
            self.ended = "bound"
        if new.iterations <= 4:
            self.step = min(1.4 * self.step, self.max_step)
        if self.progress is not None:
            self.progress(len(self.points), new.value)


@dataclass(frozen=True, eq=False)
class _Step:
    """A step that may be taken."""

    point: Point
    tangent: FloatArray
    crossings: list[Crossing]
    explained: bool


def _branch(problem: OrbitProblem, walkers: list[_Walker], began: float) -> Branch:
    """Join the two directions into one record."""
    back = walkers[0]
    points, special = back.points[::-1], back.special[::-1]
    ended = [back.ended]
    if len(walkers) == 2:
        points, special = points + walkers[1].points[1:], special + walkers[1].special
    ended.append(walkers[-1].ended)
    pairs = [floquet_multipliers(p.trace, p.determinant) for p in points]
    stable = [is_stable(m) for m in pairs]
    missed = [v for w in walkers for v in w.missed]
    good = all(reason in ("bound", "closed", MEETS) for reason in ended) and not missed
    message = f"{len(points)} points, {len(special)} special; ended: {ended[0]}, {ended[1]}"
    if missed:
        message += f"; not located near {problem.parameters[0]} = {missed[0]:.10g}: lower min_step"
    iterations = sum(w.iterations for w in walkers)
    return Branch(
        problem.parameters[0],
        problem.periods,
        np.array([p.value for p in points]),
        np.array([p.state for p in points]),
        np.array(pairs, dtype=np.complex128),
        np.array(stable),
        tuple(motion_label(problem.periods, p.counts, s) for p, s in zip(points, stable, strict=True)),
        tuple(special),
        (ended[0], ended[1]),
        max((p.error for p in special), default=0.0),
        Cost(time.perf_counter() - began, 3, iterations, 3 * problem.periods * iterations),
        good,
        message,
    )
