"""What stepping along a curve of periodic orbits asks of a flow."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar, NamedTuple, Self

import numpy as np
import numpy.typing as npt

from base import Array, Faults
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.sizes import WIDTH, Sizes
from dynamics.branches.step_rules import NEAR
from dynamics.flow.protocol import Flow
from dynamics.model.limits import MAX_POINTS, STEP, ordered
from dynamics.orbits.shooting import floquet_multipliers

FEW = 64  # pairs of extrema that are compared sooner one by one than by arrays


@dataclass(frozen=True, eq=False)
class MapPoint:
    """A state and its image under the map of n periods, at certain values of the parameters.

    Parameters
    ----------
    u : ndarray, shape (size + m,)
        Unknowns: the state over the scale, each parameter as a fraction of its range.
    values : ndarray, shape (m,)
        The parameters.
    period : float
        Excitation period, in tau.
    image : ndarray, shape (size,)
        Image of the state over the scale.
    derivative : ndarray, shape (size, size + m)
        Of the image with respect to the unknowns; its first columns are the Jacobian.
    determinant : float
        Of the Jacobian.
    counts : tuple of int
        p and q.
    levels : ndarray, shape (1,) or (2,)
        Values of X at which crossings are counted: D and, where there is a second flank, -D.
    extrema : ndarray, shape (k, 3)
        Phase in [0, 1) of the orbit's period, X, X'' at every extremum of X.
    iterations : int
        Newton iterations spent.
    """

    u: Array
    values: Array
    period: float
    image: Array
    derivative: Array
    determinant: float
    counts: tuple[int, int]
    levels: Array
    extrema: Array
    iterations: int = 0

    @property
    def value(self) -> float:
        """The first parameter."""
        return float(self.values[0])

    @property
    def size(self) -> int:
        """Length of a state."""
        return len(self.image)

    @property
    def jacobian(self) -> Array:
        """Derivative of the map with respect to the state."""
        return self.derivative[:, : self.size]

    @cached_property
    def trace(self) -> float:
        """Trace of the Jacobian."""
        return float(sum(self.derivative.diagonal().tolist()))

    @property
    def multipliers(self) -> npt.NDArray[np.complex128] | Array:
        """Floquet multipliers."""
        return floquet_multipliers(self.trace, self.determinant)

    @property
    def turning(self) -> bool:
        """Whether the multipliers whose product is nearest to 1 are a pair."""
        return abs(self.trace) < 2.0

    @property
    def fold(self) -> float:
        """Product of (1 - multiplier): zero at a saddle node."""
        return 1.0 + self.determinant - self.trace

    @property
    def flip(self) -> float:
        """Product of (1 + multiplier): zero at a period doubling."""
        return 1.0 + self.determinant + self.trace

    @property
    def torus(self) -> float:
        """Product of the multipliers less 1: zero at a Neimark-Sacker point, if they are a pair."""
        return self.determinant - 1.0

    def tangent(self, along: Array) -> Array:
        """Unit vector along the branch of one parameter, turned to the side of `along`."""
        (a, b, c), (d, e, f) = self.derivative.tolist()
        a, e = a - 1.0, e - 1.0
        normal = np.array([b * f - c * e, c * d - a * f, a * e - b * d])
        size = math.sqrt(float(normal @ normal))
        if not size > 0.0:
            return np.asarray(along / np.linalg.norm(along))
        return normal / (size if normal @ along >= 0.0 else -size)


def match_extrema(a: MapPoint, b: MapPoint) -> list[tuple[int, int]]:
    """Pairs of extrema of two neighbours that are each other's nearest in phase, and of one kind."""
    if len(a.extrema) * len(b.extrema) > FEW:
        gap = np.abs(a.extrema[:, None, 0] - b.extrema[None, :, 0])
        gap = np.minimum(gap, 1.0 - gap)
        gap[(a.extrema[:, None, 2] > 0.0) != (b.extrema[None, :, 2] > 0.0)] = np.inf
        there, back = gap.argmin(axis=1).tolist(), gap.argmin(axis=0).tolist()
        return [(i, j) for i, j in enumerate(there) if back[j] == i and gap[i, j] < NEAR]
    rows_a, rows_b = a.extrema.tolist(), b.extrema.tolist()
    nearest = ((i, _nearest(row, rows_b)) for i, row in enumerate(rows_a))
    return [(i, j) for i, j in nearest if j is not None and _nearest(rows_b[j], rows_a) == i]


def _nearest(row: list[float], rows: list[list[float]]) -> int | None:
    """Index of the extremum that is nearest in phase and of the same kind; None if none is near."""
    phase, _, bend = row
    best, at = NEAR, None
    for j, (other, _, turned) in enumerate(rows):
        if (turned > 0.0) == (bend > 0.0):
            gap = abs(other - phase)
            gap = min(gap, 1.0 - gap)
            if gap < best:
                best, at = gap, j
    return at


@dataclass(frozen=True, eq=False)
class BranchProblem(ABC):
    """Periodic orbits of n periods in dependence on one parameter or several.

    Parameters
    ----------
    oscillator : Oscillator
        What moves; its own values of the parameters are not used.
    parameters : tuple of str
        As in `Oscillator.with_parameter`.
    periods : int
        n.
    low, high : ndarray, shape (m,)
        Range of each parameter.
    scale : float
        Size of the motion, by which the state is measured.
    tolerance : float, optional
        Of a step, where the flow takes steps.
    """

    oscillator: Any
    parameters: tuple[str, ...]
    periods: int
    low: Array
    high: Array
    scale: float
    tolerance: float | None = None

    maps: ClassVar = 1
    """Period maps that a Newton iteration takes."""

    @property
    def parameter(self) -> str:
        """The first parameter."""
        return self.parameters[0]

    @property
    def size(self) -> int:
        """Length of a state."""
        return int(self.oscillator.dimension)

    @property
    def flat(self) -> Array:
        """Row across which the one parameter is held."""
        return np.append(np.zeros(self.size), 1.0)

    def values(self, u: Array) -> Array:
        """Parameters of the unknowns."""
        return np.asarray(self.low + u[self.size :] * (self.high - self.low))

    def at(self, u: Array) -> Any:
        """Oscillator of the unknowns.

        Raises
        ------
        InputError
            If a value is not allowed.
        """
        here = self.oscillator
        for name, value in zip(self.parameters, self.values(u), strict=True):
            here = here.with_parameter(name, float(value))
        return here

    @cached_property
    def rest(self) -> Array:
        """State at rest over the scale, from which motions in large backlash are measured."""
        return np.asarray(self.oscillator.rest_state() / self.scale)

    @cached_property
    def driven(self) -> float:
        """Smallest size of a motion in backlash, from its excitation, over the scale."""
        return float(WIDTH * self.oscillator.driven_size / self.scale)

    def size_of(self, u: Array) -> float:
        """Size of a motion through a state, as of `dynamics.branches.sizes`, over the scale."""
        state: list[float] = u[: self.size].tolist()
        away: float = max(abs(a - b) for a, b in zip(state, self.rest.tolist(), strict=True))
        return min(max(map(abs, state)), max(self.driven, WIDTH * away))

    def unknowns(self, state: Array, values: npt.ArrayLike) -> Array:
        """Unknowns of a state and the parameter values."""
        fraction = (np.atleast_1d(np.asarray(values, dtype=np.float64)) - self.low) / (self.high - self.low)
        return np.concatenate([np.asarray(state) / self.scale, fraction])

    @abstractmethod
    def correct(self, guess: Array, across: Array) -> Any:
        """Orbit in the plane across . (u - guess) = 0; None if Newton's method does not arrive."""

    @abstractmethod
    def trends(self, point: Any, tangent: Array) -> tuple[float, float]:
        """Slopes of `fold` and `flip` along the branch of one parameter."""

    def grazes(self, last: Any, along: Array, new: Any, tangent: Array, length: float) -> bool:
        """Whether an extremum may touch a flank twice between neighbours, whose tangents are known.

        Where the slopes of extrema are not known that is not seen.
        """
        return False

    def march(
        self, last: Any, heading: Heading, steps: Steps, places: list[list[float]], sizes: Sizes, wanted: int
    ) -> Any:  # fmt: skip
        """Steps from a point on that need no look, as of `branches.marching`; None if the flow has no loop for that."""
        return None

    @abstractmethod
    def flow(self, point: Any) -> Flow:
        """Flow of the oscillator of a point."""

    def states(self, point: Any) -> Array:
        """States over the scale after 1, 2, .. n periods, shape (n, size)."""
        start = point.u[: self.size] * self.scale
        return np.asarray(self.flow(point).follow(start, self.periods, derivatives=False).states / self.scale)

    def phases(self, point: Any) -> list[list[float]]:
        """Unknowns of a point, its orbit taken from each excitation period on, one row each."""
        rest = np.broadcast_to(point.u[self.size :], (self.periods, len(self.low)))
        rows: list[list[float]] = np.hstack([np.roll(self.states(point), 1, axis=0), rest]).tolist()
        return rows

    def half_way(self, point: Any) -> Array:
        """State over the scale after half the orbit's period; n must be even."""
        return np.asarray(self.states(point)[self.periods // 2 - 1])

    def locate(self, last: Any, new: Any, crossing: Any) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing, None if it turns out to be none; and whether the search arrived.

        Where orbits are not followed over one parameter nothing is located.
        """
        return None, False

    def magnified(self, factor: float) -> Self:
        """The same with a larger scale."""
        return replace(self, scale=factor * self.scale)


class Heading(NamedTuple):
    """Where a branch goes on from a point.

    Attributes
    ----------
    tangent, bend : ndarray, shape (size + 1,)
        Of unit length, and half the curvature.
    half : ndarray, shape (size,)
        Way from the state to that half the orbit's period later, over the scale; 0 if n is odd.
    step : float
        The next.
    """

    tangent: Array
    bend: Array
    half: Array
    step: float


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
    faults: Faults, path: str, bounds: tuple[float, float], start: str, parameter: str, value: float
) -> tuple[float, float]:
    """Bounds as numbers; notes if they are none, out of order, or do not hold the value of the start."""
    low, high = ordered(faults, path, bounds)
    if not low <= value <= high:
        faults.add(start, value, f"must have its {parameter} within bounds", "widen the bounds")
    return low, high
