"""Runs an optimisation: evaluates points as rows that are kept, so that a killed one is taken up again."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from base import SolverError
from flankfilm.optimisation.search import FAILED, front, search
from flankfilm.optimisation.task import Task
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.kept import KeptRows, Work, kept_rows
from flankfilm.studies.row import Row, RowResult
from flankfilm.studies.study_file import Value
from flankfilm.studies.table import Columns, Line
from flankfilm.studies.workers import Workers

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Evaluation:
    """One point: tolerance, values of the keys, and what came of it."""

    tolerance: float
    values: tuple[Value, ...]
    result: RowResult


@dataclass(frozen=True, eq=False)
class Optimum:
    """What an optimisation gave.

    Attributes
    ----------
    task : Task
    evaluations : tuple of Evaluation
        In the order in which they were asked for.
    best : ndarray of int
        Evaluations at the scene's tolerance that keep the limits and that none betters: one, or the front.
    computed : int
        Evaluations of this run; the others were there.
    seconds : float
        Wall time of this run.
    """

    task: Task
    evaluations: tuple[Evaluation, ...]
    best: NDArray[np.intp]
    computed: int
    seconds: float

    def __repr__(self) -> str:
        """One line: points, those that are best, seconds."""
        return f"Optimum({len(self.evaluations)} points, {len(self.best)} best, {self.seconds:.3g} s)"


@dataclass
class _Evaluator:
    """Evaluates points, each once; what is there already is taken from the table."""

    task: Task
    kept: KeptRows
    workers: Workers
    use_cache: bool
    progress: Progress
    known: dict[tuple[float, tuple[Value, ...]], RowResult]
    asked: dict[tuple[float, tuple[Value, ...]], RowResult] = field(default_factory=dict)
    computed: int = 0

    def __call__(self, units: Array, tolerance: float) -> tuple[Array, Array]:
        """Objectives and limits of points of the unit cube."""
        points = [(tolerance, self.task.values(unit)) for unit in units.tolist()]
        missing = [p for p in dict.fromkeys(points) if p not in self.known]
        start = 1 + max((result.index for result in self.known.values()), default=-1)
        rows = [
            Row(start + i, self.task.raw_scene(values, tol), self.task.outputs, self.use_cache)
            for i, (tol, values) in enumerate(missing)
        ]
        for result in self.workers.computed(rows):
            tol, values = missing[result.index - start]
            self.kept.add((tol, *values), result)
            self.known[tol, values] = result
            self.computed += 1
            self.progress(len(self.known), self.task.asked.evaluations)
        for point in points:
            self.asked.setdefault(point, self.known[point])
        results = [self.known[point] for point in points]
        return _judged(self.task, results)


def _judged(task: Task, results: list[RowResult]) -> tuple[Array, Array]:
    """Objectives with the sign of minimisation, and limits, allowed where <= 0, relative to their bounds.

    A failed point is the worst of all.
    """
    values = np.array([result.values for result in results]).reshape(-1, len(task.outputs))
    limits = [
        sign * (values[:, task.outputs.index(name)] - bound) / (abs(bound) or 1.0)
        for name, sign, bound in task.limits
    ]
    objectives = values[:, : len(task.signs)] * np.array(task.signs)
    # the search asks for no point at all where none keeps the limits
    kept = np.array(limits).reshape(len(limits), len(results)).T
    return np.where(np.isfinite(objectives), objectives, FAILED), np.where(np.isfinite(kept), kept, FAILED)


def optimise(
    task: Task,
    folder: Path,
    how: Execution = Execution(),
    progress: Progress = lambda done, total: None,
) -> Optimum:
    """Search the best points of a task; every evaluation goes into ``rows.csv`` of a folder.

    The search is the same whenever it runs: taken up again, it asks for the same points, finds those that are
    there, and goes on to the same end.

    Parameters
    ----------
    task : Task
    folder : Path
        Made when it does not exist.
    how : Execution
        Where points are computed, and whether a search that was begun in the folder is taken up.
    progress : callable
        Called with evaluations done and evaluations in all.

    Raises
    ------
    InputError
        Where the folder holds something else, or evaluations of this task without ``resume``.
    SolverError
        Where no point keeps the limits.
    """
    start = time.perf_counter()
    columns = Columns(("tolerance", *task.keys), task.outputs)
    work = Work("optimisation", task.asked.title, {"task": _plain(task), "scene": task.scene}, columns)
    with kept_rows(folder, work, how.resume) as kept, how.staff() as staff:
        evaluator = _Evaluator(task, kept, staff, how.cache, progress, dict(_points(task, kept.lines)))
        search(task, evaluator)
    evaluations = tuple(Evaluation(*point, result) for point, result in evaluator.asked.items())
    best = _best(task, evaluations)
    if not best.size:
        reasons = sorted({e.result.fault for e in evaluations if e.result.fault})
        why = f"; the first of {len(reasons)} faults: {reasons[0]}" if reasons else "; widen bounds or limits"
        raise SolverError(f"none of {len(evaluations)} points keeps the limits{why}")
    return Optimum(task, evaluations, best, evaluator.computed, time.perf_counter() - start)


def _best(task: Task, evaluations: tuple[Evaluation, ...]) -> NDArray[np.intp]:
    results = [e.result for e in evaluations]
    fine = np.array([e.tolerance == task.tolerances[1] for e in evaluations])
    objectives, limits = _judged(task, results)
    good = np.all(limits <= 0, axis=1) & np.array([not r.fault for r in results])
    found = front(objectives, fine & good)
    return found[:1] if len(task.objectives) == 1 else found


def _plain(task: Task) -> list[object]:
    asked = task.asked
    spans = asked.model_dump(include={"vary", "follow"})
    numbers = (asked.evaluations, asked.population, asked.seed, task.tolerances)
    return [task.objectives, task.signs, task.limits, spans["vary"], spans["follow"], numbers]


def _points(task: Task, lines: Iterable[Line]) -> Iterator[tuple[tuple[float, tuple[Value, ...]], RowResult]]:
    """Points of the table with their results."""
    ranges, follow = task.asked.vary, task.asked.follow
    whole = [span.whole for span in ranges.values()] + [
        ranges[rule.of].whole and rule.times.is_integer() and rule.plus.is_integer()
        for rule in follow.values()
    ]
    for line in lines:
        tolerance, *texts = line.values
        values = tuple(int(t) if w else float(t) for t, w in zip(texts, whole, strict=True))
        yield (float(tolerance), values), line.result
