"""What a result cost: seconds of computing, without imports and compilation."""

from __future__ import annotations

import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from time import perf_counter


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
            {
                name: self.parts.get(name, 0.0) + other.parts.get(name, 0.0)
                for name in {**self.parts, **other.parts}
            },
            {
                name: self.counts.get(name, 0) + other.counts.get(name, 0)
                for name in {**self.counts, **other.counts}
            },
        )


class _Aside(threading.local):
    """Seconds of a thread that no stopwatch counts; overlapping stretches count once."""

    depth = 0
    seconds = 0.0
    began = 0.0


_ASIDE = _Aside()


@contextmanager
def unclocked() -> Iterator[None]:
    """Hide what happens inside, an import or a compilation, from the stopwatches that are running.

    Examples
    --------
    >>> with unclocked():
    ...     import decimal
    """
    if _ASIDE.depth == 0:
        _ASIDE.began = perf_counter()
    _ASIDE.depth += 1
    try:
        yield
    finally:
        _ASIDE.depth -= 1
        if _ASIDE.depth == 0:
            _ASIDE.seconds += perf_counter() - _ASIDE.began


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
        self._began, self._aside = perf_counter(), _ASIDE.seconds

    @property
    def seconds(self) -> float:
        """Seconds so far, less those of `unclocked` stretches that have ended."""
        return perf_counter() - self._began - (_ASIDE.seconds - self._aside)
