"""Branches of periodic orbits over a parameter, through folds and grazings, and on from period doublings."""

from __future__ import annotations

from collections.abc import Callable
from functools import singledispatch
from typing import Any

import numpy as np

from base import Array, Faults, InputError
from dynamics.branches.arclength import follow
from dynamics.branches.branch import Branch, SpecialPoint
from dynamics.branches.branch_problem import BranchProblem, Steps, checked_range
from dynamics.branches.crossings import ExactBranch
from dynamics.branches.drive_problem import DriveProblem
from dynamics.branches.sizes import size_of
from dynamics.branches.stepwise_problem import FlowProblem
from dynamics.flow.flows import flow_of, unserved
from dynamics.model.drive_oscillator import DriveOscillator
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import Oscillator
from dynamics.model.smooth_oscillator import SmoothOscillator
from dynamics.orbits.shooting import Orbit, find_orbit

AMPLITUDES = (
    1e-3,
    3e-3,
    1e-2,
    3e-4,
    3e-2,
    1e-4,
    0.1,
)  # of a doubled orbit's start, over the size of the motion


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
        motion, and in several freedoms, Neimark-Sacker points, too.

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
    with Faults() as faults:
        steps = Steps(step, max_step, min_step, max_points)
        value = orbit.oscillator.get(parameter)
        low, high = checked_range(faults, "bounds", bounds, "orbit", parameter, value)
        if not orbit.converged:
            faults.add("orbit", orbit.message, "must be a converged orbit", "find the orbit first")
        steps.check(faults)
    scale = size_of(orbit.oscillator, orbit.state, orbit.periods, orbit.nodes, orbit.tolerance)
    problem = orbits_over(orbit.oscillator, parameter, orbit.periods, (low, high), scale, orbit.tolerance)
    return follow(problem, orbit.state, value, steps, progress)


@singledispatch
def problem_of(
    oscillator: Oscillator, parameters: tuple[str, ...], periods: int, low: Array, high: Array, scale: float,
    tolerance: float | None = None,
) -> Any:  # fmt: skip
    """Periodic orbits of an oscillator over parameters: the one place where the problem is chosen for its kind.

    Arguments are those of `BranchProblem`. All derivatives are exact for a `GearOscillator`. For a `DriveOscillator`
    those by the state are; those by parameters and all second ones are differences, good to about 1e-9. A
    `SmoothOscillator` has one parameter, and no second derivatives.
    """
    raise unserved(oscillator)


problem_of.register(GearOscillator, ExactBranch)
problem_of.register(DriveOscillator, DriveProblem)
problem_of.register(SmoothOscillator, FlowProblem)


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
    oscillator : GearOscillator, DriveOscillator or SmoothOscillator
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
    low, high = (np.array([end], dtype=np.float64) for end in bounds)
    problem: BranchProblem = problem_of(oscillator, (parameter,), periods, low, high, scale, tolerance)
    return problem


def doubled_orbit(
    oscillator: Oscillator,
    parameter: str,
    point: SpecialPoint,
    bounds: tuple[float, float],
    *,
    tolerance: float | None = None,
) -> Orbit | None:
    """Orbit of twice the period next to a period doubling, or None if none is found.

    The doubled orbit leaves the point along the eigenvector of the multiplier -1. A small distance along it is held,
    and the parameter is one of the unknowns, so that it does not matter to which side the doubled branch goes.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    point : SpecialPoint
        A period doubling on a branch in this parameter.
    bounds : tuple of float
        Range of the parameter.
    tolerance : float, optional
        Of the flow, as of `find_orbit`.

    Raises
    ------
    InputError
        If the point is not a period doubling.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, continue_branch, doubled_orbit, find_orbits
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.95, half_backlash=0.2)
    >>> (orbit,) = find_orbits(osc, (1,)).orbits
    >>> (doubling,) = continue_branch(orbit, "frequency", (0.88, 0.96)).special("period-doubling")
    >>> doubled_orbit(osc, "frequency", doubling, (0.88, 0.96)).label
    '2-2-0'
    """
    if point.kind != "period-doubling":
        raise InputError.at("point", point.kind, "must be a period-doubling", "take one from Branch.special")
    n = point.periods
    here = oscillator.with_parameter(parameter, point.parameter)
    scale = size_of(here, point.state, n, tolerance=tolerance)
    problem = orbits_over(oscillator, parameter, 2 * n, bounds, scale, tolerance)
    values, vectors = np.linalg.eig(flow_of(here, tolerance).follow(point.state, n).jacobian)
    along = np.append(np.real(vectors[:, int(np.argmin(np.abs(values + 1.0)))]), 0.0)
    along /= np.linalg.norm(along)
    origin = problem.unknowns(point.state, point.parameter)
    for amplitude in AMPLITUDES:
        doubled = problem.correct(origin + amplitude * along, along)
        if doubled is None or not 0.0 <= doubled.u[-1] <= 1.0 or abs(doubled.u[-1] - origin[-1]) > 0.1:
            continue
        if float(np.max(np.abs(problem.half_way(doubled) - doubled.u[:-1]))) < 0.5 * amplitude:
            continue  # the orbit of half the period
        there = oscillator.with_parameter(parameter, doubled.value)
        orbit = find_orbit(there, doubled.u[:-1] * scale, periods=2 * n, tolerance=tolerance)
        if orbit.converged and orbit.periods == 2 * n:
            return orbit
    return None
