"""The loop over grids, whatever the physics: finer and finer ones until two of them agree."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
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
A_co = TypeVar("A_co", bound=Agreement, covariant=True)


class Problem(Protocol[L, A_co]):
    """A film that is solved on one grid after another."""

    def on(self, nodes: int, near: L | None) -> L | None:
        """Solve on a grid, from the last one that gave in; None where it fails."""

    def compared(self, coarse: L, fine: L) -> A_co:
        """Say what two grids differ by."""


def doubled(problem: Problem[L, A], nodes: Iterable[int]) -> Iterator[A]:
    """Compare every grid with the last one before it that gave in; one that fails is passed over."""
    coarse: L | None = None
    for n in nodes:
        fine = problem.on(n, coarse)
        if fine is not None and coarse is not None:
            yield problem.compared(coarse, fine)
        coarse = coarse if fine is None else fine


def doublings(nodes: int, most: int) -> Iterator[int]:
    """Nodes of twice as many cells, and twice as many again."""
    while (nodes := 2 * nodes - 1) <= most:
        yield nodes


def refine(pairs: Iterable[A]) -> A | None:
    """Return the first pair of grids that agrees as asked; else the one that differs by the smallest amount."""
    nearest: A | None = None
    for pair in pairs:
        if pair.enough:
            return pair
        nearest = pair if nearest is None or pair.error < nearest.error else nearest
    return nearest
