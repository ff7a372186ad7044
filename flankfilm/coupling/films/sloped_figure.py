"""A figure over places and loads whose slope by the load is known where it is known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from base import Array, Integers


@dataclass(frozen=True, eq=False)
class SlopedFigure:
    """Hermite's cubics over the loads, whose values and slopes follow cubic splines over the places.

    Slopes are those of the figure itself: of third order, and no values that scatter bend them.

    Attributes
    ----------
    place : ndarray, shape (places,)
        Rising.
    log_load : ndarray, shape (loads,)
        Logarithm of the load, rising.
    value, slope : ndarray, shape (places, loads)
        Figure and its derivative by the logarithm of the load.
    """

    place: Array
    log_load: Array
    value: Array
    slope: Array

    @cached_property
    def _pieces(self) -> Array:
        """Coefficients over places, the highest power first (4, places - 1, loads, 2)."""
        from scipy.interpolate import CubicSpline  # loads half of scipy

        return np.asarray(CubicSpline(self.place, np.stack([self.value, self.slope], axis=-1)).c)

    def at(self, place: Array, log_load: Array, derivative: int = 0) -> Array:
        """Figure, or its first derivative by the logarithm of the load, inside the grid; arrays of one shape."""
        i, j = _interval(self.place, place), _interval(self.log_load, log_load)
        ahead = (place - self.place[i])[..., None]
        low, high = (_polynomial(self._pieces[:, i, k], ahead) for k in (j, j + 1))
        step = self.log_load[j + 1] - self.log_load[j]
        t, rise = (log_load - self.log_load[j]) / step, high[..., 0] - low[..., 0]
        start, end = step * low[..., 1], step * high[..., 1]
        bend, twist = 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise
        if derivative:
            return np.asarray((start + t * (2.0 * bend + 3.0 * t * twist)) / step)
        return np.asarray(low[..., 0] + t * (start + t * (bend + t * twist)))


def _interval(knots: Array, at: Array) -> Integers:
    """Number of the interval between knots that holds each place."""
    return np.clip(np.searchsorted(knots, at, side="right") - 1, 0, knots.size - 2)


def _polynomial(coefficients: Array, x: Array) -> Array:
    """Value by coefficients (4, ...), the highest power first."""
    cubic, square, line, constant = coefficients
    return np.asarray(constant + x * (line + x * (square + x * cubic)))
