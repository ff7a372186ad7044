"""Runs a study: computes the rows that are missing, each kept as it arrives."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from base import Faults, plot, view
from flankfilm.figures.views import register
from flankfilm.output.files import cell
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.kept import KeptRows, Work, kept_rows
from flankfilm.studies.plan import Plan
from flankfilm.studies.row import Row, RowResult
from flankfilm.studies.table import ROWS, WITHOUT_IT, Columns, Line


def refuse_unknown(folder: Path, lines: Iterable[Line], plan: Plan) -> None:
    """Refuse rows that the plan does not have, by their numbers or by the values of their keys."""
    rows = plan.rows
    with Faults() as faults:
        for line in lines:
            index = line.result.index
            place = f"{folder / ROWS}, row {index}"
            if not 0 <= index < len(rows):
                faults.add(place, "", f"must be one of 0 to {len(rows) - 1}", WITHOUT_IT)
            elif line.values != tuple(str(cell(value)) for value in rows[index]):
                faults.add(place, "", "has other values of the keys than the study", WITHOUT_IT)


@dataclass(frozen=True)
class StudyResults:
    """What a study gave.

    Attributes
    ----------
    plan : Plan
    rows : tuple of RowResult
        In the order of the plan; of a part, its own.
    computed : int
        Rows computed by this run; the others were there.
    seconds : float
        Wall time of this run.
    """

    plan: Plan
    rows: tuple[RowResult, ...]
    computed: int
    seconds: float

    @property
    def failures(self) -> tuple[RowResult, ...]:
        """Rows that failed."""
        return tuple(row for row in self.rows if row.fault)

    def __repr__(self) -> str:
        """One line: rows, failures, seconds."""
        return f"StudyResults({len(self.rows)} rows, {len(self.failures)} failed, {self.seconds:.3g} s)"

    _repr_html_ = view
    plot = plot


def work_of_plan(plan: Plan) -> Work:
    """What the rows of a study's folder are of."""
    return Work("study", plan.title, plan.identity(), Columns(plan.keys, plan.outputs))


def run_study(
    plan: Plan,
    folder: Path,
    how: Execution = Execution(),
    progress: Progress = lambda done, total: None,
    rows: Sequence[int] | None = None,
) -> StudyResults:
    """Compute the rows of a plan into ``rows.csv`` of a folder, and write nothing else.

    Parameters
    ----------
    plan : Plan
    folder : Path
        Made when it does not exist.
    how : Execution
        Where rows are computed, and whether a study that was begun in the folder is taken up.
    progress : callable
        Called with rows done and rows in all.
    rows : sequence of int, optional
        Numbers of the rows of a part of the study; all of them if left out.

    Returns
    -------
    StudyResults

    Raises
    ------
    InputError
        Where the folder holds another study, or rows of this one without ``resume``.
    """
    with kept_rows(folder, work_of_plan(plan), how.resume) as kept:
        return computed(plan, kept, how, progress, range(len(plan.rows)) if rows is None else rows)


def computed(
    plan: Plan, kept: KeptRows, how: Execution, progress: Progress, numbers: Sequence[int]
) -> StudyResults:
    """Compute those rows of a plan that are not kept, each kept as it arrives."""
    start = time.perf_counter()
    refuse_unknown(kept.path.parent, kept.lines, plan)
    with how.staff() as staff:
        done = {line.result.index: line.result for line in kept.lines}
        missing = [
            Row(index, plan.raw_scene(index), plan.outputs, how.cache)
            for index in numbers
            if index not in done
        ]
        progress(len(done), len(numbers))
        for result in staff.computed(missing):
            kept.add(plan.rows[result.index], result)
            done[result.index] = result
            progress(len(done), len(numbers))
    ordered = tuple(done[index] for index in numbers)
    return StudyResults(plan, ordered, len(missing), time.perf_counter() - start)


register()
