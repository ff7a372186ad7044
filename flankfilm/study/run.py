"""Runs a study: computes the rows that are missing, each kept as it arrives."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from flankfilm.folder import claim
from flankfilm.study.executors import Kind, default_workers
from flankfilm.study.kept import take_up
from flankfilm.study.plan import Plan
from flankfilm.study.row import Row, RowResult
from flankfilm.study.table import ROWS, Columns, append, locked
from flankfilm.study.workers import Workers

Told = Callable[[int, int], None]
"""Called with the rows done and the rows in all, each time that a row arrives."""


@dataclass(frozen=True)
class StudyResults:
    """What a study gave.

    Attributes
    ----------
    plan : Plan
    rows : tuple of RowResult
        In the order of the plan.
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

    def _repr_html_(self) -> str:
        """First rows, for notebooks."""
        from flankfilm.notebook import study_html

        return study_html(self)


def run_study(
    plan: Plan,
    folder: Path,
    *,
    kind: Kind = "processes",
    workers: int | None = None,
    resume: bool = False,
    use_cache: bool = True,
    told: Told = lambda done, total: None,
) -> StudyResults:
    """Compute the rows of a plan into ``rows.csv`` of a folder.

    Parameters
    ----------
    plan : Plan
    folder : Path
        Made when it does not exist.
    kind : {"processes", "dask", "mpi"}
        Where rows are computed.
    workers : int, optional
        Processes; as many as there are cores unless given.
    resume : bool
        Whether to take up a study that was begun in the folder.
    use_cache : bool
        Whether rows may take results of earlier runs from the user's cache.
    told : callable
        Told of rows done and rows in all.

    Returns
    -------
    StudyResults

    Raises
    ------
    InputError
        Where the folder holds another study, or rows of this one without `resume`.
    """
    start = time.perf_counter()
    claim(folder)
    columns = Columns(plan.keys, plan.outputs)
    with locked(folder):
        held = take_up(folder, "study", plan.title, plan.identity(), columns, resume)
        done = {line.result.index: line.result for line in held}
        missing = [
            Row(index, plan.raw_scene(index), plan.outputs, use_cache)
            for index in range(len(plan.rows))
            if index not in done
        ]
        told(len(done), len(plan.rows))
        with Workers(kind, workers or default_workers()) as staff:
            for result in staff.computed(missing):
                append(folder / ROWS, columns, plan.rows[result.index], result)
                done[result.index] = result
                told(len(done), len(plan.rows))
    ordered = tuple(done[index] for index in range(len(plan.rows)))
    return StudyResults(plan, ordered, len(missing), time.perf_counter() - start)
