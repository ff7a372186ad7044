"""Roots by bisection, which cannot fail on a monotonic function, for many at once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from base import Array, Booleans


def bisect(short: Callable[[Array], Booleans], low: Array, high: Array) -> Array:
    """Where a rising function reaches its target, between bounds.

    Parameters
    ----------
    short : callable
        Whether the function is below its target at places (n,).
    low, high : (n,) array
        Bounds; where the target lies outside, the nearer one is the answer.

    Returns
    -------
    (n,) array
        Places; the interval has shrunk to the spacing of floating-point numbers.
    """
    for _ in range(60):
        middle = 0.5 * (low + high)
        below = short(middle)
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return np.asarray(0.5 * (low + high))
