"""Local deflection of each pair by its own force: Hertz on the flanks, tables at tip edges, oil film."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from base import Array, Booleans, Integers, record
from fem.laws.corner_law import CornerLaw
from fem.pair.hertz_approach import LEAST_FORCE, HertzApproach
from gears.sharing.staying_contacts import JointLaw

__all__ = ["Film", "FilmLaw", "PairLaws", "Table", "film_yielding"]


@record
class Table:
    """Monotone cubic interpolation of one law per row; straight beyond the end.

    What contacts approach over their force is nearly linear in the force's logarithm, as in ``HertzApproach``, and is
    exactly so while only the corner and the opening of the flanks count. Smooth laws have that form up to their first
    force, and at the others the derivatives of parabolas through three points of it; laws by strips that close in any
    order have those of Fritsch and Carlson.

    Attributes
    ----------
    force, approach, steepness : (n, k) arrays
        Points [N], [m], the first without force, and derivatives [m/N]; infinite at the first of laws that are smooth.
    """

    force: Array
    approach: Array
    steepness: Array

    @classmethod
    def through(cls, force: Array, approach: Array, smooth: Booleans | bool = True) -> Table:
        """Table through growing points (n, k), and which of the laws are smooth (n,)."""
        size, secant = np.diff(force), np.diff(approach) / np.diff(force)
        left, right = 2 * size[:, 1:] + size[:, :-1], size[:, 1:] + 2 * size[:, :-1]
        middle = (left + right) / (left / secant[:, :-1] + right / secant[:, 1:])
        any_order = np.concatenate([secant[:, :1], middle, secant[:, -1:]], axis=1)
        log, quotient = np.log(force[:, 1:]), (approach[:, 1:] - approach[:, :1]) / force[:, 1:]
        rise = np.diff(quotient) / np.diff(log)
        width = log[:, 2:] - log[:, :-2]
        bent = (np.diff(log)[:, 1:] * rise[:, :-1] + np.diff(log)[:, :-1] * rise[:, 1:]) / width
        inside = quotient[:, :-1] + np.concatenate([np.minimum(rise[:, :1], 0.0), bent], axis=1)
        inside = np.clip(inside, 0.0, 3 * np.minimum(secant[:, :-1], secant[:, 1:]))
        begins = np.full((len(force), 1), np.inf)
        by_logarithm = np.concatenate([begins, inside, secant[:, -1:]], axis=1)
        return cls(force, approach, np.where(np.reshape(smooth, (-1, 1)), by_logarithm, any_order))

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Approach [m] and derivative [m/N] at forces (..., n) [N], one of each row."""
        return _by_row(self._at, force)

    def _at(self, rows: Integers, force: Array) -> tuple[Array, Array]:
        last = self.force.shape[1] - 1
        cell = np.clip((self.force[rows] <= force[:, None]).sum(axis=-1) - 1, 0, last - 1)
        f0, f1 = self.force[rows, cell], self.force[rows, cell + 1]
        d0, d1 = self.approach[rows, cell], self.approach[rows, cell + 1]
        s0, s1 = self.steepness[rows, cell], self.steepness[rows, cell + 1]
        width, begins = f1 - f0, np.isinf(s0)
        quotient, s0 = (d1 - d0) / width, np.where(begins, 0.0, s0)
        beyond = np.maximum(force - f1, 0.0)
        t = np.minimum((force - f0) / width, 1.0)
        value = (
            d0 * (1 + 2 * t) * (1 - t) ** 2
            + d1 * t**2 * (3 - 2 * t)
            + width * (s0 * t * (1 - t) ** 2 - s1 * t**2 * (1 - t))
        )
        slope = 6 * t * (1 - t) * quotient + s0 * (1 - t) * (1 - 3 * t) + s1 * t * (3 * t - 2)
        per_log = s1 - quotient
        small = quotient + per_log * np.log(np.maximum(force, LEAST_FORCE) / f1)
        value = np.where(begins, d0 + force * small, value)
        slope = np.where(begins, small + np.where(force > LEAST_FORCE, per_log, 0.0), slope)
        return value + s1 * beyond, slope


def _by_row(at: Callable[[Integers, Array], tuple[Array, Array]], force: Array) -> tuple[Array, Array]:
    """Ask laws of rows at forces (m,) for forces (..., rows): those without a force once a row."""
    bears, count = force != 0.0, force.shape[-1]
    rows = np.nonzero(bears)[-1]
    answers = at(np.concatenate([np.arange(count), rows]), np.concatenate([np.zeros(count), force[bears]]))
    value, slope = np.empty_like(force), np.empty_like(force)
    for each, answer in zip((value, slope), answers, strict=True):
        each[...] = answer[:count]
        each[bears] = answer[count:]
    return value, slope


@record
class PairLaws(JointLaw):
    """Hertz's law of each contact, and what tip corners add to it.

    Attributes
    ----------
    hertz : HertzApproach
        For all (positions, pairs); at the end of the flank for tip edges.
    corners : tuple of CornerLaw
        Of contacts at or near tip corners.
    """

    hertz: HertzApproach
    corners: tuple[CornerLaw, ...] = ()

    def at(self, position: int) -> PairLaws:
        """Laws of a single position."""
        row = slice(position, position + 1)
        per_log = np.broadcast_to(self.hertz.per_log, self.hertz.constant.shape)[row]
        corners = tuple(corner.of(position) for corner in self.corners)
        return PairLaws(HertzApproach(self.hertz.constant[row], per_log), corners)

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together."""
        value, slope = self.hertz.value_and_slope(force)
        for corner in self.corners:
            more, steeper = corner.value_and_slope(force[..., corner.at])
            value[..., corner.at] += more
            slope[..., corner.at] += steeper
        return value, slope


class Film(Protocol):
    """Separation of the flanks by an oil film, as ``mesh_cycle`` asks for it."""

    def __call__(self, rho1: Array, forces: Array) -> tuple[Array, Array]:
        """Separation s >= 0 [m] and its derivative by the force ds/dF <= 0 [m/N].

        Parameters
        ----------
        rho1 : (positions, pairs) array
            Curvature radii on the pinion [m]; nan where a pair cannot touch or touches with a tip edge only,
            where any finite answer is ignored.
        forces : (positions, pairs) array
            Normal forces [N], zero included.
        """


def film_yielding(film: Film, rho1: Array, forces: Array, shares: Array) -> Array:
    r"""What films yield beyond the transmission error, counted along their tangents from zero force (positions,) [m].

    A film separates the flanks most where the force is smallest, so that the transmission error D itself is less
    than without film and F/D would call a film stiffer than no film. What yields is the bodies' deflection
    :math:`D + s_i` and the film's :math:`F_i/k_i`: with these in series in each pair, and the mean over the pairs
    weighted by their shares, a stiff film gives the dry secant back.

    Parameters
    ----------
    film : Film
    rho1 : (positions, pairs) array
        Places [m]; nan where a pair is dry.
    forces, shares : (positions, pairs) arrays
        Forces [N] and their shares of the whole.
    """
    separation, slope = film(rho1, forces)
    yields = np.where(np.isfinite(rho1), separation - forces * slope, 0.0)
    return np.asarray(np.sum(shares * yields, axis=1))


@record
class FilmLaw(JointLaw):
    """A ``Film`` at fixed places, in the form that load sharing asks for; dry at tip edges."""

    film: Film
    rho1: Array

    def at(self, position: int) -> FilmLaw:
        """Law of a single position."""
        return FilmLaw(self.film, self.rho1[position : position + 1])

    def value_and_slope(self, force: Array) -> tuple[Array, Array]:
        """Both together; the film is asked with all leading dimensions as positions."""
        places = np.broadcast_to(self.rho1, force.shape)
        flat, wet = (-1, force.shape[-1]), np.isfinite(places)
        answers = self.film(places.reshape(flat), force.reshape(flat))
        value, slope = (np.where(wet, np.reshape(answer, force.shape), 0.0) for answer in answers)
        return value, slope
