r"""Series over a flank: all that varies smoothly with the place of a load or of a point on it.

The place is the curvature radius rho of the involute, from one near the base circle to one near the tip. A series of
degree n is a sum of Chebyshev polynomials of a variable x(rho) from -1 to 1 (``fem.influence.flank_variable``),

.. math:: f(\rho) = \sum_{k=0}^{n} c_k \, T_k(x), \qquad
   f' = x' \sum_k c_k \, T_k'(x), \qquad f'' = x'^2 \sum_k c_k \, T_k''(x) + x'' \sum_k c_k \, T_k'(x).

Places beyond the span of x are moved to its end. A load at one place and a point at another have a series in both,

.. math:: f(\rho, \rho') = \sum_{k,l} c_{kl} \, T_k(x(\rho)) \, T_l(x(\rho')).

Samples give the coefficients: the series passes through them where there are as many as coefficients, and follows
them by least squares otherwise.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cached_property
from typing import ClassVar, Self, TypeVar

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, Integers, record
from fem.influence.flank_variable import FlankVariable

__all__ = ["CrossSeries", "FlankFit", "FlankSeries", "left_out", "of_teeth"]

SIZE_PLACES = 65
"""Places along the flank at which the size of a series is evaluated."""

S = TypeVar("S", bound="_Series")


@record
class FlankFit:
    """Coefficients of series from samples at places of a flank.

    Attributes
    ----------
    variable : FlankVariable
    unit : (samples,) array
        Arguments x of the samples.
    degree : int
    """

    variable: FlankVariable
    unit: Array
    degree: int

    @cached_property
    def basis(self) -> Array:
        """Chebyshev polynomials at the samples (samples, degree + 1)."""
        return np.asarray(chebyshev.chebvander(self.unit, self.degree), dtype=float)

    @property
    def interpolates(self) -> bool:
        """Whether there are as many samples as coefficients."""
        return len(self.unit) == self.degree + 1

    @cached_property
    def weights(self) -> Array:
        """Weights of the samples in the coefficients (degree + 1, samples): (pseudo-)inverse of ``basis``."""
        weights = np.linalg.inv(self.basis) if self.interpolates else np.linalg.pinv(self.basis)
        return np.asarray(weights, dtype=float)

    def series(self, samples: Array) -> FlankSeries:
        """Series of a scalar from its samples (samples,)."""
        coefficients = np.linalg.solve(self.basis, samples) if self.interpolates else self.weights @ samples
        return FlankSeries(self.variable, np.asarray(coefficients, dtype=float))

    def cross(self, samples: Array) -> CrossSeries:
        """Series of a scalar from its samples (samples, samples), rows and columns at the same places."""
        return CrossSeries(self.variable, np.asarray(self.weights @ samples @ self.weights.T))

    def error(self, series: FlankSeries | CrossSeries, samples: Array) -> Array:
        """What a series of this fit leaves out of its samples, largest (*value).

        By least squares its distance from them; what passes through all of them shows it by its decay.
        """
        return series.tail() if self.interpolates else series.remainder(self.unit, samples)


@record
class _Series:
    """What series of one and of two places have in common: coefficients by rising degree."""

    places: ClassVar[int]

    variable: FlankVariable
    coefficients: Array

    def scaled(self, length: float, divisor: float | Array) -> Self:
        """Give a series in modules and E* its size: places times a length, values over a divisor."""
        return replace(self, variable=self.variable.scaled(length), coefficients=self.coefficients / divisor)

    def plus(self, change: Array) -> Self:
        """Series with changed coefficients."""
        return replace(self, coefficients=self.coefficients + change)

    def upper_half(self) -> Self:
        """Terms that have more than half the degree, in either place, alone."""
        degree = np.max(np.indices(self.coefficients.shape[: self.places]), axis=0)
        upper = 2 * degree > len(self.coefficients)
        upper = upper.reshape(upper.shape + (1,) * (self.coefficients.ndim - self.places))
        return replace(self, coefficients=np.where(upper, self.coefficients, 0.0))

    def size(self) -> Array:
        """Largest absolute values (*value) on the span."""
        places = np.linspace(-1.0, 1.0, SIZE_PLACES)
        values = self.coefficients
        for _ in range(self.places):  # its axis goes, that of the places is the last
            values = np.asarray(chebyshev.chebval(places, values), dtype=float)
        return np.asarray(np.max(np.abs(values), axis=tuple(range(-self.places, 0))), dtype=float)

    def tail(self) -> Array:
        """Size (*value) of the terms beyond the last ones, were they to go on as they decay; twice, for aliasing."""
        degree = np.max(np.indices(self.coefficients.shape[: self.places]), axis=0)
        size = np.array([np.max(np.abs(self.coefficients[degree == k]), axis=0) for k in range(len(degree))])
        last, before = np.max(size[-3:], axis=0), np.max(size[-9 : max(len(size) - 6, 1)], axis=0)
        ratio = np.minimum((last / np.maximum(before, 1e-300)) ** (1 / 6), 0.9)
        return np.asarray(2 * last * ratio / (1 - ratio))


@record
class FlankSeries(_Series):
    """Smooth function of one place on a flank.

    Attributes
    ----------
    variable : FlankVariable
    coefficients : (n, ...) array
        Of the Chebyshev polynomials by rising degree; further axes are those of the value.
    """

    places = 1

    @cached_property
    def _derivatives(self) -> tuple[Array, Array]:
        """Coefficients of the first and of the second derivative by x."""
        first, second = (chebyshev.chebder(self.coefficients, times) for times in (1, 2))
        return np.asarray(first, dtype=float), np.asarray(second, dtype=float)

    def basis(self, rho: Array) -> Array:
        """Chebyshev polynomials (..., n) at curvature radii (...)."""
        return self.variable.basis(rho, len(self.coefficients) - 1)

    def at(self, rho: Array, derivative: int = 0, hold: bool = True) -> Array:
        """Value (..., *value) at curvature radii (...), or its derivative by rho.

        Parameters
        ----------
        rho : array
            Of one axis at the minimum, if values are tables.
        derivative : {0, 1, 2}
            Order; that of a place beyond the span is the one at its end.
        hold : bool
            As of `FlankVariable.unit`.
        """
        unit = self.variable.unit(rho, hold)
        if not derivative:
            return _sum(self.coefficients, unit)
        by_rho, length = (
            factor.reshape(factor.shape + (1,) * (self.coefficients.ndim - 1))
            for factor in self.variable.slope(rho)
        )
        slope = _sum(self._derivatives[0], unit)
        if derivative == 1:
            return np.asarray(slope * by_rho)
        bend = _sum(self._derivatives[1], unit)
        return np.asarray(bend * by_rho**2 + slope * by_rho / length)

    def remainder(self, unit: Array, samples: Array) -> Array:
        """Largest distances (*value) of samples (samples, *value) at arguments x from the series."""
        return np.asarray(np.max(np.abs(_recurrence(self.coefficients, unit) - samples), axis=0))


@record
class CrossSeries(_Series):
    """Smooth function of the places of a load and of a point, on flanks of one gear.

    Attributes
    ----------
    variable : FlankVariable
        Of either place.
    coefficients : (n, n, ...) array
        Of the products of Chebyshev polynomials, the load's first; further axes are those of the value.
    """

    places = 2

    @cached_property
    def _slopes(self) -> tuple[Array, Array]:
        """Coefficients of the derivatives by the load's and by the point's x."""
        by_load = chebyshev.chebder(self.coefficients)
        by_point = chebyshev.chebder(self.coefficients.T).T
        return np.asarray(by_load, dtype=float), np.asarray(by_point, dtype=float)

    def bases(self, load: Array, point: Array) -> tuple[Array, Array]:
        """Chebyshev polynomials (..., n) at the curvature radii of loads and of points (...)."""
        degree = len(self.coefficients) - 1
        return self.variable.basis(load, degree), self.variable.basis(point, degree)

    def at(self, load: Array, point: Array) -> Array:
        """Value (..., *value) by loads on points at curvature radii (...)."""
        return self.of_bases(*self.bases(load, point))

    def of_bases(self, loads: Array, points: Array) -> Array:
        """Value by Chebyshev polynomials (..., n) that several series of one variable and degree share."""
        if self.coefficients.ndim == 2:
            return np.asarray(np.sum((loads @ self.coefficients) * points, axis=-1))
        first, second, *value = self.coefficients.shape
        products = (loads[..., :, None] * points[..., None, :]).reshape(*loads.shape[:-1], first * second)
        return np.asarray(np.tensordot(products, self.coefficients.reshape(first * second, *value), axes=1))

    def slope(self, load: Array, point: Array) -> Array:
        """Derivative of a scalar value by rho as load and point move on together."""
        low, high = self.variable.span
        by_load, by_point = self._slopes
        loads, points = self.bases(load, point)
        slope = np.sum((loads[..., :-1] @ by_load) * points, axis=-1)
        slope = slope + np.sum((loads @ by_point) * points[..., :-1], axis=-1)
        return np.asarray(slope * 2 / (high - low))

    def remainder(self, unit: Array, samples: Array) -> Array:
        """Largest distance of samples (samples, samples) of a scalar at arguments x from the series."""
        basis = np.asarray(chebyshev.chebvander(unit, len(self.coefficients) - 1), dtype=float)
        return np.asarray(np.max(np.abs(basis @ self.coefficients @ basis.T - samples)))


def left_out(series: Mapping[int, S], size: float | Array) -> dict[int, S]:
    """What fits leave out of series of teeth, by its size (*value).

    A fit's remainder waves about zero faster than any of its terms, and is largest where these are: its shape is that
    of the upper half of the degrees.

    Parameters
    ----------
    series : mapping of int to FlankSeries or CrossSeries
    size : float or (*value) array
        Largest absolute value.

    Returns
    -------
    dict of int to FlankSeries or CrossSeries
    """
    upper = {tooth: of_tooth.upper_half() for tooth, of_tooth in series.items()}
    largest = np.max([of_tooth.size() for of_tooth in upper.values()], axis=0)
    part = np.divide(size, largest, out=np.zeros_like(largest), where=largest > 0.0)
    return {
        tooth: replace(of_tooth, coefficients=part * of_tooth.coefficients)
        for tooth, of_tooth in upper.items()
    }


def of_teeth(series: Mapping[int, CrossSeries], tooth: Integers, load: Array, point: Array) -> Array:
    """Value (..., *value) on teeth of any numbers, each by its series.

    Parameters
    ----------
    series : mapping of int to CrossSeries
        Of one variable and degree.
    tooth : (...) array of int
        0 is the value of one that has no series.
    load, point : (...) arrays
        Curvature radii.
    """
    tooth, load, point = np.broadcast_arrays(tooth, load, point)
    shared = next(iter(series.values()))
    loads, points = shared.bases(load, point)
    moved = np.zeros((*tooth.shape, *shared.coefficients.shape[2:]))
    for number, smooth in series.items():
        here = tooth == number
        if here.any():
            moved[here] = smooth.of_bases(loads[here], points[here])
    return moved


def _sum(coefficients: Array, unit: Array) -> Array:
    """Sum of a series (..., *value): of scalars and vectors by a recurrence, of larger values by one product."""
    if coefficients.ndim <= 2:
        return _recurrence(coefficients, unit)
    return np.asarray(np.tensordot(chebyshev.chebvander(unit, len(coefficients) - 1), coefficients, 1))


def _recurrence(coefficients: Array, unit: Array) -> Array:
    """Sum of a series (..., *value) by Clenshaw's recurrence."""
    values = np.asarray(chebyshev.chebval(unit, coefficients), dtype=float)
    axes = tuple(range(coefficients.ndim - 1))
    return np.moveaxis(values, axes, tuple(axis - len(axes) for axis in axes)) if axes else values
