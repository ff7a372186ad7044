"""Roots of functions that cost much and may be lost on the way."""

from __future__ import annotations

import math
from collections.abc import Callable

__all__ = ["bracketed"]


def bracketed(
    measure: Callable[[float], float], low: float, high: float, *, xtol: float, rtol: float = 8.9e-16
) -> float | None:
    """Root between two values by Brent's method; None if the function is lost or the trials do not suffice.

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

    def known(value: float) -> float:
        found = measure(value)
        if not math.isfinite(found):
            raise _LostError
        return found

    try:
        return float(brentq(known, low, high, xtol=xtol, rtol=rtol, maxiter=100))
    except (_LostError, RuntimeError):  # RuntimeError: not within the trials
        return None


class _LostError(Exception):
    """The function has no value there."""
