"""Continuation of a branch of periodic orbits in one parameter, through folds and grazings."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from base import Array, Faults
from dynamics.arclength import follow
from dynamics.branch import Branch
from dynamics.branch_problem import BranchProblem, Steps, checked_range
from dynamics.corrector import OrbitProblem, Point
from dynamics.crossings import Crossing, find_crossings, locate
from dynamics.flows import unserved
from dynamics.oscillator import GearOscillator
from dynamics.protocol import Oscillator
from dynamics.shooting import Orbit
from dynamics.special import SpecialPoint
from dynamics.stepwise.flow import TOLERANCE
from dynamics.stepwise.oscillator import SmoothOscillator
from dynamics.stepwise.problem import FlowProblem, PeriodMap

__all__ = ["ExactBranch", "continue_branch", "follow_branch", "orbits_over"]


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
        A converged orbit within the bounds; the tolerance that it was found with is kept.
    parameter : str
        One of the `parameters` of its oscillator.
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
        Points, stability and special points: saddle nodes, period doublings, grazings; where damping depends on the
        motion Neimark-Sacker points, too.

    Raises
    ------
    InputError
        If an argument is out of range, or the orbit has not converged or lies outside the bounds.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbit
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.5, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(oscillator, (0.3, 0.0)), "frequency", (0.45, 0.6))
    >>> [point.kind for point in branch.points]
    []
    """
    faults = Faults()
    steps = Steps(step, max_step, min_step, max_points)
    value = orbit.oscillator.get(parameter)
    low, high = checked_range(faults, bounds, parameter, value)
    if not orbit.converged:
        faults.add("orbit", orbit.message, "must be a converged orbit", "find the orbit first")
    steps.check(faults)
    faults.raise_if_any()
    scale = max(float(np.max(np.abs(orbit.state))), orbit.oscillator.floor)
    problem = orbits_over(orbit.oscillator, parameter, orbit.periods, (low, high), scale, orbit.tolerance)
    return follow(problem, orbit.state, value, steps, progress)


def follow_branch(
    problem: PeriodMap,
    state: Array,
    value: float,
    steps: tuple[float, float, float] = (0.005, 0.02, 1e-8),
    *,
    max_points: int = 5000,
    progress: Callable[[int, float], None] | None = None,
) -> Branch:
    """Do the same for any `PeriodMap`, from a periodic orbit at a value of its parameter.

    Parameters
    ----------
    problem : PeriodMap
        The map.
    state : ndarray, shape (2,)
        X and V of the orbit.
    value : float
        Of the parameter, there.
    steps : tuple of float
        First, largest and smallest step, as of `continue_branch`.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameter value.

    Raises
    ------
    InputError
        If an argument is out of range, or Newton's method does not arrive at the start.

    Examples
    --------
    >>> from dynamics import FourierStiffness, PowerContact, SmoothOscillator, find_orbit
    >>> from dynamics.continuation import orbits_over
    >>> law = PowerContact(stiffness=FourierStiffness(1.0), half_backlash=0.2)
    >>> orbit = find_orbit(SmoothOscillator(law, 0.05, 0.1, 0.02, 0.5), (0.3, 0.0), tolerance=1e-9)
    >>> problem = orbits_over(orbit.oscillator, "frequency", 1, (0.49, 0.51), scale=0.3, tolerance=1e-9)
    >>> follow_branch(problem, orbit.state, 0.5).converged
    True
    """
    faults = Faults()
    chosen = Steps(*steps, max_points)
    chosen.check(faults)
    faults.raise_if_any()
    return follow(problem, state, value, chosen, progress)


@dataclass(frozen=True, eq=False)
class ExactBranch(OrbitProblem):
    """Orbits of the exact flow over one parameter, as `dynamics.arclength` takes them."""

    maps = 3

    @property
    def parameter(self) -> str:
        """What is varied."""
        return self.parameters[0]

    def crossings(self, last: Point, new: Point) -> tuple[list[Crossing], bool]:
        """Changes of sign between neighbours."""
        return find_crossings(self, last, new)

    def locate(self, last: Point, new: Point, crossing: Crossing) -> tuple[SpecialPoint | None, bool]:
        """Special point of a crossing."""
        point = locate(self, last, new, crossing)
        return point, point is not None

    def magnified(self, factor: float) -> ExactBranch:
        """With a larger scale."""
        return replace(self, scale=factor * self.scale)


def orbits_over(
    oscillator: Oscillator,
    parameter: str,
    periods: int,
    bounds: tuple[float, float],
    scale: float,
    tolerance: float | None = None,
) -> BranchProblem:
    """Periodic orbits of an oscillator over a range of one parameter, as continuation takes them.

    Parameters
    ----------
    oscillator : GearOscillator or SmoothOscillator
        The oscillator.
    parameter : str
        One of its `parameters`.
    periods : int
        Of the orbits.
    bounds : tuple of float
        Range of the parameter.
    scale : float
        Size of the motion.
    tolerance : float, optional
        Of a step of the stepwise flow; tables of the exact flow are always the full ones.
    """
    if isinstance(oscillator, GearOscillator):
        low, high = (np.array([bound], dtype=np.float64) for bound in bounds)
        return ExactBranch(oscillator, (parameter,), periods, low, high, scale)
    if isinstance(oscillator, SmoothOscillator):
        given = TOLERANCE if tolerance is None else tolerance
        return FlowProblem(oscillator, parameter, periods, *bounds, scale, given)
    raise unserved(oscillator)
