"""Errors of the minimum and the maximum of values that have errors."""

from __future__ import annotations

import numpy as np

from base import Array


def of_greatest(values: Array, errors: Array) -> float:
    """Relative error of the maximum of positive values, by the relative errors of all; 0 where all are 0.

    The maximum is off as the values near it are: one that is small may err by far more.

    Examples
    --------
    >>> round(of_greatest(np.array([10.0, 9.9, 1.0]), np.array([0.01, 0.03, 0.5])), 4)
    0.0197
    """
    most = float(values.max())
    if most <= 0.0:
        return 0.0
    above, below = np.max(values * (1.0 + errors)), np.max(values * (1.0 - errors))
    return float(max(above / most - 1.0, 1.0 - below / most))


def of_least(values: Array, errors: Array) -> float:
    """Relative error of the minimum of positive values, by the relative errors of all.

    Examples
    --------
    >>> round(of_least(np.array([1.0, 1.01, 9.0]), np.array([0.01, 0.03, 0.5])), 4)
    0.0203
    """
    least = float(values.min())
    above, below = np.min(values * (1.0 + errors)), np.min(values * (1.0 - errors))
    return float(max(above / least - 1.0, 1.0 - below / least))
