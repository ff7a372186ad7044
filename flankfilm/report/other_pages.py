"""Pages of studies, optimisations and verifications."""

from __future__ import annotations

import functools
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flankfilm import figures
from flankfilm.figures.reading import titled, unit_of, unit_text, words
from flankfilm.figures.studies import varied_numbers
from flankfilm.output.files import write_text
from flankfilm.report.page import Fact, Headline, Part, Table, picture, render
from flankfilm.report.run_parts import inputs
from flankfilm.report.text import number, percent, seconds

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling import Verification
    from flankfilm.optimisation.run import Optimum
    from flankfilm.optimisation.task import Task
    from flankfilm.studies.plan import Plan, Value
    from flankfilm.studies.row import RowResult
    from flankfilm.studies.run import StudyResults

MOST_ROWS = 100
"""Rows that a page shows; the files hold all."""


def write_study_page(found: StudyResults, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of a study and return its path.

    Parameters
    ----------
    found : StudyResults
    data : xarray.Dataset
        What ``study.nc`` holds.
    folder : Path
    """
    plan, rows = found.plan, len(found.rows)
    headlines = [
        Headline(words(data, name), *_range(data, name))
        for name in plan.outputs
        if np.isfinite(data[name]).any()
    ]
    failed = Counter(row.fault for row in found.failures)
    notes = [f"{count} rows failed: {fault}" for fault, count in failed.most_common(20)]
    drawn = []
    if varied_numbers(data, plan.keys[: plan.varied]):
        draw = functools.wraps(figures.study)(
            functools.partial(figures.study, keys=plan.keys[: plan.varied], outputs=plan.outputs)
        )
        drawn.append(
            picture(draw, data, f"Every output against {plan.keys[0]}; the other keys make families.")
        )
    left = f"The first {MOST_ROWS} of {rows}; rows.csv and study.nc hold all." if rows > MOST_ROWS else ""
    shown = found.rows[:MOST_ROWS]
    table = _rows(data, plan, [(plan.rows[row.index], row) for row in shown], left)
    facts = [
        Fact(f"{rows} rows, {plan.design}", "rows"),
        Fact(f"{seconds(float(data['seconds'].sum()))} of work"),
        *([Fact(f"{len(found.failures)} failed", "faults")] if found.failures else []),
    ]
    parts = [
        Part("study", "Outputs", figures=tuple(drawn)),
        *([Part("faults", "Rows that failed", notes=tuple(notes))] if notes else []),
        Part("rows", "Rows", tables=(table,)),
        _inputs(data),
    ]
    return _write(folder, plan.title or "Study", facts, headlines, parts)


def write_optimum_page(found: Optimum, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of an optimisation and return its path.

    Parameters
    ----------
    found : Optimum
    data : xarray.Dataset
        What ``optimum.nc`` holds.
    folder : Path
    """
    task, points = found.task, found.evaluations
    chosen = [points[place] for place in found.best]
    first = dict(zip(task.outputs, chosen[0].result.values, strict=True))
    which = "" if len(chosen) == 1 else "where the first objective is best"
    headlines = [
        Headline(words(data, name), number(first[name], 5), which, unit_of(data, name, ""))
        for name in task.outputs
    ]
    if len(chosen) == 1:
        headlines += [
            Headline(key, _cell(value), "at the optimum")
            for key, value in zip(task.keys, chosen[0].values, strict=True)
        ]
    table = _rows(data, task, [(point.values, point.result) for point in chosen[:MOST_ROWS]])
    one = len(task.objectives) == 1
    caption = (
        "The objective of every point, in the order in which they were computed."
        if one
        else "Each two objectives of every point; the front is what no other point betters in all."
    )
    note = (
        f"Far from the optimum points were computed at a tolerance of {percent(task.tolerances[0])}, near it at the "
        f"scene's own {percent(task.tolerances[1])}. The scene of the first row is in optimum.toml."
    )
    facts = [
        Fact(f"{len(points)} points", "points"),
        Fact(f"{seconds(float(data['seconds'].sum()))} of work"),
        Fact("one optimum" if one else f"{len(chosen)} points on the front", "best"),
    ]
    parts = [
        Part("points", "Points", figures=(picture(figures.optimum, data, caption),)),
        Part("best", "Optimum" if one else "Front", tables=(table,), notes=(note,)),
        _inputs(data),
    ]
    return _write(folder, task.title or "Optimisation", facts, headlines, parts)


def write_verification_page(found: Verification, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of a verification and return its path.

    Parameters
    ----------
    found : Verification
    data : xarray.Dataset
        What ``verify.nc`` holds.
    folder : Path
    """
    like, whole = found.like_for_like, found.references[0]
    headlines = []
    for model in found.models:
        by_figure = {
            d.figure: d for d in found.differences if (d.model, d.reference) == (model.label, whole.label)
        }
        if (mean := by_figure.get("mesh, mean")) is not None:
            headlines.append(
                Headline(
                    f"{model.label}: mean mesh stiffness",
                    f"{100 * mean.difference:+.1f}",
                    f"against finite elements, whose error is {percent(mean.reference_error)}",
                    "%",
                )
            )
    tables = tuple(_differences(found, reference.label) for reference in (whole, like))
    cost = "; ".join(f"{c.label} {seconds(c.cost.seconds)}" for c in (*found.references, *found.models))
    shared = f"Finite elements {seconds(found.cost.seconds)} once; then each model: {cost}."
    work = found.cost.seconds + sum(c.cost.seconds for c in found.references)
    caption = (
        "Closed forms beside finite elements (black: with all parts; dashed: without what closed forms lack). Grey: "
        "the numerical error of the latter."
    )
    facts = [
        Fact(
            f"{found.pair.pinion.teeth}/{found.pair.wheel.teeth} teeth, module {1e3 * found.pair.module:g} mm"
        ),
        Fact(f"pinion: {found.torque:g} N m"),
        Fact(f"{seconds(work)} of work", "costs"),
    ]
    parts = [
        Part("curves", "Curves", figures=(picture(figures.verification, data, caption),)),
        Part("differences", "Differences", tables=tables),
        Part("costs", "Cost", (shared,)),
        _inputs(data),
    ]
    return _write(folder, str(data.attrs["title"]) or "Closed forms", facts, headlines, parts)


def _differences(found: Verification, reference: str) -> Table:
    """Every figure of every model against one reference."""
    models = [model.label for model in found.models]
    mine = {(d.figure, d.model): d for d in found.differences if d.reference == reference}
    rows = []
    for figure in dict.fromkeys(name for name, _ in mine):
        first = next(d for (name, _), d in mine.items() if name == figure)
        own = f"{first.reference_value:.4g} ± {100 * first.reference_error:.2g} %"
        cells = [mine.get((figure, model)) for model in models]
        values = ["" if d is None else f"{d.value:.4g} ({100 * d.difference:+.1f} %)" for d in cells]
        rows.append((f"{figure} [{unit_text(first.unit)}]", own, *values))
    against = reference if reference == "finite elements" else f"finite elements {reference}"
    return Table(("figure", "finite elements", *models), tuple(rows), f"Against {against}")


def _inputs(data: xr.Dataset) -> Part:
    scene = json.dumps(json.loads(data.attrs["scene_json"]), indent=2, ensure_ascii=False)
    return inputs(scene, json.loads(data.attrs["versions_json"]))


def _range(data: xr.Dataset, name: str) -> tuple[str, str, str]:
    """Least and greatest value, what it is, and the unit."""
    values = data[name].values
    low, high = number(float(np.nanmin(values))), number(float(np.nanmax(values)))
    return (
        low if low == high else f"{low} to {high}",
        str(data[name].attrs["long_name"]),
        unit_of(data, name, ""),
    )


def _rows(
    data: xr.Dataset,
    asked: Plan | Task,
    points: Sequence[tuple[Sequence[Value], RowResult]],
    caption: str = "",
) -> Table:
    """Numbers of rows, values of their keys, and their outputs."""
    heads = ("row", *asked.keys, *(titled(data, name) for name in asked.outputs))
    cells = tuple(
        (str(result.index), *map(_cell, values), *(number(value, 5) for value in result.values))
        for values, result in points
    )
    return Table(heads, cells, caption)


def _cell(value: Value) -> str:
    return number(value, 6) if isinstance(value, float | int) else value


def _write(
    folder: Path, title: str, facts: Sequence[Fact], headlines: Sequence[Headline], parts: Sequence[Part]
) -> Path:
    path = folder / "report.html"
    write_text(path, render(title, facts, headlines, parts))
    return path
