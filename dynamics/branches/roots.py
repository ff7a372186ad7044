"""Roots of functions that cost much and may be lost on the way."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TypeVar

import numpy as np

from base import Array
from dynamics.branches.branch_problem import MapPoint

P = TypeVar("P", bound=MapPoint)


def bracketed(
    measure: Callable[[float], float], low: float, high: float, *, xtol: float, rtol: float = 8.9e-16
) -> float | None:
    """Root between two values by Brent's method; None if the function is lost or keeps its sign, or trials run out.

    Parameters
    ----------
    measure : callable
        Function of different signs at both ends; nan where it is lost.
    low, high : float
        The ends.
    xtol, rtol : float
        Absolute and relative width of the bracket at which to stop.
    """
    from scipy.optimize import brentq

    try:
        return float(brentq(measure, low, high, xtol=xtol, rtol=rtol, maxiter=100))
    except (RuntimeError, ValueError):  # not within the trials; lost, or the sign does not change
        return None


def along_chord(
    correct: Callable[[Array, Array], P | None], measure: Callable[[P, float], float], a: P, b: P, xtol: float
) -> tuple[P, float] | None:
    """Root of a quantity between two neighbours on a branch, each trial corrected on to the branch.

    Parameters
    ----------
    correct : callable
        Point of the branch in the plane through the first argument and across the second; None if there is none.
    measure : callable
        Quantity of a point, part of the way between the neighbours.
    a, b : point
        The neighbours.
    xtol : float
        Width of the bracket at which to stop, a part of the way.

    Returns
    -------
    tuple of point and float, or None
        The point, and which part of the way it lies.
    """
    chord = b.u - a.u
    row = chord / np.linalg.norm(chord)
    points: dict[float, P] = {0.0: a, 1.0: b}

    def value(fraction: float) -> float:
        point = points.get(fraction) or correct(a.u + fraction * chord, row)
        if point is None:
            return math.nan
        points[fraction] = point
        return measure(point, fraction)

    root = bracketed(value, 0.0, 1.0, xtol=xtol)
    return None if root is None or not math.isfinite(value(root)) else (points[root], root)
