"""Two sets of named arrays: which names, shapes, types and bits differ, and by how much."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from .case import NOT_THERE, Arrays


@dataclass(frozen=True)
class Change:
    """One array that is not the same in both commits.

    Attributes
    ----------
    name : str
        Of the array.
    what : str
        What differs, in words.
    absolute : float
        Maximum difference of two entries; nan where it has no meaning (text, shapes, names).
    relative : float
        The same over the maximum of the array; infinite where a tolerance cannot accept the change.
    """

    name: str
    what: str
    absolute: float = float("nan")
    relative: float = float("inf")

    def __str__(self) -> str:
        """One line."""
        return f"{self.name}: {self.what}"


def compare(first: Mapping[str, Any], second: Mapping[str, Any]) -> tuple[Change, ...]:
    """All changes from the first set of arrays to the second, the greatest relative difference first.

    Examples
    --------
    >>> import numpy as np
    >>> for change in compare({"a": np.array([1.0, 2.0]), "b": np.array(1)}, {"a": np.array([1.0, 2.5])}):
    ...     print(change)
    b: in the first commit alone
    a: 1 of 2 entries differ, at most by 0.5 (0.2 of the maximum)
    """
    changes = [Change(name, "in the first commit alone") for name in first.keys() - second.keys()]
    changes += [Change(name, "in the second commit alone") for name in second.keys() - first.keys()]
    for name in first.keys() & second.keys():
        change = compare_arrays(name, first[name], second[name])
        changes += [] if change is None else [change]
    return tuple(sorted(changes, key=lambda change: (-change.relative, change.name)))


def compare_arrays(name: str, first: npt.NDArray[Any], second: npt.NDArray[Any]) -> Change | None:
    """Change from one array to another; None where both have the same bits."""
    absent = [
        array.dtype.kind == "U" and array.shape == () and array == NOT_THERE for array in (first, second)
    ]
    if all(absent):
        return Change(name, "in neither commit: no result has an attribute of this name")
    if any(absent):
        return Change(name, f"in the {'second' if absent[0] else 'first'} commit alone")
    if first.shape != second.shape:
        return Change(name, f"shape {first.shape} and {second.shape}")
    text = first.dtype.kind == second.dtype.kind == "U"
    if first.dtype != second.dtype and not text:
        return Change(name, f"type {first.dtype} and {second.dtype}")
    same = same_bits(first, second)
    if same.all():
        return None
    count = f"{same.size - int(same.sum())} of {same.size} entries differ"
    if first.dtype.kind not in "fciu":
        place = tuple(np.argwhere(~same)[0])
        return Change(name, f"{count}, first {_short(first[place])} and {_short(second[place])}")
    absolute, relative = difference(first, second)
    return Change(
        name, f"{count}, at most by {absolute:.3g} ({relative:.2g} of the maximum)", absolute, relative
    )


def same_bits(first: npt.NDArray[Any], second: npt.NDArray[Any]) -> npt.NDArray[np.bool_]:
    """Whether entries of two arrays of one type and shape have the same bits; nan is like any nan.

    Examples
    --------
    >>> import numpy as np
    >>> same_bits(np.array([1.0, np.nan, 0.0]), np.array([1.0, -np.nan, -0.0])).tolist()
    [True, True, False]
    """
    if first.dtype.kind == "c":
        return same_bits(first.real, second.real) & same_bits(first.imag, second.imag)
    same = np.asarray(first == second)
    if first.dtype.kind == "f":
        same &= np.signbit(first) == np.signbit(
            second
        )  # numbers that are equal differ by the sign of zero alone
        same |= np.isnan(first) & np.isnan(second)
    return same


def difference(first: npt.NDArray[Any], second: npt.NDArray[Any]) -> tuple[float, float]:
    """Maximum difference of entries, and this over the maximum of both arrays; infinite where one is not a number.

    Examples
    --------
    >>> import numpy as np
    >>> difference(np.array([1.0, 4.0]), np.array([1.0, 3.0]))
    (1.0, 0.25)
    """
    if first.dtype.kind in "iu":
        first, second = first.astype(float), second.astype(float)
    same = same_bits(first, second)
    with np.errstate(all="ignore"):
        apart = np.abs(np.where(same, 0.0, first) - np.where(same, 0.0, second))
    if not np.isfinite(apart).all():
        return float("inf"), float("inf")
    greatest = float(apart.max(initial=0.0))
    sizes = np.abs(np.concatenate([first.ravel(), second.ravel()]))
    scale = float(sizes[np.isfinite(sizes)].max(initial=0.0))
    return greatest, greatest / scale if scale else 0.0


def within(changes: tuple[Change, ...], tolerance: float) -> bool:
    """Whether every change is accepted: a relative difference up to the tolerance."""
    return all(change.relative <= tolerance for change in changes)


def load(path: str) -> Arrays:
    """Named arrays of a file."""
    with np.load(path, allow_pickle=False) as kept:
        return {name: kept[name] for name in kept.files}


def _short(value: Any) -> str:
    """An entry for a line."""
    shown = repr(str(value))
    return shown if len(shown) <= 60 else f"{shown[:56]}...'"
