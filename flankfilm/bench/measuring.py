"""Times work and compares what it gives with the finest solution."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import astuple, dataclass
from functools import partial
from statistics import median
from time import perf_counter, process_time
from typing import Any

import numpy as np

from flankfilm.bench.case import Answer, Case, Level, true_error

LEAST_TOTAL = 0.02
"""Work is repeated until this many seconds have passed: short work needs more repeats for its minimum."""

MOST_REPEATS = 1000


@dataclass(frozen=True)
class Timing:
    """How long the repeats of one piece of work took.

    Attributes
    ----------
    cpu, wall : float
        Lowest processor time and lowest wall time [s]: what else the machine does only adds.
    median : float
        Median of the processor time [s].
    repeats : int
        How many.
    """

    cpu: float
    wall: float
    median: float
    repeats: int


@dataclass(frozen=True)
class Row:
    """One quantity at one level.

    Attributes
    ----------
    case, series, level, quantity : str
        What was measured.
    size : float
        Resolution in the case's measure.
    cpu, wall, median : float
        As of `Timing` [s].
    repeats : int
        How often it was timed.
    error : float
        Relative difference from the finest solution; NaN where there is none.
    estimate : float
        The solver's own estimate; NaN where it gives none.
    failure : str
        Why there are no figures; empty where there are.
    """

    case: str
    series: str
    level: str
    quantity: str
    size: float
    cpu: float
    wall: float
    median: float
    repeats: int
    error: float
    estimate: float
    failure: str = ""


@dataclass(frozen=True)
class CaseResult:
    """A measured case.

    Attributes
    ----------
    solver, key, title, work, size_name : str
        As of `Case`; `solver` is the name for ``--only``.
    orders : dict
        Quantity to theory's order.
    finest : str
        Name of the finest solution; empty where time alone was measured.
    finest_estimates : dict
        Quantity to its own estimate of the finest solution's error; NaN where unknown.
    rows : tuple of Row
        What was measured.
    """

    solver: str
    key: str
    title: str
    work: str
    size_name: str
    orders: dict[str, float]
    finest: str
    finest_estimates: dict[str, float]
    rows: tuple[Row, ...]


def timed(work: Callable[[], Any], repeat: int) -> tuple[Any, Timing]:
    """Run `work` at least `repeat` times; return what it gave last, and how long it took."""
    cpu: list[float] = []
    wall: list[float] = []
    while len(cpu) < repeat or (sum(wall) < LEAST_TOTAL and len(cpu) < MOST_REPEATS):
        began, busy = perf_counter(), process_time()
        result = work()
        cpu.append(process_time() - busy)
        wall.append(perf_counter() - began)
    return result, Timing(min(cpu), min(wall), median(cpu), len(cpu))


def steps(case: Case) -> int:
    """Count the levels of a case, the finest included."""
    return (case.finest is not None) + sum(len(series.levels) for series in case.series)


def measure(
    solver: str, case: Case, repeat: int, announce: Callable[[str], None] = lambda what: None
) -> CaseResult:
    """Time every level of a case and compare it with the finest.

    The coarsest level of each series runs once before the clock starts, so that compilation, imports and
    memory are not in the times.

    Parameters
    ----------
    solver : str
        Name under which the case is asked for.
    case : Case
        What to measure.
    repeat : int
        Smallest number of timed runs of each level.
    announce : callable
        Called with what is done next, once for each of `steps`.
    """
    finest, failure = None, ""
    if case.finest is not None:
        announce(f"{case.title}: {case.finest.name}")
        finest, failure, _ = _run(case.finest, 0)
    for series in case.series:
        _run(series.levels[0], 0)
    rows: list[Row] = []
    for series in case.series:
        for level in series.levels:
            announce(f"{case.title}: {series.name}, {level.name}")
            answer, reason, timing = _run(level, repeat)
            if finest is None and case.finest is not None:
                reason = reason or f"the finest solution failed: {failure}"
            about = partial(Row, case.key, series.name, level.name)
            rows += _rows(about, answer, finest, timing, reason)
    estimates = {} if finest is None else {q: _number(v.estimate) for q, v in finest.values.items()}
    return CaseResult(
        solver,
        case.key,
        case.title,
        case.work,
        case.size_name,
        dict(case.orders),
        "" if case.finest is None else case.finest.name,
        estimates,
        tuple(rows),
    )


def _run(level: Level, repeat: int) -> tuple[Answer | None, str, Timing]:
    """Time a level; return what it gave, or why it gave nothing."""
    with quiet():
        try:
            result, timing = timed(level.work, max(repeat, 1)) if repeat else (level.work(), _UNTIMED)
            answer = level.answer(result)
        except (ValueError, ArithmeticError) as error:
            # a refusal is a result of the measurement: the rest goes on
            return None, str(error).splitlines()[0] if str(error) else type(error).__name__, _UNTIMED
    return (None, answer.failure, timing) if answer.failure else (answer, "", timing)


@contextmanager
def quiet() -> Iterator[None]:
    """Leave out warnings of ranges: coarse levels are outside them on purpose."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)
        yield


def _rows(
    about: Callable[..., Row], answer: Answer | None, finest: Answer | None, timing: Timing, reason: str
) -> Iterator[Row]:
    """Rows of one level, a quantity each; one alone where there is nothing to compare."""
    if answer is None or finest is None:
        size = math.nan if answer is None else answer.size
        yield about("", size, *astuple(timing), math.nan, math.nan, reason)
        return
    for quantity, value in answer.values.items():
        error = true_error(value, finest.values[quantity])
        failure = "" if math.isfinite(error) else "cannot be compared with the finest solution"
        yield about(quantity, answer.size, *astuple(timing), error, _number(value.estimate), failure)


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


_UNTIMED = Timing(math.nan, math.nan, math.nan, 0)


def gain(rows: tuple[Row, ...]) -> float:
    """Return the factor by which the processor time grows for a tenth of the error, over the levels of one series.

    The slope of a straight line through log time over log error, by least squares over the levels that none
    of the others beats in both; NaN with fewer than two, or where their errors span less than a factor of
    three.
    """
    points = sorted((r.error, r.cpu) for r in rows if r.error > 0 and r.cpu > 0)
    # from the most exact: a level counts if it is cheaper than every level that is more exact
    front: list[tuple[float, float]] = []
    for error, cpu in points:
        if not front or cpu < front[-1][1]:
            front.append((error, cpu))
    if len(front) < 2 or front[-1][0] < 3.0 * front[0][0]:
        return math.nan
    error, cpu = np.log10(np.array(front)).T
    return float(10.0 ** -np.polyfit(error, cpu, 1)[0])
