"""A value that is found when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Generic, TypeVar

__all__ = ["Later", "known"]

T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class Later(Generic[T]):
    """A value that is found when it is first asked for, once; copies that are pickled or kept have it.

    Attributes
    ----------
    find : callable or None
        Gives the value; None in such copies.

    Examples
    --------
    >>> root = Later(lambda: 2.0**0.5)
    >>> round(root.value, 4)
    1.4142
    """

    find: Callable[[], T] | None

    @cached_property
    def value(self) -> T:
        """The value."""
        assert self.find is not None  # copies have the value instead
        return self.find()

    def __getstate__(self) -> dict[str, Any]:
        """Take the value along instead of what it is found by."""
        return {"find": None, "value": self.value}


def known(value: T) -> Later[T]:
    """Give a value that is there already."""
    return Later(lambda: value)
