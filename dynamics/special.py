"""Record of a point at which a branch of orbits changes its kind."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from base import Faults

__all__ = ["OfKind", "SpecialPoint", "of_kind"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SpecialPoint:
    """A special point.

    Parameters
    ----------
    kind : str
        "grazing", "saddle-node" or "period-doubling".
    parameter : float
        Value of the parameter.
    state : ndarray, shape (2,)
        X and V at tau = 0.
    multipliers : ndarray, shape (2,)
        Floquet multipliers.
    label : str
        Motion at the point. At a grazing the touch itself is not counted and a U says that the motion is
        unstable; at the other kinds it is marginal.
    error : float
        Estimated error of the parameter value, relative.
    periods : int
        Period of the orbit, in excitation periods.
    boundary : int
        At a grazing: 1 for X = D, -1 for X = -D; else 0.
    tau : float
        At a grazing: time of the touch; else nan.
    acceleration : float
        At a grazing: X'' at the touch; else nan.
    stiffness : float
        At a grazing: K at the touch; else nan. With the acceleration it gives the square-root law of the
        multipliers.
    """

    kind: str
    parameter: float
    state: FloatArray
    multipliers: npt.NDArray[np.complex128] | FloatArray
    label: str
    error: float
    periods: int = 1
    boundary: int = 0
    tau: float = math.nan
    acceleration: float = math.nan
    stiffness: float = math.nan


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
