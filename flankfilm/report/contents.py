"""Gathers a run's results into the report."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.coupling.cycle import MeshCycle, sampling_error
from flankfilm.dataset import provenance, write_text
from flankfilm.report import diagram_parts, film_parts, load_parts, mesh_parts, motion_parts, run_parts
from flankfilm.report.page import Fact, Headline, Part, render
from flankfilm.report.run_parts import CostRow
from flankfilm.report.text import percent, seconds

if TYPE_CHECKING:
    from flankfilm.results import Results


def headlines(results: Results) -> list[Headline]:
    """Numbers for the page's head and for the terminal."""
    values, shown = results.values, []
    cycle = final_cycle(results)
    if cycle is not None:
        shown += mesh_parts.headlines(cycle, values["pair"].face_width)
    if (film := values.get("film")) is not None:
        shown += film_parts.headlines(film)
    if (roots := values.get("root stress")) is not None:
        gears = (roots.stress.pinion, roots.stress.wheel)
        largest = [f"{1e-6 * gear.greatest_tension.stress_Pa:.4g}" for gear in gears]
        shown.append(
            Headline(
                "greatest root stress, pinion and wheel",
                " and ".join(largest),
                f"error {percent(roots.stress.error)}",
                "MPa",
            )
        )
    if (fourier := values.get("fourier")) is not None:
        kappa = (
            fourier.stiffness.amplitudes[0] / fourier.stiffness.mean if fourier.stiffness.amplitudes else 0.0
        )
        left = (
            "given"
            if fourier.fit is None
            else f"remainder {100 * fourier.fit.remainder_rms:.2g} % of the mean"
        )
        shown.append(Headline("first harmonic over the mean", f"{kappa:.4f}", left))
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
    return results.values.get("film") or results.values.get("dry cycle")


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
        cycles = [cycle]
        if film is not None:
            cycles.append(values["dry cycle"])
        cycles += values.get("other cycles", ())
        changes = (
            {} if film is None else {"secant": film.secant_stiffness_change, "tangent": film.stiffness_change}
        )
        parts.append(
            mesh_parts.stiffness(values.get("closed forms"), cycles, changes, _model_note(results), data)
        )
        if film is not None:
            parts.append(film_parts.film(film, data, scene.tolerance))
    if pair is not None and (torques := values.get("torques")) is not None:
        parts.append(load_parts.over_torque(torques, pair.face_width, data))
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


def _model_note(results: Results) -> str:
    plan = results.values.get("plan")
    return f"Film: {plan.film.reason}." if plan is not None else ""


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
    plan = results.plan
    scene_tolerance = results.scene.tolerance
    rows = []
    for name, run in results.runs.items():
        value: Any = results.values.get(name)
        figure, allowed, error, note = "", None, None, ""
        if name == "bodies":
            figure, allowed, error = (
                "tooth compliance",
                results.values["plan"].resolution.compliance,
                value.error,
            )
            note = f"{value.cost.unknowns:,} unknowns"
        elif name == "dry cycle":
            figure, allowed, error = (
                "mean stiffness, from sampling",
                results.values["plan"].resolution.sampling,
                sampling_error(value.secant_stiffness),
            )
            note = f"{value.position.size} positions"
        elif name == "fillets":
            figure, allowed, error = "greatest root stress per load", scene_tolerance, value.error
            note = f"{value.cost.unknowns:,} unknowns"
        elif name == "film" and value.film.model == "ehl":
            figure, allowed, error = "film thickness", results.values["plan"].film_tolerance, value.film.error
            note = f"{value.film.rho1.size} films of up to {value.film.cost.unknowns} unknowns, {value.rounds} rounds"
        elif name == "fourier" and value.fit is not None:
            figure, error = "what the series leaves out", value.fit.remainder_rms
            allowed = None if plan is None else plan.series
            note = f"order {len(value.stiffness.amplitudes)}"
        elif name == "sweep":
            figure, error = "settled motions", value.error
            note = f"{value.cost.periods:,} periods"
        elif name == "diagram":
            figure, error = "special points", value.diagram.error
            note = f"{len(value.diagram.branches)} branches"
        elif run.seconds < 0.005:
            continue
        rows.append(CostRow(run.title, figure, allowed, error, note, run.seconds, run.cached))
    return rows
