"""Cases of the oil film: flooded, starved, mixed, along a path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.bench.case import Answer, Case, Level, Series, Value, level
from flankfilm.bench.examples import contacts_along_path, pitch_point
from flankfilm.bench.work_cases import film_work

if TYPE_CHECKING:
    from ehl import Film, LineContact, Meniscus, MixedFilm, OilLayer

    Supply = Meniscus | OilLayer

__all__ = ["films"]

THICKNESS, STIFFNESS = "central and least film", "film stiffness (approach)"
ORDERS = {THICKNESS: 2.0, STIFFNESS: 2.0}
FINEST = {False: (3e-5, 0.01), True: (5e-4, 0.01)}
"""Tolerances of film and spike at the pitch point, in full and quick: graded grids alone do not resolve the
stiffness, grids around the spike do."""


def answer(film: Film) -> Answer:
    """Thickness and stiffness of a film, with the solver's estimates of both."""
    values = {
        THICKNESS: Value(np.array([film.central_thickness, film.minimum_thickness]), film.error),
        STIFFNESS: Value(np.array([film.stiffness()]), film.errors.approach_stiffness),
    }
    return Answer(film.x.size, values, "" if film.converged else film.message)


def films(quick: bool) -> tuple[Case, ...]:
    """All cases of the film."""
    flooded = (*_by_nodes(quick), _by_tolerance(quick))
    return flooded if quick else (*flooded, *_starved(), _mixed(), _path(), *_relaxed(), film_work())


def _by_nodes(quick: bool) -> tuple[Case, ...]:
    from ehl import LineContact, solve

    contacts: dict[str, tuple[str, LineContact, tuple[float, float | None]]] = {
        "light": ("M 2, L 1", LineContact.from_moes(2.0, 1.0), (1e-5, None)),
        "heavy": ("M 100, L 10", LineContact.from_moes(100.0, 10.0), (3e-5, None)),
        "pitch": ("pitch point", pitch_point(), FINEST[quick]),
    }
    counts = (33, 65, 129) if quick else (33, 65, 129, 257, 513)
    return tuple(
        Case(
            f"film_nodes_{key}",
            f"Film by nodes, {words}",
            f"Flooded line contact, {words}, from nothing: Newton's method on the given number of nodes and on half as "
            "many for the estimate, both derivatives included.",
            "nodes",
            (Series(words, tuple(level(f"{n} nodes", solve, answer, contact, 0.005, n) for n in counts)),),
            finest_film(contact, *finest),
            ORDERS,
        )
        for key, (words, contact, finest) in contacts.items()
        if not quick or key == "pitch"
    )


def _by_tolerance(quick: bool) -> Case:
    from ehl import solve

    contact = pitch_point()
    heavier = replace(contact, load=1.02 * contact.load)
    tolerances = (0.02, 0.005) if quick else (0.02, 0.005, 0.001, 3e-4, 1e-4)
    starts = {t: solve(heavier, tolerance=t) for t in tolerances}

    def cold(tolerance: float) -> Film:
        return solve(contact, tolerance=tolerance)

    def warm(tolerance: float) -> Film:
        return solve(contact, tolerance=tolerance, start=starts[tolerance])

    return Case(
        "film_tolerance",
        "Film by tolerance, pitch point",
        "Flooded line contact at the pitch point of the pair 36/40, 600 N m and 2000 rpm, to a tolerance: from "
        "nothing, and from the film of a load 2 % higher.",
        "nodes",
        (
            Series("from nothing", tuple(level(f"{100 * t:g} %", cold, answer, t) for t in tolerances)),
            Series("from a neighbour", tuple(level(f"{100 * t:g} %", warm, answer, t) for t in tolerances)),
        ),
        finest_film(contact, *FINEST[quick]),
        ORDERS,
    )


def finest_film(contact: LineContact, tolerance: float, spike: float | None) -> Level:
    """Level of a film that the others are compared with."""
    from ehl import solve

    label = f"tolerance {100 * tolerance:g} %" + ("" if spike is None else f", spike {100 * spike:g} %")
    return Level(label, lambda: solve(contact, tolerance=tolerance, spike=spike), answer)


def _starved() -> tuple[Case, ...]:
    from ehl import Meniscus, OilLayer, solve

    contact = pitch_point()
    half = solve(contact).central_thickness / 2
    supplies: dict[str, tuple[str, Supply]] = {
        "meniscus": ("meniscus 0.1 half-widths ahead", Meniscus(-1.1 * contact.half_width)),
        "layer": ("layer of half the flooded film", OilLayer(half)),
    }

    def fed(supply: Supply, nodes: int) -> Film:
        return solve(contact, nodes=nodes, supply=supply)

    return tuple(
        Case(
            f"film_{key}",
            f"Starved film, {words}",
            f"Line contact at the pitch point, {words}: the flooded film first, then the starved one, by nodes.",
            "nodes",
            (
                Series(
                    words,
                    tuple(level(f"{n} nodes", fed, answer, supply, n) for n in (33, 65, 129, 257)),
                ),
            ),
            level("1025 nodes", fed, answer, supply, 1025),
            ORDERS,
        )
        for key, (words, supply) in supplies.items()
    )


def _relaxed() -> Iterator[Case]:
    """Newton's method beside the relaxed iteration of many papers, both on the same uniform domain."""
    from ehl import LineContact, solve
    from flankfilm.bench.relaxation import DOMAIN, fastest_factors, relaxed

    quantity = "central film"
    for key, words, contact in (
        ("light", "M 5, L 5", LineContact.from_moes(5.0, 5.0)),
        ("pitch", "pitch point", pitch_point()),
    ):

        def newton(nodes: int, contact: LineContact = contact) -> Film:
            return solve(contact, nodes=nodes, domain=DOMAIN)

        def by_newton(film: Film) -> Answer:
            return Answer(film.x.size, {quantity: Value(np.array([film.central_thickness]), film.error)})

        def by_sweeps(found: tuple[float, int] | None) -> Answer:
            if found is None:
                return Answer(np.nan, {}, "no factors of the ladder converge")
            return Answer(found[1], {quantity: Value(np.array([found[0]]))})

        sweeps = [
            level(f"{n} nodes", relaxed, by_sweeps, contact, n, fastest_factors(contact, n))
            for n in (65, 129)
        ]
        yield Case(
            f"film_relaxed_{key}",
            f"Film by relaxation, {words}",
            f"Flooded line contact, {words}, on {DOMAIN[0]:g} to {DOMAIN[1]:g} half-widths: Newton's method with its "
            "estimate, and a compiled, relaxed Gauss-Seidel iteration with the fastest of seven pairs of factors.",
            "nodes, or sweeps",
            (
                Series("Newton", tuple(level(f"{n} nodes", newton, by_newton, n) for n in (65, 129, 257))),
                Series("relaxed", tuple(sweeps)),
            ),
            level("0.02 %", lambda c=contact: solve(c, tolerance=2e-4, domain=DOMAIN), by_newton),
        )


def _mixed() -> Case:
    from ehl import Roughness, solve, solve_mixed

    slow = replace(pitch_point(), entrainment=0.4)
    height = solve(slow).minimum_thickness
    rough = Roughness(deviation=height / 1.5, density=4e10, tip_radius=1e-5)
    quantity = "film and asperity share"

    def share(tolerance: float) -> MixedFilm:
        return solve_mixed(slow, rough, tolerance)

    def both(found: MixedFilm) -> Answer:
        values = np.array([found.central_thickness, found.minimum_thickness, found.asperity_share])
        failure = "" if found.converged else found.message
        return Answer(found.film.x.size, {quantity: Value(values, found.error)}, failure)

    return Case(
        "film_mixed",
        "Mixed film",
        "Line contact at the pitch point at 0.4 m/s on rough flanks whose heights deviate by two thirds of the smooth "
        "film: load shared between film and asperities, to a tolerance. The estimate is of the film alone.",
        "nodes",
        (Series("tolerances", tuple(level(f"{100 * t:g} %", share, both, t) for t in (0.02, 0.005, 0.001))),),
        level("0.02 %", share, both, 2e-4),
    )


def _path() -> Case:
    from ehl import solve_path

    contacts = contacts_along_path(41)
    quantity = "central and least films"

    def along(tolerance: float) -> list[Film]:
        return list(solve_path(contacts, tolerance=tolerance))

    def all_of(found: list[Film]) -> Answer:
        values = np.array([h for f in found for h in (f.central_thickness, f.minimum_thickness)])
        failure = next((f.message for f in found if not f.converged), "")
        nodes = float(np.mean([f.x.size for f in found]))
        return Answer(nodes, {quantity: Value(values, max(f.error for f in found))}, failure)

    return Case(
        "film_path",
        "Films along the path of contact",
        "41 flooded contacts from A to E with two jumps of the load share, each from its neighbour, to a tolerance. "
        "Error and estimate are the largest of all.",
        "nodes in the mean",
        (
            Series(
                "tolerances", tuple(level(f"{100 * t:g} %", along, all_of, t) for t in (0.02, 0.005, 0.001))
            ),
        ),
        level("0.05 %", along, all_of, 5e-4),
    )
