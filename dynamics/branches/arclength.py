"""Pseudo-arclength steps along a branch of periodic orbits, whatever the flow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from base import Array, Cost, InputError, Stopwatch
from dynamics.branches.branch import GOOD_ENDS, MEETS, Branch, SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, Heading, MapPoint, Steps
from dynamics.branches.crossings import find_crossings, rejoining_point
from dynamics.branches.locus_predictor import Tracer, both_ways, joined
from dynamics.branches.sizes import LARGE, SMALL, Sizes
from dynamics.branches.step_rules import (
    ASTRAY,
    EASY,
    FALLEN,
    ITERATIONS,
    LONGER,
    PATIENT,
    ROUND,
    STRAIGHT,
    hides,
)
from dynamics.model.options import OPTIONS
from dynamics.orbits.shooting import floquet_multipliers, is_stable, motion_label

MET = 1e-5  # of the size of the motion: distance of two halves of an orbit at which its branch meets that of the half


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
    start = problem.correct(problem.unknowns(state, value), problem.flat)
    if start is None:
        raise InputError.at(
            "orbit", value, "must be an orbit that can be continued", "at a fold, start beside it"
        )
    walkers = both_ways(lambda sign: _Walker(problem, start, sign * problem.flat, steps, progress))
    return _joined(walkers, watch)


@dataclass(frozen=True, eq=False)
class _Step:
    """A step that may be taken."""

    point: MapPoint
    tangent: Array
    half: Array  # from the state to the state half the orbit's period later; 0 if n is odd
    special: list[SpecialPoint]
    complete: bool  # whether the special points explain all that changes


class _Passed(NamedTuple):
    """What is kept of a point that was passed without a look."""

    value: float
    multipliers: npt.NDArray[np.complex128] | Array
    counts: tuple[int, int]


class _Walker(Tracer):
    """Steps along a branch, with the special points on it."""

    def __init__(
        self, problem: BranchProblem, start: MapPoint, along: Array, steps: Steps,
        progress: Callable[[int, float], None] | None,
    ) -> None:  # fmt: skip
        super().__init__(problem, start, steps)
        self.progress = progress
        self.states = [start.u[: start.size] * problem.scale]
        self.special: list[SpecialPoint] = []
        self.tangent, self.bend = start.tangent(along), np.zeros(len(along))
        self.half = self._half(start)
        self.behind = (math.inf, math.inf)
        self.refused = ""
        self.rejoining_point: SpecialPoint | None = None
        self.missed: list[float] = []
        self.iterations = 0

    def stride(self, remaining: int) -> bool:
        """Take steps that need no look many at a time, where the flow has a loop for that."""
        heading = Heading(self.tangent, self.bend, self.half, self.step)
        taken = self.problem.march(self.points[-1], heading, self.steps, self.phases, self.sizes, remaining)
        if taken is None:
            return False
        self.tangent, self.bend, self.half, self.step = taken.heading
        self.behind = (math.inf, math.inf)
        values = taken.values.tolist()
        pairs = map(floquet_multipliers, taken.traces.tolist(), taken.determinants.tolist())
        counts = map(tuple, taken.counts.tolist())
        self.points += list(map(_Passed, values, pairs, counts))
        if values:
            self.points[-1] = taken.last
        self.states += list(taken.us[:, :-1] * self.problem.scale)
        self.iterations += taken.iterations
        if self.progress is not None:
            for number, value in enumerate(values, len(self.points) - len(values) + 1):
                self.progress(number, value)
        return bool(taken.whole)

    @property
    def least(self) -> float:  # type: ignore[override]
        """Size over the scale below which a motion is measured by a smaller one."""
        return SMALL if self.problem.driven < SMALL else 0.0

    @property
    def sizes(self) -> Sizes:
        """Sizes of motions that the scale serves."""
        return Sizes(self.least, min(LARGE, OPTIONS.unbounded * self.size / self.problem.scale))

    def attempt(self, last: MapPoint) -> _Step | None:
        """Next point with what lies before it; at a bound, the point on it."""
        last = self.measured(last)
        if last is None:
            return None
        aim = self.aimed(last, last.u + self.step * (self.tangent + self.step * self.bend))
        if aim is None:
            return None
        self.refused = "Newton's method did not arrive"
        patient = self.step > PATIENT * self.steps.least
        new, ahead = self.problem.correct(*aim), None
        if new is None and not patient:  # a corner of more than a right angle: on with the parameter
            ahead = math.copysign(1.0, self.tangent[-1]) * self.problem.flat
            new = self.problem.correct(aim[0], ahead)
        if new is None or new.iterations > ITERATIONS:
            return None
        chord = new.u - last.u
        astray = ASTRAY if patient else ROUND  # behind a corner
        if math.sqrt(chord @ chord) > astray * self.step and aim[1] is self.tangent:
            return None
        tangent = new.tangent(chord if ahead is None else ahead)
        self.refused = "the branch has a corner"
        if tangent @ self.tangent < OPTIONS.corner and patient:
            return None
        self.refused = "the multipliers jump"
        if abs(new.trace - last.trace) > OPTIONS.multiplier_jump * max(1.0, abs(last.trace)) and patient:
            return None
        self.refused = "special points lie close together"
        half = self._half(new)
        if patient and not self._met(half):
            length = math.dist(new.u, last.u)
            if self._hides(last, new, tangent) or self.problem.grazes(
                last, self.tangent, new, tangent, length
            ):
                return None
        return self._between(last, new, tangent, half, patient)

    def _hides(self, last: MapPoint, new: MapPoint, tangent: Array) -> bool:
        """Whether two special points of one kind may lie between neighbours.

        Slopes are asked for where a function of the multipliers is less than its last changes.
        """
        at, there, length = _tests(last), _tests(new), math.dist(new.u, last.u)
        swings = (abs(a - b) + abs(a - c) for a, b, c in zip(at, there, self.behind, strict=True))
        if all(min(abs(a), abs(b)) > swing for a, b, swing in zip(at, there, swings, strict=True)):
            return False
        rise, climb = self.problem.trends(last, self.tangent), self.problem.trends(new, tangent)
        return any(hides(*ends, length) for ends in zip(at, rise, there, climb, strict=True))

    def _end_at(self, point: SpecialPoint | None) -> None:
        """Note where the branch ends; a saddle node there is the doubling itself, at which a multiplier is 1 too."""
        self.ended, self.rejoining_point = MEETS, point
        if point is not None:
            near = 10.0 * MET * self.problem.scale
            self.special = [
                p for p in self.special if p.kind != "saddle-node" or _off(p.state, point.state) > near
            ]

    def _met(self, half: Array) -> bool:
        """Whether the two halves of the orbit have changed places, or become one."""
        if self.problem.periods % 2:
            return False
        fallen = float(np.max(np.abs(half))) < FALLEN * float(np.max(np.abs(self.half)))
        return fallen or bool(half @ self.half < 0.0)

    def why(self, last: MapPoint) -> str:
        """What the last attempt was refused for."""
        return f"{self.refused} at a step of {self.step:.0e}"

    def _half(self, point: MapPoint) -> Array:
        """From the state to the state half the orbit's period later; 0 if n is odd."""
        if self.problem.periods % 2:
            return np.zeros(point.size)
        return np.asarray(self.problem.half_way(point) - point.u[: point.size])

    def met_again(self, larger: BranchProblem, last: MapPoint, along: Array) -> MapPoint | None:
        """The orbit at the same value of the parameter."""
        again: MapPoint | None = larger.correct(larger.unknowns(self.states[-1], last.value), larger.flat)
        return again

    def rescale(self, again: MapPoint, along: Array, factor: float) -> None:
        """Without a bend: the next step is straight."""
        self.bend, self.half, self.tangent = np.zeros(len(along)), self.half / factor, again.tangent(along)

    def _between(
        self, last: MapPoint, new: MapPoint, tangent: Array, half: Array, patient: bool
    ) -> _Step | None:
        """The step with its special points; None if one is not located and a shorter step may help."""
        crossings, explained = find_crossings(last, new)
        if not explained and patient:
            return None
        looked = [self.problem.locate(last, new, crossing) for crossing in crossings]
        arrived = all(there for _, there in looked)
        self.refused = "a special point was not located"
        if not arrived and patient:
            return None
        if self._met(half):
            self.refused = "the branch of half the period is near"
            if not patient or float(np.max(np.abs(self.half))) < MET:
                self._end_at(rejoining_point(self.problem, last))
            return None
        chord = new.u - last.u
        special_points = [p for p, _ in looked if p is not None]
        self.refused = "special points lie close together"
        if patient and _astride(last, new, special_points):
            return None
        special_points.sort(
            key=lambda p: float((self.problem.unknowns(p.state, p.parameter) - last.u) @ chord)
        )
        return _Step(new, tangent, half, special_points, explained and arrived)

    def accept(self, last: MapPoint, reached: _Step) -> None:
        """Take a point and what lies before it, choose the next step."""
        new = reached.point
        length = math.dist(new.u, last.u)
        if not reached.complete:
            self.missed.append(new.value)
        self.special += reached.special
        self.points.append(new)
        self.states.append(new.u[: new.size] * self.problem.scale)
        self.iterations += new.iterations
        self.behind = _tests(last)
        # half the curvature, for the predictor: none from so short a step that the difference is rounding
        self.bend = (
            0.5 / length * (reached.tangent - self.tangent) if length > STRAIGHT else 0.0 * reached.tangent
        )
        self.tangent, self.half = reached.tangent, reached.half
        if new.iterations <= EASY:
            self.step = min(LONGER * self.step, self.steps.most)
        if self.progress is not None:
            self.progress(len(self.points), new.value)


def _tests(point: MapPoint) -> tuple[float, float]:
    """Functions of the multipliers that are zero at saddle nodes and at period doublings."""
    return point.fold, point.flip


def _astride(last: MapPoint, new: MapPoint, special_points: list[SpecialPoint]) -> bool:
    """Whether special points of one kind lie on either side of a grazing between neighbours, which show none."""
    sides = [_tests(last), _tests(new)]
    for point in special_points:
        if point.kind == "grazing":
            signs = (float(np.prod(1.0 + sign * point.multipliers).real) for sign in (-1.0, 1.0))
            if any(a * b > 0.0 > a * c for a, b, c in zip(*sides, signs, strict=True)):
                return True
    return False


def _off(here: Array, there: Array) -> float:
    return float(np.max(np.abs(here - there)))


def _joined(walkers: list[_Walker], watch: Stopwatch) -> Branch:
    """Join the directions into one record."""
    problem = walkers[0].problem
    points, states = (
        joined(parts, 1) for parts in ([w.points for w in walkers], [w.states for w in walkers])
    )
    special = joined([w.special for w in walkers])
    ended = (walkers[0].ended, walkers[-1].ended)
    pairs = [p.multipliers for p in points]
    stable = [is_stable(m) for m in pairs]
    missed = [v for w in walkers for v in w.missed]
    good = all(reason in GOOD_ENDS for reason in ended) and not missed
    met = (walkers[0].rejoining_point, walkers[-1].rejoining_point if len(walkers) > 1 else None)
    message = f"{len(points)} points, {len(special)} special; ended: {ended[0]}, {ended[1]}"
    if any(end == MEETS and point is None for end, point in zip(ended, met, strict=True)):
        message += "; where it meets was not located"
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
        Cost(watch.seconds, problem.size + 1, iterations, problem.maps * problem.periods * iterations),
        good,
        message,
        met,
        problem.oscillator,
    )
