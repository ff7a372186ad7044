"""The mesh cycle: stiffness, transmission error, load share and contacts, by the chosen and by the other models."""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

import fem
from base import Figure, Quantity
from base.results import EXACT, ITSELF, figures, why_no_error
from flankfilm import coupling
from flankfilm.building.pair import pinion_speed_if_any
from flankfilm.figures.reading import PER_FACE, read_figure
from flankfilm.output.variables import figure_of, of_models, of_quantities, of_record, sentence
from flankfilm.products.closed_forms import CLOSED_FORMS
from flankfilm.products.output import (
    Held,
    Named,
    Of,
    Take,
    error_in,
    in_result,
    model_error_of,
    output_of,
    outputs_from,
)
from flankfilm.products.product import CurveTable, Product, ranked
from flankfilm.report import stiffness_parts
from flankfilm.report.page import Headline, Part, said
from flankfilm.report.run_parts import Work
from flankfilm.report.text import counted
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine, Stage, stage
from flankfilm.stages.mesh import (
    BODIES,
    COMPLIANCE,
    DRY_CYCLE,
    FACE_GEARS,
    FILM,
    MESH,
    PAIR,
    PLAN,
    TEETH,
    along_the_face,
    loaded_teeth,
    with_arcs,
)

if TYPE_CHECKING:
    import xarray as xr

CYCLE = ("position", "secant_stiffness", "tangent_stiffness", "transmission_error", "load_share")
"""Columns of a mesh cycle."""

CONTACTS = ("unloaded_transmission_error", "hertz_pressure", "half_width")
"""Figures of a loaded contact by finite elements that stand beside those which every model has."""

OTHERS = "unknown: closed forms, or pairs without a common body; other_mean_error and other_range_error are numerical"

MEANS = {"mean_secant_stiffness": "mean_error", "transmission_error_range": "range_error"}
"""Figures of mesh cycles to those that hold their errors."""

PRESSED = {"stiffness", "film", "root-stress"}
"""Wants of a scene for which the contact pressure is shown."""

OLDER = "older name, kept for one version, of"

MEAN_STIFFNESS: Held = {
    "error_output": "tangent_stiffness_error",
    "model_output": "tangent_stiffness_model_error",
}


@stage("references", "stiffness by reference", "dynamics", COMPLIANCE, DRY_CYCLE)
def REFERENCES(run: Engine) -> coupling.StiffnessReferences | None:
    """Mean stiffness against bodies, bores and teeth, and the parts of the deflection; None by closed forms."""
    cycle = run[DRY_CYCLE]
    if cycle.contact is None:
        return None
    return coupling.stiffness_references(run[PAIR], cycle, run[COMPLIANCE], run.scene.bore_inertia)


@stage("other cycles", "mesh cycle by the other models", TEETH, DRY_CYCLE)
def OTHER_CYCLES(run: Engine) -> tuple[coupling.MeshCycle, ...]:
    """Mesh cycles by the models that the scene did not choose: independent pairs added, without film."""
    return tuple(map(with_arcs, loaded_teeth(run).others(run[DRY_CYCLE].position.size)))


def goals(scene: Scene, wants: Set[str]) -> Iterator[Stage[Any]]:
    """The mesh cycle, with the film that the scene gives it, and other models where they are looked at."""
    if scene.stiffness.model == "given" or not wants & {"stiffness", "film"}:
        return
    yield PLAN
    if along_the_face(scene):
        yield FACE_GEARS
    yield from (DRY_CYCLE, REFERENCES)
    if wants & {"closed-forms", "report"} and not (scene.pair is not None and scene.pair.helical):
        yield OTHER_CYCLES
    if scene.film.model != "none" or "film" in wants:
        yield MESH


def variables(computed: Computed) -> Iterator[xr.Dataset]:
    """The dry cycle with its contacts, stiffness by reference, and the other models."""
    if (dry := computed.get(DRY_CYCLE)) is not None:
        yield of_record("dry", dry)
        if dry.contact is not None:
            yield of_record("dry", dry.contact, CONTACTS)
            yield of_quantities("dry", _sliding(dry.contact, pinion_speed_if_any(computed.scene)))
    if (references := computed.get(REFERENCES)) is not None:
        yield of_record("reference", references)
    if others := computed.get(OTHER_CYCLES):
        labelled = {cycle.label: cycle for cycle in others}
        yield of_models("other", labelled, "model of the mesh cycle", errors=MEANS, no_error=OTHERS)


def _sliding(contact: fem.MeshCycle, speed: float | None) -> Iterator[Quantity]:
    """Sliding of a loaded contact, at a speed of the pinion [rad/s] where there is one; nan where nothing touches."""
    touching = contact.forces > 0
    specific = np.where(touching, contact.specific_sliding, np.nan)
    yield figure_of(
        "specific_sliding",
        "1",
        "sliding over the flank's own speed",
        "gear position pair",
        specific,
        no_error=EXACT,
    )
    if speed is not None:
        sliding = np.where(touching, contact.sliding(speed), np.nan)
        yield figure_of(
            "sliding",
            "m/s",
            "sliding speed u1 - u2, negative before C",
            "position pair",
            sliding,
            no_error=EXACT,
        )


def final_cycle(computed: Computed) -> coupling.MeshCycle | None:
    """Return the mesh cycle with the film where there is one, else the dry one."""
    lubricated = computed.get(FILM)
    return computed.get(DRY_CYCLE) if lubricated is None else lubricated


def headlines(computed: Computed) -> Iterator[Headline]:
    """Mean stiffnesses, transmission error and contact pressure."""
    cycle, pair, dry = final_cycle(computed), computed.get(PAIR), computed.get(DRY_CYCLE)
    if cycle is not None and pair is not None:
        shown = ranked(stiffness_parts.headlines(cycle, pair.face_width), 2, 2, 2)
        if computed.failed(FILM):  # figures of dry teeth must not pass for lubricated ones
            shown = [replace(headline, name=f"{headline.name}, without the film") for headline in shown]
        yield from shown
    if dry is not None and dry.contact is not None and PRESSED & set(computed.scene.wants):
        yield from ranked(stiffness_parts.pressure_headlines(dry.contact, computed.get(CLOSED_FORMS)), 1)


def sections(computed: Computed, results: xr.Dataset) -> Iterator[Part]:
    """Stiffness of all models, and by the reference of the deflection."""
    pair, cycle, dry = computed.get(PAIR), final_cycle(computed), computed.get(DRY_CYCLE)
    if pair is None or cycle is None or dry is None:
        return
    cycles = list(dict.fromkeys((cycle, dry, *(computed.get(OTHER_CYCLES) or ()))))
    single, notes = computed.get(CLOSED_FORMS), _film_notes(computed)
    yield stiffness_parts.stiffness(single, dry.contact, cycles, notes, pair.face_width, results)
    if (references := computed.get(REFERENCES)) is not None:
        yield stiffness_parts.references(references, pair.face_width)


def _film_notes(computed: Computed) -> list[str]:
    """The reason for the film or its absence, and the changes of stiffness by the film."""
    if computed.failed(FILM):
        return [said("film_failed")]
    plan, film = computed.get(PLAN), computed.get(FILM)
    notes = [] if plan is None else [f"Film: {plan.film.reason}."]
    if film is not None:
        for kind, name in (("secant", "secant_stiffness_change"), ("tangent", "stiffness_change")):
            change = read_figure(film, name)
            notes.append(
                f"The film changes the mean {kind} stiffness by {float(change.values):+.2f} {change.unit}."
            )
    return notes


def _of_bodies(value: fem.PairCompliance, computed: Computed) -> Work:
    plan = computed.get(PLAN)
    if plan is None:
        return Work()
    unknowns = counted(value.cost.unknowns, "unknown")
    return Work("tooth compliance", plan.resolution.compliance, value.error, unknowns)


def _of_cycle(value: coupling.MeshCycle, computed: Computed) -> Work:
    plan, arcs = computed.get(PLAN), value.arcs
    if plan is None or arcs is None:
        return Work()
    division = arcs.division
    mean, error = division.arcs.mean("secant_stiffness")
    samples = f"{counted(len(division.arcs.arcs), 'arc')}, {counted(division.samples, 'position')}"
    return Work("mean stiffness, from arcs", plan.resolution.sampling, error / mean, samples)


def _per_face(
    figure: str, take: Take = float, name: str = "", said: str = "{}", **held: Unpack[Held]
) -> Named:
    """Stiffness of the mesh per face width, with the film where the scene has one."""
    about = Figure("N/m", figures(coupling.MeshCycle)[figure].meaning, shown=PER_FACE)
    return output_of(
        name or figure,
        about,
        "stiffness",
        lambda engine: take(getattr(engine[MESH], figure)) / engine[PAIR].face_width,
        said,
        error_in(lambda engine: engine[MESH], figure),
        **held,
    )


def _harmonic(name: str, kind: str, curve: str, order: int) -> Named:
    about = Figure("1", f"amplitude of harmonic {order} of the {kind} stiffness over its mean")
    return output_of(
        f"{name}_{order}",
        about,
        "stiffness",
        in_result(MESH, lambda cycle: getattr(cycle, f"{curve}_harmonics")[order - 1]),
        error=_of_harmonic(curve, order),
    )


def _of_harmonic(curve: str, order: int) -> Of:
    """Error of a harmonic relative to itself; the cycle holds those of ratios to the mean."""

    def error(cycle: coupling.MeshCycle) -> float | None:
        errors, values = (getattr(cycle, f"{curve}_{name}") for name in ("harmonics_error", "harmonics"))
        return None if errors is None or values[order - 1] == 0.0 else errors[order - 1] / values[order - 1]

    return in_result(MESH, error)


def _error_of(figure: str, name: str) -> Named:
    about = Figure("1", f"estimated relative error: {sentence(figures(coupling.MeshCycle)[figure].meaning)}")
    return output_of(name, about, "stiffness", in_result(MESH, lambda cycle: cycle.errors[figure]))


def _harmonics_error(curve: str, name: str) -> Named:
    meaning = f"largest estimated error of the harmonics 1 to 5 of the {name} stiffness over its mean"
    about = Figure("1", meaning, no_error=ITSELF)

    def largest(cycle: coupling.MeshCycle) -> Any:
        errors = getattr(cycle, f"{curve}_harmonics_error")
        return None if errors is None else np.max(errors[:5])

    return output_of(f"{name}_harmonics_error", about, "stiffness", in_result(MESH, largest))


def outputs() -> tuple[Named, ...]:
    """Numbers that a study can ask for."""
    of_mesh = outputs_from(lambda engine: engine[MESH], coupling.MeshCycle, "stiffness")
    return (
        _per_face(
            "mean_secant_stiffness", error_output="stiffness_error", model_output="stiffness_model_error"
        ),
        _per_face("mean_stiffness", name="mean_tangent_stiffness", **MEAN_STIFFNESS),
        _per_face(
            "mean_stiffness", said=f"{{}}; {OLDER} mean_tangent_stiffness_N_per_mm_um", **MEAN_STIFFNESS
        ),
        _per_face("least_secant_stiffness"),
        _per_face("greatest_secant_stiffness", name="largest_secant_stiffness"),
        of_mesh(
            "transmission_error_range",
            name="transmission_error",
            error_output="transmission_error_error",
            model_output="transmission_error_model_error",
        ),
        *(_harmonic("harmonic", "secant", "secant_stiffness", order) for order in range(1, 6)),
        *(_harmonic("tangent_harmonic", "tangent", "stiffness", order) for order in range(1, 6)),
        of_mesh("mean_error", name="stiffness_error"),
        _error_of("mean_stiffness", "tangent_stiffness_error"),
        of_mesh("range_error", name="transmission_error_error"),
        _harmonics_error("secant_stiffness", "secant"),
        _harmonics_error("stiffness", "tangent"),
        output_of(
            "efficiency",
            Figure("1", "power out over power in", no_error=why_no_error(fem.MeshCycle, "efficiency")),
            "stiffness",
            in_result(MESH, lambda cycle: getattr(cycle.contact, "efficiency", None)),
            "{}, sliding of the dry contacts alone",
        ),
        *(
            model_error_of(f"{name}_model_error", meant, "stiffness", lambda engine: engine[MESH], figure)
            for name, meant, figure in (
                ("stiffness", "the mean secant stiffness", "mean_secant_stiffness"),
                ("tangent_stiffness", "the mean tangent stiffness", "mean_stiffness"),
                ("transmission_error", "the peak-to-peak transmission error", "transmission_error_range"),
            )
        ),
    )


PRODUCT = Product(
    name="stiffness",
    goals=goals,
    variables=variables,
    solved={"dry": DRY_CYCLE, "reference": REFERENCES, "other": OTHER_CYCLES},
    tables={
        "mesh_cycle_dry": CurveTable("dry", "position", CYCLE),
        "contacts_dry": CurveTable(
            "dry", "hertz_pressure", ("position", "forces", "hertz_pressure", "half_width", "sliding")
        ),
    },
    headlines=headlines,
    pictures=stiffness_parts.PICTURES,
    sections=sections,
    work={BODIES.name: _of_bodies, DRY_CYCLE.name: _of_cycle},
    outputs=outputs,
)
