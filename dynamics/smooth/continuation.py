"""Continuation of a branch of periodic orbits of any period map, through folds and grazings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from base import Faults
from dynamics.arclength import follow
from dynamics.branch import Branch
from dynamics.branch_problem import Steps, checked_range
from dynamics.smooth.crossings import Sign, find_crossings, locate
from dynamics.smooth.problem import FlowProblem, MapPoint, PeriodMap, correct, tangent
from dynamics.smooth.shooting import SmoothOrbit
from dynamics.special import SpecialPoint

__all__ = ["continue_branch", "follow_branch"]

FloatArray = npt.NDArray[np.float64]


def continue_branch(
    orbit: SmoothOrbit,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.1, 2.1),
    *,
    step: float = 0.005,
    max_step: float = 0.02,
    min_step: float = 1e-8,
    max_points: int = 5000,
    progress: Callable[[int, float], None] | None = None,
) -> Branch:
    """Follow a periodic orbit in a parameter, both ways from where it is.

    Parameters
    ----------
    orbit : SmoothOrbit
        A converged orbit within the bounds; its tolerance is kept.
    parameter : str
        As in `SmoothOscillator.parameters`.
    bounds : tuple of float
        Range of the parameter.
    step, max_step, min_step : float
        First, largest and smallest step along the branch, over the size of the motion and the width of the bounds.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameter value.

    Returns
    -------
    Branch
        Points, stability and special points: saddle nodes, period doublings, grazings, Neimark-Sacker points.

    Raises
    ------
    InputError
        If an argument is out of range, or the orbit has not converged or lies outside the bounds.
    """
    faults = Faults()
    value = orbit.oscillator.get(parameter)
    low, high = checked_range(faults, bounds, parameter, value)
    if not orbit.converged:
        faults.add("orbit", orbit.message, "must be a converged orbit", "find the orbit first")
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(orbit.state))), orbit.oscillator.size)
    problem = FlowProblem(orbit.oscillator, parameter, orbit.periods, low, high, scale, orbit.tolerance)
    return follow_branch(
        problem, orbit.state, value, (step, max_step, min_step), max_points=max_points, progress=progress
    )


def follow_branch(
    problem: PeriodMap,
    state: FloatArray,
    value: float,
    steps: tuple[float, float, float] = (0.005, 0.02, 1e-8),
    *,
    max_points: int = 5000,
    progress: Callable[[int, float], None] | None = None,
) -> Branch:
    """Do the same for any `PeriodMap`, from a periodic orbit at a value of its parameter.

    Raises
    ------
    InputError
        If an argument is out of range, or Newton's method does not arrive at the start.
    """
    faults = Faults()
    chosen = Steps(*steps, max_points)
    chosen.check(faults)
    faults.raise_if_any()
    return follow(_Stepwise(problem), state, value, chosen, progress)


@dataclass(frozen=True)
class _Stepwise:
    """Orbits of a period map, as `dynamics.arclength` takes them."""

    flow: PeriodMap
    maps: int = 1

    @property
    def parameter(self) -> str:
        """What is varied."""
        return self.flow.parameter

    @property
    def periods(self) -> int:
        """Of the orbits."""
        return self.flow.periods

    @property
    def low(self) -> float:
        """Least value."""
        return self.flow.low

    @property
    def high(self) -> float:
        """Greatest value."""
        return self.flow.high

    @property
    def scale(self) -> float:
        """Size of the motion."""
        return self.flow.scale

    def correct(self, guess: FloatArray, across: FloatArray) -> MapPoint | None:
        """Orbit in a plane."""
        return correct(self.flow, guess, across)

    def tangent(self, point: MapPoint, along: FloatArray) -> FloatArray:
        """Unit vector along the branch."""
        return tangent(point, along)

    def phases(self, point: MapPoint) -> list[list[float]]:
        """Unknowns from each excitation period on."""
        states = self.flow.states(point)
        rows: list[list[float]] = np.column_stack(
            [np.roll(states, 1, axis=0), np.full(len(states), point.u[2])]
        ).tolist()
        return rows

    def half_way(self, point: MapPoint) -> FloatArray:
        """State after half the orbit's period."""
        states: FloatArray = self.flow.states(point)
        half: FloatArray = states[self.periods // 2 - 1]
        return half

    def crossings(self, last: MapPoint, new: MapPoint) -> tuple[list[Sign], bool]:
        """Changes of sign between neighbours."""
        return find_crossings(last, new)

    def locate(self, last: MapPoint, new: MapPoint, crossing: Sign) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing; a determinant of 1 with real multipliers is none."""
        return locate(self.flow, last, new, crossing)

    def magnified(self, factor: float) -> _Stepwise | None:
        """With a larger scale, which a map of the user's may not have."""
        if not isinstance(self.flow, FlowProblem):
            return None
        return _Stepwise(replace(self.flow, scale=factor * self.flow.scale))
