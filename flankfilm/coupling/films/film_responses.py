"""Answers of films to an oscillating load over place and line load, as cells of lines of contact ask for them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

import ehl
import gears
from base import Array
from flankfilm.coupling.films.film_field import FilmField
from flankfilm.coupling.films.film_table import OF_SLOPES, film_grid, films_on
from flankfilm.coupling.films.films import FilmModel
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

__all__ = ["FilmResponses", "film_responses"]

FIGURES = ("in_phase", "behind", "error")


@dataclass(frozen=True, eq=False)
class FilmResponses(FilmField):
    """Complex compliance of films at one frequency, times their load, by bicubic splines over place and its logarithm.

    Below the lightest load the product stays as it is there.

    Attributes
    ----------
    in_phase, behind : ndarray, shape (places, loads)
        Real and imaginary part of compliance times load [m].
    error : ndarray, shape (places, loads)
        Relative error of each answer, with that of its film.
    """

    figures = FIGURES
    degree_along = 3

    in_phase: Array
    behind: Array
    error: Array

    def grid(self, figure: str) -> Array:
        """As of `FilmField`."""
        return np.asarray(getattr(self, figure))

    def at(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """As of `FilmField`."""
        return self.within(figure, rho1, load, slope)

    def compliance(self, rho1: Array, load: Array) -> Array:
        """Complex compliance at places [m] under line loads above 0 [N/m], per length of the contact [m2/N]."""
        return np.asarray((self.at("in_phase", rho1, load) + 1j * self.at("behind", rho1, load)) / load)

    def relative_error(self, rho1: Array, load: Array) -> Array:
        """Relative error of that by the films and their answers."""
        return np.asarray(np.maximum(self.at("error", rho1, load), self.error.min()))

    def varied(self) -> tuple[tuple[FilmResponses, float], ...]:
        """Every second place, and every second load; and how much of what these change is error."""
        return tuple((self._every_second(along), OF_SLOPES) for along in (0, 1))

    def _every_second(self, along: int) -> FilmResponses:
        kept = (slice(None, None, 2), slice(None)) if along == 0 else (slice(None), slice(None, None, 2))
        grid = {name: getattr(self, name)[kept] for name in FIGURES}
        return replace(self, rho1=self.rho1[kept[0]], load=self.load[kept[1]], **grid)


def film_responses(
    pair: gears.GearPair,
    dry: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    model: FilmModel,
    frequency: float,
    tolerance: float,
) -> FilmResponses:
    """Solve films around the places and line loads of a dry contact, and their answers to an oscillating load.

    Parameters
    ----------
    pair : gears.GearPair
    dry : MeshCycle
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    model : FilmModel
        Solved; a meniscus in half-widths is placed by each film's own load.
    frequency : float
        [rad/s].
    tolerance : float
        Relative, of the films.

    Raises
    ------
    SolverError
        Where a film has no solution.
    """
    rho1, load = film_grid(pair, dry)
    rows = films_on(pair, rho1, load, speed, lubricant, model, tolerance)
    answers = [
        [ehl.film_response(film, frequency) for film in row[::-1] if not isinstance(film, ehl.FormulaFilm)]
        for row in rows
    ]
    moved = load * np.array([[complex(answer.compliance) for answer in row] for row in answers])
    error = np.array([[answer.error + answer.film.error for answer in row] for row in answers])
    return FilmResponses(rho1, load, moved.real, moved.imag, error)
