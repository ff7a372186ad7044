"""Where a branch of doubled period meets that of half its period: the latter's period doubling."""

from __future__ import annotations

from dataclasses import replace

from base import Array
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, MapPoint
from dynamics.branches.special_orbits import Condition

FIRST, LAST = 1e-11, 1e-2  # of the range: from the last doubled orbit to where the parent is looked at
WIDER = 10.0
DOUBLING = (Condition("period-doubling"),) * 2


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
