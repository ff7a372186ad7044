r"""Films over place and line load: solved at some places of the path under some loads, and carried to all others.

Under a given oil a film is a function of its place on the path, which has radius and speeds, and of its line load.
Cells of a face bear any of these loads at any place, thousands of them, and what they ask for is smooth in both: films
are solved on a grid of places and of logarithms of loads, and the logarithms of their separation and thicknesses are
interpolated by bicubic splines, that of the separation over the loads by the films' own slopes: separations scatter
within their error, which splines through them alone make several per cent of their slopes. The error is read from the
films that every second place, and every second load, leave out.

The film of a cell is that of a line contact. Oil that flows along the face is left out: between cells, where the
pressure changes over the length that the load changes over, many half-widths; and at the ends of the face, where oil
leaks over about a half-width and the film is thinner than is said here.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

import ehl
import gears
from base import Array, InputError, RangeWarning
from flankfilm.coupling.films.film_field import FilmField
from flankfilm.coupling.films.films import (
    FilmModel,
    PlacedMeniscus,
    Solved,
    film_inside,
    films_under,
    power_of,
    separations_of,
)
from flankfilm.coupling.films.line_contacts import line_contacts
from flankfilm.coupling.films.sloped_figure import SlopedFigure
from flankfilm.coupling.mesh.cells import cells_of, line_loads
from gears.pair.hertz import half_width

if TYPE_CHECKING:
    from flankfilm.coupling.mesh.mesh_curves import MeshCycle

PLACES = 9
"""Places of the path at which films are solved."""

LOADS = 21
"""Line loads at each of them."""

LIGHTEST = 2e-3
"""Smallest of these loads over the largest of the dry contact."""

HEAVIEST = 1.2
"""Largest of them over that: films move load to where there is most of it."""

LEFT_OUT = {"separation": 0.25, "minimum_thickness": 0.25, "central_thickness": 0.75}
"""Part of what a grid twice as coarse misses that this one does: a sixteenth where both resolve the films.

Central films have a knee where the spike passes, which grids halve by halves.
"""

OF_SLOPES = 0.5
"""The same of slopes by the load, which stiffness follows: they converge by an eighth where both grids resolve them."""

FIGURES = ("separation", "minimum_thickness", "central_thickness")


@dataclass(frozen=True, eq=False)
class FilmTable(FilmField):
    """Films without heat over place and rising line loads, as load sharing over pairs and cells takes them.

    Logarithms of the figures are interpolated by bicubic splines. Below the lightest load the law goes on along its
    tangent, above the heaviest along its power.

    Attributes
    ----------
    face_width : float
        By which a whole face's force is its line load [m].
    separation, minimum_thickness, central_thickness : ndarray, shape (places, loads)
        Of the films [m].
    film_error : float or None
        Largest relative error of the films' thicknesses; None by formula.
    power : ndarray, shape (places, loads)
        Power of the load with which the separation grows, by the films' own slopes.
    separation_shift, slope_shift : ndarray or None, shape (places, loads)
        Relative errors of the separations and of their slopes, with the sign of the last refinement; None by formula.
    """

    figures = FIGURES
    degree_along = 3

    face_width: float
    separation: Array
    minimum_thickness: Array
    central_thickness: Array
    film_error: float | None
    power: Array
    separation_shift: Array | None = None
    slope_shift: Array | None = None

    def at(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """Separation or thickness [m], of a name in `FIGURES`, or its slope by the load [m2/N].

        Parameters
        ----------
        figure : str
        rho1, load : ndarray
            Places [m] and line loads [N/m], of the same shape.
        slope : int
            0 for the figure, 1 for its slope.
        """
        return self._law(figure, rho1, load)[slope]

    def _law(self, figure: str, rho1: Array, load: Array) -> tuple[Array, Array]:
        """Figure and its slope by the load."""
        least = np.maximum(load, self.load[0])
        exponent = np.maximum(-self.within(figure, rho1, least, 1), 0.0)
        beyond = np.maximum(np.log(least / self.load[-1]), 0.0)
        value = np.exp(self.within(figure, rho1, least) - exponent * beyond)
        slope = -exponent * value / least
        return value + slope * np.minimum(load - least, 0.0), slope

    def __call__(self, rho1: Array, forces: Array) -> tuple[Array, Array]:
        """Separation [m] and its slope [m/N] at places and under forces that load a whole face evenly.

        Parameters
        ----------
        rho1 : ndarray
            Places [m]; NaN where no film is wanted: zero there.
        forces : ndarray
            Of the same shape [N].
        """
        separation, slope = self._law("separation", rho1, forces / self.face_width)
        known = np.isfinite(rho1)
        return np.where(known, separation, 0.0), np.where(known, slope / self.face_width, 0.0)

    def thickness(self, figure: str, rho1: Array, load: Array) -> Array:
        """Thickness of films [m], of a name in `FIGURES`, at places under line loads [N/m].

        NaN below the lightest load, where films are thicker than the thickest that is known.
        """
        known = np.isfinite(rho1) & (load >= self.load[0])
        return np.where(known, self.at(figure, rho1, load), np.nan)

    def corners(self, pair: gears.GearPair) -> Array:
        """No positions: the law is smooth along the path."""
        return np.zeros(0)

    def varied(self) -> tuple[tuple[FilmTable, float], ...]:
        """Tables that are off, and how much of what each changes of a figure is error.

        One has the separations off by their films' errors, node by node as the last refinement moved them, and all
        slopes off by theirs to one side; two have every second place and every second load. Films by formula have no
        error estimate.
        """
        grids = tuple((self._every_second(along), OF_SLOPES) for along in (0, 1))
        if self.separation_shift is None or self.slope_shift is None:
            return grids
        grown, steeper = 1.0 + self.separation_shift, 1.0 + np.abs(self.slope_shift)
        off = replace(self, separation=self.separation * grown, power=self.power * steeper / grown)
        return (off, 1.0), *grids

    @property
    def error(self) -> float | None:
        """Relative error of minimum films and separation under a line load; None by formula."""
        return None if self.film_error is None else float(np.hypot(self.film_error, self.grid_error))

    @cached_property
    def grid_error(self) -> float:
        """The same by the grid of places and loads alone."""
        return max(self._missed("separation"), self._missed("minimum_thickness"))

    @cached_property
    def central_error(self) -> float:
        """Relative error of central films by the grid of places and loads."""
        return self._missed("central_thickness")

    def _missed(self, name: str) -> float:
        missed, (rho1, load) = 0.0, np.meshgrid(self.rho1, self.load, indexing="ij")
        for along in (0, 1):
            omitted = np.arange(1, self.separation.shape[along], 2)
            off = self._every_second(along).within(name, rho1, load) - self.grid(name)
            missed = max(missed, LEFT_OUT[name] * float(np.abs(np.take(off, omitted, axis=along)).max()))
        return missed

    def _every_second(self, along: int) -> FilmTable:
        """Table by every second place (0), or load (1)."""
        kept = (slice(None, None, 2), slice(None)) if along == 0 else (slice(None), slice(None, None, 2))
        shifts = () if self.separation_shift is None else ("separation_shift", "slope_shift")
        grid: dict[str, Any] = {name: getattr(self, name)[kept] for name in (*FIGURES, "power", *shifts)}
        return replace(self, rho1=self.rho1[kept[0]], load=self.load[kept[1]], **grid)

    @cached_property
    def _sloped(self) -> SlopedFigure:
        return SlopedFigure(self.rho1, np.log(self.load), self.grid("separation"), self.power)

    def within(self, figure: str, rho1: Array, load: Array, slope: int = 0) -> Array:
        """Figure as it is interpolated, the separation with its own slopes."""
        if figure != "separation":
            return super().within(figure, rho1, load, slope)
        place = np.clip(np.nan_to_num(rho1), self.rho1[0], self.rho1[-1])
        return self._sloped.at(place, np.log(np.clip(load, self.load[0], self.load[-1])), slope)

    def grid(self, figure: str) -> Array:
        """Logarithm of a figure of all films (places, loads)."""
        return np.asarray(np.log(getattr(self, figure)))


def film_table(
    pair: gears.GearPair,
    dry: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    model: FilmModel,
    tolerance: float,
) -> FilmTable:
    """Solve films at places of the path, under the line loads that cells of the dry contact bear.

    Parameters
    ----------
    pair : gears.GearPair
    dry : MeshCycle
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    model : FilmModel
        Films that follow from place and load alone: not behind a meniscus that each load places by itself.
    tolerance : float
        Relative, of the films.

    Raises
    ------
    InputError
        For films that depend on more.
    SolverError
        Where a film has no solution.
    """
    _check(model)
    rho1, load = film_grid(pair, dry)
    _check_place(model, pair, float(pair.path_at(rho1).radius.max()), float(load[-1]))
    return table_on(pair, rho1, load, speed, lubricant, model, tolerance)


def film_grid(pair: gears.GearPair, dry: MeshCycle) -> tuple[Array, Array]:
    """Places of the path (places,) [m], and line loads (loads,) [N/m], both rising, around those of a dry contact."""
    greatest = line_loads(dry, pair.face_width).max()
    loaded = dry.rho1[np.isfinite(dry.rho1) & (dry.forces > 0.0)]
    if dry.lines is not None:  # whose cells each have their place
        cells = cells_of(dry)
        loaded, greatest = cells.rho1[cells.bear], cells.greatest
    half = 0.5 * pair.base_pitch / dry.position.size
    ends = max(float(loaded.min()) - half, pair.points.A), min(float(loaded.max()) + half, pair.points.E)
    return np.linspace(*ends, PLACES), np.geomspace(HEAVIEST * greatest, LIGHTEST * greatest, LOADS)[::-1]


def table_on(
    pair: gears.GearPair,
    rho1: Array,
    load: Array,
    speed: float,
    lubricant: ehl.Lubricant,
    model: FilmModel,
    tolerance: float,
) -> FilmTable:
    """Solve films at places (places,) [m] under line loads (loads,) [N/m], both rising; else as of `film_table`."""
    rows = films_on(pair, rho1, load, speed, lubricant, model, tolerance)

    def each(figure: str) -> Array:
        return np.array([[getattr(film, figure) for film in row[::-1]] for row in rows])

    solved = model.name == "ehl"
    errors = [[film_inside(film).errors for film in row[::-1]] for row in rows] if solved else []
    return FilmTable(
        rho1,
        load,
        pair.face_width,
        np.array(
            [
                separations_of(np.full(load.size, place), row)[::-1]
                for place, row in zip(rho1, rows, strict=True)
            ]
        ),
        each("minimum_thickness"),
        each("central_thickness"),
        float(each("error").max()) if solved else None,
        np.array([[power_of(film) for film in row[::-1]] for row in rows]),
        np.array([[error.separation_shift for error in row] for row in errors]) if solved else None,
        np.array([[error.slope_shift for error in row] for row in errors]) if solved else None,
    )


def films_on(
    pair: gears.GearPair,
    rho1: Array,
    load: Array,
    speed: float,
    lubricant: ehl.Lubricant,
    model: FilmModel,
    tolerance: float,
) -> list[tuple[Solved, ...]]:
    """Films at every place, from the heaviest to the lightest; arguments as of `table_on`."""
    rows: list[tuple[Solved, ...]] = []
    for place in rho1:
        at = np.full(load.size, place)
        contacts = line_contacts(pair, at, load[::-1], speed, lubricant)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)  # films that are borne warn where they are shown
            rows.append(films_under(model, at, contacts, rows[-1] if rows else (), tolerance))
    return rows


def _check(model: FilmModel) -> None:
    """Refuse films that follow from more than place and line load."""
    if isinstance(model.supply, PlacedMeniscus):
        allowed = (
            "must not be a meniscus in half-widths where the load varies along the face: every cell would hold it "
            "elsewhere, and its film yield by where that is"
        )
        remedy = "give its place, the same for all cells, or take flooded contacts or a layer of oil"
        raise InputError.at("film.supply", "a meniscus in half-widths", allowed, remedy)
    if model.stiffness != model.own_stiffness:
        allowed = "must be left out where the load varies along the face: films there have their own slope by the load"
        raise InputError.at("film.definition", repr(model.definition), allowed, "leave it out")


def _check_place(model: FilmModel, pair: gears.GearPair, radius: float, load: float) -> None:
    """Refuse a meniscus inside the contact of the heaviest film [m], [N/m]."""
    if not isinstance(model.supply, ehl.Meniscus):
        return
    held, wide = -model.supply.position, float(half_width(load, radius, pair.reduced_modulus))
    if held <= wide:
        allowed = (
            f"must be more than {wide:.4g} m, the half-width where cells bear {HEAVIEST:g} times what they do"
        )
        raise InputError.at("meniscus", f"{held:g}", allowed, "nearer in no film forms; move it out")
