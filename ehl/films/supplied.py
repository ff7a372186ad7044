"""How its oil is supplied decides which films of a contact are solved, with heat or without."""

from __future__ import annotations

from typing import Protocol, TypeVar

from ehl.discrete.supply import OilLayer, Supply
from ehl.solving.levels import Level, State

_SURELY = 0.7  # share of the expected flooded flow below which a layer starves the contact for certain


class Solved(Protocol):
    """A film on two grids."""

    @property
    def fine(self) -> Level:
        """Finer of them."""

    @property
    def error(self) -> float:
        """Estimated relative error of central and minimum film."""

    @property
    def state(self) -> State:
        """What a next film starts from."""


S_co = TypeVar("S_co", bound=Solved, covariant=True)
S = TypeVar("S", bound=Solved)


class Films(Protocol[S_co]):
    """Films of one contact; None where there is none."""

    def flooded(self, near: State | None) -> S_co | None:
        """Film that takes what oil it wants, from a similar one."""

    def starved(self, near: State | None, full: State | None, flow: float | None) -> S_co | None:
        """Film that the supply holds, from a similar one; the flooded one, and its flow [m] where it is known."""

    def expected(self, full: State) -> float:
        """Flow of the flooded film [m] by that of a similar contact, changed as Moes' formula has it."""


def supplied(films: Films[S], supply: Supply | None, start: State | None) -> S | None:
    """Solve with a supply: a layer may be thicker than what the contact takes, which the flooded film shows.

    A layer of less than seven tenths of the flow that the start's flooded film makes likely starves the contact for
    certain: the flooded film is then left out.
    """
    held = start if start is not None and start.plan.fixed else None
    full = start if held is None else held.flooded
    if supply is None:
        return films.flooded(full)
    if not isinstance(supply, OilLayer):
        return films.starved(held, full, None)
    if held is not None and full is not None:
        flow = films.expected(full)
        starved = films.starved(held, full, flow) if supply.thickness < _SURELY * flow else None
        if starved is not None:
            return starved
    flooded = films.flooded(full)
    if flooded is None or supply.thickness >= flooded.fine.flow * (1.0 - flooded.error):
        return flooded
    return films.starved(held, flooded.state, flooded.fine.flow)
