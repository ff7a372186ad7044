"""The oil film: along the path and through single contacts, and the mesh cycle with it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Figure, Quantity
from base.results import figures, why_no_error
from ehl.discrete.regimes import CLASS, NUMBERS, regime_number
from flankfilm import coupling
from flankfilm.output.variables import figure_of, of_models, of_quantities, of_record
from flankfilm.products.output import Named, Of, Take, in_result, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked
from flankfilm.products.stiffness import CYCLE
from flankfilm.report import film_parts
from flankfilm.report.page import Headline, Part
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage
from flankfilm.stages.losses import HOT_FILM, LOSSES
from flankfilm.stages.mesh import FILM, PAIR, PLAN

if TYPE_CHECKING:
    import xarray as xr

    import ehl

THROUGH = ("x", "pressure", "thickness", "central_thickness", "minimum_thickness")
"""Figures of whole films."""

UNRESOLVED = "nan where it is narrower than grids resolve"


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The film with heat, where it may be wanted; the isothermal one follows from the mesh cycle."""
    if "film" in wants and scene.stiffness.model != "given" and scene.film.asked_heat != "off":
        yield HOT_FILM


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Mesh cycle with film, the film along the path, whole films and starved ones otherwise."""
    cycle, pair = computed.get(FILM), computed.get(PAIR)
    if cycle is None or pair is None:
        return
    yield of_record("lubricated", cycle)
    yield of_record("film", cycle.film)
    if cycle.over_face is not None:
        yield of_record("film_face", cycle.over_face)
    if cycle.over_lines is not None:
        yield of_record("film_lines", cycle.over_lines)
    for name, film in cycle.film.profiles.items():
        prefix = f"film_profile_{name.replace(' ', '_')}"
        yield of_record(prefix, film, THROUGH)
        yield of_record(prefix, film.contact, ("half_width",))
        rough = cycle.film.film_ratio is not None
        yield of_quantities(prefix, _whole_pressure(film, pair.reduced_modulus, rough))
    if cycle.otherwise:
        held = {film_parts.held_as_it_is(cycle): cycle, **cycle.otherwise}
        meaning = "mesh cycle with films that differ in what is held"
        yield of_models("held", held, meaning, no_error="not estimated for each of them")


def _whole_pressure(film: ehl.Film, modulus: float, rough: bool) -> Iterator[Quantity]:
    """Hertz pressure of a dry contact, and with rough flanks the pressure of film and asperities together.

    Both carry their share of the load at every point alike: the film's contact has this part of the modulus.
    """
    part = film.contact.reduced_modulus / modulus
    greatest = film.contact.peak_pressure / part
    yield figure_of(
        "hertz_pressure",
        "Pa",
        "Hertz pressure, the largest of the dry contact",
        "",
        greatest,
        shown="GPa",
        no_error=why_no_error(coupling.FilmAlongPath, "hertz_pressure"),
    )
    if rough:
        whole = film.pressure / part
        meaning = "pressure of film and asperities together"
        about = why_no_error(film, "pressure")
        yield figure_of("total_pressure", "Pa", meaning, "node", whole, shown="GPa", no_error=about)


def headlines(computed: Computed) -> Iterator[Headline]:
    """Minimum films; teeth run on the film with heat where there is one, which goes before this one."""
    if (cycle := computed.get(FILM)) is None:
        return
    warm = computed.get(LOSSES) is not None
    for headline in ranked(film_parts.headlines(cycle), 1):
        if warm and headline.name == film_parts.LEAST:
            yield replace(headline, name=f"{headline.name}, isothermal", rank=3)
        else:
            yield headline


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """The film along the path and through single contacts."""
    if (cycle := computed.get(FILM)) is not None:
        yield film_parts.film(cycle, results, computed.scene.tolerance)


def _of_films(cycle: coupling.LubricatedCycle, computed: Computed) -> Work:
    plan, film = computed.get(PLAN), cycle.film
    if plan is None or film.model != "ehl":
        return Work()
    films, rounds = counted(film.rho1.size, "film"), counted(cycle.rounds, "round")
    note = f"{films} of up to {counted(film.cost.unknowns, 'unknown')}, {rounds}"
    return Work("film thickness", plan.film_tolerance, film.error, note)


def _at_point(point: str, figure: str) -> Take:
    """A curve along the path at A, B, C, D or E: of the nearest film, since curves step at B and D.

    B and D count as ends of the single-pair zone.
    """

    def of(engine: Engine) -> float:
        film, points = engine[FILM].film, engine[PAIR].points
        inside = {"B": 1e-6, "D": -1e-6}.get(point, 0.0)
        towards = film.rho1 - (getattr(points, point) + inside)
        nearest = np.abs(towards) if not inside else np.where(towards * inside > 0, np.abs(towards), np.inf)
        return float(getattr(film, figure)[int(np.argmin(nearest))])

    return of


def _at_points() -> Iterator[Named]:
    """Film and pressure at the points of the path."""
    for name, figure in (("least_film", "minimum_thickness"), ("hertz_pressure", "hertz_pressure")):
        about = figures(coupling.FilmAlongPath)[figure]
        for point in "ABCDE":
            value, known = _at_point(point, figure), "film_error" if name == "least_film" else ""
            yield output_of(
                f"{name}_at_{point}", about, "film", value, f"{{}} at {point}", error_output=known
            )


def _through(name: str, figure: Figure, value: Take, error: Take | None = None) -> Named:
    """Figure of the pressure and film through the contact nearest to C; nan where it has none."""

    def at_c(take: Take) -> Of:
        def of(engine: Engine) -> Any:
            film = engine[FILM].film.profiles.get("C")
            return None if film is None else take(film)

        return of

    return output_of(
        f"{name}_at_C", figure, "film", at_c(value), error=None if error is None else at_c(error)
    )


def _of_spike(value: Callable[[Any, Any], float]) -> Take:
    """Figure of the spike of a film that was solved for it; None where grids do not resolve it."""

    def of(film: Any) -> float | None:
        known = film.spike is not None and np.isfinite(film.spike.error)
        return value(film.spike, film.contact) if known else None

    return of


def _regime(cycle: coupling.LubricatedCycle) -> float | None:
    """Regime of the minimum film; None for smooth flanks."""
    ratio = cycle.film.least_film_ratio
    return None if ratio is None else regime_number(ratio)


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    from ehl import Spike

    of_film = outputs_from(lambda engine: engine[FILM].film, coupling.FilmAlongPath, "film")
    of_lubricated = outputs_from(lambda engine: engine[FILM], coupling.LubricatedCycle, "film")
    return (
        of_film("least_film", error_output="least_film_error"),
        of_film(
            "central_thickness",
            np.min,
            "least_central_film",
            "minimum {} along the path",
            error_output="film_error",
        ),
        output_of(
            "film_at_C",
            figures(coupling.FilmAlongPath)["central_thickness"],
            "film",
            lambda engine: np.interp(
                engine[PAIR].points.C, engine[FILM].film.rho1, engine[FILM].film.central_thickness
            ),
            "{} at the pitch point",
            error_output="film_error",
        ),
        of_film("greatest_pressure", name="hertz_pressure"),
        of_lubricated("secant_stiffness_change", name="film_change"),
        *_at_points(),
        _through(
            "spike",
            Figure(
                "Pa",
                f"pressure spike of the contact at C; {UNRESOLVED}",
                shown="GPa",
            ),
            _of_spike(lambda spike, contact: spike.pressure),
            _of_spike(lambda spike, contact: spike.error),
        ),
        _through(
            "spike_over_hertz",
            Figure("1", f"pressure spike of the contact at C over its Hertz pressure; {UNRESOLVED}"),
            _of_spike(lambda spike, contact: spike.pressure / contact.peak_pressure),
            _of_spike(lambda spike, contact: spike.error),
        ),
        _through(
            "spike_position",
            Figure(
                "1",
                f"place of the pressure spike at C, in half-widths after the middle; {UNRESOLVED}",
                no_error=why_no_error(Spike, "position"),
            ),
            _of_spike(lambda spike, contact: spike.position / contact.half_width),
        ),
        _through(
            "neck_position",
            Figure(
                "1",
                "place of the minimum film at C, in half-widths after the middle",
                no_error="not estimated: a film is flat at its minimum; the film itself has an error there",
            ),
            lambda film: film.minimum_position / film.contact.half_width,
        ),
        _through(
            "neck_depth",
            Figure(
                "1",
                "minimum over central film of the contact at C",
                no_error="not estimated: the ratio of two films that have an error and err alike",
            ),
            lambda film: film.minimum_thickness / film.central_thickness,
        ),
        of_film(
            "least_film_ratio",
            name="film_ratio",
            said="{}; nan if smooth",
            error_output="least_film_error",
        ),
        output_of(
            "regime",
            Figure("1", f"regime at the minimum film ratio: {NUMBERS}; nan if smooth", no_error=CLASS),
            "film",
            in_result(FILM, _regime),
        ),
        of_film(
            "asperity_share",
            np.max,
            said="largest {} along the path; nan if smooth",
            error="greatest_asperity_share_error",
        ),
        of_film("starvation", np.min, said="minimum {} along the path; nan if flooded"),
        output_of(
            "least_film_error",
            Figure("1", "estimated relative error of the minimum film and film ratio; nan where unknown"),
            "film",
            in_result(FILM, attrgetter("film.least_film_error")),
        ),
        output_of(
            "film_error",
            Figure("1", "largest estimated relative error of the films; nan where unknown"),
            "film",
            in_result(FILM, attrgetter("film.error")),
        ),
    )


PRODUCT = Product(
    name="film",
    goals=goals,
    variables=variables,
    solved=dict.fromkeys(("lubricated", "film", "held"), FILM),
    tables={
        "mesh_cycle_lubricated": CurveTable("lubricated", "position", CYCLE),
        "film_along_path": CurveTable("film", "rho1", axis="point"),
        "film_on_lines": CurveTable(
            "film_lines",
            "minimum_thickness",
            ("z", "travel", "line_load", "minimum_thickness", "central_thickness", "hertz_pressure"),
        ),
    },
    headlines=headlines,
    pictures=film_parts.PICTURES,
    sections=sections,
    work={FILM.name: _of_films},
    outputs=outputs,
)
