"""Pseudo-arclength steps along a branch of periodic orbits, whatever the flow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from base import Array, Cost, Faults, Stopwatch
from dynamics.branch import GOOD_ENDS, MEETS, UNBOUNDED, Branch
from dynamics.branch_problem import BranchProblem, PlanePoint, Steps
from dynamics.corrector import passes
from dynamics.shooting import floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["follow"]

FLAT = np.array([0.0, 0.0, 1.0])  # across which the parameter is held
LARGE = 4.0  # times the size of the motion: where a growing motion is measured by a larger one
ENDLESS = 1e4  # times its first size: a motion that grows without bound


def follow(
    problem: BranchProblem,
    state: Array,
    value: float,
    steps: Steps,
    progress: Callable[[int, float], None] | None,
) -> Branch:
    """Follow a branch both ways from a periodic orbit at a value of the parameter.

    Raises
    ------
    InputError
        If Newton's method does not arrive at the start.
    """
    watch = Stopwatch()
    start = problem.correct(problem.unknowns(state, value), FLAT)
    if start is None:
        faults = Faults()
        faults.add("orbit", value, "must be an orbit that can be continued", "at a fold, start beside it")
        faults.raise_if_any()
    walkers = []
    for way in (-1.0, 1.0):
        walker = _Walker(problem, start, way * FLAT, steps, progress)
        walker.run()
        walkers.append(walker)
        if walker.ended == "closed":
            break
    return _joined(walkers, watch)


@dataclass(frozen=True, eq=False)
class _Step:
    """A step that may be taken."""

    point: PlanePoint
    tangent: Array
    special: list[SpecialPoint]
    complete: bool  # whether the special points explain all that changes


class _Walker:
    """Steps from a start in one direction until a reason to end."""

    def __init__(
        self, problem: BranchProblem, start: PlanePoint, along: Array, steps: Steps,
        progress: Callable[[int, float], None] | None,
    ) -> None:  # fmt: skip
        self.problem, self.steps, self.progress = problem, steps, progress
        self.step = steps.first
        self.size = problem.scale
        self.points, self.states = [start], [start.u[:2] * problem.scale]
        self.special: list[SpecialPoint] = []
        self.tangent, self.bend = start.tangent(along), np.zeros(3)
        self.phases = problem.phases(start)
        self.half = self._half(start)
        self.ended, self.refused = "", ""
        self.missed: list[float] = []
        self.iterations = 0

    def run(self) -> None:
        """Step until the branch ends."""
        while not self.ended:
            if len(self.points) > self.steps.points:
                self.ended = f"{self.steps.points} points: raise max_points"
                return
            last = self.points[-1]
            step = self._try(last)
            if step is None:
                self.step *= 0.5
                if self.step < self.steps.least and not self.ended:
                    self.ended = f"{self.refused} at a step of {self.step:.0e}"
                continue
            new = step.point
            half = self._half(new)
            if half @ self.half < 0.0:  # the two halves of the orbit have changed places
                self.ended = MEETS
                return
            self.half = half
            self._accept(step)
            size = float(np.max(np.abs(new.u[:2])))
            if len(self.points) > 3 and passes(last.u, new.u, self.phases):  # however small the loop
                self.ended = "closed"
            elif size * self.problem.scale > ENDLESS * self.size:
                self.ended = UNBOUNDED
            elif size > LARGE:
                self._magnify(size)

    def _half(self, point: PlanePoint) -> Array:
        """From the state to the state half the orbit's period later; 0 if n is odd."""
        if self.problem.periods % 2:
            return np.zeros(2)
        return self.problem.half_way(point) - point.u[:2]

    def _magnify(self, factor: float) -> None:
        """Measure a motion that has grown by its new size: steps and tolerances are shares of it."""
        larger = self.problem.magnified(factor)
        if larger is None:
            return
        again = larger.correct(larger.unknowns(self.states[-1], self.points[-1].value), FLAT)
        if again is None:
            return
        self.problem, self.points[-1] = larger, again
        shrink = np.array([1.0 / factor, 1.0 / factor, 1.0])
        self.phases = (np.array(self.phases) * shrink).tolist()
        self.bend = np.zeros(3)
        self.half = self.half / factor
        self.tangent = again.tangent(self.tangent * shrink)

    def _try(self, last: PlanePoint) -> _Step | None:
        """Next point, or None if the step is too long; at a bound, the point on it."""
        guess, row = last.u + self.step * (self.tangent + self.step * self.bend), self.tangent
        bound = 1.0 if guess[2] > 1.0 else 0.0 if guess[2] < 0.0 else math.nan
        if not math.isnan(bound):
            if last.u[2] == bound:
                self.ended = "bound"
                return None
            guess = last.u + (bound - last.u[2]) / self.tangent[2] * self.tangent
            guess[2] = bound
            row = FLAT
        self.refused = "Newton's method did not arrive"
        new = self.problem.correct(guess, row)
        if new is None or new.iterations > 8:
            return None
        chord = new.u - last.u
        if math.sqrt(chord @ chord) > 2.0 * self.step and math.isnan(bound):
            return None
        tangent = new.tangent(chord)
        patient = self.step > 16.0 * self.steps.least
        self.refused = "the branch has a corner"
        if tangent @ self.tangent < 0.9 and patient:
            return None
        self.refused = "the multipliers jump"
        if abs(new.trace - last.trace) > 0.3 * max(1.0, abs(last.trace)) and patient:
            return None
        return self._between(last, new, tangent, patient)

    def _between(self, last: PlanePoint, new: PlanePoint, tangent: Array, patient: bool) -> _Step | None:
        """The step with its special points; None if one is not located and a shorter step may help."""
        crossings, explained = self.problem.crossings(last, new)
        if not explained and patient:
            return None
        looked = [self.problem.locate(last, new, crossing) for crossing in crossings]
        arrived = all(there for _, there in looked)
        self.refused = "a special point was not located"
        if not arrived and patient:
            return None
        chord = new.u - last.u
        found = [p for p, _ in looked if p is not None]
        found.sort(key=lambda p: float((self.problem.unknowns(p.state, p.parameter) - last.u) @ chord))
        return _Step(new, tangent, found, explained and arrived)

    def _accept(self, step: _Step) -> None:
        """Take a point and what lies before it, choose the next step."""
        new = step.point
        length = math.dist(new.u, self.points[-1].u)
        if not step.complete:
            self.missed.append(new.value)
        self.special += step.special
        self.points.append(new)
        self.states.append(new.u[:2] * self.problem.scale)
        self.iterations += new.iterations
        # half the curvature, for the predictor: none from so short a step that the difference is rounding
        self.bend = 0.5 / length * (step.tangent - self.tangent) if length > 1e-5 else np.zeros(3)
        self.tangent = step.tangent
        if new.u[2] in (0.0, 1.0):
            self.ended = "bound"
        if new.iterations <= 4:
            self.step = min(1.4 * self.step, self.steps.most)
        if self.progress is not None:
            self.progress(len(self.points), new.value)


def _joined(walkers: list[_Walker], watch: Stopwatch) -> Branch:
    """Join the directions into one record."""
    back, problem = walkers[0], walkers[0].problem
    points, states, special = back.points[::-1], back.states[::-1], back.special[::-1]
    ended = (back.ended, walkers[-1].ended)
    if len(walkers) == 2:
        points, states = points + walkers[1].points[1:], states + walkers[1].states[1:]
        special = special + walkers[1].special
    pairs = [floquet_multipliers(p.trace, p.determinant) for p in points]
    stable = [is_stable(m) for m in pairs]
    missed = [v for w in walkers for v in w.missed]
    good = all(reason in GOOD_ENDS for reason in ended) and not missed
    message = f"{len(points)} points, {len(special)} special; ended: {ended[0]}, {ended[1]}"
    if missed:
        message += f"; not located near {problem.parameter} = {missed[0]:.10g}: lower min_step"
    iterations = sum(w.iterations for w in walkers)
    return Branch(
        problem.parameter,
        problem.periods,
        np.array([p.value for p in points]),
        np.array(states),
        np.array(pairs, dtype=np.complex128),
        np.array(stable),
        tuple(motion_label(problem.periods, p.counts, s) for p, s in zip(points, stable, strict=True)),
        tuple(special),
        ended,
        max((p.error for p in special), default=0.0),
        Cost(watch.seconds, 3, iterations, problem.maps * problem.periods * iterations),
        good,
        message,
    )
