"""Special points between two neighbours on a branch: found by signs, located by Newton's method or by bracketing.

Likewise the period doubling of the branch of half the period that a doubled branch meets.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, Heading, MapPoint, Steps, match_extrema
from dynamics.branches.compiled_steps import March, march
from dynamics.branches.corrector import OrbitProblem, Point
from dynamics.branches.roots import along_chord
from dynamics.branches.sizes import Sizes
from dynamics.branches.special_orbits import PRODUCTS, Condition, special_orbit
from dynamics.model.protocol import EPS
from dynamics.orbits.shooting import is_stable, motion_label

P = TypeVar("P", bound=MapPoint)
Crossing = tuple[Condition, Condition]  # as it is at the one and at the other of two neighbours
FIRST, LAST = 1e-11, 1e-2  # of the range: from the last doubled orbit to where the parent is looked at
WIDER = 10.0
DOUBLING = (Condition("period-doubling"),) * 2


def find_crossings(a: MapPoint, b: MapPoint) -> tuple[list[Crossing], bool]:
    """Changes of sign between two neighbours, and whether the grazings explain the change of the counts."""
    crossings: list[Crossing] = [
        (Condition(kind),) * 2
        for kind, product in PRODUCTS.items()
        if getattr(a, product) * getattr(b, product) < 0.0
    ]
    levels_a, levels_b = a.levels.tolist(), b.levels.tolist()
    if len(levels_a) == 2 and min(levels_a[0], levels_b[0]) == 0.0:
        return crossings, True
    change = [0, 0]
    rows_a, rows_b = a.extrema.tolist(), b.extrema.tolist()
    for i, j in match_extrema(a, b):
        (phase_a, x_a, bend), (phase_b, x_b, _) = rows_a[i], rows_b[j]
        kindred = 1 if bend > 0.0 else -1
        for surface, (level_a, level_b) in enumerate(zip(levels_a, levels_b, strict=True)):
            before, after = x_a - level_a, x_b - level_b
            if before * after < 0.0 or (after == 0.0 and before != 0.0):
                touch = Condition("grazing", (1, -1)[surface], kindred, phase_a)
                crossings.append((touch, replace(touch, phase=phase_b)))
                change[surface] += kindred if before > 0.0 else -kindred
    return crossings, change == [b.counts[0] - a.counts[0], b.counts[1] - a.counts[1]]


def between(crossing: Crossing, fraction: float) -> Condition:
    """Condition part of the way from one neighbour to the other."""
    turn = (crossing[1].phase - crossing[0].phase + 0.5) % 1.0 - 0.5
    return replace(crossing[0], phase=(crossing[0].phase + fraction * turn) % 1.0)


def bracketed_orbit(
    problem: BranchProblem, ends: Sequence[P], crossing: Crossing, xtol: float
) -> tuple[P, Condition] | None:
    """Root search along the chord of neighbours, each trial corrected on to the branch; no corner stops it.

    Returns the special orbit and its condition, None if the branch cannot be followed there.
    """

    def measure(point: MapPoint, fraction: float) -> float:
        return between(crossing, fraction).measure(problem, point)

    root = along_chord(problem.correct, measure, ends[0], ends[1], xtol)
    return None if root is None else (root[0], between(crossing, root[1]))


def special_point(
    problem: BranchProblem, point: MapPoint, condition: Condition, ends: Sequence[MapPoint], error: float
) -> SpecialPoint:
    """Record of a special orbit between neighbours; `error` is that of the parameter."""
    multipliers = point.multipliers
    label = motion_label(problem.periods, point.counts)  # marginal: neither stable nor unstable
    touch: dict[str, float] = {}
    if condition.kind == "grazing":
        phase, _, acceleration = point.extrema[condition.nearest(point)]
        # counts of the neighbour on the side without the touch
        label = motion_label(problem.periods, min(p.counts for p in ends), is_stable(multipliers))
        touch = {"tau": float(phase) * problem.periods * point.period, "acceleration": float(acceleration)}
    return SpecialPoint(
        condition.kind, point.value, point.u[: point.size] * problem.scale, multipliers, label,
        max(error / max(abs(point.value), 1e-300), EPS), problem.periods, condition.boundary, **touch,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ExactBranch(OrbitProblem):
    """Orbits of the exact flow over one parameter, as `dynamics.branches.arclength` follows them."""

    def locate(self, last: Point, new: Point, crossing: Crossing) -> tuple[SpecialPoint | None, bool]:
        """Close in on a crossing; it is not located if the branch cannot be followed there."""
        at_a, at_b = (c.measure(self, p) for c, p in zip(crossing, (last, new), strict=True))
        chord = new.u - last.u
        fraction = at_a / (at_a - at_b) if at_a != at_b else 0.5
        point = special_orbit(self, between(crossing, fraction), last.u + fraction * chord)
        if point is None or not -0.02 <= float((point.u - last.u) @ chord / (chord @ chord)) <= 1.02:
            located = bracketed_orbit(self, (last, new), crossing, 1e-15)
            if located is None:
                return None, False
            point = located[0]
        condition = between(crossing, 0.5)
        error = self._error(point, condition)
        special = special_point(self, point, condition, (last, new), error)
        if condition.kind == "grazing":
            here = self.at(point.u)
            special = replace(special, stiffness=float(here.stiffness(here.frequency * special.tau)))
        return special, True

    def march(
        self, last: Point, heading: Heading, steps: Steps, places: list[list[float]], sizes: Sizes, wanted: int
    ) -> March:  # fmt: skip
        """Steps in a compiled loop."""
        return march(self, last, heading, steps, places, sizes, wanted)

    def _error(self, point: Point, condition: Condition) -> float:
        """Change of the parameter with tables of half the cell."""
        finer: Point | None = special_orbit(self, condition, point.u, refinement=2, limit=4)
        if finer is not None:
            return abs(finer.value - point.value)
        # next to a grazing: what the change of the measure amounts to
        there = self.evaluate(point.u, 2)
        slope = float(np.linalg.norm(condition.rows(self, point)[-1]))
        if there is None or not slope > 0.0:
            return math.inf
        off = abs(condition.measure(self, there) - condition.measure(self, point)) / slope
        return float(self.high[0] - self.low[0]) * off


def rejoining_point(problem: BranchProblem, last: MapPoint) -> SpecialPoint | None:
    """Period doubling of the branch of half the period beside a doubled orbit; None if none is found.

    The parent's orbit is looked at on both sides of the doubled one, ever farther away, until the product of
    (1 + multiplier) changes its sign; a doubling behind a grazing, where the product has a corner, is bracketed too.

    Parameters
    ----------
    problem : BranchProblem
        Of the doubled orbits.
    last : MapPoint
        The doubled orbit next to the meeting.
    """
    parent = replace(problem, periods=problem.periods // 2)
    guess = last.u.copy()
    guess[: last.size] += 0.5 * (problem.half_way(last) - last.u[: last.size])
    start = parent.correct(guess, parent.flat)
    if start is None:
        return None
    before: dict[float, MapPoint] = {1.0: start, -1.0: start}
    off = FIRST
    while off < LAST and before:  # the nearest doubling, whichever side it is on
        for way, near in list(before.items()):
            there = _beside(parent, start, near, way * off)
            if there is None:
                del before[way]
                continue
            if near.flip * there.flip <= 0.0:
                doubling, arrived = parent.locate(near, there, DOUBLING)
                if doubling is not None and arrived:
                    return doubling
                del before[way]
                continue
            before[way] = there
        off *= WIDER
    return None


def _beside(parent: BranchProblem, start: MapPoint, before: MapPoint, off: float) -> MapPoint | None:
    """Orbit of the parent's branch a distance of the parameter away from the start."""
    along: Array = before.tangent(parent.flat)
    step = start.u[-1] + off - before.u[-1]
    guess = before.u + (step / along[-1] if along[-1] else 0.0) * along
    guess[-1] = start.u[-1] + off
    orbit: MapPoint | None = parent.correct(guess, parent.flat)
    return orbit
