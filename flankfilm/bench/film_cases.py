"""Cases of the oil film: flooded, starved, mixed, along a path."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.bench.case import Answer, Case, Level, Levels, answer, case, level, over, percent, value
from flankfilm.bench.examples import DOMAIN, contacts_along_path, pitch_point
from flankfilm.bench.thermal_cases import thermal_films
from flankfilm.bench.work_cases import work_film

if TYPE_CHECKING:
    from ehl import Film, LineContact, Meniscus, MixedFilm, OilLayer, TransientFilm


THICKNESS, STIFFNESS = "central and minimum film", "film stiffness (approach)"
ORDERS = {THICKNESS: 2.0, STIFFNESS: 2.0}
FINEST = {False: (3e-5, 0.01), True: (5e-4, 0.01)}
"""Tolerances of film and spike at the pitch point, in full and quick: graded grids alone do not resolve the
stiffness, grids around the spike do."""
NODES = "{} nodes".format


def thickness_and_stiffness(film: Film) -> Answer:
    """Thickness and stiffness of a film, with the solver's estimates of both."""
    values = {
        THICKNESS: value([film.central_thickness, film.minimum_thickness], film.error),
        STIFFNESS: value(film.stiffness(), film.errors.approach_stiffness),
    }
    return answer(film.x.size, values, film)


def films(quick: bool) -> tuple[Case, ...]:
    """All cases of the film."""
    from ehl import LineContact, Meniscus, OilLayer, solve

    pitch = pitch_point()
    at_pitch = film_nodes("pitch", "pitch point", pitch, FINEST[quick], quick)
    if quick:
        return at_pitch, film_tolerance(quick), *thermal_films(quick)
    half = solve(pitch).central_thickness / 2
    return (
        film_nodes("light", "M 2, L 1", LineContact.from_moes(2.0, 1.0), (1e-5, None), quick),
        film_nodes("heavy", "M 100, L 10", LineContact.from_moes(100.0, 10.0), (3e-5, None), quick),
        at_pitch,
        film_tolerance(quick),
        film_starved("meniscus", "meniscus 0.1 half-widths ahead", Meniscus(-1.1 * pitch.half_width)),
        film_starved("layer", "layer of half the flooded film", OilLayer(half)),
        film_mixed(),
        film_path(),
        *(film_path_fed(*kind) for kind in fed_kinds()),
        film_over_time(),
        *thermal_films(quick),
        film_relaxed("light", "M 5, L 5", LineContact.from_moes(5.0, 5.0)),
        film_relaxed("pitch", "pitch point", pitch),
        work_film(),
    )


@case("Film by nodes, {words}", "nodes", "film_nodes_{short}")
def film_nodes(
    short: str, words: str, contact: LineContact, finest: tuple[float, float | None], quick: bool
) -> Levels:
    """Flooded film by the number of nodes.

    Flooded line contact, {words}, from nothing: Newton's method on the given number of nodes and on half as many for
    the estimate, both derivatives included.
    """
    from ehl import solve

    counts = (33, 65, 129) if quick else (33, 65, 129, 257, 513)
    series = over(counts, NODES, solve, thickness_and_stiffness, contact, 0.005, name=words)
    return Levels((series,), finest_film(contact, *finest), ORDERS)


@case("Film by tolerance, pitch point", "nodes")
def film_tolerance(quick: bool) -> Levels:
    """Flooded film by its tolerance, from nothing and from a neighbour.

    Flooded line contact at the pitch point of the pair 36/40, 600 N m and 2000 rpm, to a tolerance: from nothing, and
    from the film of a load 2 % higher.
    """
    from ehl import solve

    contact = pitch_point()
    heavier = replace(contact, load=1.02 * contact.load)
    tolerances = (0.02, 0.005) if quick else (0.02, 0.005, 0.001, 3e-4, 1e-4)
    starts = {t: solve(heavier, tolerance=t) for t in tolerances}

    def cold(tolerance: float) -> Film:
        return solve(contact, tolerance=tolerance)

    def warm(tolerance: float) -> Film:
        return solve(contact, tolerance=tolerance, start=starts[tolerance])

    series = (
        over(tolerances, percent, cold, thickness_and_stiffness, name="from nothing"),
        over(tolerances, percent, warm, thickness_and_stiffness, name="from a neighbour"),
    )
    return Levels(series, finest_film(contact, *FINEST[quick]), ORDERS)


def finest_film(contact: LineContact, tolerance: float, spike: float | None) -> Level:
    """Level of a film that the others are compared with."""
    from ehl import solve

    label = f"tolerance {percent(tolerance)}" + ("" if spike is None else f", spike {percent(spike)}")
    return Level(label, lambda: solve(contact, tolerance=tolerance, spike=spike), thickness_and_stiffness)


@case("Starved film, {words}", "nodes", "film_{short}")
def film_starved(short: str, words: str, supply: Meniscus | OilLayer) -> Levels:
    """Starved film by the number of nodes.

    Line contact at the pitch point, {words}: the flooded film first, then the starved one, by nodes.
    """
    from ehl import solve

    contact = pitch_point()

    def fed(nodes: int) -> Film:
        return solve(contact, nodes=nodes, supply=supply)

    series = over((33, 65, 129, 257), NODES, fed, thickness_and_stiffness, name=words)
    return Levels((series,), level(NODES(1025), fed, thickness_and_stiffness, 1025), ORDERS)


@case("Film by relaxation, {words}", "nodes, or sweeps", "film_relaxed_{short}")
def film_relaxed(short: str, words: str, contact: LineContact) -> Levels:
    """Newton's method beside the relaxed iteration of many papers, both on the same uniform domain.

    Flooded line contact, {words}, on {DOMAIN[0]:g} to {DOMAIN[1]:g} half-widths: Newton's method with its estimate,
    and a compiled, relaxed Gauss-Seidel iteration with the fastest of seven pairs of factors.
    """
    from ehl import solve
    from flankfilm.bench.relaxation import fastest_factors, relaxed

    factors = {nodes: fastest_factors(contact, nodes) for nodes in (65, 129)}

    def newton(**resolution: Any) -> Film:
        return solve(contact, domain=DOMAIN, **resolution)

    def central(size: float, film: float, error: float | None = None) -> Answer:
        return Answer(size, {"central film": value(film, error)})

    def by_newton(film: Film) -> Answer:
        return central(film.x.size, film.central_thickness, film.error)

    def sweeps(nodes: int) -> tuple[float, int] | None:
        return relaxed(contact, nodes, factors[nodes])

    def by_sweeps(relaxation: tuple[float, int] | None) -> Answer:
        if relaxation is None:
            return Answer(np.nan, {}, "no factors of the ladder converge")
        return central(relaxation[1], relaxation[0])

    series = (
        over((65, 129, 257), NODES, lambda nodes: newton(nodes=nodes), by_newton, name="Newton"),
        over(factors, NODES, sweeps, by_sweeps, name="relaxed"),
    )
    return Levels(series, level(percent(2e-4), lambda: newton(tolerance=2e-4), by_newton))


@case("Mixed film", "nodes")
def film_mixed() -> Levels:
    """Mixed film by its tolerance.

    Line contact at the pitch point at 0.4 m/s on rough flanks whose heights deviate by two thirds of the smooth film:
    load shared between film and asperities, to a tolerance. The estimate is of the film alone.
    """
    from ehl import Roughness, solve, solve_mixed

    slow = replace(pitch_point(), entrainment=0.4)
    height = solve(slow).minimum_thickness
    rough = Roughness(deviation=height / 1.5, density=4e10, tip_radius=1e-5)

    def film_and_share(mixed: MixedFilm) -> Answer:
        shared = (mixed.central_thickness, mixed.minimum_thickness, mixed.asperity_share)
        return answer(mixed.film.x.size, {"film and asperity share": value(shared, mixed.error)}, mixed)

    series = over((0.02, 0.005, 0.001), percent, solve_mixed, film_and_share, slow, rough, name="tolerances")
    return Levels((series,), level(percent(2e-4), solve_mixed, film_and_share, slow, rough, 2e-4))


@case("Films along the path of contact", "nodes in the mean")
def film_path() -> Levels:
    """Films along a path by their tolerance.

    41 flooded contacts from A to E with two jumps of the load share, each from its neighbour, to a tolerance. Error
    and estimate are the largest of all.
    """
    from ehl import solve_path

    contacts = contacts_along_path(41)

    def along(tolerance: float) -> list[Film]:
        return list(solve_path(contacts, tolerance=tolerance))

    def all_of(path_films: list[Film]) -> Answer:
        heights = [h for f in path_films for h in (f.central_thickness, f.minimum_thickness)]
        values = {"central and minimum films": value(heights, max(f.error for f in path_films))}
        return answer(float(np.mean([f.x.size for f in path_films])), values, *path_films)

    series = over((0.02, 0.005, 0.001), percent, along, all_of, name="tolerances")
    return Levels((series,), level("0.05 %", along, all_of, 5e-4))


def fed_kinds() -> tuple[tuple[str, str, OilLayer | None, bool], ...]:
    """Films along the path that are starved, by a layer or by menisci where no layer is given, rough, or both."""
    from ehl import OilLayer

    layer = OilLayer(0.11e-6)
    return (
        ("layer", "a layer of 0.11 um", layer, False),
        ("meniscus", "menisci 0.03 half-widths ahead", None, False),
        ("layer_rough", "a layer of 0.11 um, Ra 0.4 um", layer, True),
        ("meniscus_rough", "menisci 0.03 half-widths ahead, Ra 0.4 um", None, True),
    )


@case("Films along the path of contact, {words}", "nodes in the mean", "film_path_{short}")
def film_path_fed(short: str, words: str, layer: OilLayer | None, rough: bool) -> Levels:
    """Starved and rough films along a path by their tolerance.

    41 contacts from A to E with two jumps of the load share, {words}, each from its neighbour. Error and
    estimate are the largest of all.
    """
    from ehl import Meniscus, MixedFilm, Roughness, solve, solve_mixed

    ground = Roughness.from_drawing(mean=0.4e-6)

    def along(tolerance: float) -> list[Film | MixedFilm]:
        path_films: list[Any] = []
        for contact in contacts_along_path(41):
            supply = layer or Meniscus(-1.03 * contact.half_width)
            start = path_films[-1] if path_films else None
            if rough:
                path_films.append(solve_mixed(contact, ground, tolerance, supply, start))
            else:
                path_films.append(solve(contact, tolerance, supply=supply, start=start))
        return path_films

    def all_of(path_films: list[Film | MixedFilm]) -> Answer:
        inside = [f.film if isinstance(f, MixedFilm) else f for f in path_films]
        heights = [h for f in path_films for h in (f.central_thickness, f.minimum_thickness)]
        values = {"central and minimum films": value(heights, max(f.error for f in path_films))}
        return answer(float(np.mean([f.x.size for f in inside])), values, *path_films)

    series = over((0.005, 0.001, 2e-4), percent, along, all_of, name="tolerances")
    return Levels((series,), level("0.01 %", along, all_of, 1e-4))


@case("Film under a falling load", "nodes")
def film_over_time() -> Levels:
    """Film over time by its tolerance.

    Flooded line contact at the pitch point whose load falls to half along half a cosine within 4 b/u: central and
    minimum film at seven times, by steps of time and grids that the tolerance chooses.
    """
    from ehl import solve_transient

    contact = pitch_point()
    unit = contact.half_width / contact.entrainment
    times = np.linspace(0.0, 12.0, 7) * unit

    def load(time: float) -> float:
        return contact.load * (0.75 + 0.25 * float(np.cos(np.pi * min(time / (4.0 * unit), 1.0))))

    def followed(tolerance: float) -> TransientFilm:
        return solve_transient(contact, load, times, tolerance=tolerance)

    def central_and_minimum(transient: TransientFilm) -> Answer:
        values = {"central and minimum films": value([*transient.central, *transient.least], transient.error)}
        return answer(transient.x.shape[1], values, transient)

    series = over((0.02, 0.01, 0.005), percent, followed, central_and_minimum, name="tolerances")
    return Levels((series,), level("0.25 %", followed, central_and_minimum, 2.5e-3))
