"""What stepping along a branch of periodic orbits asks of a flow."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from base import Array, Faults
from dynamics.limits import MAX_POINTS, STEP, ordered
from dynamics.special import SpecialPoint

__all__ = ["BranchProblem", "PlanePoint", "Steps", "checked_range", "match_extrema"]

NEAR = 0.05  # of the orbit's period: how far an extremum may move between neighbours


class PlanePoint:
    """What points of branches have in common.

    Attributes
    ----------
    u : ndarray, shape (2 + m,)
        X and V over the scale, each parameter as a fraction of its range.
    values : ndarray, shape (m,)
        The parameters.
    derivative : ndarray, shape (2, 2 + m)
        Of the image with respect to the unknowns; its first two columns are the Jacobian.
    determinant : float
        Of the Jacobian.
    counts : tuple of int
        p and q.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of the orbit's period, X, X'' at every extremum of X.
    iterations : int
        Newton iterations spent.
    """

    u: Array
    values: Array
    derivative: Array
    determinant: float
    counts: tuple[int, int]
    extrema: Array
    iterations: int

    @property
    def value(self) -> float:
        """The first parameter."""
        return float(self.values[0])

    @cached_property
    def trace(self) -> float:
        """Trace of the Jacobian."""
        return float(self.derivative[0, 0] + self.derivative[1, 1])

    @property
    def fold(self) -> float:
        """Product of (1 - multiplier): zero at a saddle node."""
        return 1.0 + self.determinant - self.trace

    @property
    def flip(self) -> float:
        """Product of (1 + multiplier): zero at a period doubling."""
        return 1.0 + self.determinant + self.trace

    def tangent(self, along: Array) -> Array:
        """Unit vector along the branch of one parameter, turned to the side of `along`."""
        (a, b, c), (d, e, f) = self.derivative.tolist()
        a, e = a - 1.0, e - 1.0
        normal = np.array([b * f - c * e, c * d - a * f, a * e - b * d])
        size = math.sqrt(float(normal @ normal))
        if not size > 0.0:
            return np.asarray(along / np.linalg.norm(along))
        return normal / (size if normal @ along >= 0.0 else -size)


def match_extrema(a: PlanePoint, b: PlanePoint) -> list[tuple[int, int]]:
    """Pairs of extrema of two neighbours that are each other's nearest in phase, and of one kind."""
    if len(a.extrema) == 0 or len(b.extrema) == 0:
        return []
    gap = np.abs(a.extrema[:, None, 0] - b.extrema[None, :, 0])
    gap = np.minimum(gap, 1.0 - gap)
    gap[(a.extrema[:, None, 2] > 0.0) != (b.extrema[None, :, 2] > 0.0)] = np.inf
    there, back = gap.argmin(axis=1).tolist(), gap.argmin(axis=0).tolist()
    return [(i, j) for i, j in enumerate(there) if back[j] == i and gap[i, j] < NEAR]


class BranchProblem(Protocol):
    """A flow seen by the steps; its points and crossings are its own.

    Attributes
    ----------
    parameter : str
        What is varied.
    periods : int
        Of the orbits.
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
    def scale(self) -> float: ...  # noqa: D102

    @property
    def maps(self) -> int: ...  # noqa: D102

    def unknowns(self, state: Array, value: float) -> Array:
        """Unknowns of a state and a value of the parameter."""
        ...

    def correct(self, guess: Array, across: Array) -> Any:
        """Orbit in the plane across . (u - guess) = 0; None if Newton's method does not arrive."""
        ...

    def phases(self, point: Any) -> list[list[float]]:
        """Unknowns of a point, its orbit taken from each excitation period on."""
        ...

    def half_way(self, point: Any) -> Array:
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
        faults.whole("max_points", self.points, *MAX_POINTS)


def checked_range(
    faults: Faults, bounds: tuple[float, float], parameter: str, value: float
) -> tuple[float, float]:
    """Bounds as numbers; notes if they are none, out of order, or do not hold the value."""
    low, high = ordered(faults, "bounds", bounds)
    if not low <= value <= high:
        faults.add("orbit", value, f"must have its {parameter} within bounds", "widen the bounds")
    return low, high
