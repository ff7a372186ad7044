"""Steps along a branch of the exact flow that need no closer look, many at a time and in plain numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from base import Array, Integers
from dynamics.branches.branch_problem import Heading, Steps
from dynamics.branches.corrector import LIMIT, ROOM, OrbitProblem, Point
from dynamics.branches.sizes import WIDTH, Sizes
from dynamics.branches.step_rules import (
    ASTRAY,
    EASY,
    FALLEN,
    FAR,
    ITERATIONS,
    LONGER,
    NEAR,
    PATIENT,
    STRAIGHT,
    SWAY,
    hides,
    touches_twice,
)
from dynamics.flow.exact_flow import ExactFlow
from dynamics.model.options import OPTIONS

BLOCK = 64  # steps after which it is said how far a branch is
Rows = list[list[float]]
TAKE, SHORTEN, LEAVE = range(3)  # what is to be done with a step


class March(NamedTuple):
    """What steps have met.

    Attributes
    ----------
    us : ndarray, shape (k, 3)
        Unknowns of the points taken.
    values : ndarray, shape (k,)
        The parameter.
    traces, determinants : ndarray, shape (k,)
        Of the Jacobians.
    counts : ndarray of int, shape (k, 2)
        p and q.
    iterations : int
        Of Newton's method, in all.
    last : Point
        The last point taken; where there is none, that from which the steps went.
    heading : Heading
        How the branch goes on.
    whole : bool
        Whether as many steps were taken as were wanted: the next may be as plain.
    """

    us: Array
    values: Array
    traces: Array
    determinants: Array
    counts: Integers
    iterations: int
    last: Point
    heading: Heading
    whole: bool


def march(
    problem: OrbitProblem, last: Point, heading: Heading, steps: Steps, places: Sequence[Sequence[float]],
    sizes: Sizes, wanted: int,
) -> March:  # fmt: skip
    """Take steps from a point for as long as nothing lies between neighbours.

    It is left to single steps to look at what may be a special point, the end of the range, a tangent that turns or a
    multiplier that jumps at steps near the smallest, another number of cells, an orbit passed before, or no orbit.

    Parameters
    ----------
    problem : OrbitProblem
        The orbits, over one parameter.
    last : Point
        Where to begin.
    heading : Heading
        How the branch goes on there.
    steps : Steps
        How far to step.
    places : sequence of (float, float, float)
        Unknowns of the first orbit, taken from each of its periods on.
    sizes : Sizes
        Of motions, outside which no step begins.
    wanted : int
        Steps, at most; no more than a block is taken.
    """
    course = _Course(problem, last, heading, places)
    least, wanted = PATIENT * steps.least, min(wanted, BLOCK)
    while len(course.passed) < wanted:
        if course.step <= least or not sizes.least <= course.size() <= sizes.most:
            break
        verdict = course.attempt()
        if verdict == LEAVE:
            break
        if verdict == SHORTEN:
            course.step *= 0.5
        else:
            course.accept(steps.most)
    return course.result(len(course.passed) == wanted)


class _Room:
    """What the kernel `correct` fills."""

    def __init__(self, extrema: int) -> None:
        self.u, self.image, self.lin, self.bend = (
            np.empty(3),
            np.empty(2),
            np.empty((2, 3)),
            np.empty((3, 2, 2)),
        )
        self.counts, self.turns, self.clock = np.empty(2, dtype=np.int64), np.empty((extrema, 8)), np.empty(1)
        self.turned = self.iterations = 0
        self.residual = 0.0


class _Course:
    """Where steps have arrived, and the step that is tried."""

    def __init__(self, problem: OrbitProblem, last: Point, heading: Heading, places: Sequence[Any]) -> None:
        from dynamics.kernels.correcting import correct

        self.problem, self.first, self.places, self.corrected = problem, last, places, correct
        self.low, self.high = problem.reach(last.u)
        self.rest: list[float] = problem.rest.tolist()
        self.driven = problem.driven
        self.tables, self.two = problem.rooms(last.u), len(last.levels) == 2
        number = max(ROOM * problem.periods, len(last.extrema))
        self.known, self.tried = _Room(number), _Room(number)
        self.u: list[float] = last.u.tolist()
        self.tangent, self.bend = heading.tangent.tolist(), heading.bend.tolist()
        self.half, self.step = heading.half.tolist(), heading.step
        self.trace, self.determinant, self.play = last.trace, last.determinant, float(last.levels[0])
        self.trends = problem.trends(last, heading.tangent)
        self.rates = problem.rates(last.extrema_slope, heading.tangent)
        self.counts, self.extrema = list(last.counts), last.extrema.tolist()
        self.passed: list[tuple[float, float, float, float, float, int, int, int]] = []
        self.trial: Any = None

    def size(self) -> float:
        """Size of the motion through the last point, over the scale, as of `BranchProblem.size_of`."""
        x, v, _ = self.u
        away: float = WIDTH * max(abs(x - self.rest[0]), abs(v - self.rest[1]))
        return min(max(abs(x), abs(v)), max(self.driven, away))

    def attempt(self) -> int:
        """Try a step; what is to be done with it."""
        problem, room, step = self.problem, self.tried, self.step
        (x, v, p), (t0, t1, t2), (b0, b1, b2) = self.u, self.tangent, self.bend
        ahead = p + step * (t2 + step * b2)
        if not self.low <= ahead <= self.high:
            return LEAVE
        room.u[:] = x + step * (t0 + step * b0), v + step * (t1 + step * b1), ahead
        flag, room.turned, room.iterations, room.residual = self.corrected(
            problem.origin, problem.ways, room.u, np.array(self.tangent), problem.scale, problem.periods, LIMIT,
            room.image, room.lin, room.bend, room.counts, room.turns, room.clock, self.tables,
        )  # fmt: skip
        if flag != 0 or room.iterations > ITERATIONS:
            return SHORTEN
        u = room.u.tolist()
        s0, s1, s2 = u[0] - x, u[1] - v, u[2] - p
        (a, b, c), (d, e, f) = room.lin.tolist()
        trace, a, e = a + e, a - 1.0, e - 1.0
        n0, n1, n2 = b * f - c * e, c * d - a * f, a * e - b * d
        size, square = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2), s0 * s0 + s1 * s1 + s2 * s2
        if room.turned > len(room.turns) or u[2] in (0.0, 1.0) or not size > 0.0:
            return LEAVE
        if n0 * s0 + n1 * s1 + n2 * s2 < 0.0:  # on the side of the step
            size = -size
        tangent = [n0 / size, n1 / size, n2 / size]
        if (
            math.sqrt(square) > ASTRAY * step
            or tangent[0] * t0 + tangent[1] * t1 + tangent[2] * t2 < OPTIONS.corner
        ):
            return SHORTEN
        if abs(trace - self.trace) > OPTIONS.multiplier_jump * max(1.0, abs(self.trace)):
            return SHORTEN
        turning = shrinking = 0.0
        for along, ((aa, ab), (ba, bb)) in zip(tangent, room.bend.tolist(), strict=True):
            turning += along * (aa + bb)
            shrinking += along * ((e + 1.0) * aa + (a + 1.0) * bb - d * ab - b * ba)
        trends = shrinking - turning, shrinking + turning
        return self._look(u, tangent, trace, trends, square)

    def _look(
        self, u: list[float], tangent: list[float], trace: float, trends: tuple[float, float], square: float
    ) -> int:  # fmt: skip
        """Whether anything lies between the last point and the one that is tried."""
        problem, room, (x, v, p) = self.problem, self.tried, self.u
        at = self.tables[5][2]
        packed = at.tolist()
        play, determinant = packed[6], problem.determinant(packed, float(room.clock[0]))
        half = self.half
        if problem.periods % 2 == 0:
            half = self._half_way(at)
            fallen = max(abs(half[0]), abs(half[1])) < FALLEN * max(abs(self.half[0]), abs(self.half[1]))
            if fallen or half[0] * self.half[0] + half[1] * self.half[1] < 0.0:
                return LEAVE
        det, old, length = self.determinant, self.trace, math.sqrt(square)
        fold, flip = 1.0 + det - old, 1.0 + det + old
        folded, flipped = 1.0 + determinant - trace, 1.0 + determinant + trace
        rise, climb = self.trends, trends
        reach = SWAY * length * (max(abs(rise[0]), abs(rise[1])) + max(abs(climb[0]), abs(climb[1])))
        if min(abs(fold), abs(folded), abs(flip), abs(flipped)) < reach and (
            hides(fold, rise[0], folded, climb[0], length) or hides(flip, rise[1], flipped, climb[1], length)
        ):
            return SHORTEN
        if fold * folded < 0.0 or flip * flipped < 0.0 or (det - 1.0) * (determinant - 1.0) < 0.0:
            return LEAVE
        rows, counts, (t0, t1, t2) = room.turns[: room.turned].tolist(), room.counts.tolist(), tangent
        extrema = [row[:3] for row in rows]
        rates = [t0 * row[5] + t1 * row[6] + t2 * row[7] for row in rows]
        if not self.two or (self.play > 0.0 and play > 0.0):
            if not alike(self.extrema, extrema, self.play, play, self.two):
                return LEAVE
            if counts != self.counts or self._grazes(extrema, rates, play, tangent[2], length):
                return SHORTEN
        for place in self.places:
            if (place[0] - x) ** 2 + (place[1] - v) ** 2 + (place[2] - p) ** 2 <= FAR * square:
                return LEAVE
        self.trial = u, tangent, trace, trends, determinant, play, counts, extrema, rates, half, length
        return TAKE

    def _grazes(self, extrema: Rows, rates: list[float], play: float, ahead: float, length: float) -> bool:
        """Whether an extremum may touch a flank twice on the way to the point that is tried."""
        problem = self.problem
        old, scale = self.play, problem.scale
        begin, end = problem.widening * self.tangent[2], problem.widening * ahead
        least, more = SWAY * length * scale, abs(begin) + abs(end)
        for (_, x, _), rise, (_, later, _), climb in zip(
            self.extrema, self.rates, extrema, rates, strict=True
        ):
            reach = least * (abs(rise) + abs(climb) + more)
            if abs(abs(x) - old) < reach or abs(abs(later) - play) < reach:
                signs = (1.0, -1.0) if self.two else (1.0,)
                levels = [sign * old for sign in signs], [sign * play for sign in signs]
                if touches_twice(x, rise, later, climb, levels, (begin, end), scale, length):
                    return True
        return False

    def _half_way(self, packed: Array) -> list[float]:
        """From the state that is tried to that half the period later, by the tables that it was found with."""
        coef, edge = self.tables[0]
        u, scale, halves = self.tried.u[:2], self.problem.scale, self.problem.periods // 2
        image = ExactFlow(packed, coef, edge).follow(u * scale, halves, derivatives=False).state
        ahead: list[float] = (image / scale - u).tolist()
        return ahead

    def accept(self, most: float) -> None:
        """Take the step that was tried, choose the next."""
        u, tangent, trace, trends, determinant, play, counts, extrema, rates, half, length = self.trial
        bent = 0.5 / length if length > STRAIGHT else 0.0
        self.bend = [bent * (n - t) for n, t in zip(tangent, self.tangent, strict=True)]
        self.u, self.tangent, self.half = u, tangent, half
        self.trace, self.trends, self.determinant, self.play = trace, trends, determinant, play
        self.counts, self.extrema, self.rates = counts, extrema, rates
        self.known, self.tried = self.tried, self.known
        spent = self.known.iterations
        self.passed.append((*u, trace, determinant, *counts, spent))
        if spent <= EASY:
            self.step = min(LONGER * self.step, most)

    def result(self, whole: bool) -> March:
        """What the steps have met."""
        problem, room = self.problem, self.known
        trail = np.array(self.passed).reshape(-1, 8)
        values = problem.low[0] + trail[:, 2] * (problem.high[0] - problem.low[0])
        heading = Heading(np.array(self.tangent), np.array(self.bend), np.array(self.half), self.step)
        last = self.first
        if self.passed:
            last = problem.point(
                room.u, room.image, room.lin, room.bend, room.counts, float(room.clock[0]), room.turns[: room.turned],
                room.iterations, room.residual,
            )  # fmt: skip
        counts, spent = trail[:, 5:7].astype(np.int64), int(trail[:, 7].sum())
        return March(trail[:, :3], values, trail[:, 3], trail[:, 4], counts, spent, last, heading, whole)


def alike(before: Rows, after: Rows, old: float, new: float, two: bool) -> bool:
    """Whether the extrema of neighbours follow one another, and lie on the same sides of D, of `old` and of `new`."""
    if len(before) != len(after):
        return False
    for (phase, a, bend), (later, b, turned) in zip(before, after, strict=True):
        if abs(later - phase) > NEAR or not bend * turned > 0.0 or not (a - old) * (b - new) > 0.0:
            return False
        if two and not (a + old) * (b + new) > 0.0:
            return False
    return True
