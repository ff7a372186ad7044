"""Functions of an array of torques that take a single torque too."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Concatenate, ParamSpec, Protocol, overload

import numpy as np

from base import Array, Faults
from fem.cycle.result import MeshCycle
from fem.pair.checked import check_pair, numbers_of

if TYPE_CHECKING:
    from gears import GearPair

__all__ = ["OneOrSeveral", "one_or_several"]

Options = ParamSpec("Options")


class OneOrSeveral(Protocol[Options]):
    """A function of a torque that gives one cycle, of several torques that gives as many."""

    @overload
    def __call__(
        self, pair: GearPair, torque: float, *args: Options.args, **kwargs: Options.kwargs
    ) -> MeshCycle: ...

    @overload
    def __call__(
        self, pair: GearPair, torque: Sequence[float] | Array, *args: Options.args, **kwargs: Options.kwargs
    ) -> tuple[MeshCycle, ...]: ...


def one_or_several(
    sweep: Callable[Concatenate[GearPair, Array, Options], tuple[MeshCycle, ...]],
) -> OneOrSeveral[Options]:
    """Let a function of an array of torques take a single torque too, for which it returns a single cycle."""

    @wraps(sweep)
    def either(
        pair: GearPair, torque: float | Sequence[float] | Array, *args: Options.args, **kwargs: Options.kwargs
    ) -> MeshCycle | tuple[MeshCycle, ...]:
        with Faults() as faults:
            check_pair(faults, pair)
            torques = numbers_of(faults, "torque", torque, "give N m")
        cycles = sweep(pair, np.atleast_1d(torques).ravel(), *args, **kwargs)
        return cycles if np.ndim(torque) else cycles[0]

    return either  # type: ignore[return-value]
