"""Gathers a run's results into the report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.coupling.cycle import MeshCycle, sampling_error
from flankfilm.figures.reading import read_figure
from flankfilm.output.files import provenance, write_text
from flankfilm.report import diagram_parts, film_parts, load_parts, mesh_parts, motion_parts, run_parts
from flankfilm.report.page import Fact, Headline, Part, render
from flankfilm.report.run_parts import CostRow
from flankfilm.report.text import percent, seconds

if TYPE_CHECKING:
    from flankfilm.coupling import LubricatedCycle
    from flankfilm.results import Results


Work = tuple[str, float | None, float | None, str]
"""Figure, share of the tolerance, error, and what was done."""

NOTHING: Work = ("", None, None, "")

LEAST_SECONDS = 0.005
"""Time of a stage that is listed although it has no error of its own [s]."""


def headlines(results: Results) -> list[Headline]:
    """Numbers for the page's head and for the terminal."""
    values, shown = results.values, []
    cycle = final_cycle(results)
    if cycle is not None:
        shown += mesh_parts.headlines(cycle, values["pair"].face_width)
    if (film := values.get("film")) is not None:
        shown += film_parts.headlines(film)
    if (roots := values.get("root stress")) is not None:
        shown.append(load_parts.headline(roots))
    if (fourier := values.get("fourier")) is not None:
        shown.append(motion_parts.fourier_headline(fourier))
    if (sweep := values.get("sweep")) is not None:
        shown.append(motion_parts.headline(sweep))
    if (diagram := values.get("diagram")) is not None:
        shown.append(diagram_parts.headline(diagram))
    return shown


def summary(results: Results) -> list[str]:
    """Lines for the terminal: headline figures with errors, and the files."""
    lines = [f"{h.name}: {h.with_unit}" + (f" ({h.note})" if h.note else "") for h in headlines(results)]
    lines += [decision.line for decision in results.decisions]
    if results.plan is not None:
        lines.append(results.plan.line)
    return [*lines, f"{results.written} after {results.seconds:.1f} s"]


def final_cycle(results: Results) -> MeshCycle | None:
    """Return the mesh cycle with the film where there is one, else the dry one."""
    found: MeshCycle | None = results.values.get("film", results.values.get("dry cycle"))
    return found


def write_report(results: Results, folder: Path) -> Path:
    """Write ``report.html`` into a folder and return its path."""
    scene = results.scene
    parts = [part for part in (*_result_parts(results), *_run_parts(results)) if part is not None]
    path = folder / "report.html"
    write_text(path, render(scene.title or "flankfilm", _facts(results), headlines(results), parts))
    return path


def _facts(results: Results) -> list[Fact]:
    """What was computed, how well, and at what cost, in a line."""
    scene, facts = results.scene, []
    if (pair := results.values.get("pair")) is not None:
        facts.append(
            Fact(
                f"{pair.pinion.teeth}/{pair.wheel.teeth} teeth, module {1e3 * pair.module:g} mm, "
                f"face {1e3 * pair.face_width:g} mm",
                "geometry",
            )
        )
        if scene.operating is not None:
            torque, speed = scene.operating.pinion_torque_Nm, scene.operating.pinion_speed_rpm
            at = [
                f"{value:g} {unit}" for value, unit in ((torque, "N m"), (speed, "rpm")) if value is not None
            ]
            facts.append(Fact("pinion: " + ", ".join(at)))
    facts.append(Fact(f"tolerance {percent(scene.tolerance)}, {seconds(results.seconds)}", "costs"))
    if count := sum(len(run.warnings) for run in results.runs.values()):
        facts.append(Fact(f"{count} warning{'s' if count > 1 else ''}", "decisions"))
    return facts


def _result_parts(results: Results) -> list[Part | None]:
    values, scene, data = results.values, results.scene, results.dataset
    pair, cycle = values.get("pair"), final_cycle(results)
    parts: list[Part | None] = []
    if pair is not None:
        parts.append(mesh_parts.geometry(pair, data))
    if cycle is not None and pair is not None:
        film = values.get("film")
        cycles = dict.fromkeys((cycle, values["dry cycle"], *values.get("other cycles", ())))
        notes = _film_notes(results, film)
        parts.append(
            mesh_parts.stiffness(values.get("closed forms"), list(cycles), notes, pair.face_width, data)
        )
        if film is not None:
            parts.append(film_parts.film(film, data, scene.tolerance))
    if (torques := values.get("torques")) is not None:
        parts.append(load_parts.over_torque(torques, data))
    if (whole := values.get("revolution")) is not None:
        parts.append(load_parts.revolution(whole, data))
    if (roots := values.get("root stress")) is not None:
        parts.append(load_parts.root_stress(roots, data))
    if (fields := values.get("fields")) is not None:
        parts.append(mesh_parts.fields(fields, data))
    if (fourier := values.get("fourier")) is not None:
        parts.append(motion_parts.fourier(fourier, data))
    if (scaling := values.get("scaling")) is not None:
        parts.append(motion_parts.scaling(scaling))
        if (sweep := values.get("sweep")) is not None:
            parts.append(motion_parts.sweep(sweep, data))
        if (diagram := values.get("diagram")) is not None:
            parts.append(diagram_parts.diagram(diagram, data))
    return parts


def _film_notes(results: Results, film: LubricatedCycle | None) -> list[str]:
    """Why there is a film or none, and what it changes."""
    notes = [] if results.plan is None else [f"Film: {results.plan.film.reason}."]
    if film is not None:
        for kind, name in (("secant", "secant_stiffness_change"), ("tangent", "stiffness_change")):
            change = read_figure(film, name)
            notes.append(
                f"The film changes the mean {kind} stiffness by {float(change.values):+.2f} {change.unit}."
            )
    return notes


def _run_parts(results: Results) -> list[Part | None]:
    scene = results.scene
    made = provenance(scene.model_dump_json())
    return [
        run_parts.costs(_cost_rows(results), results.seconds, scene.tolerance),
        run_parts.decisions(results.decisions, results.plan, results.runs),
        run_parts.inputs(
            json.dumps(scene.model_dump(exclude_none=True), indent=2, ensure_ascii=False),
            json.loads(made["versions_json"]),
        ),
    ]


def _cost_rows(results: Results) -> list[CostRow]:
    """Error and work of each stage that ran, in the order of the house."""
    return [
        CostRow(run.title, *_work(name, results), run.seconds, run.cached)
        for name, run in results.runs.items()
        if _work(name, results) != NOTHING or run.seconds >= LEAST_SECONDS
    ]


def _work(name: str, results: Results) -> Work:
    """Which figure a stage's error belongs to, what was allowed, the error, and what was done for it."""
    value: Any = results.values.get(name)
    plan, tolerance = results.plan, results.scene.tolerance
    if name == "bodies" and plan is not None:
        work = f"{value.cost.unknowns:,} unknowns"
        return "tooth compliance", plan.resolution.compliance, value.error, work
    if name == "dry cycle" and plan is not None:
        sampled = sampling_error(value.secant_stiffness)
        work = f"{value.position.size} positions"
        return "mean stiffness, from sampling", plan.resolution.sampling, sampled, work
    if name == "fillets":
        return "greatest root stress per load", tolerance, value.error, f"{value.cost.unknowns:,} unknowns"
    if name == "film" and plan is not None and value.film.model == "ehl":
        film = value.film
        work = f"{film.rho1.size} films of up to {film.cost.unknowns} unknowns, {value.rounds} rounds"
        return "film thickness", plan.film_tolerance, film.error, work
    if name == "fourier" and value.fit is not None:
        allowed = None if plan is None else plan.series
        return "what the series leaves out", allowed, value.remainder, f"order {value.order}"
    if name == "sweep":
        return "settled motions", None, value.error, f"{value.cost.periods:,} periods"
    if name == "diagram":
        return "special points", None, value.error, f"{value.branches} branches"
    return NOTHING
