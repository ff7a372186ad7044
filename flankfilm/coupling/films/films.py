"""Films of all loaded contacts of a mesh cycle, in the order of the path: flooded, starved or mixed."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np

import ehl
import gears
from base import Array, Faults, InputError, Integers, RangeWarning, SolverError
from flankfilm.coupling.films.film_law import FilmLaw, HeldMeniscus
from flankfilm.coupling.films.line_contacts import line_contacts
from flankfilm.coupling.mesh.mesh_curves import MeshCycle

Solved: TypeAlias = "ehl.Film | ehl.MixedFilm | ehl.FormulaFilm"
Supply: TypeAlias = "ehl.Meniscus | ehl.OilLayer | None"

FILM_POSITIONS = 40
"""Positions of a base pitch at which films are solved by themselves."""

_LEAST_PLANES = 0.5  # sigma: minimum distance of mean planes from which a power law of the load goes on

LEAST_SHARE = 1e-3
"""Pairs with less than this part of the force get no film: they hardly touch, and what their film
separates them by moves the load share by less than their own part."""


@dataclass(frozen=True)
class PlacedMeniscus:
    """A meniscus that each contact's own load places, and that stays in that place when the load changes from there.

    Attributes
    ----------
    half_widths : float
        Distance ahead of the contact's middle over the half-width of the dry contact, above one.
    """

    half_widths: float


Held: TypeAlias = "ehl.Meniscus | ehl.OilLayer | PlacedMeniscus | None"


def supply_of(held: Held, contact: ehl.LineContact) -> Supply:
    """Supply of one contact from what is held at the inlets of all.

    Raises
    ------
    InputError
        For a meniscus inside the dry contact.
    """
    if isinstance(held, PlacedMeniscus):
        return ehl.Meniscus(-held.half_widths * contact.half_width)
    if isinstance(held, ehl.Meniscus) and -held.position <= contact.half_width:
        allowed = f"must be more than {contact.half_width:.4g} m, the half-width of a contact on the path"
        remedy = "nearer in no film forms; move it out, or give its place in half-widths"
        raise InputError.at("meniscus", f"{-held.position:g}", allowed, remedy)
    return held


@dataclass(frozen=True)
class FilmModel:
    """How films are computed.

    Attributes
    ----------
    name : str
        ``"ehl"``: solved; ``"dowson"``: by Dowson's formula.
    definition : str or None
        Definition of the film stiffness; by the model's own unless given.
    supply : ehl.Meniscus, ehl.OilLayer, PlacedMeniscus or None
        What is held at the inlet; None for flooded contacts.
    roughness : ehl.Roughness or None
        Of both flanks together; None for smooth ones.
    grid : str
        As of `ehl.solve`.
    """

    name: str = "ehl"
    definition: str | None = None
    supply: Held = None
    roughness: ehl.Roughness | None = None
    grid: str = "graded"

    def __post_init__(self) -> None:
        """Check that the parts go together."""
        with Faults() as faults:
            faults.choice("film.name", self.name, ("ehl", "dowson"))
            for part, allowed in (("supply", "flooded contacts"), ("roughness", "smooth flanks")):
                if self.name == "dowson" and getattr(self, part) is not None:
                    faults.add(f"film.{part}", "", f"requires solved films; formulas are of {allowed}")

    @property
    def stiffness(self) -> str:
        """Definition of the film stiffness that goes in series with the teeth."""
        return self.definition or self.own_stiffness

    @property
    def own_stiffness(self) -> str:
        """Definition by the slope of the separation under the load, the model's own."""
        return "dowson-central" if self.name == "dowson" else "approach"

    @property
    def follows_load(self) -> bool:
        """Whether flooded films, by the slope of their separation: then place and line load alone say what they do.

        A meniscus lies where one load has put it when the load changes from there, and the lightest films behind a
        layer are not found.
        """
        return self.stiffness == self.own_stiffness and self.supply is None

    @property
    def held(self) -> str:
        """``"flooded"``, ``"meniscus"`` or ``"oil-layer"``."""
        if self.supply is None:
            return "flooded"
        return "oil-layer" if type(self.supply).__name__ == "OilLayer" else "meniscus"


@dataclass(frozen=True)
class PathFilms:
    """Films in the order of the path.

    Attributes
    ----------
    rho1 : ndarray, shape (n,)
        Curvature radius of the pinion's flank at the contacts [m].
    films : tuple
        One for each contact.
    flooded : tuple of Film
        The smooth, flooded films of the same contacts; empty unless something is held at the inlet.
    beside : tuple of int
        Which of them are of pairs that hardly touch and serve the law of the films alone.
    """

    rho1: Array
    films: tuple[Solved, ...]
    flooded: tuple[ehl.Film, ...] = ()
    beside: tuple[int, ...] = ()

    @property
    def loaded(self) -> PathFilms:
        """Films of the pairs that carry load."""
        kept = [i for i in range(len(self.films)) if i not in self.beside]
        flooded = tuple(self.flooded[i] for i in kept) if self.flooded else ()
        return PathFilms(self.rho1[kept], tuple(self.films[i] for i in kept), flooded)


def touching(cycle: MeshCycle) -> tuple[Integers, Integers]:
    """Positions and numbers of the loaded pairs of a cycle, in the order of the path."""
    position, number = np.nonzero(np.isfinite(cycle.rho1) & (cycle.load_share > LEAST_SHARE))
    order = np.argsort(cycle.rho1[position, number], kind="stable")
    return position[order], number[order]


def contacts_of(
    pair: gears.GearPair,
    cycle: MeshCycle,
    speed: float,
    lubricant: ehl.Lubricant,
    line_load: Array | None = None,
) -> tuple[Array, tuple[ehl.LineContact, ...]]:
    """Line contacts that the loaded pairs of a cycle make, with their places on the path [m].

    Parameters
    ----------
    pair : gears.GearPair
    cycle : MeshCycle
    speed : float
        Of the pinion [rad/s].
    lubricant : ehl.Lubricant
    line_load : ndarray, shape (positions, pairs), optional
        Force per length of face that counts [N/m]; that of an even load unless given.

    Raises
    ------
    InputError
        For loads that vary along the face, unless it is said which counts.
    """
    if line_load is None:
        _require_even(pair, cycle)
        line_load = cycle.forces / pair.face_width
    position, number = touching(cycle)
    rho1 = cycle.rho1[position, number]
    return rho1, line_contacts(pair, rho1, line_load[position, number], speed, lubricant)


def _require_even(pair: gears.GearPair, cycle: MeshCycle) -> None:
    """Refuse loads that vary along the face."""
    by = "with leads" if not pair.straight else "with cells of the face"
    if cycle.lines is not None:
        by = "with lines of contact across the face"
    if not pair.straight or cycle.face is not None or cycle.lines is not None:
        allowed = "must be loaded evenly along the face for these films"
        remedy = "leave leads, alignment and cells out; lubricated_cycle by finite elements has films over the face"
        raise InputError.at("pair", by, allowed, remedy)


def films_of(
    model: FilmModel,
    rho1: Array,
    contacts: tuple[ehl.LineContact, ...],
    before: PathFilms | None,
    tolerance: float,
    beside: tuple[int, ...] = (),
) -> PathFilms:
    """Films of all contacts, each solved from its neighbour, or from itself of the round before.

    Films beside the loaded ones, which nothing shows, warn of nothing.

    Raises
    ------
    SolverError
        Where a film has no solution.
    """
    old = before if before is not None and len(before.films) == len(contacts) else PathFilms(rho1, ())
    flooded: tuple[ehl.Film, ...] = ()
    if model.supply is not None:
        smooth = replace(model, supply=None, roughness=None)
        flooded = tuple(map(film_inside, films_under(smooth, rho1, contacts, old.flooded, tolerance)))
    return PathFilms(rho1, films_under(model, rho1, contacts, old.films, tolerance, beside), flooded, beside)


def films_under(
    model: FilmModel,
    rho1: Array,
    contacts: tuple[ehl.LineContact, ...],
    before: tuple[Solved, ...],
    tolerance: float,
    beside: tuple[int, ...] = (),
) -> tuple[Solved, ...]:
    """Films of all contacts by the model; arguments as of `films_along`."""
    if model.name == "dowson":
        return tuple(ehl.dowson(contact) for contact in contacts)
    supplies = tuple(supply_of(model.supply, contact) for contact in contacts)
    return films_along(model, rho1, contacts, supplies, before, tolerance, beside)


def held_the_other_way(model: FilmModel, path: PathFilms, tolerance: float) -> PathFilms:
    """Solve the same starved films with their meniscus held instead of their layer, or the layer instead of it."""
    contacts = tuple(film.contact for film in path.films)
    by_layer = model.held == "oil-layer"
    supplies = tuple(
        None if not film.starved else ehl.Meniscus(film.inlet) if by_layer else ehl.OilLayer(film.flow)
        for film in map(film_inside, path.films)
    )
    return replace(path, films=films_along(model, path.rho1, contacts, supplies, path.films, tolerance))


def films_along(
    model: FilmModel,
    rho1: Array,
    contacts: tuple[ehl.LineContact, ...],
    supplies: tuple[Supply, ...],
    before: tuple[Solved, ...],
    tolerance: float,
    beside: tuple[int, ...] = (),
) -> tuple[Solved, ...]:
    """Solve contacts one after the other, each from what it was before, or from the last.

    Raises
    ------
    SolverError
        Where a film has no solution.
    """
    films: list[Solved] = []
    for i, (contact, supply) in enumerate(zip(contacts, supplies, strict=True)):
        near = before[i] if before else films[-1] if films else None
        film: ehl.Film | ehl.MixedFilm
        with warnings.catch_warnings():
            if i in beside:
                warnings.simplefilter("ignore", RangeWarning)
            if model.roughness is None:
                start = None if near is None else film_inside(near)
                film = ehl.solve(contact, tolerance, start=start, supply=supply, grid=model.grid)
            else:
                assert not isinstance(near, ehl.FormulaFilm)  # rough flanks have solved films
                film = ehl.solve_mixed(contact, model.roughness, tolerance, supply, near)
        if not film.converged:
            raise SolverError(f"no film at rho1 = {1e3 * rho1[i]:.3f} mm: {film.message}")
        films.append(film)
    return tuple(films)


def film_inside(film: Solved) -> ehl.Film:
    """Film itself: of a mixed film that of the load which the asperities leave to it."""
    return film.film if isinstance(film, ehl.MixedFilm) else film  # type: ignore[return-value]


def law_of(path: PathFilms, face_width: float, definition: str) -> FilmLaw:
    """Gather the films along the path into a law.

    Raises
    ------
    SolverError
        As of `separations_of`.
    """
    force = np.array([face_width * film.contact.load for film in path.films])
    separations = separations_of(path.rho1, path.films)
    exponent = np.array([_exponent(film, definition) for film in path.films])
    inside = [film_inside(film) for film in path.films]
    if not path.flooded or not any(type(film.supply).__name__ == "Meniscus" for film in inside):
        return FilmLaw(path.rho1, force, separations, exponent)
    held = HeldMeniscus(
        np.array([-film.inlet / film.contact.half_width for film in inside]),
        np.array([film.separation for film in path.flooded]),
        np.array([_exponent(film, "approach") for film in path.flooded]),
    )
    return FilmLaw(path.rho1, force, separations, exponent, held)


def off_by_errors(law: FilmLaw, path: PathFilms) -> tuple[FilmLaw, ...]:
    """Laws of films that err as far as is estimated: one by their separation, two by its slope.

    Separations are off as the last refinement moved them. Slopes move this way and that along the path, since the
    pressure spike runs over the nodes: that decides what harmonics err by. Means err by more than the sum of these
    moves, so that in a further law all slopes are off to one side. Films by formula have no error estimate.
    """
    if not all(isinstance(film, ehl.Film | ehl.MixedFilm) for film in path.films):
        return ()
    errors = [film_inside(film).errors for film in path.films]
    by_separation = 1.0 + np.array([error.separation_shift for error in errors])
    by_slope = np.array([error.slope_shift for error in errors])
    return (
        replace(law, separation=law.separation * by_separation, exponent=law.exponent / by_separation),
        replace(law, exponent=law.exponent * np.maximum(1.0 + by_slope, 0.0)),
        replace(law, exponent=law.exponent * (1.0 + np.abs(by_slope))),
    )


def _exponent(film: Solved, definition: str) -> float:
    """Exponent by which a film's separation falls with the load.

    At light loads of thin, soft contacts a film's slope can vanish or turn within its error: then a constant.
    """
    slope = getattr(film, "separation_slope", None)
    if definition != "approach" or slope is None:
        slope = -1.0 / film.stiffness(definition)
    return max(-slope * film.contact.load / _separation(film), 0.0)


def power_of(film: Solved) -> float:
    """Power of the load with which a film's separation grows, below 0 as a rule; none where planes overlap."""
    slope = getattr(film, "separation_slope", None)
    if slope is None:
        slope = -1.0 / film.stiffness()
    return slope * film.contact.load / film.separation if film.separation >= _separation(film) else 0.0


def separations_of(rho1: Array, films: tuple[Solved, ...]) -> Array:
    """Separations of films at places [m] that laws of the load continue (n,) [m].

    Raises
    ------
    SolverError
        Where a film separates the flanks by less than its error.
    """
    separations = np.array([_separation(film) for film in films])
    if np.any(separations <= 0.0):
        place = 1e3 * rho1[int(np.argmin(separations))]
        raise SolverError(
            f"the film at rho1 = {place:.3f} mm separates the flanks by less than its error: it is as good "
            'as dry; take film.model = "none"'
        )
    return separations


def _separation(film: Solved) -> float:
    """Separation that a power law of the load continues: between rough flanks at least half a sigma.

    Mean planes that overlap have no power law. Their distance is off by less than a sigma then, its slope stays.
    """
    least = _LEAST_PLANES * film.roughness.deviation if isinstance(film, ehl.MixedFilm) else -math.inf
    return max(film.separation, least)
