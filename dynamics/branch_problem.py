"""What stepping along a branch of periodic orbits asks of a flow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from base import Faults
from dynamics.limits import NUMBER, STEP
from dynamics.special import SpecialPoint

__all__ = ["BranchPoint", "BranchProblem", "Steps", "checked_range"]

FloatArray = npt.NDArray[np.float64]


class BranchPoint(Protocol):
    """A point of a branch.

    Attributes
    ----------
    u : ndarray, shape (3,)
        X and V over the scale, the parameter as a fraction of its range.
    value : float
        The parameter.
    trace, determinant : float
        Of the Jacobian.
    counts : tuple of int
        p and q.
    iterations : int
        Newton iterations spent.
    """

    @property
    def u(self) -> FloatArray: ...  # noqa: D102

    @property
    def value(self) -> float: ...  # noqa: D102

    @property
    def trace(self) -> float: ...  # noqa: D102

    @property
    def determinant(self) -> float: ...  # noqa: D102

    @property
    def counts(self) -> tuple[int, int]: ...  # noqa: D102

    @property
    def iterations(self) -> int: ...  # noqa: D102


class BranchProblem(Protocol):
    """A flow seen by the steps; its points and crossings are its own.

    Attributes
    ----------
    parameter : str
        What is varied.
    periods : int
        Of the orbits.
    low, high : float
        Range of the parameter.
    scale : float
        Size of the motion.
    maps : int
        Period maps that a Newton iteration takes.
    """

    @property
    def parameter(self) -> str: ...  # noqa: D102

    @property
    def periods(self) -> int: ...  # noqa: D102

    @property
    def low(self) -> float: ...  # noqa: D102

    @property
    def high(self) -> float: ...  # noqa: D102

    @property
    def scale(self) -> float: ...  # noqa: D102

    @property
    def maps(self) -> int: ...  # noqa: D102

    def correct(self, guess: FloatArray, across: FloatArray) -> Any:
        """Orbit in the plane across . (u - guess) = 0; None if Newton's method does not arrive."""
        ...

    def tangent(self, point: Any, along: FloatArray) -> FloatArray:
        """Unit vector along the branch, turned to the side of `along`."""
        ...

    def phases(self, point: Any) -> list[list[float]]:
        """Unknowns of a point, its orbit taken from each excitation period on."""
        ...

    def half_way(self, point: Any) -> FloatArray:
        """X and V over the scale after half the orbit's period; asked for even periods only."""
        ...

    def crossings(self, last: Any, new: Any) -> tuple[Sequence[Any], bool]:
        """What changes sign between two neighbours, and whether that explains the change of the counts."""
        ...

    def locate(self, last: Any, new: Any, crossing: Any) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing, None if it turns out to be none; and whether the search arrived."""
        ...

    def magnified(self, factor: float) -> BranchProblem | None:
        """The same with a larger scale; None if it cannot be changed."""
        ...


@dataclass(frozen=True)
class Steps:
    """How far to step.

    Attributes
    ----------
    first, most, least : float
        Steps, over the size of the motion and the width of the range.
    points : int
        Points in each direction.
    """

    first: float
    most: float
    least: float
    points: int

    def check(self, faults: Faults) -> None:
        """Note what is not allowed."""
        for name, number in (("step", self.first), ("max_step", self.most), ("min_step", self.least)):
            faults.number(name, number, STEP)
        faults.whole("max_points", self.points, 1, 10**7, "5000 is usual")


def checked_range(
    faults: Faults, bounds: tuple[float, float], parameter: str, value: float
) -> tuple[float, float]:
    """Bounds as numbers; notes if they are none, out of order, or do not hold the value."""
    low, high = (faults.number(f"bounds[{i}]", bounds[i], NUMBER) for i in range(2))
    if not low < high:
        faults.add("bounds", bounds, "must have the lower value first", "give (low, high)")
    if not low <= value <= high:
        faults.add("orbit", value, f"must have its {parameter} within bounds", "widen the bounds")
    return low, high
