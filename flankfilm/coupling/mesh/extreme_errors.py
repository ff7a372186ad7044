"""Errors of the minimum and the maximum of values that have errors, and of the maximum of a curve by its samples."""

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


def of_sampled_greatest(values: Array) -> float:
    """Relative error of the maximum of a positive curve, of which samples at even steps are known.

    The curve may step down from its maximum, or turn there, anywhere within a step of the largest sample: half of what
    it changes by in the step beside it, on the side on which it changes less, or in the steps beyond its neighbours if
    that is more. Of curves with a step or a corner this is at least half of what is left out; of smooth ones more.

    Examples
    --------
    >>> of_sampled_greatest(np.array([5.0, 10.0, 9.8, 9.6]))
    0.01
    >>> of_sampled_greatest(np.array([3.0]))
    nan
    """
    at, steps = int(np.argmax(values)), np.abs(np.diff(values))
    if not steps.size or values[at] <= 0.0:
        return float("nan")
    sides = ((at - 1, at), (at - 2, at + 1))
    changes = [
        min(float(steps[k]) for k in pair if 0 <= k < steps.size) for pair in sides if _known(pair, steps)
    ]
    return 0.5 * max(changes) / float(values[at])


def _known(places: tuple[int, int], steps: Array) -> bool:
    """Whether one of the steps is there."""
    return any(0 <= place < steps.size for place in places)
