"""The loop over grids, whatever the physics: finer and finer ones until two of them agree."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Protocol, TypeVar


class Agreement(Protocol):
    """What two grids differ by."""

    @property
    def error(self) -> float:
        """Estimated relative error of the finer grid."""

    @property
    def enough(self) -> bool:
        """Whether it is what was asked for, or finer grids would not come closer."""


L = TypeVar("L")
A = TypeVar("A", bound=Agreement)


def doubled(levels: Iterable[L | None], compared: Callable[[L, L], A]) -> Iterator[A]:
    """Compare every grid with the last one before it that gave in; one that fails (None) is passed over."""
    coarse: L | None = None
    for fine in levels:
        if fine is not None and coarse is not None:
            yield compared(coarse, fine)
        coarse = coarse if fine is None else fine


def refine(pairs: Iterable[A]) -> A | None:
    """Return the first pair of grids that agrees as asked; else the one that differs by the smallest amount."""
    nearest: A | None = None
    for pair in pairs:
        if pair.enough:
            return pair
        nearest = pair if nearest is None or pair.error < nearest.error else nearest
    return nearest
