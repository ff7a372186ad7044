r"""By how much films separate two flanks, as a function of place and force, around solved films.

Near a film solved at the force :math:`F_0` the separation follows

.. math:: s(F) = s_0 \, (F/F_0)^{-n}, \qquad n = F_0 / (k \, s_0),

which meets value and slope :math:`ds/dF = -1/k` there, stays positive and falls with the force: the form that
every film formula has. Iterated with new films it needs two or three rounds, where a straight line
can turn negative at small forces.

Behind a meniscus that stays in place n is up to hundreds, since a heavier contact widens towards it: the dry
contact's edge, :math:`b \propto \sqrt{F}`, comes nearer, by the distance :math:`d(F) = X (F/F_0)^{-1/2} - 1` in
half-widths, X the meniscus' place at :math:`F_0`. Where the edge reaches it the film ends; a lighter contact leaves
it behind and is flooded, with the separation :math:`S_0 (F/F_0)^{-m}`, or what two flooded films follow. In between

.. math:: s(F) = \frac{S_0 \, (F/F_0)^{-m}}{1 + c \, (d_0/d)^q},
   \qquad c = \frac{S_0}{s_0} - 1, \quad q = 2 (n - m) \frac{1 + c}{c} \frac{X - 1}{X},

with the same value and slope at :math:`F_0`; q comes out near one for line contacts.

Between two films along the path, what each gives at the force in question
is weighted linearly: place changes radius and speed by little from one film to the next. Where a pair comes or goes
the force changes by a factor between them, and n with it (0.1 at heavy, 1 at light loads): from the force of one film
to that of the other :math:`\ln s` is the cubic in :math:`\ln F` that meets both, for either of them; where the forces
differ by less than a fourth the separations differ by the place, and n is linear.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base import Array

if TYPE_CHECKING:
    from gears import GearPair

BEYOND = 0.5
"""Steps between films by which a law goes on beyond the first and the last."""

_ALIKE = 0.25
"""Logarithm of the ratio of two forces below which films differ by their places rather than by their forces."""

_LEAST_RATIO = 0.01
_LEAST_DISTANCE = 1e-12
_LARGEST_LOGARITHM = 300.0


@dataclass(frozen=True, eq=False)
class HeldMeniscus:
    """What bounds films behind a meniscus that stays in place, at the solved forces.

    Attributes
    ----------
    place : ndarray, shape (n,)
        X, distance of the meniscus from the middle of the contact, over the half-width [-]; above one.
    flooded_separation, flooded_exponent : ndarray, shape (n,)
        S_0 [m] and m [-] of the flooded contact.
    """

    place: Array
    flooded_separation: Array
    flooded_exponent: Array

    def bound(
        self,
        film: NDArray[np.intp],
        solved: tuple[Array, Array],
        ratio: Array,
        flooded: tuple[Array, Array],
        plain: tuple[Array, Array],
    ) -> tuple[Array, Array]:
        """Separation [m] and its local exponent at forces over solved ones.

        Parameters
        ----------
        film : array of int
        solved : (array, array)
            Separation and exponent where each film was solved.
        ratio : array
            Forces over those at which the meniscus is in its place.
        flooded, plain : (array, array)
            Separation and exponent at the forces, flooded and as if nothing bounded the film.
        """
        place, slow = self.place[film], self.flooded_exponent[film]
        lacking = self.flooded_separation[film] / solved[0] - 1.0
        bounds = (lacking > 0.0) & (solved[1] > slow) & (place > 1.0)
        c, first = np.where(bounds, lacking, 1.0), np.where(bounds, place, 2.0)
        q = np.where(bounds, 2.0 * (solved[1] - slow) * (1.0 + c) / c * (first - 1.0) / first, 0.0)
        edge = first * ratio**-0.5
        distance = np.maximum(edge - 1.0, _LEAST_DISTANCE)
        choked = c * np.exp(np.minimum(q * np.log((first - 1.0) / distance), _LARGEST_LOGARITHM))
        held = np.where(edge > 1.0, flooded[0] / (1.0 + choked), 0.0)
        steep = flooded[1] + q * choked / (1.0 + choked) * edge / (2.0 * distance)
        return np.where(bounds, held, plain[0]), np.where(bounds, steep, plain[1])


@dataclass(frozen=True, eq=False)
class FilmLaw:
    """Films along the path of contact, as load sharing takes them.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank at the films, rising [m].
    force : ndarray, shape (n,)
        Force at which each film was solved [N].
    separation : ndarray, shape (n,)
        Separation there [m].
    exponent : ndarray, shape (n,)
        n, at least zero [-].
    held : HeldMeniscus, optional
        For films behind a meniscus. Where its flooded separation is no larger, or its exponent no less than n,
        the plain power law stands.
    """

    rho1: Array
    force: Array
    separation: Array
    exponent: Array
    held: HeldMeniscus | None = None

    def __call__(self, rho1: Array, forces: Array) -> tuple[Array, Array]:
        """Separation [m] and its slope [m/N] at given places and forces.

        Below a hundredth of a solved force the law goes on along its tangent: the power law would grow
        without bound where the pair lets go, and a slope that jumps has Newton's method of the load sharing
        step to and fro across it. The line through the first two films, or the last two, goes on for half a step
        beyond them, as far as the ends of the path; places beyond, and behind a meniscus all beyond the films, have
        the nearest one.

        Parameters
        ----------
        rho1 : ndarray
            Places [m]; NaN where no film is wanted: zero there.
        forces : ndarray
            Of the same shape [N].
        """
        _, share, sides = self._beside(rho1, forces)
        separation, slope = ((1 - share) * a + share * b for a, b in zip(*sides, strict=True))
        known = np.isfinite(rho1)
        return np.where(known, separation, 0.0), np.where(known, np.minimum(slope, 0.0), 0.0)

    def halves(self) -> tuple[FilmLaw, FilmLaw]:
        """Laws by every second film: from the first on with the last one too, and those left out.

        With films in the middle of intervals h of a smooth law, the first of these is off at the end of the path by
        f'' h^2/4 more, 2/3 of what the law itself is off there, and the second by f' h/2, as it does not reach the end.
        Between films both are off by four times as much. Behind a meniscus, where places beyond the films have the
        nearest one, both ends stay in both.
        """
        count, held = self.rho1.size, self.held
        ends = [0, count - 1]
        even = np.unique(np.append(np.arange(0, count, 2), ends))
        odd = (
            np.arange(1, count, 2)
            if held is None and count > 1
            else np.unique(np.append(np.arange(1, count, 2), ends))
        )
        return self._of(even), self._of(odd)

    def _of(self, each: NDArray[np.intp]) -> FilmLaw:
        """Law by some of the films."""
        held = self.held
        if held is not None:
            held = HeldMeniscus(held.place[each], held.flooded_separation[each], held.flooded_exponent[each])
        return FilmLaw(self.rho1[each], self.force[each], self.separation[each], self.exponent[each], held)

    def corners(self, pair: GearPair) -> Array:
        """Positions within a base pitch at which pairs pass films, where the law along the path has corners (n,)."""
        return np.asarray((self.rho1 - pair.points.A) / pair.base_pitch % 1.0)

    def carried(self, figure: Array, rho1: Array, forces: Array) -> Array:
        """Figure of the films, such as a thickness, at other places and forces: in proportion to the separation.

        Parameters
        ----------
        figure : ndarray, shape (n,)
            Of each film.
        rho1, forces : ndarray
            As of a call.

        Returns
        -------
        ndarray
            NaN without force or place.
        """
        (first, second), share, sides = self._beside(rho1, forces)
        (below, _), (above, _) = sides
        between = (1 - share) * figure[first] * below / self.separation[first]
        between = between + share * figure[second] * above / self.separation[second]
        return np.where(np.isfinite(rho1) & (forces > 0.0), between, np.nan)

    def stiffness(self, rho1: Array) -> Array:
        """Film stiffness at the solved forces, infinite at NaN [N/m]."""
        (first, second), share = self._neighbours(rho1)
        yielding = self.exponent * self.separation / self.force
        between = np.where(np.isfinite(rho1), (1 - share) * yielding[first] + share * yielding[second], 0.0)
        return np.divide(1.0, between, out=np.full_like(between, np.inf), where=between > 0)

    def _neighbours(self, rho1: Array) -> tuple[tuple[NDArray[np.intp], NDArray[np.intp]], Array]:
        """Films on either side of each place, and the share of the second."""
        place = np.nan_to_num(rho1)
        second = np.clip(np.searchsorted(self.rho1, place), min(1, self.rho1.size - 1), self.rho1.size - 1)
        first = np.maximum(second - 1, 0)
        step = self.rho1[second] - self.rho1[first]
        share = np.divide(place - self.rho1[first], step, out=np.zeros_like(place), where=step > 0)
        beyond = BEYOND if self.held is None else 0.0
        return (first, second), np.clip(share, -beyond, 1.0 + beyond)

    def _beside(
        self, rho1: Array, forces: Array
    ) -> tuple[tuple[NDArray[np.intp], NDArray[np.intp]], Array, list[tuple[Array, Array]]]:
        """Films on either side of each place, the share of the second, and what each gives at the forces."""
        (first, second), share = self._neighbours(rho1)
        # a meniscus lies where the force of its place put it: between two films, where the force between theirs would
        between = (1 - share) * self.force[first] + share * self.force[second]
        solved = [self.force[film] if self.held is None else between for film in (first, second)]
        sides = [
            self._one(film, (first, second), forces, at)
            for film, at in zip((first, second), solved, strict=True)
        ]
        return (first, second), share, sides

    def _one(
        self,
        film: NDArray[np.intp],
        neighbours: tuple[NDArray[np.intp], NDArray[np.intp]],
        forces: Array,
        solved: Array,
    ) -> tuple[Array, Array]:
        """Separation and slope by one film each of two, taken as solved at the given forces."""
        ratio = np.maximum(forces / solved, _LEAST_RATIO)
        least, here = ratio * solved, (self.separation, self.exponent)
        below = np.minimum(forces - least, 0.0)
        separation, local = self._followed(film, neighbours, least, here)
        if self.held is not None:
            flooded = self.held.flooded_separation, self.held.flooded_exponent
            at_rest = self.separation[film], self.exponent[film]
            free = self._followed(film, neighbours, least, flooded)
            separation, local = self.held.bound(film, at_rest, ratio, free, (separation, local))
        slope = -local * separation / least
        return separation + slope * below, slope

    def _followed(
        self,
        film: NDArray[np.intp],
        neighbours: tuple[NDArray[np.intp], NDArray[np.intp]],
        forces: Array,
        solved: tuple[Array, Array],
    ) -> tuple[Array, Array]:
        """Separation by one of two films, solved with separate separations and exponents, and its exponent."""
        fallen, local = self._fall(neighbours, forces, *solved)
        before, _ = self._fall(neighbours, self.force[film], *solved)
        return solved[0][film] * np.exp(np.minimum(before - fallen, _LARGEST_LOGARITHM)), local

    def _fall(
        self,
        neighbours: tuple[NDArray[np.intp], NDArray[np.intp]],
        forces: Array,
        separation: Array,
        exponent: Array,
    ) -> tuple[Array, Array]:
        """Logarithm by which separations between two films fall from the lesser of their forces, and n there."""
        lighter = self.force[neighbours[0]] <= self.force[neighbours[1]]
        light, heavy = (
            np.where(lighter, neighbours[0], neighbours[1]),
            np.where(lighter, neighbours[1], neighbours[0]),
        )
        width = np.log(self.force[heavy] / self.force[light])
        above = np.log(forces / self.force[light])
        part = np.clip(np.divide(above, width, out=np.zeros_like(above), where=width > 0.0), 0.0, 1.0)
        first, change = exponent[light], np.where(width > 0.0, exponent[heavy] - exponent[light], 0.0)
        # what the separations of both lack of the mean n is of the force, or of the place where forces are alike
        lacking = np.log(separation[light] / separation[heavy]) - (first + 0.5 * change) * width
        lacking = lacking * width / (width**2 + _ALIKE**2)
        fallen = first * above + change * (0.5 * width * part**2 + np.maximum(above - width, 0.0))
        local = first + change * part + 6.0 * lacking * part * (1.0 - part)
        return fallen + lacking * width * part**2 * (3.0 - 2.0 * part), local
