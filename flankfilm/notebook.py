"""How runs and studies show themselves in a notebook: plain HTML, every text escaped."""

from __future__ import annotations

from html import escape
from pathlib import Path
from typing import TYPE_CHECKING

from flankfilm.report.text import number
from flankfilm.stages.failures import lines
from gears.notebook import table

if TYPE_CHECKING:
    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.results import Results
    from flankfilm.studies.run import StudyResults

MOST_ROWS = 12
"""Rows of a study that are shown."""


def results_html(results: Results) -> str:
    """Headline figures of a run with their notes, and its files."""
    from flankfilm.report.contents import headlines

    rows = [(line.name, line.with_unit, line.note) for line in headlines(results)]
    folder = results.folder or Path()
    files = ", ".join(str(path.relative_to(folder)) for path in results.files[:20])
    more = f" and {len(results.files) - 20} more" if len(results.files) > 20 else ""
    size = f"{results.written} after {results.seconds:.1f} s{': ' if files else ''}{files}{more}"
    title = escape(results.scene.title or "flankfilm")
    failed = "".join(f"<p>{escape(line)}</p>" for line in lines(results.failures))
    return f"<p><b>{title}</b></p>{failed}{table((), rows)}<p>{escape(size)}</p>"


def study_html(found: StudyResults) -> str:
    """First rows of a study: varied keys, outputs, and why rows failed."""
    plan = found.plan
    rows = []
    for row in found.rows[:MOST_ROWS]:
        keys = (value if isinstance(value, str) else number(value) for value in plan.rows[row.index])
        outputs = (number(value) for value in row.values)
        rows.append((str(row.index), *keys, *outputs, row.fault))
    head = ("row", *plan.keys, *plan.outputs, "fault")
    size = f"{len(found.rows)} rows, {len(found.failures)} failed, {found.computed} computed in {found.seconds:.1f} s"
    return f"<p><b>{escape(plan.title or 'Study')}</b>: {escape(size)}</p>{table(head, rows)}"


def optimum_html(found: Optimum) -> str:
    """Best points of an optimisation, and what may be said of them."""
    from flankfilm.optimisation.words import claims

    task = found.task
    chosen = [found.evaluations[place] for place in found.best[:MOST_ROWS]]
    rows = [
        (
            str(point.result.index),
            *(value if isinstance(value, str) else number(value, 6) for value in point.values),
            *(number(value, 5) for value in point.result.values),
        )
        for point in chosen
    ]
    said = "".join(f"<p>{escape(line)}</p>" for line in claims(found))
    size = f"{len(found.evaluations)} points, {found.computed} computed in {found.seconds:.1f} s"
    head = f"<p><b>{escape(task.asked.title or 'Optimisation')}</b>: {escape(size)}</p>"
    return f"{head}{table(('row', *task.keys, *task.outputs), rows)}{said}"
