"""Branches of a drive train: its period map with derivatives by state and one parameter, and its multipliers."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from base import Array, InputError
from dynamics.branches.bends import Bend, bend_by_differences
from dynamics.branches.branch_problem import MapPoint
from dynamics.branches.stepwise_problem import PeriodMap
from dynamics.flow.drive_flow import DriveFlow, tabulated
from dynamics.flow.protocol import MapResult
from dynamics.model.drive_oscillator import DriveOscillator
from dynamics.orbits.shooting import multipliers_of

# of the parameter's range: differences, whose error only slows Newton's method down; the shorter ones beside impacts
ASIDE = (3e-6, 3e-8, 1e-9)


@dataclass(frozen=True, eq=False)
class DrivePoint(MapPoint):
    """A state of a drive train and its image: special points by all its multipliers.

    Parameters
    ----------
    state : ndarray, shape (size,)
        Displacements and speeds at tau = 0.
    end : ndarray, shape (size,)
        Its image.
    course : tuple of int
        Impacts on the way and the flanks at its ends, 1, 0 or -1.
    """

    state: Array = field(default_factory=lambda: np.empty(0))
    end: Array = field(default_factory=lambda: np.empty(0))
    course: tuple[int, ...] = ()

    @property
    def residual(self) -> float:
        """Of the map, over the scale."""
        return float(np.max(np.abs(self.image - self.u[: self.size])))

    @cached_property
    def multipliers(self) -> npt.NDArray[np.complex128] | Array:
        """Floquet multipliers."""
        return multipliers_of(self.jacobian, self.determinant)

    @cached_property
    def fold(self) -> float:
        """Product of (1 - multiplier): zero at a saddle node."""
        return float(np.linalg.det(np.eye(self.size) - self.jacobian))

    @cached_property
    def flip(self) -> float:
        """Product of (1 + multiplier): zero at a period doubling."""
        return float(np.linalg.det(np.eye(self.size) + self.jacobian))

    @cached_property
    def torus(self) -> float:
        """Product of (1 - product) of all pairs of multipliers: zero at a Neimark-Sacker point."""
        first, second = np.triu_indices(self.size, 1)
        return float(np.prod(1.0 - self.multipliers[first] * self.multipliers[second]).real)

    @property
    def turning(self) -> bool:
        """Whether the multipliers whose product is nearest to 1 are a pair."""
        first, second = np.triu_indices(self.size, 1)
        at = int(np.argmin(np.abs(1.0 - self.multipliers[first] * self.multipliers[second])))
        return bool(self.multipliers[first[at]].imag != 0.0)

    def tangent(self, along: Array) -> Array:
        """Unit vector along the branch of one parameter, turned to the side of `along`."""
        normal = np.linalg.svd(self.derivative - np.eye(self.size, len(self.u)))[2][-1]
        return np.asarray(normal if normal @ along >= 0.0 else -normal)


@dataclass(frozen=True, eq=False)
class DriveProblem(PeriodMap):
    """Periodic orbits of a drive train; attributes as in `BranchProblem`.

    Attributes
    ----------
    refinement : int
        Factor on the number of cells.
    """

    oscillator: DriveOscillator
    refinement: int = 1

    maps = 3

    @cached_property
    def widenings(self) -> Array:
        """Change of half the backlash over the range of each parameter."""
        return np.where(np.array(self.parameters) == "half_backlash", self.high - self.low, 0.0)

    def evaluate(self, u: Array, refinement: int = 1) -> DrivePoint | None:
        """Image of the unknowns; None if the parameters are not allowed there or the motion is lost."""
        try:
            here: DriveOscillator = self.at(u)
        except InputError:  # the continuation tries a smaller step
            return None
        cells = math.ceil(here.cells) * self.refinement * refinement
        point = self._image(u, here, cells)
        if point is None:
            return None
        slopes = [self._slope(point, place, cells) for place in range(self.size, len(u))]
        if slopes[0] is None:
            return None
        # a further parameter may not be allowed to change, as one force of a train that nothing holds
        columns = [np.full(self.size, np.nan) if slope is None else slope / self.scale for slope in slopes]
        return replace(point, derivative=np.column_stack([point.derivative, *columns]))

    def bend(self, point: DrivePoint) -> Bend:
        """Derivatives of the Jacobian and of what it singles out, by differences."""
        return bend_by_differences(self, point)

    def beside(self, point: MapPoint, change: Array) -> DrivePoint | None:
        """Image of the unknowns of a point and a change of them, in as many cells; without slopes by parameters."""
        try:
            here: DriveOscillator = self.at(point.u + change)
        except InputError:  # the end of what a parameter may be
            return None
        return self._image(point.u + change, here, math.ceil(self.at(point.u).cells) * self.refinement)

    def course(self, point: MapPoint) -> tuple[int, ...]:
        """Impacts on the way and the flanks at its ends."""
        course: tuple[int, ...] = getattr(point, "course", ())
        return course

    def _image(self, u: Array, here: DriveOscillator, cells: int) -> DrivePoint | None:
        """Image of the unknowns in so many cells, without slopes by parameters; None if the motion is lost."""
        state = u[: self.size] * self.scale
        flow = tabulated(here, cells)
        image = flow.follow(state, self.periods)
        if image.message:
            return None
        turns = flow.sampled(state, self.periods, 0)[1]
        extrema = turns[:, :3]
        extrema[:, 0] = np.mod(extrema[:, 0] / (here.period * self.periods), 1.0)
        levels = np.array([1.0] if here.one_sided else [1.0, -1.0]) * here.half_backlash
        return DrivePoint(
            u.copy(), self.values(u), here.period, image.state / self.scale, image.jacobian,
            math.exp(image.log_determinant), image.impacts, levels, extrema, state=state, end=image.state,
            course=self._course(here, state, image),
        )  # fmt: skip

    def flow(self, point: MapPoint) -> DriveFlow:
        """Tables of the oscillator of a point."""
        here: DriveOscillator = self.at(point.u)
        return tabulated(here, math.ceil(here.cells) * self.refinement)

    def refined(self) -> DriveProblem:
        """The same with half the cells."""
        return replace(self, refinement=2 * self.refinement)

    def _slope(self, point: DrivePoint, place: int, cells: int) -> Array | None:
        """Derivative of the image by one unknown that is a parameter, over its range.

        A central difference; to one side where the other is not allowed. Where impacts on the way are others, or lie
        in another period, the map has a corner: such a side is left out, too, and tried nearer if both are.
        """
        central: list[tuple[float, Array]] = []
        for aside in ASIDE:
            sides, alike = [], []
            for way in (aside, -aside):
                beside = point.u.copy()
                beside[place] += way
                try:
                    there = self.at(beside)
                except InputError:  # the end of what the parameter may be
                    continue
                moved = tabulated(there, cells).follow(point.state, self.periods, derivatives=False)
                sides.append((way, moved.state))
                if self._course(there, point.state, moved) == point.course:
                    alike.append(sides[-1])
            central = central or sides
            if alike or not sides:
                central = alike
                break
        if not central:
            return None
        (ahead, high), (back, low) = [*central, (0.0, point.end)][:2]
        return np.asarray((high - low) / (ahead - back))

    def _course(self, here: DriveOscillator, state: Array, image: MapResult) -> tuple[int, ...]:
        """Impacts of a motion and the flanks that it begins and ends on, 1, 0 or -1."""
        ends = np.array([0.0, self.periods * here.period])
        y = here.contact_motion(ends, np.stack([state, image.state]))[0]
        sides = np.sign(here.deflection(y)).astype(int)
        return (*image.impacts, *sides.tolist())
