"""Which computed special point an event is: by kind, label and order along the branch, never by the number alone."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from dynamics.branches.branch import SpecialPoint
from dynamics.inverse.events import Event

Line = Sequence[SpecialPoint]  # special points of one branch, in their order along it
Partners = tuple[SpecialPoint | None, ...]


def match(lines: Sequence[Line], events: Sequence[Event], width: float) -> Partners:
    """Partner of each event, None where there is none.

    Events that name a branch are laid on one computed branch in their order, by dynamic programming over both
    directions and all branches. All others take the points that are left so that the sum of the losses is smallest.
    No point is taken twice.

    Parameters
    ----------
    lines : sequence of sequences of SpecialPoint
        Branches.
    events : sequence of Event
        Events.
    width : float
        Range of the parameter.
    """
    partners: list[SpecialPoint | None] = [None] * len(events)
    taken: set[int] = set()
    for name in dict.fromkeys(e.branch for e in events if e.branch):
        rows = [i for i, e in enumerate(events) if e.branch == name]
        chosen = _along([events[i] for i in rows], lines, width, taken)
        for i, point in zip(rows, chosen, strict=True):
            partners[i] = point
            taken |= set() if point is None else {id(point)}
    rest = [i for i, e in enumerate(events) if not e.branch]
    points = list({id(p): p for line in lines for p in line if id(p) not in taken}.values())
    for i, point in zip(rest, _freely([events[i] for i in rest], points, width), strict=True):
        partners[i] = point
    return tuple(partners)


def _along(events: list[Event], lines: Sequence[Line], width: float, taken: set[int]) -> Partners:
    """Best order-preserving choice on one branch."""
    best: tuple[float, Partners] = (math.inf, (None,) * len(events))
    for line in lines:
        free = [p for p in line if id(p) not in taken]
        for points in (free, free[::-1]):
            choice = _ordered(events, points, width)
            if choice[0] < best[0]:
                best = choice
    return best[1]


def _ordered(events: list[Event], points: list[SpecialPoint], width: float) -> tuple[float, Partners]:
    """Order-preserving choice of smallest loss: total[i, j] is that of the first i events on the first j points."""
    m, n = len(events), len(points)
    total = np.zeros((m + 1, n + 1))
    for i, event in enumerate(events):
        total[i + 1, 0] = total[i, 0] + event.loss(math.nan, width)
        for j, point in enumerate(points):
            total[i + 1, j + 1] = min(
                total[i + 1, j],
                total[i, j + 1] + event.loss(math.nan, width),
                total[i, j] + (event.loss(point.parameter, width) if event.fits(point) else math.inf),
            )
    partners: list[SpecialPoint | None] = [None] * m
    i, j = m, n
    while i > 0 and j > 0:
        if total[i, j] == total[i, j - 1]:
            j -= 1
        elif total[i, j] == total[i - 1, j] + events[i - 1].loss(math.nan, width):
            i -= 1
        else:
            partners[i - 1] = points[j - 1]
            i, j = i - 1, j - 1
    return float(total[m, n]), tuple(partners)


def _freely(events: list[Event], points: list[SpecialPoint], width: float) -> Partners:
    """One-to-one choice of smallest loss, without order."""
    from scipy.optimize import linear_sum_assignment

    if not events or not points:
        return (None,) * len(events)
    never = 1e6
    cost = np.full((len(events), len(points) + len(events)), never)
    for i, event in enumerate(events):
        cost[i, len(points) + i] = event.loss(math.nan, width) + 1e-9
        for j, point in enumerate(points):
            if event.fits(point):
                cost[i, j] = event.loss(point.parameter, width)
    _, columns = linear_sum_assignment(cost)
    return tuple(points[j] if j < len(points) else None for j in columns.tolist())
