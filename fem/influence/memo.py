"""A bounded memory of results, keyed by all they depend on, for all threads of a process."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping
from dataclasses import fields, is_dataclass
from threading import Lock
from typing import Generic, TypeVar

import numpy as np

__all__ = ["Memo", "read_only"]

T = TypeVar("T")


class Memo(Generic[T]):
    """Keeps the results that were asked for last.

    Two threads that ask for the same result at the same time may both compute it; both get the first one.

    Parameters
    ----------
    most : int
        Results kept; the one whose last use is longest ago goes first.

    Examples
    --------
    >>> squares = Memo[int](2)
    >>> [squares.obtain(n, lambda n=n: n * n) for n in (2, 3, 4)]
    [4, 9, 16]
    >>> len(squares), squares.obtain(4, lambda: -1)
    (2, 16)
    """

    def __init__(self, most: int) -> None:
        self.most = most
        self._kept: OrderedDict[Hashable, T] = OrderedDict()
        self._lock = Lock()

    def __len__(self) -> int:
        """How many results are kept."""
        return len(self._kept)

    def obtain(self, key: Hashable, compute: Callable[[], T]) -> T:
        """Return the result of a key, computed where it is not kept."""
        with self._lock:
            if key in self._kept:
                self._kept.move_to_end(key)
                return self._kept[key]
        record = compute()
        with self._lock:
            record = self._kept.setdefault(key, record)
            self._kept.move_to_end(key)
            while len(self._kept) > self.most:
                self._kept.popitem(last=False)
        return record

    def clear(self) -> None:
        """Forget all."""
        with self._lock:
            self._kept.clear()


def read_only(value: T) -> T:
    """Make every array in a record, and in what it is made of, refuse writing; returns the record."""
    if isinstance(value, np.ndarray):
        value.flags.writeable = False
    elif is_dataclass(value):
        for field in fields(value):
            read_only(getattr(value, field.name))
    elif isinstance(value, Mapping):
        for inner in value.values():
            read_only(inner)
    elif isinstance(value, tuple):
        for inner in value:
            read_only(inner)
    return value
