"""Special points between neighbours on a branch, for any period map: signs find them, bracketing locates them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from base import Array
from dynamics.branch_problem import match_extrema
from dynamics.protocol import EPS
from dynamics.roots import along_chord
from dynamics.shooting import floquet_multipliers, is_stable, motion_label
from dynamics.special import SpecialPoint
from dynamics.stepwise.point import MapPoint

__all__ = ["Sign", "find_crossings", "locate"]


class RefinedMap(Protocol):
    """What locating asks of a period map."""

    @property
    def periods(self) -> int: ...

    @property
    def scale(self) -> float: ...

    def correct(self, guess: Array, across: Array) -> MapPoint | None:
        """Periodic orbit in the plane across . (u - guess) = 0, or None if Newton's method does not arrive."""
        ...

    def refined(self) -> RefinedMap:
        """The same map, more accurately, for an error estimate."""
        ...


@dataclass(frozen=True)
class Sign:
    """A quantity whose sign is watched.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling", "neimark-sacker" or "grazing".
    surface : int
        At a grazing, which level.
    kindred : int
        At a grazing, the sign of X'' of the extremum.
    phases : tuple of float
        At a grazing, where in the orbit's period the extremum lies at the two neighbours.
    """

    kind: str
    surface: int = -1
    kindred: int = 0
    phases: tuple[float, float] = (0.0, 0.0)

    def extremum(self, point: MapPoint, fraction: float) -> int:
        """Extremum that is meant, part of the way from one neighbour to the other; -1 if there is none."""
        first, last = self.phases
        phase = first + fraction * ((last - first + 0.5) % 1.0 - 0.5)
        gap = np.abs((point.extrema[:, 0] - phase + 0.5) % 1.0 - 0.5)
        gap[point.extrema[:, 2] * self.kindred <= 0.0] = np.inf
        at = int(np.argmin(gap)) if len(gap) else -1
        return at if at >= 0 and np.isfinite(gap[at]) else -1

    def measure(self, point: MapPoint, fraction: float) -> float:
        """Value of the quantity; nan if there is none."""
        if self.kind == "saddle-node":
            return point.fold
        if self.kind == "period-doubling":
            return point.flip
        if self.kind == "neimark-sacker":
            return point.torus
        at = self.extremum(point, fraction)
        return float(point.extrema[at, 1] - point.levels[self.surface]) if at >= 0 else math.nan


def find_crossings(a: MapPoint, b: MapPoint) -> tuple[list[Sign], bool]:
    """Changes of sign between two neighbours, and whether the grazings explain the change of the counts."""
    found: list[Sign] = []
    if a.fold * b.fold < 0.0:
        found.append(Sign("saddle-node"))
    if a.flip * b.flip < 0.0:
        found.append(Sign("period-doubling"))
    if a.torus * b.torus < 0.0:  # a pair only if |trace| < 2 there: `locate` decides
        found.append(Sign("neimark-sacker"))
    change = [0, 0]
    if len(a.levels) == 2 and min(a.levels[0], b.levels[0]) == 0.0:
        return found, True
    for i, j in match_extrema(a, b):
        kindred = 1 if a.extrema[i, 2] > 0.0 else -1
        for surface in range(len(a.levels)):
            before = a.extrema[i, 1] - a.levels[surface]
            after = b.extrema[j, 1] - b.levels[surface]
            if before * after < 0.0 or (after == 0.0 and before != 0.0):
                phases = (float(a.extrema[i, 0]), float(b.extrema[j, 0]))
                found.append(Sign("grazing", surface, kindred, phases))
                change[surface] += kindred if before > 0.0 else -kindred
    return found, change == [b.counts[0] - a.counts[0], b.counts[1] - a.counts[1]]


def locate(problem: RefinedMap, a: MapPoint, b: MapPoint, sign: Sign) -> tuple[SpecialPoint | None, bool]:
    """Special point between two neighbours, and whether the search arrived.

    A determinant of one with real multipliers is no Neimark-Sacker point: then there is none, and that is no failure.
    """
    point, fraction = _bracket(problem, a, b, sign)
    if point is None:
        return None, False
    if sign.kind == "neimark-sacker" and abs(point.trace) >= 2.0:
        return None, True
    finer = problem.refined()
    ends = [finer.correct(p.u, (b.u - a.u) / np.linalg.norm(b.u - a.u)) for p in (a, b)]
    error = math.inf
    if ends[0] is not None and ends[1] is not None:
        there, _ = _bracket(finer, ends[0], ends[1], sign)
        error = abs(there.value - point.value) if there is not None else math.inf
    multipliers = floquet_multipliers(point.trace, point.determinant)
    label, touch = motion_label(problem.periods, point.counts), {}
    if sign.kind == "grazing":
        phase, _, bend = point.extrema[sign.extremum(point, fraction)]
        label = motion_label(problem.periods, min(a.counts, b.counts), is_stable(multipliers))
        touch = {"tau": float(phase) * problem.periods * point.period, "acceleration": float(bend)}
    special = SpecialPoint(
        sign.kind, point.value, point.u[:2] * problem.scale, multipliers, label,
        max(error / max(abs(point.value), 1e-300), EPS), problem.periods, (1, -1, 0)[sign.surface], **touch,
    )  # fmt: skip
    return special, True


def _bracket(problem: RefinedMap, a: MapPoint, b: MapPoint, sign: Sign) -> tuple[MapPoint | None, float]:
    """Root search along the chord, each trial corrected on to the branch."""
    found = along_chord(problem.correct, sign.measure, a, b, 1e-14)
    return (None, math.nan) if found is None else found
