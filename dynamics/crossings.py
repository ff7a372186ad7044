"""Special points between two neighbours on a branch: found by signs, located by Newton's method or by bracketing."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from dynamics.branch_problem import match_extrema
from dynamics.conditions import Condition, special_orbit
from dynamics.corrector import OrbitProblem, Point
from dynamics.protocol import EPS
from dynamics.roots import along_chord
from dynamics.shooting import floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["Crossing", "find_crossings", "locate"]

Crossing = tuple[Condition, Condition]  # as it is at the one and at the other of two neighbours


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

    def measure(point: Point, fraction: float) -> float:
        return between(crossing, fraction).measure(problem, point)

    found = along_chord(problem.correct, measure, a, b, 1e-15)
    return None if found is None else found[0]
