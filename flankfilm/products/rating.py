"""Rating of the pair: safeties by standards, and beside them by our own load factors."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Set
from dataclasses import replace
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import gears.rating
from base import Figure
from base.results import ITSELF, figures
from flankfilm import coupling
from flankfilm.figures.reading import GEARS
from flankfilm.output.variables import of_record
from flankfilm.products.output import Named, Output, in_result, output_of, outputs_from
from flankfilm.products.product import CurveTable, Product, ranked
from flankfilm.products.root_stress import ROOT_STRESS
from flankfilm.report import rating_parts
from flankfilm.report.page import Headline, Part
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage, stage
from flankfilm.stages.mesh import PAIR
from flankfilm.stages.rating import LOADED_FACTORS, MOTION_FACTOR, OWN_CONTACT, RATING, own_factors
from gears.closed_form.record import STANDARD

if TYPE_CHECKING:
    import xarray as xr

PARTS = ("tolerances", "misalignment", "factors", "pitting", "bending", "scuffing", "spectrum")
"""Parts of a rating that have variables."""


@stage(
    "own rating",
    "rating with our own load factors",
    "wants",
    RATING,
    MOTION_FACTOR,
    LOADED_FACTORS,
    OWN_CONTACT,
    ROOT_STRESS,
)
def OWN_RATING(run: Engine) -> coupling.OwnRating | None:
    """Safeties with the factors that the run has; None where it has none."""
    factors = own_factors(run)
    if "root-stress" in run.scene.wants:
        stress = run[ROOT_STRESS].stress
        factors["tensions"] = stress.pinion.greatest_tension_Pa, stress.wheel.greatest_tension_Pa
        factors["tension_error"] = stress.error
    return coupling.own_rating(run[RATING], run[PAIR], **factors) if factors else None


def goals(_: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The rating, and our own factors beside it where other wants give them."""
    if "rating" in wants:
        yield from (RATING, OWN_RATING)


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """Safeties and every factor, by the standard and our own."""
    rating, own = computed.get(RATING), computed.get(OWN_RATING)
    if rating is None:
        return
    yield of_record("rating", rating)
    for name in PARTS:
        if (part := getattr(rating, name)) is not None:
            yield of_record(f"rating_{name}", part)
    yield of_record("rating_run_in", rating.factors.effective)
    if own is not None:
        yield of_record("rating_own", own)
        for name in ("motion", "loaded", "flanks"):
            if (part := getattr(own, name)) is not None:
                yield of_record(f"rating_{name}", part)
        if own.loaded is not None and own.loaded.worst_share is not None:
            yield of_record("rating_worst_share", own.loaded.worst_share)


def headlines(computed: Computed) -> Iterator[Headline]:
    """Smallest safeties and damage, first of the limits of the teeth."""
    if (rating := computed.get(RATING)) is not None:
        yield from ranked(rating_parts.headlines(rating, computed.get(OWN_RATING)), 1, 1, 1, 1)


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """The rating as an engineer signs it."""
    if (rating := computed.get(RATING)) is not None:
        yield rating_parts.section(rating, computed.get(OWN_RATING), results)


def _part(name: str) -> Callable[[Engine], Any]:
    """Part of a rating; None where it has none."""
    return lambda engine: getattr(engine[RATING], name)


def _of(part: str, kind: type) -> Callable[..., Named]:
    """Maker of outputs from the figures of a part of the rating, which may be None."""

    def make(figure: str, name: str, said: str = "{}", take: Callable[[Any], Any] = float) -> Named:
        about = figures(kind)[figure]

        def value(engine: Engine) -> Any:
            there = _part(part)(engine)
            quantity = None if there is None else getattr(there, figure)
            return None if quantity is None else take(quantity)

        known = Figure(about.unit, about.meaning, shown=about.shown, no_error=about.no_error or STANDARD)
        return output_of(name, known, "rating", value, said)

    return make


def _each(make: Callable[..., Named], figure: str, name: str, said: str) -> Iterator[Named]:
    """Outputs of both gears, and of the one with the smaller value."""
    for gear, called in enumerate(GEARS):

        def take(values: Any, gear: int = gear) -> float:
            return float(values[gear])

        yield make(figure, f"{name}_{called}", f"{said} of the {called}", take)
    yield make(figure, name, f"{said}, the smaller of both gears", min)


def _of_standard() -> Iterator[Named]:
    """Safeties, load factors and damage by standards."""
    pitting, bending = _of("pitting", gears.rating.PittingSafety), _of("bending", gears.rating.BendingSafety)
    yield from _each(pitting, "S_H", "S_H", "safety against pitting by ISO 6336-2")
    yield from _each(bending, "S_F", "S_F", "safety against breakage by ISO 6336-3; nan without an answer")
    scuffing = _of("scuffing", gears.rating.ScuffingSafety)
    yield scuffing(
        "S_intS", "S_S", "safety against scuffing by the integral temperature; nan without an answer"
    )
    yield scuffing("theta_int", "integral_temperature", "integral temperature of scuffing; nan without one")
    factors = _of("factors", gears.rating.LoadFactors)
    for name in ("K_v", "K_Hbeta", "K_Halpha"):
        yield factors(name, f"iso_{name}", "{} by ISO 6336-1")
    yield factors("N", "resonance_ratio")
    steps = _of("spectrum", gears.rating.SpectrumRating)
    for letter, what in (("H", "flanks"), ("F", "roots")):
        said = f"Miner's sum of the {what} at the required safety, the larger of both gears; nan without a spectrum"
        yield steps(f"damage_{letter}", f"damage_{what}", said, max)
        safe = f"safety of the {what} at which Miner's sum is 1, the smaller of both gears; nan without a spectrum"
        yield steps(f"S_{letter}", f"spectrum_S_{letter}", safe, min)
    yield steps(
        "life", "spectrum_life", "time until failure at the required safeties; nan without a spectrum"
    )


def _of_ours() -> Iterator[Named]:
    """Our own factors, and safeties with them; each asks for the want that gives it."""
    of_motion = outputs_from(lambda engine: engine[MOTION_FACTOR], coupling.MotionFactor, "rating")
    of_contact = outputs_from(lambda engine: engine[LOADED_FACTORS], coupling.LoadedFactors, "rating")
    yield _with("spectrum", of_motion("K_v", name="motion_K_v", error_output="motion_K_v_error"))
    yield _with(
        "spectrum", _error("motion_K_v_error", "the dynamic factor of the motion", MOTION_FACTOR, "error")
    )
    yield _with("stiffness", of_contact("K_H", name="contact_K_H", error_output="contact_K_H_error"))
    yield _with("stiffness", _error("contact_K_H_error", "the load factors", LOADED_FACTORS, "error"))
    for letter, what in (("H", "pitting"), ("F", "breakage")):
        name = f"own_S_{letter}"
        said = (
            f"safety against {what} with our own load factors, the smaller of both gears; with the dynamic factor of "
            "the motion where motion_K_v is asked for too"
        )
        figure = Figure("1", said, no_error="the standard's")
        yield _with(
            "stiffness", output_of(name, figure, "rating", _own(name[4:], min), error_output=f"{name}_error")
        )
        error = attrgetter(f"{name[4:]}_error")
        yield _with("stiffness", _error(f"{name}_error", f"the safety against {what}", OWN_RATING, error))


def _own(figure: str, take: Callable[[Any], Any]) -> Callable[[Engine], Any]:
    """Figure of the rating with our own factors."""

    def value(engine: Engine) -> Any:
        own = engine[OWN_RATING]
        quantity = None if own is None else getattr(own, figure)
        return None if quantity is None else take(quantity)

    return value


def _error(name: str, of: str, solver: Stage[Any], take: str | Callable[[Any], Any]) -> Named:
    """Output of an estimated error."""
    about = Figure("1", f"estimated relative error of {of}", no_error=ITSELF)
    getter = attrgetter(take) if isinstance(take, str) else take
    return output_of(name, about, "rating", in_result(solver, getter))


def _with(want: str, named: Named) -> Named:
    """Output that needs a second want beside the rating."""
    name, output = named
    wanting: Output = replace(output, wants=(*output.wants, want))
    return name, wanting


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    return (*_of_standard(), *_of_ours())


PRODUCT = Product(
    name="rating",
    goals=goals,
    variables=variables,
    solved={"rating": RATING, "rating_own": OWN_RATING, "rating_motion": MOTION_FACTOR},
    headlines=headlines,
    pictures=rating_parts.PICTURES,
    sections=sections,
    tables={
        "rating_spectrum": CurveTable(
            "rating_spectrum",
            "torque",
            ("torque", "speed", "cycles", "K_v", "K_Hbeta", "parts_H", "parts_F"),
        ),
        "dynamic_factor": CurveTable("rating_motion", "swept", ("swept", "factor")),
    },
    outputs=outputs,
)
