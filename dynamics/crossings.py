"""Special points between two neighbours on a branch: found by signs, located by Newton's method or by bracketing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from dynamics.conditions import Condition, special_orbit
from dynamics.corrector import OrbitProblem, Point
from dynamics.shooting import EPS, floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["Crossing", "find_crossings", "locate", "match_extrema"]

FloatArray = npt.NDArray[np.float64]
NEAR = 0.05  # of the orbit's period: how far an extremum may move between neighbours
Crossing = tuple[Condition, Condition]  # as it is at the one and at the other of two neighbours


def match_extrema(a: Point, b: Point) -> list[tuple[int, int]]:
    """Pairs of extrema of two neighbours that are each other's nearest in phase, and of one kind."""
    if len(a.extrema) == 0 or len(b.extrema) == 0:
        return []
    gap = np.abs(a.extrema[:, None, 0] - b.extrema[None, :, 0])
    gap = np.minimum(gap, 1.0 - gap)
    gap[(a.extrema[:, None, 2] > 0.0) != (b.extrema[None, :, 2] > 0.0)] = np.inf
    there, back = gap.argmin(axis=1).tolist(), gap.argmin(axis=0).tolist()
    return [(i, j) for i, j in enumerate(there) if back[j] == i and gap[i, j] < NEAR]


def find_crossings(problem: OrbitProblem, a: Point, b: Point) -> tuple[list[Crossing], bool]:
    """Changes of sign between two neighbours, and whether the grazings explain the change of the counts."""
    found: list[Crossing] = []
    if a.fold * b.fold < 0.0:
        found.append((Condition("saddle-node"),) * 2)
    if a.flip * b.flip < 0.0:
        found.append((Condition("period-doubling"),) * 2)
    d_a, d_b = problem.play(a.u), problem.play(b.u)
    if min(d_a, d_b) == 0.0 and not problem.oscillator.one_sided:
        return found, True
    change = [0, 0]
    sides = (1,) if problem.oscillator.one_sided else (1, -1)
    rows_a, rows_b = a.extrema.tolist(), b.extrema.tolist()
    for i, j in match_extrema(a, b):
        (phase_a, x_a, bend), (phase_b, x_b, _) = rows_a[i], rows_b[j]
        kindred = 1 if bend > 0.0 else -1
        for boundary in sides:
            before, after = x_a - boundary * d_a, x_b - boundary * d_b
            if before * after < 0.0 or (after == 0.0 and before != 0.0):
                found.append(
                    (
                        Condition("grazing", boundary, kindred, phase_a),
                        Condition("grazing", boundary, kindred, phase_b),
                    )
                )
                change[0 if boundary == 1 else 1] += kindred if before > 0.0 else -kindred
    seen = [b.counts[0] - a.counts[0], b.counts[1] - a.counts[1]]
    return found, change == seen


def locate(problem: OrbitProblem, a: Point, b: Point, crossing: Crossing) -> SpecialPoint | None:
    """Close in on a crossing between two neighbours; None if the branch cannot be followed there."""
    at_a, at_b = (c.measure(problem, p) for c, p in zip(crossing, (a, b), strict=True))
    chord = b.u - a.u
    fraction = at_a / (at_a - at_b) if at_a != at_b else 0.5
    point = special_orbit(problem, between(crossing, fraction), a.u + fraction * chord)
    if point is not None and not -0.02 <= float((point.u - a.u) @ chord / (chord @ chord)) <= 1.02:
        point = None
    if point is None:
        point = _bracket(problem, a, b, crossing)
    if point is None:
        return None
    return record(problem, point, between(crossing, 0.5), min(a.counts, b.counts))


def between(crossing: Crossing, fraction: float) -> Condition:
    """Condition part of the way from one neighbour to the other."""
    turn = (crossing[1].phase - crossing[0].phase + 0.5) % 1.0 - 0.5
    return replace(crossing[0], phase=(crossing[0].phase + fraction * turn) % 1.0)


def record(
    problem: OrbitProblem, point: Point, condition: Condition, counts: tuple[int, int]
) -> SpecialPoint:
    """Record of a special orbit; `counts` are those of its neighbour on the side without the touch."""
    finer = special_orbit(problem, condition, point.u, refinement=2, limit=4)
    error = abs(finer.value - point.value) if finer else np.inf
    if finer is None:  # next to a grazing: what the change of the measure amounts to
        there = problem.evaluate(point.u, 2)
        slope = float(np.linalg.norm(condition.gradient(problem, point)))
        if there is not None and slope > 0.0:
            off = abs(condition.measure(problem, there) - condition.measure(problem, point)) / slope
            error = float(problem.high[0] - problem.low[0]) * off
    multipliers = floquet_multipliers(point.trace, point.determinant)
    label = motion_label(problem.periods, point.counts)  # marginal: neither stable nor unstable
    touch: dict[str, float] = {}
    if condition.kind == "grazing":
        here = problem.at(point.u)
        phase, _, acceleration = point.extrema[condition.nearest(point)]
        tau = float(phase) * problem.periods * here.period
        label = motion_label(problem.periods, counts, is_stable(multipliers))
        touch = {"tau": tau, "acceleration": float(acceleration)}
        touch["stiffness"] = float(here.stiffness(here.frequency * tau))
    relative = max(float(error) / max(abs(point.value), 1e-300), EPS)
    return SpecialPoint(
        condition.kind, point.value, point.state, multipliers, label, relative, problem.periods,
        condition.boundary, **touch
    )  # fmt: skip


def _bracket(problem: OrbitProblem, a: Point, b: Point, crossing: Crossing) -> Point | None:
    """Root search along the chord, each trial corrected on to the branch: slower, but no corner stops it."""
    from scipy.optimize import brentq

    chord = b.u - a.u
    row = chord / np.linalg.norm(chord)
    points: dict[float, Point] = {0.0: a, 1.0: b}

    def measure(fraction: float) -> float:
        point = points.get(fraction) or problem.correct(a.u + fraction * chord, row)
        if point is None:
            raise _LostError
        points[fraction] = point
        value = between(crossing, fraction).measure(problem, point)
        if not np.isfinite(value):
            raise _LostError
        return value

    search: Callable[..., float] = brentq
    try:
        root = float(search(measure, 0.0, 1.0, xtol=1e-15, rtol=4.0 * EPS, maxiter=100))
        measure(root)
    except (_LostError, ValueError):  # ValueError: the sign did not change after all
        return None
    return points[root]


class _LostError(Exception):
    """The branch could not be followed to a point between two neighbours."""
