"""How results show themselves in a notebook: figures with their errors and a picture, in HTML without scripts."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Iterator, Mapping
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from base import FlankfilmError, Quantity, has_picture, quantities
from base.views import picture as drawn_of
from flankfilm.figures.reading import unit_text
from flankfilm.report.text import number, percent, seconds
from flankfilm.stages.failures import lines
from gears.notebook import closed_form_html as plain_closed_form_html
from gears.notebook import table

if TYPE_CHECKING:
    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.outcome.results import Results
    from flankfilm.studies.run import StudyResults
    from gears.closed_form.record import ClosedForm

MOST_ROWS = 12
"""Rows of a study that are shown."""

MOST_FIGURES = 16
"""Figures of a record that are shown."""


def record_html(result: object) -> str | None:
    """Single numbers of a record with their errors, whether it converged, what it cost, and its picture."""
    rows = list(_figures(result))[:MOST_FIGURES]
    drawn = picture(result)
    if not rows and not drawn:
        return None
    head = f"<p><b>{escape(type(result).__name__)}</b></p>"
    return f"{head}{table(('', 'value', 'error'), rows)}{_told(result)}{drawn}"


def _figures(result: object) -> Iterator[tuple[str, str, str]]:
    """Meaning, value with unit, and error of each single number; those of the headline first."""
    known = quantities(result)
    first = [name for name in getattr(type(result), "headline", ()) if name in known]
    for name in dict.fromkeys((*first, *known)):
        quantity = known[name]
        if name in ("error", "converged", "message") or quantity.figure.dims or _empty(quantity.value):
            continue
        yield quantity.figure.meaning, _shown(quantity), _error(result, name, quantity)


def _empty(value: Any) -> bool:
    return not isinstance(value, str | bool | int | float | np.generic) or value == ""


def _shown(quantity: Quantity) -> str:
    if isinstance(quantity.value, str | bool | np.bool_):
        return str(quantity.value)
    unit = unit_text(quantity.figure.read_in, "")
    return f"{number(float(quantity.figure.in_shown(quantity.value)), 5)} {unit}".strip()


def _error(result: object, name: str, quantity: Quantity) -> str:
    """Relative error of a figure: its own, or for a headline that of the whole; empty where it is not known."""
    error = getattr(result, quantity.figure.error, None) if quantity.figure.error else None
    error = error.get(name) if isinstance(error, Mapping) else error
    if error is None and name in getattr(type(result), "headline", ()) and quantity.figure.unit:
        error = getattr(result, "error", None)
    known = (
        isinstance(error, float | np.floating) and np.isfinite(error) and not isinstance(quantity.value, int)
    )
    return f"± {percent(float(error))}" if known and error is not None else ""


def _told(result: object) -> str:
    """Error of the whole, whether it converged, the message, and the cost."""
    said = []
    if isinstance(error := getattr(result, "error", None), float | np.floating):
        said.append(f"error {percent(float(error))}")
    if isinstance(converged := getattr(result, "converged", None), bool):
        said.append("converged" if converged else "not converged")
    if (cost := getattr(result, "cost", None)) is not None:
        said.append(seconds(cost.seconds))
    message = getattr(result, "message", "")
    line = ", ".join(said) + (f": {message}" if message else "")
    return f"<p>{escape(line)}</p>" if line else ""


def picture(result: object) -> str:
    """Picture of a result as an image in the page; empty for one without, the reason where it cannot be drawn."""
    if not has_picture(result):
        return ""
    from flankfilm.figures.style import styled

    try:
        drawn = drawn_of(result)
    except (FlankfilmError, ValueError) as fault:
        return f"<p>no picture: {escape(str(fault))}</p>"
    image = io.BytesIO()
    with styled():
        drawn.savefig(image, format="png", dpi=96)
    data = b64encode(image.getvalue()).decode("ascii")
    name = escape(f"picture of {type(result).__name__}", quote=True)
    return f'<img alt="{name}" src="data:image/png;base64,{data}"/>'


def closed_form_html(result: ClosedForm) -> str:
    """Stiffness of a closed form, the shares of its parts, and their picture."""
    return plain_closed_form_html(result) + picture(result)


def results_html(results: Results) -> str:
    """Headline figures of a run with their notes, and its files."""
    from flankfilm.runs.report import headlines

    rows = [(line.name, line.with_unit, line.note) for line in headlines(results.computed)]
    folder = results.folder or Path()
    files = ", ".join(str(path.relative_to(folder)) for path in results.files[:20])
    more = f" and {len(results.files) - 20} more" if len(results.files) > 20 else ""
    size = f"{results.written} after {results.seconds:.1f} s{': ' if files else ''}{files}{more}"
    title = escape(results.scene.title or "flankfilm")
    failed = "".join(f"<p>{escape(line)}</p>" for line in lines(results.failures))
    return f"<p><b>{title}</b></p>{failed}{table((), rows)}<p>{escape(size)}</p>{picture(results)}"


def study_html(study_results: StudyResults) -> str:
    """First rows of a study: varied keys, outputs, and why rows failed."""
    plan = study_results.plan
    rows = []
    for row in study_results.rows[:MOST_ROWS]:
        keys = (value if isinstance(value, str) else number(value) for value in plan.rows[row.index])
        outputs = (number(value) for value in row.values)
        rows.append((str(row.index), *keys, *outputs, row.fault))
    head = ("row", *plan.keys, *plan.outputs, "fault")
    size = (
        f"{len(study_results.rows)} rows, {len(study_results.failures)} failed, "
        f"{study_results.computed} computed in {study_results.seconds:.1f} s"
    )
    return f"<p><b>{escape(plan.title or 'Study')}</b>: {escape(size)}</p>{table(head, rows)}{picture(study_results)}"


def optimum_html(optimum: Optimum) -> str:
    """Best points of an optimisation, and what may be said of them."""
    from flankfilm.optimisation.words import claims

    task = optimum.task
    chosen = [optimum.evaluations[place] for place in optimum.best[:MOST_ROWS]]
    rows = [
        (
            str(point.result.index),
            *(value if isinstance(value, str) else number(value, 6) for value in point.values),
            *(number(value, 5) for value in point.result.values),
        )
        for point in chosen
    ]
    said = "".join(f"<p>{escape(line)}</p>" for line in claims(optimum))
    size = f"{optimum.points} points, {optimum.computed} computed in {optimum.seconds:.1f} s"
    head = f"<p><b>{escape(task.asked.title or 'Optimisation')}</b>: {escape(size)}</p>"
    return f"{head}{table(('row', *task.keys, *task.outputs), rows)}{said}{picture(optimum)}"
