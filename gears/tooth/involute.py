"""The involute function and its inverse."""

from __future__ import annotations

import math

import numpy as np

from base import Array


def involute_function(tangent: float | Array) -> Array:
    """Involute function of an angle given by its tangent, inv a = tan a - a.

    Parameters
    ----------
    tangent : float or (n,) array
        tan a, which is the roll angle of the involute, rho / r_b [rad].

    Returns
    -------
    array like `tangent`
        inv a [rad].
    """
    roll = np.asarray(tangent, dtype=float)
    return np.asarray(roll - np.arctan(roll))


def tangent_from_involute(value: float) -> float:
    """Tangent of the angle whose involute function is `value`.

    Newton's method on f(x) = x - atan x - value. f is convex and increasing for x > 0, so from any point on
    the right of the root the iteration falls monotonically on it.

    Parameters
    ----------
    value : float
        inv a > 0 [rad].

    Returns
    -------
    float
        tan a.
    """
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"the involute function takes finite values above zero here, not {value!r}")
    root = min(value + math.pi / 2, math.cbrt(3.0 * value) * (1.0 + value) + value)
    for _ in range(60):
        step = (root - math.atan(root) - value) * (1.0 + root**2) / root**2
        root -= step
        if abs(step) <= 1e-15 * root:
            break
    return root
