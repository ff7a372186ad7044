"""Films of all loaded contacts of a mesh cycle, in the order of the path: flooded, starved or mixed."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from base import SolverError
from flankfilm.build import pinion_speed
from flankfilm.build_film import lubricant, roughness, supply_of
from flankfilm.film_law import FilmLaw, HeldMeniscus
from flankfilm.mesh_stiffness import MeshStiffness

if TYPE_CHECKING:
    from ehl import Film, FormulaFilm, LineContact, Meniscus, MixedFilm, OilLayer, Roughness
    from flankfilm.stages.engine import Engine

    Solved: TypeAlias = Film | MixedFilm | FormulaFilm
    Supply: TypeAlias = Meniscus | OilLayer | None

Array = NDArray[np.float64]

LEAST_SHARE = 1e-3
"""Pairs with less than this part of the force get no film: they hardly touch, and what their film
separates them by moves the load share by less than their own part."""


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
    """

    rho1: Array
    films: tuple[Solved, ...]
    flooded: tuple[Film, ...] = ()


def contacts_of(engine: Engine, cycle: MeshStiffness) -> tuple[Array, tuple[LineContact, ...]]:
    """Give the line contacts that the loaded pairs of a cycle make, with their places on the path."""
    from ehl import LineContact

    pair, oil, speed = engine["pair"], lubricant(engine.scene), pinion_speed(engine.scene)
    touching = np.isfinite(cycle.rho1) & (cycle.load_share > LEAST_SHARE)
    position, number = np.nonzero(touching)
    order = np.argsort(cycle.rho1[position, number], kind="stable")
    position, number = position[order], number[order]
    rho1 = cycle.rho1[position, number]
    path = pair.path_at(rho1)
    contacts = tuple(
        LineContact(load=w, entrainment=u, radius=r, reduced_modulus=pair.reduced_modulus, lubricant=oil)
        for w, u, r in zip(
            (cycle.forces[position, number] / pair.face_width).tolist(),
            path.entrainment(speed).tolist(),
            path.radius.tolist(),
            strict=True,
        )
    )
    return rho1, contacts


def films_of(
    engine: Engine, rho1: Array, contacts: tuple[LineContact, ...], before: PathFilms | None, tolerance: float
) -> PathFilms:
    """Solve all films by the scene's model, each from its neighbour, or from itself of the round before."""
    from ehl import dowson

    scene = engine.scene
    if engine["plan"].film.choice == "dowson":
        return PathFilms(rho1, tuple(dowson(contact) for contact in contacts))
    old = before if before is not None and len(before.films) == len(contacts) else PathFilms(rho1, ())
    flooded: tuple[Film, ...] = ()
    if scene.film.starved:
        smooth = _solved(engine, rho1, contacts, (None,) * len(contacts), old.flooded, tolerance, None)
        flooded = tuple(film_inside(film) for film in smooth)
    supplies = tuple(supply_of(scene, contact) for contact in contacts)
    films = _solved(engine, rho1, contacts, supplies, old.films, tolerance, roughness(scene))
    return PathFilms(rho1, films, flooded)


def held_the_other_way(engine: Engine, path: PathFilms, tolerance: float) -> PathFilms:
    """Solve the same starved films with their meniscus held instead of their layer, or the layer instead of it."""
    from ehl import Meniscus, OilLayer

    inside = tuple(film_inside(film) for film in path.films)
    contacts = tuple(film.contact for film in path.films)
    by_layer = engine.scene.film.supply == "oil-layer"
    supplies = tuple(
        None if not film.starved else Meniscus(film.inlet) if by_layer else OilLayer(film.flow)
        for film in inside
    )
    found = _solved(engine, path.rho1, contacts, supplies, path.films, tolerance, roughness(engine.scene))
    return replace(path, films=found)


def _solved(
    engine: Engine,
    rho1: Array,
    contacts: tuple[LineContact, ...],
    supplies: tuple[Supply, ...],
    before: tuple[Solved, ...],
    tolerance: float,
    rough: Roughness | None,
) -> tuple[Solved, ...]:
    """Solve contacts one after the other, each from what it was before, or from the last."""
    from ehl import solve, solve_mixed

    found: list[Solved] = []
    for i, (contact, supply) in enumerate(zip(contacts, supplies, strict=True)):
        near = before[i] if before else found[-1] if found else None
        start = None if near is None else film_inside(near)
        film: Film | MixedFilm
        if rough is None:
            film = solve(contact, tolerance, start=start, supply=supply, grid=engine.scene.film.grid)
        else:
            film = solve_mixed(contact, rough, tolerance, supply, start)
        if not film.converged:
            raise SolverError(f"no film at rho1 = {1e3 * rho1[i]:.3f} mm: {film.message}")
        found.append(film)
    return tuple(found)


def film_inside(film: Solved) -> Film:
    """Give the film itself: of a mixed film that of the load which the asperities leave to it."""
    from ehl import MixedFilm

    return film.film if isinstance(film, MixedFilm) else film  # type: ignore[return-value]


def law_of(path: PathFilms, face_width: float, definition: str) -> FilmLaw:
    """Gather the films along the path into a law."""
    force = np.array([face_width * film.contact.load for film in path.films])
    separations = np.array([film.separation for film in path.films])
    if np.any(separations <= 0.0):
        where = 1e3 * path.rho1[int(np.argmin(separations))]
        raise SolverError(
            f"the film at rho1 = {where:.3f} mm separates the flanks by less than its error: it is as good "
            'as dry; take film.model = "none"'
        )
    exponent = np.array([_exponent(film, definition) for film in path.films])
    if not path.flooded or not any(_by_meniscus(film) for film in path.films):
        return FilmLaw(path.rho1, force, separations, exponent)
    held = HeldMeniscus(
        np.array([-film.inlet / film.contact.half_width for film in map(film_inside, path.films)]),
        np.array([film.separation for film in path.flooded]),
        np.array([_exponent(film, "approach") for film in path.flooded]),
    )
    return FilmLaw(path.rho1, force, separations, exponent, held)


def _by_meniscus(film: Solved) -> bool:
    from ehl import Meniscus

    return isinstance(film_inside(film).supply, Meniscus)


def _exponent(film: Solved, definition: str) -> float:
    """Exponent by which a film's separation falls with the load.

    At light loads of thin, soft contacts a film's slope can vanish or turn within its error: then a constant.
    """
    slope = getattr(film, "separation_slope", None)
    if definition != "approach" or slope is None:
        slope = -1.0 / film.stiffness(definition)
    return max(-slope * film.contact.load / film.separation, 0.0)
