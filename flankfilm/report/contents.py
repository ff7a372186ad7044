"""Gathers a run's results into the report."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.coupling.mesh.mesh_curves import MeshCycle
from flankfilm.figures.reading import read_figure
from flankfilm.report import (
    drive_parts,
    excitation_parts,
    face_parts,
    film_parts,
    losses_parts,
    mesh_parts,
    motion_parts,
    oscillator_parts,
    pair_parts,
    run_parts,
    speed_parts,
)
from flankfilm.report.page import Fact, Head, Headline, Part, said, write_page
from flankfilm.report.text import counted, percent, seconds

if TYPE_CHECKING:
    import xarray as xr

    import fem
    from flankfilm.coupling import LubricatedCycle
    from flankfilm.outcome.results import Results
    from flankfilm.scene import Scene

ALONG_FLANKS = ("diameter", "face_place")
"""Abscissas of the drawings of measured flanks."""

HEADLINES: Mapping[str, Callable[[Any], list[Headline]]] = {
    "film": film_parts.headlines,
    "losses": losses_parts.headlines,
    "root stress": mesh_parts.root_headlines,
    "fourier": motion_parts.fourier_headlines,
    "sweep": motion_parts.sweep_headlines,
    "drive sweep": drive_parts.headlines,
    "diagram": motion_parts.diagram_headlines,
    "dynamic-map": speed_parts.map_headlines,
}
"""Stages with numbers for the page's head, after those of the mesh cycle."""

OF_CYCLE = (2, 2, 2)
"""Ranks of the figures of a mesh cycle."""

RANKS: Mapping[str, tuple[int, ...]] = {
    "film": (1,),
    "losses": (2, 2, 3, 1),
    "root stress": (1,),
    "sweep": (2, 2),
    "drive sweep": (2, 2, 2),
    "diagram": (2,),
    "dynamic-map": (2,),
}
"""Ranks on the page of the first figures of each stage; the others follow."""

PRESSED = {"stiffness", "film", "root-stress"}
"""Wants of a scene for which the contact pressure is shown."""

PARTS: Mapping[str, Callable[[Any, xr.Dataset], Part]] = {
    "torques": mesh_parts.over_torque,
    "revolution": mesh_parts.revolution,
    "root stress": mesh_parts.root_stress,
    "fields": mesh_parts.fields,
    "fourier": motion_parts.fourier,
    "excitation": excitation_parts.excitation,
    "film damping": motion_parts.film_damping,
    "scaling": oscillator_parts.scaling,
    "sweep": motion_parts.sweep,
    "drive": drive_parts.drive,
    "drive sweep": drive_parts.drive_sweep,
    "diagram": motion_parts.diagram,
    "spectrum": excitation_parts.spectrum,
    "run-up": speed_parts.run_up,
    "dynamic-map": speed_parts.dynamic_map,
}
"""Stages with separate sections, after geometry, stiffness and film."""

GEOMETRY = {"geometry", "report"}
"""Wants of a scene whose geometry is printed whole."""

SHOWN = 5
"""Maximum number of foreign files that are named."""


def headlines(results: Results) -> list[Headline]:
    """Numbers for the page's head and for the terminal, with their errors against the scene's tolerance."""
    return [headline.against(results.scene.tolerance) for headline in _headlines(results)]


def misses(results: Results) -> list[str]:
    """Headlines whose error is above the tolerance of the scene, and messages of solvers."""
    above = [headline.miss(results.scene.tolerance) for headline in _headlines(results)]
    return [*filter(None, above), *run_parts.doubts(results)]


def _headlines(results: Results) -> list[Headline]:
    values, cycle = results.values, final_cycle(results)
    shown = [] if cycle is None else mesh_parts.headlines(cycle, values["pair"].face_width)
    if _film_failed(results):  # figures of dry teeth must not pass for lubricated ones
        shown = [replace(headline, name=f"{headline.name}, without the film") for headline in shown]
    shown = _ranked(shown, OF_CYCLE)
    dry: MeshCycle | None = values.get("dry cycle")
    if dry is not None and dry.contact is not None and PRESSED & set(results.scene.wants):
        shown += _ranked(mesh_parts.pressure_headlines(dry.contact, values.get("closed forms")), (1,))
    if (bears := _over_face(results)) is not None:
        shown += _ranked(face_parts.headlines(bears), (1,))
    for name, numbers in HEADLINES.items():
        if (stage := values.get(name)) is not None:
            shown += _ranked(numbers(stage), RANKS.get(name, ()))
    operating = results.scene.operating
    if "sweep" in values and operating is not None and operating.pinion_speed_rpm is not None:
        shown += _ranked(motion_parts.operating_headlines(values["sweep"]), (1,))
    if "drive sweep" in values and operating is not None and operating.pinion_speed_rpm is not None:
        around = drive_parts.operating_headlines(values["drive sweep"], operating.pinion_speed_rpm)
        shown += _ranked(around, (1,))
    if "losses" in values:
        # teeth run on the film with heat: it goes before the isothermal one
        warm = {film_parts.LEAST: (", isothermal", 3), film_parts.LEAST_WITH_HEAT: ("", 1)}
        for i, headline in enumerate(shown):
            kind, rank = warm.get(headline.name, ("", headline.rank))
            shown[i] = replace(headline, name=headline.name + kind, rank=rank)
    pair = values.get("pair")
    return shown if shown or pair is None else pair_parts.headlines(pair)


def _ranked(headlines: list[Headline], ranks: tuple[int, ...]) -> list[Headline]:
    """Give the first figures of a stage their ranks on the page."""
    return [
        replace(headline, rank=rank) for headline, rank in zip(headlines, ranks, strict=False)
    ] + headlines[len(ranks) :]


def summary(results: Results) -> list[str]:
    """Lines for the terminal: headline figures with errors, and the files."""
    if set(results.scene.wants) <= GEOMETRY:
        lines = pair_parts.printed(results.dataset)
    else:
        lines = [_line(headline) for headline in headlines(results)]
    lines += misses(results)
    lines += [decision.line for decision in results.decisions]
    if results.plan is not None:
        lines.append(results.plan.line)
    lines.append(f"{results.written} after {results.seconds:.1f} s")
    if results.others:
        more = ", ..." if len(results.others) > SHOWN else ""
        lines.append(f"kept, not of this run: {', '.join(results.others[:SHOWN])}{more}")
    return lines


def _line(headline: Headline) -> str:
    """Headline on the terminal."""
    note = (
        f" {headline.note}"
        if headline.note.startswith("±")
        else f" ({headline.note})"
        if headline.note
        else ""
    )
    return f"{headline.name}: {headline.with_unit}{note}"


def final_cycle(results: Results) -> MeshCycle | None:
    """Return the mesh cycle with the film where there is one, else the dry one."""
    cycle: MeshCycle | None = results.values.get("film", results.values.get("dry cycle"))
    return cycle


def _over_face(results: Results) -> fem.FaceLoads | None:
    """Line loads over the face of the dry cycle; None where they are even."""
    dry: MeshCycle | None = results.values.get("dry cycle")
    return None if dry is None or dry.contact is None else dry.contact.face


def _film_failed(results: Results) -> bool:
    return any(failure.name == "film" for failure in results.failures)


def write_report(results: Results, folder: Path) -> Path:
    """Write ``report.html`` into a folder and return its path."""
    scene, warned = results.scene, run_parts.warnings(results, misses(results))
    parts = [
        *run_parts.failures(results),
        *_result_parts(results),
        run_parts.costs(results),
        *run_parts.decisions(results, warned),
        run_parts.inputs(_asked(scene), results.dataset.attrs["versions_json"]),
    ]
    drawing = None if results.values.get("pair") is None else pair_parts.drawing(results.dataset)
    head = Head(scene.title or "flankfilm", _facts(results), headlines(results), warned, drawing)
    return write_page(folder, head, parts)


def _asked(scene: Scene) -> dict[str, Any]:
    """Plain values of a scene; the defaults of [film] are left out if the scene has no such section."""
    unsaid = set() if "film" in scene.model_fields_set else {"film"}
    return scene.model_dump(exclude_none=True, exclude=unsaid)


def _facts(results: Results) -> list[Fact]:
    """What was computed, at what tolerance and cost, in one line."""
    scene, facts = results.scene, []
    if count := len(results.failures):
        facts.append(Fact(f"{counted(count, 'part')} not computed", "failures"))
    if (pair := results.values.get("pair")) is not None:
        teeth = f"{pair.pinion.teeth}/{pair.wheel.teeth} teeth"
        size = f"module {1e3 * pair.module:g} mm, face {1e3 * pair.face_width:g} mm"
        facts.append(Fact(f"{teeth}, {size}", "geometry"))
        if scene.operating is not None:
            asked = {"N m": scene.operating.pinion_torque_Nm, "rpm": scene.operating.pinion_speed_rpm}
            at = [f"{value:g} {unit}" for unit, value in asked.items() if value is not None]
            facts.append(Fact("pinion: " + ", ".join(at)))
    facts.append(Fact(f"tolerance {percent(scene.tolerance)}, {seconds(results.seconds)}", "costs"))
    return facts


def _result_parts(results: Results) -> list[Part]:
    values, data = results.values, results.dataset
    pair, cycle, film = values.get("pair"), final_cycle(results), values.get("film")
    parts = []
    if pair is not None:
        parts.append(pair_parts.geometry(pair, data))
        if (heat := values.get("heat")) is not None:
            parts.append(pair_parts.heat(heat))
        if any(f"flank_{gear}_{along}" in data for gear in ("pinion", "wheel") for along in ALONG_FLANKS):
            parts.append(mesh_parts.flanks(data))
        if cycle is not None:
            cycles = list(dict.fromkeys((cycle, values["dry cycle"], *values.get("other cycles", ()))))
            notes, width = _film_notes(results, film), pair.face_width
            single, dry = values.get("closed forms"), values["dry cycle"].contact
            parts.append(mesh_parts.stiffness(single, dry, cycles, notes, width, data))
            if (references := values.get("references")) is not None:
                parts.append(mesh_parts.references(references, width))
    if pair is not None and (bears := _over_face(results)) is not None:
        parts.append(face_parts.face(bears, values.get("load over the face"), data))
    if film is not None:
        parts.append(film_parts.film(film, data, results.scene.tolerance))
    if (lost := values.get("losses")) is not None:
        parts.append(losses_parts.losses(lost, data, results.scene))
    return parts + [part(values[name], data) for name, part in PARTS.items() if values.get(name) is not None]


def _film_notes(results: Results, film: LubricatedCycle | None) -> list[str]:
    """The reason for the film or its absence, and the changes of stiffness by the film."""
    if _film_failed(results):
        return [said("film_failed")]
    notes = [] if results.plan is None else [f"Film: {results.plan.film.reason}."]
    if film is not None:
        for kind, name in (("secant", "secant_stiffness_change"), ("tangent", "stiffness_change")):
            change = read_figure(film, name)
            notes.append(
                f"The film changes the mean {kind} stiffness by {float(change.values):+.2f} {change.unit}."
            )
    return notes
