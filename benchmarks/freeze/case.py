"""A case: a function of one tree of the project that returns named arrays."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

Arrays: TypeAlias = dict[str, npt.NDArray[Any]]

NOT_THERE = "(no such name)"
"""Stands for an attribute that a result of this commit does not have under any of the names asked for."""

CLOCKS = frozenset({"seconds", "cost", "rate", "crc32"})
"""Names of what differs from run to run: time, what follows from it, and check sums over both."""


@dataclass(frozen=True)
class Room:
    """Where a case runs.

    Attributes
    ----------
    tree : Path
        Root of the commit's files; the case may add files there.
    folder : Path
        Empty folder for what the case writes.
    """

    tree: Path
    folder: Path


@dataclass(frozen=True)
class Case:
    """One case.

    Attributes
    ----------
    name : str
        Package and subject, ``"fem/steel"``.
    compute : callable
        `Room` to named arrays.
    quick : bool
        Whether the case belongs to the short comparison.
    """

    name: str
    compute: Callable[[Room], Mapping[str, Any]]
    quick: bool = False


class Cases:
    """Cases of one file, in the order of their definition; an instance decorates functions without arguments."""

    def __init__(self, package: str) -> None:
        self.package = package
        self.cases: list[Case] = []

    def __call__(
        self, *, quick: bool = False
    ) -> Callable[[Callable[[], Mapping[str, Any]]], Callable[[], Mapping[str, Any]]]:
        """Take a function as a case under its own name."""

        def take(function: Callable[[], Mapping[str, Any]]) -> Callable[[], Mapping[str, Any]]:
            self.add(function.__name__, lambda _: function(), quick=quick)
            return function

        return take

    def add(self, name: str, compute: Callable[[Room], Mapping[str, Any]], *, quick: bool = False) -> None:
        """Take a function of the room as a case."""
        self.cases.append(Case(f"{self.package}/{name}", compute, quick))


def public(*names: str) -> Any:
    """Public name of the project, by the first of several spellings that exists: ``public("fem.new", "fem.old")``.

    Raises
    ------
    AttributeError
        Where no spelling exists in this commit.
    """
    for name in names:
        module, _, attribute = name.rpartition(".")
        try:
            return getattr(import_module(module), attribute)
        except (AttributeError, ModuleNotFoundError):
            continue
    raise AttributeError(f"none of {', '.join(names)} is a public name here")


def take(result: object, names: str) -> dict[str, Any]:
    """Attributes of a result by name, separated by spaces; ``new|old`` takes the first that exists and is called `new`.

    Examples
    --------
    >>> take(3.0 + 4.0j, "real height|imag")
    {'real': 3.0, 'height': 4.0}
    """
    values: dict[str, Any] = {}
    for spelling in names.split():
        names_of_one = spelling.split("|")
        held = (name for name in names_of_one if hasattr(result, name))
        name = next(held, None)
        values[names_of_one[0]] = NOT_THERE if name is None else getattr(result, name)
    return values


def flat(values: Mapping[str, Any]) -> Arrays:
    """Named arrays of whatever results hold: numbers, text, records, and sequences and mappings of these.

    Examples
    --------
    >>> flat({"a": [1.0, 2.0], "b": {"c": None, "d": ("x", (1, 2))}})["b/d/0"]
    array('x', dtype='<U1')
    """
    arrays: Arrays = {}
    for name, value in values.items():
        for key, array in _pieces(name, value):
            if key in arrays:
                raise ValueError(f"two arrays are called {key}")
            arrays[key] = array
    return arrays


def _pieces(name: str, value: Any) -> Iterator[tuple[str, npt.NDArray[Any]]]:
    """A value as arrays that a file can hold without pickling."""
    if value is None or callable(value):
        yield name, np.array("None" if value is None else "(callable)")
    elif isinstance(value, Mapping):
        for key, part in value.items():
            yield from _pieces(f"{name}/{key}", part)
    elif is_dataclass(value) and not isinstance(value, type):
        shown = (field.name for field in fields(value) if not field.name.startswith("_"))
        for key in shown:
            if key not in CLOCKS:
                yield from _pieces(f"{name}/{key}", getattr(value, key))
    elif isinstance(value, np.ndarray) and value.dtype != object:
        yield name, value
    elif isinstance(value, np.ndarray):
        yield from _sequence(name, value.ravel().tolist())
    elif isinstance(value, Sequence) and not isinstance(value, (str, bytes)):
        yield from _sequence(name, value)
    elif isinstance(value, (str, bool, int, float, complex, np.generic)):
        yield name, np.asarray(value)
    else:
        raise TypeError(f"{name} is a {type(value).__name__}: name the figures of it that are to be compared")


def _sequence(name: str, values: Sequence[Any]) -> Iterator[tuple[str, npt.NDArray[Any]]]:
    """One array where the entries are numbers or texts of one shape; else one array for each of them."""
    plain = (str, bool, int, float, complex, np.generic, np.ndarray, list, tuple)
    if all(isinstance(value, plain) for value in values):
        kinds = {isinstance(value, str) for value in values}
        try:
            array = np.asarray(values)
        except ValueError:
            array = np.empty(0, object)
        if array.dtype != object and len(kinds) < 2 and (array.dtype.kind != "U" or kinds == {True}):
            yield name, array
            return
    yield f"{name}/length", np.asarray(len(values))
    for k, value in enumerate(values):
        yield from _pieces(f"{name}/{k}", value)
