r"""What films prop two flanks apart by, as a function of place and force, around solved films.

Near a film solved at the force :math:`F_0` the prop follows

.. math:: s(F) = s_0 \, (F/F_0)^{-n}, \qquad n = F_0 / (k \, s_0),

which meets value and slope :math:`ds/dF = -1/k` there, stays positive and falls with the force: the form that
every film formula has. Iterated with new films it needs two or three rounds, where a straight line
can turn negative at small forces.

Behind a meniscus that stays in place n is ten and more, since a heavier contact widens towards it. A lighter
one leaves it behind and is flooded: its prop S, which follows a power law :math:`m` of its own, bounds the law,

.. math:: s(F) = \frac{S_0 \, (F/F_0)^{-m}}{1 + c \, (F/F_0)^r},
   \qquad c = \frac{S_0}{s_0} - 1, \quad r = (n - m) \frac{1 + c}{c},

with the same value and slope at :math:`F_0`.

Between two films along the path, what each says of the force in question
is weighted linearly: place changes radius and speed by little from one film to the next.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


_LEAST_RATIO = 0.01
_LARGEST_LOGARITHM = 300.0


@dataclass(frozen=True, eq=False)
class FilmLaw:
    """Films along the path of contact, as load sharing takes them.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank at the films, rising [m].
    force : ndarray, shape (n,)
        Force at which each film was solved [N].
    prop : ndarray, shape (n,)
        Prop there [m].
    exponent : ndarray, shape (n,)
        n, at least zero [-].
    flooded_prop, flooded_exponent : ndarray, shape (n,), optional
        S_0 [m] and m [-] of the flooded contact, for films that a meniscus holds. Where S_0 is no larger
        than s_0, or m no less than n, the plain power law stands.
    """

    rho1: Array
    force: Array
    prop: Array
    exponent: Array
    flooded_prop: Array | None = None
    flooded_exponent: Array | None = None

    def __call__(self, rho1: Array, forces: Array) -> tuple[Array, Array]:
        """Prop [m] and its slope [m/N] at given places and forces.

        A force below a hundredth of a solved one is taken as that hundredth: the power law would grow
        without bound where the pair lets go. Places beyond the films have the nearest one.

        Parameters
        ----------
        rho1 : ndarray
            Places [m]; NaN where no film is wanted: zero there.
        forces : ndarray
            Of the same shape [N].
        """
        (first, second), share = self._neighbours(rho1)
        told = [self._one(film, forces) for film in (first, second)]
        prop, slope = ((1 - share) * a + share * b for a, b in zip(*told, strict=True))
        some = np.isfinite(rho1)
        return np.where(some, prop, 0.0), np.where(some, slope, 0.0)

    def stiffness(self, rho1: Array) -> Array:
        """Film stiffness at the solved forces, infinite at NaN [N/m]."""
        (first, second), share = self._neighbours(rho1)
        yielding = self.exponent * self.prop / self.force
        between = np.where(np.isfinite(rho1), (1 - share) * yielding[first] + share * yielding[second], 0.0)
        return np.divide(1.0, between, out=np.full_like(between, np.inf), where=between > 0)

    def _neighbours(self, rho1: Array) -> tuple[tuple[NDArray[np.intp], NDArray[np.intp]], Array]:
        """Films on either side of each place, and the share of the second."""
        place = np.clip(np.nan_to_num(rho1), self.rho1[0], self.rho1[-1])
        second = np.clip(np.searchsorted(self.rho1, place), min(1, self.rho1.size - 1), self.rho1.size - 1)
        first = np.maximum(second - 1, 0)
        step = self.rho1[second] - self.rho1[first]
        share = np.divide(place - self.rho1[first], step, out=np.zeros_like(place), where=step > 0)
        return (first, second), share

    def _one(self, film: NDArray[np.intp], forces: Array) -> tuple[Array, Array]:
        """Prop and slope by one film each."""
        solved, exponent = self.force[film], self.exponent[film]
        ratio = np.maximum(forces / solved, _LEAST_RATIO)
        if self.flooded_prop is None or self.flooded_exponent is None:
            prop, local = self.prop[film] * ratio**-exponent, exponent
        else:
            flooded, slow = self.flooded_prop[film], self.flooded_exponent[film]
            prop, local = _bounded(self.prop[film], exponent, flooded, slow, ratio)
        slope = np.where(ratio > _LEAST_RATIO, -local * prop / (ratio * solved), 0.0)
        return prop, slope


def _bounded(prop: Array, exponent: Array, flooded: Array, slow: Array, ratio: Array) -> tuple[Array, Array]:
    """Prop and its local exponent by the law that the flooded film bounds."""
    lacking = flooded / prop - 1.0
    bounds = (lacking > 0.0) & (exponent > slow)
    c = np.where(bounds, lacking, 1.0)
    steep = (exponent - slow) * (1.0 + c) / c
    choked = c * np.exp(np.minimum(steep * np.log(ratio), _LARGEST_LOGARITHM))
    held = flooded * ratio**-slow / (1.0 + choked)
    return (
        np.where(bounds, held, prop * ratio**-exponent),
        np.where(bounds, slow + steep * choked / (1.0 + choked), exponent),
    )


@dataclass(frozen=True, eq=False)
class PlacedFilm:
    """A film law at fixed places, in the form of `gears.share_load`."""

    law: FilmLaw
    rho1: Array

    def approach(self, force: Array) -> Array:
        """Prop of each pair, shape (positions, pairs) [m]."""
        return self.law(self.rho1, force)[0]

    def slope(self, force: Array) -> Array:
        """Derivative of the prop by the force, shape (positions, pairs) [m/N]."""
        return self.law(self.rho1, force)[1]
