"""Runs an optimisation: evaluates points as rows that are kept, so that a killed one is taken up again."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from base import InputError, SolverError
from flankfilm.optimisation.optimum import Evaluation, Optimum, error_of, judged
from flankfilm.optimisation.search import front, search
from flankfilm.optimisation.start import NOT_THERE
from flankfilm.optimisation.task import Task
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.kept import KeptRows, Work
from flankfilm.studies.row import Row, RowResult
from flankfilm.studies.study_file import Value
from flankfilm.studies.table import ROWS, WITHOUT_IT, Columns, Line
from flankfilm.studies.workers import Workers

Array = NDArray[np.float64]

Point = tuple[float, tuple[Value, ...]]
"""Tolerance, and values of the keys."""


@dataclass
class _Evaluator:
    """Evaluates points, each once; what is there already is taken from the table."""

    task: Task
    kept: KeptRows
    workers: Workers
    use_cache: bool
    progress: Progress
    known: dict[Point, RowResult]
    asked: dict[Point, RowResult] = field(default_factory=dict)
    computed: int = 0

    def __call__(self, units: Array, tolerance: float, /) -> tuple[Array, Array]:
        """Objectives and limits of points of the unit cube."""
        points = [(tolerance, self.task.values(unit)) for unit in units.tolist()]
        results = self.results(points)
        for point, result in zip(points, results, strict=True):
            self.asked.setdefault(point, result)
        return judged(self.task, results)

    @property
    def remaining(self) -> int:
        """Points that may still be asked for; the scene as it stands is one."""
        return self.task.asked.evaluations - len(self.asked) - 1

    def error(self, unit: Array, /) -> float:
        """Absolute error of the first objective at a point, at the scene's tolerance."""
        point = (self.task.tolerances[1], self.task.values(unit.tolist()))
        (result,) = self.results([point])
        return abs(result.values[0]) * error_of(self.task, self.task.objectives[0], result)

    def start(self) -> Evaluation | None:
        """The scene as it stands, at its own tolerance; None where its keys make no scene."""
        if self.task.start.scene is None:
            return None
        point = (self.task.tolerances[1], self.task.start.values)
        return Evaluation(*point, *self.results([point]))

    def results(self, points: list[Point]) -> list[RowResult]:
        """Results of points, of which those that are not known are computed and kept."""
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
        return [self.known[point] for point in points]


def work_of_task(task: Task) -> Work:
    """What the rows of an optimisation's folder are of."""
    columns = Columns(("tolerance", *task.keys), task.outputs)
    return Work("optimisation", task.asked.title, {"task": _plain(task), "scene": task.scene}, columns)


def searched(task: Task, kept: KeptRows, how: Execution, progress: Progress) -> Optimum:
    """Search the best points of a task; those that are not kept are computed, and kept as they arrive.

    Raises
    ------
    SolverError
        Where no point keeps the limits.
    """
    began = time.perf_counter()
    with how.staff() as staff:
        evaluator = _Evaluator(task, kept, staff, how.cache, progress, dict(_points(task, kept.lines)))
        start = evaluator.start()
        polished = search(task, evaluator)
    evaluations = tuple(Evaluation(*point, result) for point, result in evaluator.asked.items())
    best = _best(task, evaluations)
    if not best.size:
        reasons = sorted({e.result.fault for e in evaluations if e.result.fault})
        why = f"; the first of {len(reasons)} faults: {reasons[0]}" if reasons else "; widen bounds or limits"
        raise SolverError(f"none of {len(evaluations)} points keeps the limits{why}")
    seconds = time.perf_counter() - began
    return Optimum(task, evaluations, best, evaluator.computed, seconds, start, polished)


def _best(task: Task, evaluations: tuple[Evaluation, ...]) -> NDArray[np.intp]:
    results = [e.result for e in evaluations]
    fine = np.array([e.tolerance == task.tolerances[1] for e in evaluations])
    objectives, limits = judged(task, results)
    good = np.all(limits <= 0, axis=1) & np.array([not r.fault for r in results])
    best = front(objectives, fine & good)
    return best[:1] if len(task.objectives) == 1 else best


def _plain(task: Task) -> list[object]:
    asked = task.asked
    spans = asked.model_dump(include={"vary", "follow"})
    numbers = (asked.evaluations, asked.population, asked.seed, task.tolerances)
    return [task.objectives, task.signs, task.limits, spans["vary"], spans["follow"], numbers]


def _points(task: Task, lines: Iterable[Line]) -> Iterator[tuple[Point, RowResult]]:
    """Points of the table with their results."""
    ranges, follow = task.asked.vary, task.asked.follow
    whole = [span.whole for span in ranges.values()] + [
        ranges[rule.of].whole and rule.times.is_integer() and rule.plus.is_integer()
        for rule in follow.values()
    ]
    for line in lines:
        tolerance, *texts = line.values
        try:
            values = tuple(
                NOT_THERE if t == NOT_THERE else int(t) if w else float(t)
                for t, w in zip(texts, whole, strict=True)
            )
            yield (float(tolerance), values), line.result
        except ValueError as fault:
            place = f"{ROWS}, row {line.result.index}"
            raise InputError.at(place, "", "holds a text where a number belongs", WITHOUT_IT) from fault
