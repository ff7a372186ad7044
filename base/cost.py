"""What a result cost: seconds of computing, without imports and compilation."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any


@dataclass(frozen=True)
class Cost:
    """What a result cost.

    Attributes
    ----------
    seconds : float
        Time spent computing [s]; imports and compilation are not counted.
    unknowns : int
        Of the largest system of equations; 0 where nothing is solved.
    iterations : int
        Newton iterations of all solutions.
    periods : int
        Excitation periods integrated.
    parts : mapping of str to float
        Seconds by part of the work [s].
    counts : mapping of str to int
        Whatever else was counted.
    """

    seconds: float
    unknowns: int = 0
    iterations: int = 0
    periods: int = 0
    parts: Mapping[str, float] = field(default_factory=dict)
    counts: Mapping[str, int] = field(default_factory=dict)

    def __add__(self, other: Cost) -> Cost:
        """Cost of both: the larger system, everything else summed."""
        return Cost(
            self.seconds + other.seconds,
            max(self.unknowns, other.unknowns),
            self.iterations + other.iterations,
            self.periods + other.periods,
            _summed(self.parts, other.parts),
            _summed(self.counts, other.counts),
        )


def _summed(first: Mapping[str, Any], second: Mapping[str, Any]) -> dict[str, Any]:
    return {name: first.get(name, 0) + second.get(name, 0) for name in {**first, **second}}


class Aside(threading.local):
    """Seconds of a thread that no stopwatch counts; overlapping stretches count once."""

    depth = 0
    seconds = 0.0
    began = 0.0

    def open(self) -> None:
        """Begin a stretch."""
        if self.depth == 0:
            self.began = perf_counter()
        self.depth += 1

    def close(self) -> None:
        """End the stretch that was begun last."""
        self.depth -= 1
        if self.depth == 0:
            self.seconds += perf_counter() - self.began


ASIDE = Aside()


@contextmanager
def unclocked() -> Iterator[None]:
    """Hide what happens inside, an import or a compilation, from the stopwatches that are running.

    Examples
    --------
    >>> with unclocked():
    ...     import decimal
    """
    ASIDE.open()
    try:
        yield
    finally:
        ASIDE.close()


class Stopwatch:
    """Counts seconds of computing from its making on.

    Examples
    --------
    >>> watch = Stopwatch()
    >>> with unclocked():
    ...     import json
    >>> 0.0 <= watch.seconds < 1.0
    True
    """

    def __init__(self) -> None:
        self._began, self._aside = perf_counter(), ASIDE.seconds

    @property
    def seconds(self) -> float:
        """Seconds so far, less those of `unclocked` stretches that have ended."""
        return perf_counter() - self._began - (ASIDE.seconds - self._aside)
