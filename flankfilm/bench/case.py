"""What is measured: a solver's work at several resolutions or tolerances, and its finest solution."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from functools import wraps
from inspect import signature
from typing import Any, NamedTuple, ParamSpec

import numpy as np
from numpy.typing import ArrayLike

from base import Array

P = ParamSpec("P")


@dataclass(frozen=True, eq=False)
class Value:
    """One quantity that a solver computed.

    Attributes
    ----------
    values : ndarray, shape (n,)
        SI.
    estimate : float or None
        The solver's own estimate of their relative error; None where it gives none.
    over_largest : bool
        Errors are differences over the largest of all values (states, which pass through zero) instead of
        each over its own.
    """

    values: Array
    estimate: float | None = None
    over_largest: bool = False


@dataclass(frozen=True, eq=False)
class Answer:
    """What one run gave.

    Attributes
    ----------
    size : float
        Resolution in the case's own measure: unknowns, nodes, positions.
    values : mapping
        Quantity to value.
    failure : str
        Why the solver itself does not believe the figures; empty where it does.
    """

    size: float
    values: Mapping[str, Value]
    failure: str = ""


@dataclass(frozen=True)
class Level:
    """One resolution or tolerance.

    Attributes
    ----------
    name : str
        As a reader knows it: "0.1 %", "129 nodes".
    work : callable
        What is timed.
    answer : callable
        Takes what `work` returned; is not timed.
    """

    name: str
    work: Callable[[], Any]
    answer: Callable[[Any], Answer]


@dataclass(frozen=True)
class Series:
    """Levels that belong together, from the coarsest to the finest."""

    name: str
    levels: tuple[Level, ...]


@dataclass(frozen=True)
class PeerWork:
    """The same work for another program.

    Attributes
    ----------
    script : str
        File in ``benchmarks/peers``, without suffix.
    inputs : mapping
        What the script reads, as JSON.
    quantity : str
        Quantity of the case that its values are compared with.
    """

    script: str
    inputs: Mapping[str, Any]
    quantity: str


@dataclass(frozen=True)
class Case:
    """Work of one solver.

    Attributes
    ----------
    key : str
        Names files; unique.
    title : str
        Names the work.
    work : str
        What is timed and what the errors are of, in a sentence or two.
    size_name : str
        What `Answer.size` counts.
    series : tuple of Series
        What is measured.
    finest : Level or None
        Run once; true errors are differences from it. None where time alone is measured.
    orders : mapping
        Quantity to the order p of theory, error proportional to size^-p; absent where theory gives none.
    peers : tuple of PeerWork
        The same work by others.
    """

    key: str
    title: str
    work: str
    size_name: str
    series: tuple[Series, ...]
    finest: Level | None
    orders: Mapping[str, float] = field(default_factory=dict)
    peers: tuple[PeerWork, ...] = ()


class Levels(NamedTuple):
    """What a case measures, as of `Case`."""

    series: tuple[Series, ...]
    finest: Level | None = None
    orders: Mapping[str, float] = {}
    peers: tuple[PeerWork, ...] = ()


def case(title: str, size_name: str, key: str = "") -> Callable[[Callable[P, Levels]], Callable[P, Case]]:
    """Make a function that gives levels one that gives their case.

    The work is what the function's docstring says below the first line. Braces there, in the title and in the key hold
    the function's arguments and its module's constants.

    Parameters
    ----------
    title, size_name, key : str
        As of `Case`; the key is the function's name unless given.
    """

    def decorate(function: Callable[P, Levels]) -> Callable[P, Case]:
        @wraps(function)
        def build(*args: P.args, **kwargs: P.kwargs) -> Case:
            arguments = signature(function).bind(*args, **kwargs).arguments
            known = {**function.__globals__, **arguments}
            text = " ".join((function.__doc__ or "").partition("\n")[2].split())
            own, named, said = (w.format(**known) for w in (key or function.__name__, title, text))
            return Case(own, named, said, size_name, *function(*args, **kwargs))

        return build

    return decorate


def value(numbers: ArrayLike, estimate: float | None = None, over_largest: bool = False) -> Value:
    """Make a value of one number or of several."""
    return Value(np.atleast_1d(np.asarray(numbers, dtype=float)), estimate, over_largest)


def answer(size: float, values: Mapping[str, Value], *of: Any) -> Answer:
    """Make the answer of results that have ``converged`` and ``message``; the first that did not converge fails it."""
    return Answer(size, values, next((result.message for result in of if not result.converged), ""))


def level(name: str, work: Callable[..., Any], answer: Callable[[Any], Answer], *args: Any) -> Level:
    """Make a level whose work is a call with arguments."""
    return Level(name, lambda: work(*args), answer)


def over(
    steps: Iterable[Any],
    label: Callable[[Any], str],
    work: Callable[..., Any],
    answer: Callable[[Any], Answer],
    *args: Any,
    name: str,
) -> Series:
    """Make a series of calls with `args` and then one of the steps, which `label` names."""
    return Series(name, tuple(level(label(step), work, answer, *args, step) for step in steps))


def percent(tolerance: float) -> str:
    """Name of a level by its tolerance."""
    return f"{100 * tolerance:g} %"


def work(name: str, task: Callable[[], Any], size: float = float("nan")) -> Series:
    """Make a series of one level that is timed and gives no figure."""
    return Series(name, (Level(name, task, lambda returned: Answer(size, {})),))


def true_error(computed: Value, finest: Value) -> float:
    """Return the largest relative difference from the finest values; NaN where they cannot be compared."""
    if computed.values.shape != finest.values.shape or computed.values.size == 0:
        return float("nan")
    off = np.abs(computed.values - finest.values)
    scale = np.abs(finest.values)
    return float(np.max(off / (np.max(scale) if finest.over_largest else scale)))
