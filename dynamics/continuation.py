"""Continuation of a branch of periodic orbits in one parameter, through folds and grazings."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from dynamics.branch import GOOD_ENDS, KINDS, MEETS, UNBOUNDED, Branch
from dynamics.corrector import OrbitProblem, Point, passes
from dynamics.cost import Cost
from dynamics.crossings import find_crossings, locate
from dynamics.errors import Faults
from dynamics.shooting import Orbit, floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["KINDS", "MEETS", "Branch", "continue_branch"]

FloatArray = npt.NDArray[np.float64]
LARGE = 4.0  # times the size of the motion: where a growing motion is measured by a larger one
ENDLESS = 1e4  # times its first size: a motion that grows without bound


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
        self.first = problem.scale
        self.points = [start]
        self.special: list[SpecialPoint] = []
        self.tangent = problem.tangent(start, along)
        self.bend = np.zeros(3)
        even = problem.periods % 2 == 0
        self.phases = problem.phases(start)
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
            self._accept(step)
            size = float(np.max(np.abs(new.u[:2])))
            if len(self.points) > 3 and passes(last, new, self.phases):  # however small the loop
                self.ended = "closed"
            elif size * self.problem.scale > ENDLESS * self.first:
                self.ended = UNBOUNDED
            elif size > LARGE:
                self._rescale(size)

    def _rescale(self, factor: float) -> None:
        """Measure a motion that has grown by its new size: steps and tolerances are shares of it."""
        last = self.points[-1]
        larger = replace(self.problem, scale=factor * self.problem.scale)
        again = larger.correct(larger.unknowns(last.state, last.value), np.array([0.0, 0.0, 1.0]))
        if again is None:
            return
        self.problem, self.points[-1] = larger, again
        shrink = np.array([1.0 / factor, 1.0 / factor, 1.0])
        self.phases = (np.array(self.phases) * shrink).tolist()
        self.bend = np.zeros(3)
        self.half = self.half / factor
        self.tangent = larger.tangent(again, self.tangent * shrink)

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
        between = [locate(self.problem, last, new, crossing) for crossing in crossings]
        found = [p for p in between if p is not None]
        self.refused = "a special point was not located"
        if len(found) < len(between) and patient:
            return None
        found.sort(key=lambda p: float((self.problem.unknowns(p.state, p.parameter) - last.u) @ chord))
        return _Step(new, tangent, found, explained and len(found) == len(between))

    def _accept(self, step: _Step) -> None:
        """Take a point and what lies before it, choose the next step."""
        new = step.point
        length = math.dist(new.u, self.points[-1].u)
        if not step.complete:
            self.missed.append(new.value)
        self.special += step.special
        self.points.append(new)
        self.iterations += new.iterations
        # half the curvature, for the predictor: none from so short a step that the difference is rounding
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
    special: list[SpecialPoint]
    complete: bool  # whether the special points explain all that changes


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
    good = all(reason in GOOD_ENDS for reason in ended) and not missed
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
