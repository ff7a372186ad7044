"""Pages of studies, optimisations and verifications."""

from __future__ import annotations

import functools
import json
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base import Booleans
from flankfilm import figures
from flankfilm.coupling.mesh.references import RELATIVE, relative_to
from flankfilm.coupling.mesh.verification import UNITS
from flankfilm.figures.optima import can_be_mapped
from flankfilm.figures.reading import key_title, key_words, titled, unit_of, unit_text, words
from flankfilm.figures.studies import varied_numbers
from flankfilm.optimisation.words import gained, tied
from flankfilm.output.uncertainty import Uncertainty, met
from flankfilm.report import face_parts
from flankfilm.report.page import Fact, Head, Headline, Part, Table, picture, pictures, said, write_page
from flankfilm.report.run_parts import inputs
from flankfilm.report.text import counted, number, off, percent, plus_minus, seconds
from flankfilm.scene import Scene, parse_tolerance
from flankfilm.studies.output_errors import ERROR_OF, MODEL_ERROR_OF, exact

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.coupling.mesh.verification import Difference, Verification
    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.optimisation.task import Task
    from flankfilm.studies.plan import Plan
    from flankfilm.studies.row import RowResult
    from flankfilm.studies.run import StudyResults
    from flankfilm.studies.study_file import Value

ERRORS = frozenset((*ERROR_OF.values(), *MODEL_ERROR_OF.values()))
"""Outputs that are relative errors of others."""

OF_DEFLECTION = frozenset({"stiffness_error", "tangent_stiffness_error", "transmission_error_error"})
"""Errors of the outputs that depend on the reference of the deflection."""

REFERENCE_KEYS = frozenset({"stiffness.reference", "dynamics.stiffness_reference", "stiffness.model"})
"""Keys that change this reference."""

MOST_ROWS = 100
"""Maximum number of rows on a page; the files hold all."""


def write_study_page(study: StudyResults, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of a study and return its path.

    Parameters
    ----------
    study : StudyResults
    data : xarray.Dataset
        What ``study.nc`` holds.
    folder : Path
    """
    plan, rows = study.plan, len(study.rows)
    headlines = [_range(data, name) for name in plan.outputs if np.isfinite(data[name]).any()]
    failed = Counter(row.fault for row in study.failures)
    notes = tuple(f"{counted(count, 'row')} failed: {fault}" for fault, count in failed.most_common(20))
    varied, drawn = plan.keys[: plan.varied], []
    if varied_numbers(data, varied):
        draw = functools.wraps(figures.study)(
            functools.partial(figures.study, keys=varied, outputs=plan.outputs)
        )
        caption = f"Every output against {key_words(varied_numbers(data, varied)[0])[0]}"
        caption += "; the other keys make families." if len(varied) > 1 else "."
        drawn.append(picture(draw, data, caption))
    omitted = f"The first {MOST_ROWS} of {rows}; rows.csv and study.nc hold all." if rows > MOST_ROWS else ""
    table = _rows(data, plan, [(plan.rows[row.index], row) for row in study.rows[:MOST_ROWS]], omitted)
    facts = [
        Fact(f"{counted(rows, 'row')}, {plan.design}", "rows"),
        _tolerance(data),
        *reference_facts(plan),
        _work(data),
    ]
    parts = [
        Part("study", "Outputs", figures=tuple(drawn)),
        Part("rows", "Rows", tables=(table,), unfolded=True),
        _inputs(data),
    ]
    if notes:
        facts.append(Fact(f"{len(study.failures)} failed", "faults"))
        parts.insert(1, Part("faults", "Rows that failed", notes=notes, unfolded=True))
    return write_page(folder, Head(plan.title or "Study", facts, headlines), parts)


def write_optimum_page(optimum: Optimum, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of an optimisation and return its path.

    Parameters
    ----------
    optimum : Optimum
    data : xarray.Dataset
        What ``optimum.nc`` holds.
    folder : Path
    """
    task, points = optimum.task, optimum.evaluations
    chosen = [points[place] for place in optimum.best]
    single = len(task.objectives) == 1
    coarse, fine = (percent(tolerance) for tolerance in task.tolerances)
    settled = "converged" if optimum.converged else "not converged"
    facts = [
        Fact(counted(optimum.points, "point"), "points"),
        _work(data),
        Fact("one optimum" if single else f"{counted(len(chosen), 'point')} on the front", "best"),
        Fact(settled, "claims"),
    ]
    drawn = [picture(figures.optimum, data, said("optimum_of_one" if single else "optimum_of_several"))]
    if can_be_mapped(data):
        drawn.insert(0, picture(figures.optimum_map, data, said("optimum_map")))
    note = said("two_tolerances", coarse=coarse, fine=fine)
    table = _rows(data, task, [(point.values, point.result) for point in chosen[:MOST_ROWS]])
    parts = [
        Part(
            "claims",
            "What was found",
            (_in_words(optimum.message),),
            notes=(*gained(optimum), tied(optimum)),
            unfolded=True,
        ),
        Part("points", "Points", figures=tuple(drawn)),
        Part("best", "Optimum" if single else "Front", tables=(table,), notes=(note,), unfolded=True),
        _inputs(data),
    ]
    return write_page(
        folder, Head(task.asked.title or "Optimisation", facts, _best_cards(optimum, data)), parts
    )


def _in_words(message: str) -> str:
    return f"{message[:1].upper()}{message[1:]}."


def _bounds(task: Task, name: str) -> str:
    limit = task.asked.limits[name]
    ends = (("at least", limit.at_least), ("at most", limit.at_most))
    return ", ".join(f"{which} {number(bound)}" for which, bound in ends if bound is not None)


def _best_cards(optimum: Optimum, data: xr.Dataset) -> list[Headline]:
    """Outputs of the best point with their errors and the gain on the start; its keys where it is the only one."""
    task, first = optimum.task, optimum.evaluations[optimum.best[0]]
    gains = {gain.objective: gain for gain in optimum.gains}
    cards = []
    for name, value in zip(task.outputs, first.result.values, strict=True):
        if name in ERROR_OF.values():
            continue
        note = []
        if name in task.objectives:
            error = plus_minus(optimum.error_of(name, first.result))
            note.append("exact" if exact(name) else error)
        else:
            note.append(f"limit: {_bounds(task, name)}")
        if (gain := gains.get(name)) is not None and len(optimum.best) == 1:
            start = f"{number(gain.start, 5)} {unit_of(data, name, '')}".strip()
            note.append(f"{start} for the scene as given")
        if len(optimum.best) > 1:
            note.append("at the best first objective")
        cards.append(Headline(words(data, name), number(value, 5), ", ".join(note), unit_of(data, name, "")))
    if len(optimum.best) > 1:
        return cards
    ties = optimum.tied_ranges()
    for key, value in zip(task.keys, first.values, strict=True):
        name, unit = key_words(key)
        low, high = ties.get(key, (value, value))
        wide = f"tied designs: {_cell(low)} to {_cell(high)}" if low != high else "at the optimum"
        cards.append(Headline(name, _cell(value), wide, "" if unit == "-" else unit))
    return cards


def write_verification_page(verification: Verification, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of a verification and return its path.

    Parameters
    ----------
    verification : Verification
    data : xarray.Dataset
        What ``verify.nc`` holds.
    folder : Path
    """
    whole, pair = verification.references[0], verification.pair
    headlines = [
        Headline(
            relative_to(f"{d.model}: mean mesh stiffness", whole.deflection_reference),
            f"{100 * d.difference:+.1f}",
            f"against finite elements, whose error is {percent(d.reference_error)}",
            "%",
        )
        for d in verification.differences
        if (d.figure, d.reference) == ("mesh, mean", whole.label)
    ]
    tables = tuple(
        _differences(verification, reference.label) for reference in (whole, verification.like_for_like)
    )
    cost = "; ".join(
        f"{c.label} {seconds(c.cost.seconds)}" for c in (*verification.references, *verification.models)
    )
    shared = f"Finite elements {seconds(verification.cost.seconds)} once; then each model: {cost}."
    work = verification.cost.seconds + sum(c.cost.seconds for c in verification.references)
    facts = [
        Fact(f"{pair.pinion.teeth}/{pair.wheel.teeth} teeth, module {1e3 * pair.module:g} mm"),
        Fact(f"pinion: {verification.torque:g} N m"),
        Fact(f"{seconds(work)} of work", "costs"),
    ]
    over = verification.over_face
    parts = [
        Part("curves", "Curves", figures=pictures(data, "verification")),
        Part(
            "differences",
            "Differences",
            tables=tables,
            notes=(verification.message,) if verification.message else (),
            unfolded=True,
        ),
        *([] if over is None else [face_parts.beside(over, data)]),
        Part("costs", "Cost", (shared,)),
        _inputs(data),
    ]
    return write_page(folder, Head(str(data.attrs["title"]) or "Closed forms", facts, headlines), parts)


def _differences(verification: Verification, reference: str) -> Table:
    """Every figure of every model against one reference."""
    rows = tuple(
        (f"{name} [{unit_text(unit)}]", *cells) for name, unit, *cells in compared(verification, reference)
    )
    against = compared_with(verification, reference)
    heads = ("figure", "finite elements", *(model.label for model in verification.models))
    return Table(heads, rows, f"Against {against}")


def compared_with(verification: Verification, reference: str) -> str:
    """Finite elements that models are compared with: the parts left out, and the reference of the deflection."""
    whole = next(elements for elements in verification.references if elements.label == reference)
    return relative_to(
        reference if reference == "finite elements" else f"finite elements {reference}",
        whole.deflection_reference,
    )


def compared(verification: Verification, reference: str) -> Iterator[tuple[str, ...]]:
    """Cells of every figure against one reference: name, unit, by finite elements with its error, by each model."""
    for figure, unit in UNITS.items():
        by_model = {
            d.model: d for d in verification.differences if (d.figure, d.reference) == (figure, reference)
        }
        if by_model:
            first = next(iter(by_model.values()))
            whole = f"{first.reference_value:.4g} ± {100 * first.reference_error:.2g} %"
            yield figure, unit, whole, *(_against(by_model.get(model.label)) for model in verification.models)


def _against(difference: Difference | None) -> str:
    if difference is None:
        return ""
    return f"{difference.value:.4g} ({100 * difference.difference:+.1f} %)"


def _inputs(data: xr.Dataset) -> Part:
    return inputs(json.loads(data.attrs["scene_json"]), data.attrs["versions_json"])


def _work(data: xr.Dataset) -> Fact:
    return Fact(f"{seconds(float(data['seconds'].sum()))} of work")


def _tolerance(data: xr.Dataset) -> Fact:
    """Tolerance of the rows."""
    if "tolerance" in data.coords:
        return Fact("tolerance of each row in the table", "rows")
    return Fact(f"tolerance of each row {percent(_asked(data))}")


def reference_facts(plan: Plan) -> list[Fact]:
    """Reference of the deflection by finite elements, where an output depends on it and no row changes it."""
    stiffness, dynamics = (plan.scene.get(section) or {} for section in ("stiffness", "dynamics"))
    depends = OF_DEFLECTION & {ERROR_OF.get(name) for name in plan.outputs}
    if not depends or REFERENCE_KEYS & {*plan.keys} or stiffness.get("model", "fem") != "fem":
        return []
    reference = stiffness.get("reference") or dynamics.get("stiffness_reference") or "body"
    return [Fact(f"deflection {RELATIVE[reference]}")]


def _asked(data: xr.Dataset) -> float:
    """Tolerance of the scene that is varied."""
    asked = json.loads(data.attrs["scene_json"]).get("tolerance", Scene.model_fields["tolerance"].default)
    return float(parse_tolerance(asked))


def _range(data: xr.Dataset, name: str) -> Headline:
    """Minimum and maximum value of an output."""
    values = data[name].values
    least, most = (float(end(values)) for end in (np.nanmin, np.nanmax))
    meaning = str(data[name].attrs["long_name"]).partition(";")[0]
    if name in ERRORS:
        ends = dict.fromkeys((percent(least), percent(most)))
        return Headline(words(data, name), " to ".join(ends), meaning)
    if ERROR_OF.get(name) in data:
        meaning += f"; at most {_off(data, name, np.isfinite(values))}"
    ends = dict.fromkeys((_output(least), _output(most)))
    return Headline(words(data, name), " to ".join(ends), meaning, unit_of(data, name, ""))


def _off(data: xr.Dataset, name: str, rows: Booleans) -> str:
    """Largest uncertainty of an output over rows, marked where one does not meet the tolerance of its row."""
    errors = data[ERROR_OF[name]].values[rows]
    model = MODEL_ERROR_OF.get(name)
    model_errors = data[model].values[rows] if model in data else None
    known = None if model_errors is None or not np.isfinite(model_errors).all() else float(model_errors.max())
    if not np.isfinite(errors).all():
        return "error unknown"
    if "tolerance" in data.coords:
        asked = data["tolerance"].values[rows]
        tolerances = [float(parse_tolerance(str(text))) for text in np.broadcast_to(asked, errors.shape)]
    else:
        tolerances = [_asked(data)] * errors.size
    missed = [
        error for error, allowed in zip(errors.tolist(), tolerances, strict=True) if not met(error, allowed)
    ]
    return off(Uncertainty(float(errors.max()), known), min(tolerances) if missed else None)


def _rows(
    data: xr.Dataset,
    asked: Plan | Task,
    points: Sequence[tuple[Sequence[Value], RowResult]],
    caption: str = "",
) -> Table:
    """Numbers of rows, values of their keys, and their outputs."""
    named = (words(data, name) if name in ERRORS else titled(data, name) for name in asked.outputs)
    heads = ("row", *map(key_title, asked.keys), *named)
    texts = [percent if name in ERRORS else _output for name in asked.outputs]
    cells = tuple(
        (
            str(result.index),
            *map(_cell, values),
            *(text(value) for text, value in zip(texts, result.values, strict=True)),
        )
        for values, result in points
    )
    return Table(heads, cells, caption)


def _output(value: float) -> str:
    return number(value, 5)


def _cell(value: Value) -> str:
    return number(value, 6) if isinstance(value, float | int) else value
