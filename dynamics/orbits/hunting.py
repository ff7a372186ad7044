"""Fixed points of the map of any flow from many starts, by deflated Newton's method."""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from base import Array
from dynamics.flow.exact_flow import ExactFlow
from dynamics.flow.protocol import Flow

SAME = 1e-7  # over the scale: nearer points are one
CLOSE = 1e-12  # residual over the scale and the stretch of the map at a fixed point, tenfold what is aimed at
FAR = 1e3  # over the scale: where a search is given up
FREE = 1e-3  # minimum that deflation leaves of a step's denominator


@singledispatch
def hunted(
    flow: Flow, starts: Array, periods: int, limit: int, scale: float, points: Array, known: int
) -> tuple[int, int]:
    """Fixed points of the map over some periods from many starts.

    A point that is known pushes later searches away: the residual is multiplied by 1 + (scale/distance)^2 of each,
    which scales Newton's step by 1/(1 - step . grad log of that factor).

    Parameters
    ----------
    flow : Flow
        Whose map is meant; the exact one of a pair is searched by a compiled kernel.
    starts : ndarray, shape (k, dimension)
        States at tau = 0.
    periods, limit : int
        Excitation periods of the map, and iterations from each start.
    scale : float
        Size of the states.
    points : ndarray, shape (any, dimension)
        Its first rows are known already; new ones are added, all points of an orbit at once, as far as there is room.
    known : int
        Number of those rows.

    Returns
    -------
    tuple of int
        Rows that are known then, and periods used.
    """
    used = 0
    for start in starts:
        at, spent = _sought(flow, start, periods, limit, scale, points[:known])
        used += spent
        if at is None or _met(at, points[:known], scale):
            continue
        used += periods
        orbit = [at, *flow.follow(at, periods, derivatives=False).states[:-1]]
        for state in orbit:
            if known == len(points):
                return known, used
            if not _met(state, points[:known], scale):
                points[known] = state
                known += 1
    return known, used


@hunted.register
def _of_pair(
    flow: ExactFlow, starts: Array, periods: int, limit: int, scale: float, points: Array, known: int
) -> tuple[int, int]:
    from dynamics.kernels.searching import hunt

    last, used = hunt(flow.arrays, flow.space(), starts, periods, limit, scale, points, known)
    return int(last), int(used)


def _sought(
    flow: Flow, start: Array, periods: int, limit: int, scale: float, points: Array
) -> tuple[Array | None, int]:
    """Fixed point that Newton's method reaches from a start, None if it reaches none, and periods used."""
    at, near, stretch = start.copy(), np.inf, 1.0
    for iteration in range(limit):
        image = flow.follow(at, 1, periods - 1)
        if image.message:
            return None, (iteration + 1) * periods
        gap = image.state - at
        near, stretch = float(np.max(np.abs(gap))), max(1.0, float(np.max(np.abs(image.jacobian))))
        if near <= 0.1 * CLOSE * scale * stretch:
            break
        try:
            step: Array = np.asarray(np.linalg.solve(np.eye(len(at)) - image.jacobian, gap), dtype=np.float64)
        except np.linalg.LinAlgError:
            break
        left = 1.0 - _pull(at, step, points, scale)
        factor = 1.0 / left if abs(left) > FREE else 1.0
        factor *= min(1.0, 0.5 * scale / max(float(np.max(np.abs(factor * step))), 1e-300))
        trial = at + factor * step
        if not float(np.max(np.abs(trial))) < FAR * scale:
            return None, (iteration + 1) * periods
        at = trial
    return (at if near <= CLOSE * scale * stretch else None), (iteration + 1) * periods


def _pull(at: Array, step: Array, points: Array, scale: float) -> float:
    """Slope of the logarithm of the deflating factor along a step; 0 of one so short that it is the last."""
    if not float(np.max(np.abs(step))) > 1e-6 * scale:
        return 0.0
    off = (at - points) / scale
    square = np.sum(off**2, axis=1) + 1e-300
    return float(-2.0 * np.sum(off @ (step / scale) / (square * (1.0 + square))))


def _met(state: Array, points: Array, scale: float) -> bool:
    """Whether a state is one of the points."""
    return bool(np.any(np.max(np.abs(points - state), axis=1) < SAME * scale)) if len(points) else False
