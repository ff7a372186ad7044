"""Gathers a run's results into the report and the lines for the terminal."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.output.variables import merged
from flankfilm.plan.decisions import decisions
from flankfilm.processes.assistant import Assistant
from flankfilm.products import geometry
from flankfilm.products.catalogue import PRODUCTS
from flankfilm.report import pair_parts, run_parts
from flankfilm.report.page import Drawing, Fact, Head, Headline, Part, write_page
from flankfilm.report.text import counted, percent, seconds
from flankfilm.runs.dataset import results_dataset
from flankfilm.stages.computed import Computed
from flankfilm.stages.mesh import PAIR

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.outcome.results import Results
    from flankfilm.scene import Scene

GEOMETRY = {"geometry", "report"}
"""Wants of a scene whose geometry is printed whole."""

SHOWN = 5
"""Maximum number of foreign files that are named."""


def headlines(computed: Computed) -> list[Headline]:
    """Numbers for the page's head and for the terminal, with their errors against the scene's tolerance."""
    return [headline.against(computed.scene.tolerance) for headline in _headlines(computed)]


def misses(computed: Computed) -> list[str]:
    """Headlines whose error is above the tolerance of the scene, and messages of solvers."""
    above = [headline.miss(computed.scene.tolerance) for headline in _headlines(computed)]
    return [*filter(None, above), *run_parts.doubts(computed)]


def _headlines(computed: Computed) -> list[Headline]:
    shown = [headline for product in PRODUCTS for headline in product.headlines(computed)]
    pair = computed.values.get("pair")
    return shown if shown or pair is None else pair_parts.headlines(pair)


def figure_lines(computed: Computed) -> list[str]:
    """Lines for the terminal that are known before files are: headline figures with errors, and decisions."""
    if set(computed.scene.wants) <= GEOMETRY:
        lines = pair_parts.printed(results_dataset(computed))
    else:
        lines = [_line(headline) for headline in headlines(computed)]
    lines += misses(computed)
    lines += [decision.line for decision in decisions(computed.values)]
    if (plan := computed.values.get("plan")) is not None:
        lines.append(plan.line)
    return lines


def summary(results: Results) -> list[str]:
    """Lines for the terminal: `figure_lines`, and the files."""
    lines = [*figure_lines(results.computed), f"{results.written} after {results.seconds:.1f} s"]
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


@dataclass(frozen=True)
class Shown:
    """What of a report shows results, its pictures drawn: the longest work of a report.

    Attributes
    ----------
    head : Drawing or None
        The pair in mesh.
    parts : tuple of Part
        In the order of the report.
    """

    head: Drawing | None
    parts: tuple[Part, ...]


def draw_pair(computed: Computed) -> Shown:
    """Draw what shows the geometry: it needs no other stages, and so can be drawn while these are computed."""
    return _of_pair(computed, merged(geometry.PRODUCT.variables(computed), {}), None)


def draw(results: Results, helper: Assistant, of_pair: Shown | None = None) -> Shown:
    """Draw what shows results, but for what `draw_pair` has drawn.

    The helper draws pictures for phones meanwhile, where it has nothing else to do.
    """
    computed, data = results.computed, results.dataset
    first = of_pair or _of_pair(computed, data, helper)
    rest = (product.sections(computed, data) for product in PRODUCTS if product is not geometry.PRODUCT)
    return Shown(first.head, (*first.parts, *(part.drawn(helper) for parts in rest for part in parts)))


def _of_pair(computed: Computed, data: xr.Dataset, helper: Assistant | None) -> Shown:
    """Draw what shows the geometry; nothing without a pair."""
    parts = geometry.PRODUCT.sections(computed, data)
    head = None if computed.get(PAIR) is None else pair_parts.drawing(data)
    return Shown(head, tuple(part.drawn(helper) for part in parts))


def write_report(results: Results, folder: Path, shown: Shown | None = None) -> Path:
    """Write ``report.html`` into a folder and return its path.

    Parameters
    ----------
    results : Results
    folder : Path
    shown : Shown, optional
        Of `draw`, where it is at hand.
    """
    scene, warned = results.scene, run_parts.warnings(results, misses(results.computed))
    shown = shown or draw(results, Assistant())
    parts = [
        *run_parts.failures(results),
        *shown.parts,
        run_parts.costs(results, [_work(name, results) for name in results.runs]),
        *run_parts.decisions(results, warned),
        run_parts.inputs(_asked(scene), results.dataset.attrs["versions_json"]),
    ]
    head = Head(scene.title or "flankfilm", _facts(results), headlines(results.computed), warned, shown.head)
    return write_page(folder, head, parts)


def _asked(scene: Scene) -> dict[str, Any]:
    """Plain values of a scene; the defaults of [film] are left out if the scene has no such section.

    Contact beyond the path is what there was, also where the key is left out.
    """
    unsaid = set() if "film" in scene.model_fields_set else {"film"}
    asked = scene.model_dump(exclude_none=True, exclude=unsaid)
    asked["stiffness"]["contact_beyond_path"] = scene.tip_edges
    return asked


def _facts(results: Results) -> list[Fact]:
    """What was computed, at what tolerance and cost, in one line."""
    scene, facts = results.scene, []
    if count := len(results.failures):
        facts.append(Fact(f"{counted(count, 'part')} not computed", "failures"))
    if (pair := results.values.get("pair")) is not None:
        teeth = f"{pair.pinion.teeth}/{pair.wheel.teeth} teeth"
        size = f"module {1e3 * pair.module:g} mm, face {1e3 * pair.face_width:g} mm"
        size += f", helix angle {math.degrees(pair.helix_angle):.6g}°" if pair.helix_angle else ""
        facts.append(Fact(f"{teeth}, {size}", "geometry"))
        if scene.operating is not None:
            asked = {"N m": scene.operating.pinion_torque_Nm, "rpm": scene.operating.pinion_speed_rpm}
            at = [f"{value:g} {unit}" for unit, value in asked.items() if value is not None]
            facts.append(Fact("pinion: " + ", ".join(at)))
    facts.append(Fact(f"tolerance {percent(scene.tolerance)}, {seconds(results.seconds)}", "costs"))
    return facts


def _work(name: str, results: Results) -> run_parts.Work:
    """Figure that a stage's error belongs to, error allowed, error, and work."""
    about = next((product.work[name] for product in PRODUCTS if name in product.work), None)
    value = results.values.get(name)
    return run_parts.Work() if about is None or value is None else about(value, results.computed)
