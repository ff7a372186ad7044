"""What answers move by when a constant is doubled or halved, measured in the errors that they report.

An answer is computed again for a constant that its code reads; which code it runs is heard once, by the interpreter's
profiler. Code that ran less often the second time is what fills a store: for constants that it reads, all that the
process keeps is put aside.
"""

from __future__ import annotations

import math
import sys
import time
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import cache, cached_property
from types import CodeType
from typing import Any

import numpy as np

from base import InputError, SolverError
from benchmarks.constants.answers import Figures, RefusedError, answers
from benchmarks.constants.scanned import PACKAGES, Constant, changed, reads
from fem.influence.memo import Memo

ROUNDING = 1e-9
"""Relative, what figures may move by beside their errors."""

CYCLES = ("fem: path only", "fem: tips free")
"""Answers of elements that are asked for a constant of gears which no answer of gears reads."""

SECONDS = 0.2
"""Of answers for one change of a constant, after which no further one is begun."""


def _bound() -> list[Any]:
    """What modules of the packages have bound to names, but for those of compiled code."""
    own = [
        m for name, m in sys.modules.items() if name.partition(".")[0] in PACKAGES and "kernels" not in name
    ]
    return [value for module in own for value in vars(module).values()]


def _remembering() -> list[Any]:
    """Caches of functions of the packages, but for those of compiled code."""
    return [f for f in _bound() if hasattr(f, "cache_clear") and ".kernels" not in f.__module__]


@contextmanager
def fresh() -> Iterator[None]:
    """All that the process has kept put aside, and what is kept meanwhile forgotten afterwards."""
    memos = [thing for thing in _bound() if isinstance(thing, Memo)]
    kept = [memo._kept for memo in memos]
    for memo in memos:
        memo._kept = type(memo._kept)()
    for function in _remembering():
        function.cache_clear()
    try:
        yield
    finally:
        for memo, before in zip(memos, kept, strict=True):
            memo._kept = before
        for function in _remembering():
            function.cache_clear()


def computed(answer: Callable[[], Figures]) -> Figures:
    """An answer without its warnings."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with np.errstate(all="ignore"):
            return answer()


def heard(answer: Callable[[], Figures]) -> tuple[Figures, Counter[CodeType]]:
    """An answer, and how often each code ran for it."""
    calls: Counter[CodeType] = Counter()

    def hear(frame: Any, event: str, _: Any) -> None:
        if event == "call":
            calls[frame.f_code] += 1

    before = sys.getprofile()
    sys.setprofile(hear)
    try:
        return computed(answer), calls
    finally:
        sys.setprofile(before)


@dataclass(frozen=True)
class Known:
    """An answer as it is: figures, code that runs for it, code that runs only where nothing is kept, times."""

    name: str
    figures: Figures
    code: frozenset[CodeType]
    keeps: frozenset[CodeType]
    cold: float
    warm: float


@cache
def known(name: str) -> Known:
    """Compute an answer from nothing and again."""
    answer = answers()[name]
    computed(answer)  # imports what is imported late, and loads compiled code
    with fresh():
        began = time.process_time()
        _, first = heard(answer)
        cold = time.process_time() - began
    computed(answer)  # fills what functions keep
    _, second = heard(answer)
    began = time.process_time()
    figures = computed(answer)
    warm = time.process_time() - began
    keeps = frozenset(code for code, count in first.items() if second[code] != count)
    return Known(name, figures, frozenset(first) | frozenset(second), keeps, cold, warm)


@dataclass(frozen=True)
class Move:
    """What one change did: figures' moves over their errors, the errors' own change, or why there is no answer."""

    constant: Constant
    twice: bool
    answer: str
    moves: dict[str, float] = field(default_factory=dict)
    errors: float = 1.0
    refused: str = ""
    broken: str = ""

    @cached_property
    def worst(self) -> float:
        """Largest move over its error."""
        return math.inf if self.broken else max(self.moves.values(), default=0.0)

    def __str__(self) -> str:
        """One line."""
        change = f"{self.constant} {'doubled' if self.twice else 'halved'}: {self.answer}"
        if self.broken or self.refused:
            return f"{change}: {self.broken or self.refused}"
        figure = max(self.moves, key=lambda name: self.moves[name])
        return f"{change}: {figure} moves by {self.worst:.3g} of its error"


def _compared(before: Figures, after: Figures) -> tuple[dict[str, float], float]:
    """Moves over the larger of both errors, and the largest change of an error as a factor."""
    moves, errors = {}, [1.0]
    for name, (value, error) in before.items():
        other, off = after.get(name, (np.asarray(math.nan), 0.0))
        size = float(np.max(np.abs(value), initial=0.0))
        if np.shape(other) != np.shape(value):
            moves[name] = math.inf
            continue
        far = float(np.max(np.abs(other - value), initial=0.0))
        allowed = max(error, off) + ROUNDING * size
        moves[name] = (
            math.inf if math.isnan(far) and not np.isnan(value).any() else far / allowed if far > 0 else 0.0
        )
        if min(error, off) > 0:
            errors.append(max(error / off, off / error))
    return moves, max(errors)


def moved(constant: Constant, twice: bool, name: str) -> Move:
    """Compute an answer with a constant doubled or halved; anew from nothing where what is kept does not fit it."""
    here, reading = known(name), reads(constant)
    keeps = any(map(reading, here.keeps))
    move = _moved(constant, twice, here, keeps)
    return move if keeps or not move.broken else _moved(constant, twice, here, True)


def _moved(constant: Constant, twice: bool, here: Known, anew: bool) -> Move:
    try:
        with changed(constant, twice), fresh() if anew else nullcontext():
            after = computed(answers()[here.name])
    except (RefusedError, SolverError, InputError) as refused:
        return Move(constant, twice, here.name, refused=f"refused, {type(refused).__name__}: {refused}"[:200])
    except Exception as broken:  # noqa: BLE001 - a changed constant may break anything; the study lists what
        return Move(constant, twice, here.name, broken=f"broken, {type(broken).__name__}: {broken}"[:200])
    return Move(constant, twice, here.name, *_compared(here.figures, after))


def readers(constant: Constant) -> list[str]:
    """Answers that read a constant, the quick ones of its own package first, within the time there is."""
    reading = reads(constant)
    own = [
        name
        for name in answers()
        if name.startswith(constant.package) and any(map(reading, known(name).code))
    ]
    if not own and constant.package == "gears":  # what only a mesh cycle asks of them
        own = [name for name in CYCLES if any(map(reading, known(name).code))]

    def seconds(name: str) -> float:
        here = known(name)
        return here.cold if any(map(reading, here.keeps)) else here.warm

    chosen: list[str] = []
    spent = 0.0
    for name in sorted(own, key=seconds):
        if chosen and spent + seconds(name) > SECONDS:
            break
        chosen.append(name)
        spent += seconds(name)
    return chosen
