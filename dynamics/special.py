"""Record of a point at which a branch of orbits changes its kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from base import Array, Faults, quantity, record

__all__ = ["OfKind", "SpecialPoint", "of_kind"]


@record
class SpecialPoint:
    """A special point."""

    headline = ("kind", "parameter", "label")

    kind: str = quantity("", "grazing, saddle-node, period-doubling or neimark-sacker")
    parameter: float = quantity("1", "value of the parameter", error="error")
    state: Array = quantity("1", "X and V at tau = 0", "state")
    multipliers: npt.NDArray[np.complex128] | Array = quantity("1", "Floquet multipliers", "multiplier")
    label: str = quantity(
        "",
        "motion at the point; at a grazing the touch itself is not counted and a U says that the motion is unstable, "
        "at the other kinds it is marginal",
    )
    error: float = quantity("1", "estimated relative error of the parameter value")
    periods: int = quantity("1", "period of the orbit, in excitation periods", default=1)
    boundary: int = quantity("1", "at a grazing 1 for X = D, -1 for X = -D; else 0", default=0)
    tau: float = quantity("1", "time of the touch at a grazing; else nan", default=math.nan)
    acceleration: float = quantity("1", "X'' at the touch of a grazing; else nan", default=math.nan)
    stiffness: float = quantity(
        "1",
        "K at the touch of a grazing, which with the acceleration gives the square-root law of the multipliers; else "
        "nan",
        default=math.nan,
    )


class OfKind(Protocol):
    """What has a kind."""

    @property
    def kind(self) -> str:
        """Its name."""


Marked = TypeVar("Marked", bound=OfKind)


def of_kind(points: Sequence[Marked], kind: str, kinds: Sequence[str]) -> list[Marked]:
    """Points of one kind, in their order.

    Parameters
    ----------
    points : sequence
        Special points or points of codimension two.
    kind : str
        One of `kinds`.
    kinds : sequence of str
        The kinds there are.

    Raises
    ------
    InputError
        If there is no such kind.
    """
    if kind not in kinds:
        faults = Faults()
        faults.add("kind", kind, f"must be one of {', '.join(kinds)}", "name one of these")
        faults.raise_if_any()
    return [p for p in points if p.kind == kind]
