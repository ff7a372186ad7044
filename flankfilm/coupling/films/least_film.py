"""Minimum film over the smooth parts of the path, from films at equal steps, and what sampling makes of it.

Films stand at the middles of equal steps, so that the minimum may lie between two of them, or half a step beyond the
first or last of a part: at the ends of the path, and where the load steps since a pair comes or goes.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from base import Array

STEP = 0.05
"""Smallest change of the load's logarithm between two films that may be a step of it."""

STEEPER = 4.0
"""How much more a step changes than its neighbours do: the load of relieved teeth grows without one."""

_HALF_BEYOND = np.array([1.875, -1.25, 0.375])  # parabola through films at 0, 1 and 2, at -1/2


def parts_of(load: Array) -> list[slice]:
    """Films between steps of the load (n,)."""
    change = np.abs(np.diff(np.log(load)))
    beside = np.maximum(np.append(0.0, change[:-1]), np.append(change[1:], 0.0))
    steps = np.flatnonzero((change > STEP) & (change > STEEPER * beside)) + 1
    ends = [0, *steps.tolist(), load.size]
    return [slice(first, last) for first, last in pairwise(ends)]


def least_of(film: Array, load: Array) -> tuple[float, float]:
    """Minimum film [m] of smooth parts, and how far the parabolas that give it may be off [m].

    Parameters
    ----------
    film, load : (n,) arrays
        In the order of the path [m], [N/m].
    """
    candidates = [candidate for part in parts_of(load) for candidate in _candidates(film[part])]
    least = min(value for value, _ in candidates)
    return least, max(off for value, off in candidates if value - off <= least)


def least_sampled(film: Array) -> tuple[float, float]:
    """Minimum of films whose loads scatter from place to place, and its change to the farther of its neighbours [m].

    So they do where cells of lines of contact come by: no curve through them says more.
    """
    at = int(np.argmin(film))
    beside = film[max(at - 1, 0) : at + 2]
    return float(film[at]), float(beside.max() - film[at])


def _candidates(film: Array) -> list[tuple[float, float]]:
    """Minimum values within and at both ends of a smooth part, each with its error."""
    if film.size < 3:
        return [(float(film.min()), float(np.ptp(film)))]
    candidates = []
    for start in (film[:3], film[:-4:-1]):
        straight = 1.5 * start[0] - 0.5 * start[1]
        value = float(max(_HALF_BEYOND @ start, 0.5 * start[0]))  # a curve that bends within a step or two
        candidates.append((value, abs(value - float(straight))))
    at = int(np.argmin(film))
    if 0 < at < film.size - 1:
        before, here, after = film[at - 1 : at + 2].tolist()
        curve, slope = before - 2.0 * here + after, 0.5 * (after - before)
        lower = 0.5 * slope**2 / curve if curve > 0.0 else 0.0
        candidates.append((here - lower, lower))
    return candidates
