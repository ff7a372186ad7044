"""Cases of films with heat, by nodes beside the isothermal film and along a path; and of films over the face."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.bench.case import Answer, Case, Levels, answer, case, level, over, percent, value
from flankfilm.bench.examples import contacts_along_path, example_pair, pitch_point

if TYPE_CHECKING:
    from ehl import LineContact, ThermalFilm
    from flankfilm.coupling.films.film_table import FilmTable

_NODES = "{} nodes".format
_THICKNESS = "central and minimum film"


def thermal_films(quick: bool) -> tuple[Case, ...]:
    """All cases of films with heat, and of films over the face."""
    return (thermal_nodes(quick),) if quick else (thermal_nodes(quick), thermal_path(), face_table())


def _sliding(contact: LineContact, ratio: float) -> LineContact:
    """Return the contact with an oil that thins and warms, in sliding of a share of the entrainment."""
    oil = replace(contact.lubricant, temperature=353.15, viscosity_slope=0.04, eyring_stress=5e6)
    return replace(contact, lubricant=oil, sliding=ratio * contact.entrainment)


def _warm(film: ThermalFilm) -> Answer:
    values = {
        _THICKNESS: value([film.central_thickness, film.minimum_thickness], film.error),
        "traction": value(film.traction_coefficient, film.traction_error),
        "temperature rises": value(
            [film.oil_temperature_rise, film.surface_temperature_rise], film.temperature_error
        ),
    }
    return answer(film.x.size, values, film)


@case("Film with heat by nodes", "nodes", "film_heat_nodes")
def thermal_nodes(quick: bool) -> Levels:
    """Flooded film with heat and shear thinning by the number of nodes.

    Line contact at the pitch point of the pair 36/40, 600 N m and 2000 rpm, but sliding by 0.4 of the entrainment,
    Eyring stress 5 MPa: from nothing, and from the film of a load 2 % higher. `Film by nodes, pitch point` is the
    isothermal film of the same contact.
    """
    from ehl import solve_thermal

    contact = _sliding(pitch_point(), 0.4)
    heavier = replace(contact, load=1.02 * contact.load)
    counts = (65, 129) if quick else (65, 129, 257, 513)
    starts = {n: solve_thermal(heavier, nodes=n) for n in counts}

    def nothing(nodes: int) -> ThermalFilm:
        return solve_thermal(contact, nodes=nodes)

    def neighbour(nodes: int) -> ThermalFilm:
        return solve_thermal(contact, nodes=nodes, start=starts[nodes])

    series = (
        over(counts, _NODES, nothing, _warm, name="from nothing"),
        over(counts, _NODES, neighbour, _warm, name="from a neighbour"),
    )
    finest = 257 if quick else 1025
    return Levels(series, level(_NODES(finest), nothing, _warm, finest), {_THICKNESS: 2.0})


@case("Films with heat along the path of contact", "nodes in the mean", "film_heat_path")
def thermal_path() -> Levels:
    """Films with heat along a path by their tolerance.

    40 flooded contacts from A to E with two jumps of the load share, sliding from -0.4 to 0.4 of the entrainment, each
    from its neighbour. Error and estimate are the largest of all.
    """
    from ehl import solve_thermal

    ratios = np.linspace(-0.4, 0.4, 40)
    contacts = [_sliding(c, r) for c, r in zip(contacts_along_path(40), ratios, strict=True)]

    def along(tolerance: float) -> list[ThermalFilm]:
        films: list[ThermalFilm] = []
        for contact in contacts:
            films.append(solve_thermal(contact, tolerance=tolerance, start=films[-1] if films else None))
        return films

    def all_of(films: list[ThermalFilm]) -> Answer:
        heights = [h for f in films for h in (f.central_thickness, f.minimum_thickness)]
        friction = [f.traction_coefficient for f in films if abs(f.traction_coefficient) > 0.01]
        values = {
            "central and minimum films": value(heights, max(f.error for f in films)),
            "traction": value(friction, max(f.traction_error for f in films)),
        }
        return answer(float(np.mean([f.x.size for f in films])), values, *films)

    series = over((0.02, 0.01, 0.005), percent, along, all_of, name="tolerances")
    return Levels((series,), level(percent(2e-3), along, all_of, 2e-3))


@case("Films over the face", "line loads", "film_face_table")
def face_table() -> Levels:
    """Films of the cells of a face by the line loads at which they are solved.

    Pair 36/40, 2000 rpm: nine places of the path and line loads over 2.8 decades, and between them bicubic splines. The
    values are minimum and central films of 200 cells at random places and loads.
    """
    from flankfilm.coupling import FilmModel
    from flankfilm.coupling.films.film_table import table_on

    pair, chance = example_pair(), np.random.default_rng(11)
    rho1, oil = np.linspace(pair.points.A, pair.points.E, 9), pitch_point().lubricant
    lightest, heaviest = 1.2e3, 7.2e5
    cells = (
        chance.uniform(rho1[0], rho1[-1], 200),
        np.exp(chance.uniform(np.log(lightest), np.log(heaviest), 200)),
    )

    def solved(loads: int) -> FilmTable:
        return table_on(pair, rho1, np.geomspace(lightest, heaviest, loads), 209.44, oil, FilmModel(), 2e-3)

    def of(table: FilmTable) -> Answer:
        least, central = (
            table.thickness(name, *cells) for name in ("minimum_thickness", "central_thickness")
        )
        errors = np.hypot([table.grid_error, table.central_error], table.film_error or 0.0).tolist()
        return answer(
            table.load.size,
            {"minimum films": value(least, errors[0]), "central films": value(central, errors[1])},
        )

    counts = (11, 21, 41)
    return Levels(
        (over(counts, "{} loads".format, solved, of, name="loads"),), level("81 loads", solved, of, 81)
    )
