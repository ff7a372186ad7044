"""Page of a study."""

from __future__ import annotations

import functools
import json
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base import Booleans
from base.results import ITSELF
from flankfilm import figures
from flankfilm.coupling.mesh.references import RELATIVE
from flankfilm.figures.reading import key_title, key_words, titled, unit_of, words
from flankfilm.figures.studies import varied_numbers
from flankfilm.output.uncertainty import Uncertainty, met
from flankfilm.report.page import Fact, Head, Headline, Part, Table, picture, write_page
from flankfilm.report.run_parts import inputs_of, work_of
from flankfilm.report.text import counted, number, off, percent
from flankfilm.scene import Scene, parse_tolerance
from flankfilm.studies.outputs import ERROR_OF, MODEL_ERROR_OF
from flankfilm.studies.quantiles import SHARES, quantiles, sampled

if TYPE_CHECKING:
    import xarray as xr

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
    points = [(plan.rows[row.index], row) for row in study.rows[:MOST_ROWS]]
    table = rows_table(data, plan.keys, plan.outputs, points, omitted)
    facts = [
        Fact(f"{counted(rows, 'row')}, {plan.design}", "rows"),
        _tolerance(data),
        *reference_facts(plan),
        work_of(data),
    ]
    parts = [
        Part("study", "Outputs", figures=tuple(drawn)),
        Part("rows", "Rows", tables=(table,), unfolded=True),
        inputs_of(data),
    ]
    if sampled(plan.design, rows):
        parts.insert(1, _quantiles(data, plan.outputs))
    if notes:
        facts.append(Fact(f"{len(study.failures)} failed", "faults"))
        parts.insert(1, Part("faults", "Rows that failed", notes=notes, unfolded=True))
    return write_page(folder, Head(plan.title or "Study", facts, headlines), parts)


def _quantiles(data: xr.Dataset, outputs: Sequence[str]) -> Part:
    """Quantiles of every output over the drawn rows."""
    heads = (
        "output",
        "rows",
        *(f"{100 * share:g} %" for share in SHARES),
        "largest change with half the rows",
    )
    cells = tuple(
        (
            words(data, output.name),
            str(output.rows),
            *map(number, output.values.tolist()),
            number(float(output.changes.max()), 2),
        )
        for output in quantiles(data, outputs)
    )
    caption = "That share of the rows stays below the value. Errors of rows and of what was drawn are not contained."
    return Part("quantiles", "Quantiles", tables=(Table(heads, cells, caption),), unfolded=True)


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
    elif (note := str(data[name].attrs["error_note"])) != ITSELF:
        meaning += f"; {error_noted(note)}"
    ends = dict.fromkeys((_output(least), _output(most)))
    return Headline(words(data, name), " to ".join(ends), meaning, unit_of(data, name, ""))


def error_noted(note: str) -> str:
    """Why an output has no error, as a part of a sentence.

    Examples
    --------
    >>> error_noted("unknown: a closed form"), error_noted("exact: it follows from what is given")
    ('error unknown: a closed form', 'exact: it follows from what is given')
    """
    return note if note.startswith(("exact", "a class")) else f"error {note}"


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


def rows_table(
    data: xr.Dataset,
    keys: Sequence[str],
    outputs: Sequence[str],
    points: Sequence[tuple[Sequence[Value], RowResult]],
    caption: str = "",
) -> Table:
    """Numbers of rows, values of their keys, and their outputs."""
    named = (words(data, name) if name in ERRORS else titled(data, name) for name in outputs)
    heads = ("row", *map(key_title, keys), *named)
    texts = [percent if name in ERRORS else _output for name in outputs]
    cells = tuple(
        (
            str(result.index),
            *map(cell, values),
            *(text(value) for text, value in zip(texts, result.values, strict=True)),
        )
        for values, result in points
    )
    return Table(heads, cells, caption)


def _output(value: float) -> str:
    return number(value, 5)


def cell(value: Value) -> str:
    """Value of a key as text."""
    return number(value, 6) if isinstance(value, float | int) else value
