"""Compiled code on all cores of one process: numbers are those of one core, whatever the order."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from base.cost import ASIDE

T = TypeVar("T")
FEW = 16  # pieces of work that are not worth a thread


def cores() -> int:
    """Cores that this process may use; at most NUMBA_NUM_THREADS, which says 1 to the workers of a study.

    Examples
    --------
    >>> cores() >= 1
    True
    """
    here = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    asked = os.environ.get("NUMBA_NUM_THREADS", "")
    return max(1, min(here, int(asked) if asked.isdigit() else here))


def side_by_side(tasks: Sequence[Callable[[], T]]) -> list[T]:
    """Do tasks that mostly run compiled code, which others need not wait for; their results in order.

    Where there is one core they are done one after the other. What is raised by one is raised here.

    Examples
    --------
    >>> side_by_side([lambda: 1, lambda: 2])
    [1, 2]
    """
    if len(tasks) < 2 or cores() == 1:
        return [task() for task in tasks]

    def timed(task: Callable[[], T]) -> tuple[T, float]:
        before = ASIDE.seconds
        return task(), ASIDE.seconds - before

    with ThreadPoolExecutor(min(cores(), len(tasks)) - 1) as pool:
        others = [pool.submit(timed, task) for task in tasks[1:]]
        began = ASIDE.seconds
        first = tasks[0]()
        done = [other.result() for other in others]
    # threads compiled while this one computed, waited, or compiled itself
    ASIDE.seconds = max(ASIDE.seconds, *(began + aside for _, aside in done))
    return [first, *(result for result, _ in done)]


def in_blocks(number: int, work: Callable[[int, int], int], worth: int | None = None) -> int:
    """Sum of what `work` returns for blocks of so many pieces, from the first to before the last, on all cores.

    `worth` says how many pieces are work at all, if not all of them: a few are not worth a thread.

    Examples
    --------
    >>> in_blocks(100, lambda first, last: last - first)
    100
    """
    hands = min(cores(), (number if worth is None else worth) // FEW)
    if hands < 2:
        return work(0, number)
    size = max(FEW, number // (8 * hands))  # more blocks than hands: they take different times
    starts = iter(range(0, number, size))  # taken by one hand at a time: the interpreter's lock sees to that

    def hand() -> int:
        return sum(work(first, min(first + size, number)) for first in starts)

    return sum(side_by_side([hand] * hands))
