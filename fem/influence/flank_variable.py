r"""Argument of the series over a flank (``fem.influence.series``): -1 to 1 over a span of curvature radii.

It is linear in the curvature radius rho of the involute, or in the root of its distance from the tip corner,

.. math:: x = \frac{2 \rho - \rho_{low} - \rho_{high}}{\rho_{high} - \rho_{low}}, \qquad
   x = \frac{2 r - r_{near} - r_{far}}{r_{far} - r_{near}}, \quad r = \sqrt{\rho_{end} - \rho}.

The root moves a singularity at the corner, close beyond the span, away from it: a series in r follows a function that
begins there as d ln d with the distance d.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Self

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, record

__all__ = ["FlankVariable", "RootVariable", "stretched_points"]


@record
class FlankVariable:
    """Argument of a series, -1 to 1 over a span of curvature radii: linear in rho.

    Attributes
    ----------
    span : (float, float)
        Smallest and largest curvature radius.
    """

    span: tuple[float, float]

    @cached_property
    def _ends(self) -> tuple[float, float]:
        """Values at x = -1 and x = 1 of what x is linear in."""
        return self.span

    def _linear(self, rho: Array) -> Array:
        """Quantity that x is linear in."""
        return rho

    def scaled(self, length: float) -> Self:
        """Variable over a span that is longer by a factor."""
        low, high = self.span
        return replace(self, span=(low * length, high * length))

    def held(self, rho: Array) -> Array:
        """Curvature radii, those beyond the span moved to its end."""
        return np.clip(rho, *self.span)

    def unit(self, rho: Array, hold: bool = True) -> Array:
        """Argument x at curvature radii.

        Parameters
        ----------
        rho : array
        hold : bool
            Whether x stays between -1 and 1. For places that are known to be on the span it need not: rounding alone
            takes them beyond.
        """
        first, last = self._ends
        x = (2 * self._linear(rho) - first - last) / (last - first)
        return np.clip(x, -1.0, 1.0) if hold else np.asarray(x)

    def rho(self, unit: Array) -> Array:
        """Curvature radii at arguments x."""
        first, last = self._ends
        return np.asarray(0.5 * (first + last) + 0.5 * (last - first) * unit)

    def slope(self, rho: Array) -> tuple[Array, Array]:
        """First derivative x' by rho on the span, and the length l in the second one, x'' = x'/l."""
        low, high = self.span
        return np.asarray(2 / (high - low)), np.asarray(np.inf)

    def basis(self, rho: Array, degree: int, hold: bool = True) -> Array:
        """Chebyshev polynomials (..., degree + 1) at curvature radii (...)."""
        return np.asarray(chebyshev.chebvander(self.unit(rho, hold), degree), dtype=float)


@record
class RootVariable(FlankVariable):
    """Argument of a series, -1 to 1 over a span of curvature radii: linear in (rho_end - rho)^(1/2), -1 near the tip.

    Attributes
    ----------
    span : (float, float)
        Smallest and largest curvature radius.
    rho_end : float
        Curvature radius of the tip corner, beyond the span.
    """

    rho_end: float

    @cached_property
    def _ends(self) -> tuple[float, float]:
        low, high = self.span
        return float(np.sqrt(self.rho_end - high)), float(np.sqrt(self.rho_end - low))

    def _linear(self, rho: Array) -> Array:
        return np.sqrt(self.rho_end - self.held(rho))

    def scaled(self, length: float) -> Self:
        """Variable over a span that is longer by a factor."""
        return replace(super().scaled(length), rho_end=self.rho_end * length)

    def rho(self, unit: Array) -> Array:
        """Curvature radii at arguments x."""
        return np.asarray(self.rho_end - super().rho(unit) ** 2)

    def slope(self, rho: Array) -> tuple[Array, Array]:
        """First derivative x' by rho on the span, and the length l in the second one, x'' = x'/l."""
        near, far = self._ends
        away = self.rho_end - self.held(rho)
        return -1.0 / (np.sqrt(away) * (far - near)), 2 * away


def stretched_points(count: int) -> Array:
    """Chebyshev points from 1 to -1, stretched to include both ends (count,)."""
    unit = np.cos(np.pi * (np.arange(count) + 0.5) / count)
    return np.asarray(unit / unit[0])
