"""Continuation of a branch of periodic orbits in one parameter, through folds and grazings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from base import Faults
from dynamics.arclength import follow
from dynamics.branch import Branch
from dynamics.branch_problem import Steps, checked_range
from dynamics.corrector import OrbitProblem, Point
from dynamics.crossings import Crossing, find_crossings, locate
from dynamics.shooting import Orbit
from dynamics.special import SpecialPoint

__all__ = ["continue_branch"]

FloatArray = npt.NDArray[np.float64]


def continue_branch(
    orbit: Orbit,
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

    Pseudo-arclength continuation: predictor along the tangent of the branch at the last point, corrector by
    Newton's method in the plane across it, so that folds are no obstacle. Steps shrink where the branch bends,
    where the multipliers change fast (as the square root of the penetration does, next to a grazing) and where
    the extrema that crossed the limits of the backlash do not account for the change of the label.

    Parameters
    ----------
    orbit : Orbit
        A converged orbit within the bounds.
    parameter : str
        As in `GearOscillator.with_parameter`.
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
        Points, stability and special points.

    Raises
    ------
    InputError
        If an argument is out of range, or the orbit has not converged or lies outside the bounds.
    """
    faults = Faults()
    steps = Steps(step, max_step, min_step, max_points)
    value = orbit.oscillator.get(parameter)
    low, high = checked_range(faults, bounds, parameter, value)
    if not orbit.converged:
        faults.add("orbit", orbit.message, "must be a converged orbit", "find the orbit first")
    steps.check(faults)
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(orbit.state))), orbit.oscillator.half_backlash, 1e-300)
    orbits = OrbitProblem(
        orbit.oscillator, (parameter,), orbit.periods, np.array([low]), np.array([high]), scale
    )
    return follow(_Exact(orbits), orbit.state, value, steps, progress)


@dataclass(frozen=True)
class _Exact:
    """Orbits of the exact flow, as `dynamics.arclength` takes them."""

    orbits: OrbitProblem
    maps: int = 3

    @property
    def parameter(self) -> str:
        """What is varied."""
        return self.orbits.parameters[0]

    @property
    def periods(self) -> int:
        """Of the orbits."""
        return self.orbits.periods

    @property
    def low(self) -> float:
        """Least value."""
        return float(self.orbits.low[0])

    @property
    def high(self) -> float:
        """Greatest value."""
        return float(self.orbits.high[0])

    @property
    def scale(self) -> float:
        """Size of the motion."""
        return self.orbits.scale

    def correct(self, guess: FloatArray, across: FloatArray) -> Point | None:
        """Orbit in a plane."""
        return self.orbits.correct(guess, across)

    def tangent(self, point: Point, along: FloatArray) -> FloatArray:
        """Unit vector along the branch."""
        return self.orbits.tangent(point, along)

    def phases(self, point: Point) -> list[list[float]]:
        """Unknowns from each excitation period on."""
        return self.orbits.phases(point)

    def half_way(self, point: Point) -> FloatArray:
        """State after half the orbit's period."""
        return self.orbits.half_way(point)

    def crossings(self, last: Point, new: Point) -> tuple[list[Crossing], bool]:
        """Changes of sign between neighbours."""
        return find_crossings(self.orbits, last, new)

    def locate(self, last: Point, new: Point, crossing: Crossing) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing."""
        point = locate(self.orbits, last, new, crossing)
        return point, point is not None

    def magnified(self, factor: float) -> _Exact:
        """With a larger scale."""
        return _Exact(replace(self.orbits, scale=factor * self.orbits.scale))
