"""Special points between two neighbours on a branch: found by signs, located on the branch to rounding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.corrector import BranchProblem, Point
from dynamics.shooting import EPS, floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint

__all__ = ["Crossing", "find_crossings", "locate", "match_extrema"]

FloatArray = npt.NDArray[np.float64]
NEAR = 0.05  # of the orbit's period: how far an extremum may move between neighbours


@dataclass(frozen=True, eq=False)
class Crossing:
    """A change of sign between two neighbours.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling" or "grazing".
    boundary : int
        At a grazing 1 or -1, else 0.
    kindred : int
        At a grazing the sign of X'' of the extremum, else 0.
    phases : tuple of float
        At a grazing the phase of the extremum at the two neighbours.
    """

    kind: str
    boundary: int = 0
    kindred: int = 0
    phases: tuple[float, float] = (0.0, 0.0)


def match_extrema(a: Point, b: Point) -> list[tuple[int, int]]:
    """Pairs of extrema of two neighbours that are each other's nearest in phase, and of one kind."""
    pairs: list[tuple[int, int]] = []
    if len(a.extrema) == 0 or len(b.extrema) == 0:
        return pairs
    gap = np.abs(a.extrema[:, None, 0] - b.extrema[None, :, 0])
    gap = np.minimum(gap, 1.0 - gap)
    gap[np.sign(a.extrema[:, None, 2]) != np.sign(b.extrema[None, :, 2])] = np.inf
    for i in range(len(gap)):
        j = int(np.argmin(gap[i]))
        if gap[i, j] < NEAR and int(np.argmin(gap[:, j])) == i:
            pairs.append((i, j))
    return pairs


def find_crossings(problem: BranchProblem, a: Point, b: Point) -> tuple[list[Crossing], bool]:
    """Changes of sign between two neighbours, and whether the grazings explain the change of the counts."""
    found = []
    if a.fold * b.fold < 0.0:
        found.append(Crossing("saddle-node"))
    if a.flip * b.flip < 0.0:
        found.append(Crossing("period-doubling"))
    change = np.zeros(2, dtype=np.int64)
    d_a, d_b = (problem.at(p.u).half_backlash for p in (a, b))
    for i, j in match_extrema(a, b) if min(d_a, d_b) > 0.0 else []:
        kindred = int(np.sign(a.extrema[i, 2]))
        for boundary in (1, -1):
            before = a.extrema[i, 1] - boundary * d_a
            after = b.extrema[j, 1] - boundary * d_b
            if before * after < 0.0 or (after == 0.0 and before != 0.0):
                phases = (float(a.extrema[i, 0]), float(b.extrema[j, 0]))
                found.append(Crossing("grazing", boundary, kindred, phases))
                change[0 if boundary == 1 else 1] += kindred * int(np.sign(before))
    seen = np.array(b.counts) - np.array(a.counts)
    return found, bool(np.all(change == seen) or min(d_a, d_b) == 0.0)


def locate(problem: BranchProblem, a: Point, b: Point, crossing: Crossing) -> SpecialPoint | None:
    """Close in on a crossing along the branch between two neighbours; None if the branch cannot be followed there."""
    from scipy.optimize import brentq

    chord = b.u - a.u
    row = chord / np.linalg.norm(chord)
    points: dict[float, Point] = {0.0: a, 1.0: b}

    def at(fraction: float, refinement: int = 1) -> Point | None:
        return problem.correct(a.u + fraction * chord, row, refinement)

    def measure(fraction: float) -> float:
        point = points.get(fraction) or at(fraction)
        if point is None:
            raise _LostError
        points[fraction] = point
        return _measure(problem, point, crossing, fraction)

    try:
        root = float(brentq(measure, 0.0, 1.0, xtol=1e-15, rtol=4.0 * EPS, maxiter=100))
        value = measure(root)
        slope = _steepness(measure, root, value)
    except (_LostError, ValueError):  # ValueError: the sign did not change after all
        return None
    point = points[root]
    finer = at(root, 2)
    error = abs(finer.value - point.value) if finer else np.inf
    if finer and slope > 0.0:
        off = abs(_measure(problem, finer, crossing, root)) / slope
        speed = abs(b.value - a.value) if crossing.kind != "saddle-node" else abs(b.value - a.value) * off
        error += off * speed
    multipliers = floquet_multipliers(point.trace, point.determinant)
    label = motion_label(problem.periods, point.counts)  # marginal: neither stable nor unstable
    touch = {}
    if crossing.kind == "grazing":
        here = problem.at(point.u)
        phase, _, acceleration = point.extrema[_nearest(point, crossing, root)]
        tau = float(phase) * problem.periods * here.period
        label = motion_label(problem.periods, min(a.counts, b.counts), is_stable(multipliers))
        touch = {"tau": tau, "acceleration": float(acceleration)}
        touch["stiffness"] = float(here.stiffness(here.frequency * tau))
    relative = max(float(error) / max(abs(point.value), 1e-300), EPS)
    return SpecialPoint(
        crossing.kind, point.value, point.state, multipliers, label, relative, crossing.boundary, **touch
    )  # fmt: skip


class _LostError(Exception):
    """The branch could not be followed to a point between two neighbours."""


def _steepness(measure: Callable[[float], float], root: float, value: float) -> float:
    """Size of the slope of a measure at its root, from a small step to whichever side has room."""
    step = 1e-4 if root < 0.5 else -1e-4
    return abs(measure(root + step) - value) / 1e-4


def _nearest(point: Point, crossing: Crossing, fraction: float) -> int:
    """Extremum that continues the one which crosses the boundary."""
    turn = (crossing.phases[1] - crossing.phases[0] + 0.5) % 1.0 - 0.5
    expected = crossing.phases[0] + fraction * turn
    gap = np.abs((point.extrema[:, 0] - expected + 0.5) % 1.0 - 0.5)
    gap[np.sign(point.extrema[:, 2]) != crossing.kindred] = np.inf
    return int(np.argmin(gap))


def _measure(problem: BranchProblem, point: Point, crossing: Crossing, fraction: float) -> float:
    """Quantity that is zero at the special point."""
    if crossing.kind == "saddle-node":
        return point.fold
    if crossing.kind == "period-doubling":
        return point.flip
    if len(point.extrema) == 0:
        raise _LostError
    x = float(point.extrema[_nearest(point, crossing, fraction), 1])
    return x - crossing.boundary * problem.at(point.u).half_backlash
