"""From a period doubling on to the branch of twice the period, on the stepwise flow."""

from __future__ import annotations

import numpy as np

from base import Faults
from dynamics.smooth.flow import TOLERANCE, follow
from dynamics.smooth.oscillator import Engine, SmoothOscillator
from dynamics.smooth.problem import FlowProblem, correct
from dynamics.smooth.shooting import SmoothOrbit, find_orbit
from dynamics.special import SpecialPoint
from dynamics.switching import AMPLITUDES

__all__ = ["doubled_orbit"]


def doubled_orbit(
    oscillator: SmoothOscillator,
    parameter: str,
    point: SpecialPoint,
    bounds: tuple[float, float],
    *,
    tolerance: float = TOLERANCE,
) -> SmoothOrbit | None:
    """Orbit of twice the period next to a period doubling, or None if none is found.

    A small distance along the eigenvector of the multiplier -1 is held, and the parameter is one of the unknowns.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator; its value of the parameter is not used.
    parameter : str
        As in `SmoothOscillator.parameters`.
    point : SpecialPoint
        A period doubling on a branch in this parameter.
    bounds : tuple of float
        Range of the parameter.
    tolerance : float
        Of a step.

    Raises
    ------
    InputError
        If the point is not a period doubling.
    """
    faults = Faults()
    if point.kind != "period-doubling":
        faults.add("point", point.kind, "must be a period-doubling", "take one from Branch.special")
    faults.raise_if_any()
    n = point.periods
    scale = max(float(np.max(np.abs(point.state))), oscillator.size)
    problem = FlowProblem(oscillator, parameter, 2 * n, bounds[0], bounds[1], scale, tolerance)
    here = oscillator.with_parameter(parameter, point.parameter)
    values, vectors = np.linalg.eig(follow(Engine(here, tolerance), point.state, n).jacobian)
    along = np.append(np.real(vectors[:, int(np.argmin(np.abs(values + 1.0)))]), 0.0)
    along /= np.linalg.norm(along)
    fraction = (point.parameter - bounds[0]) / (bounds[1] - bounds[0])
    origin = np.append(point.state / scale, fraction)
    for amplitude in AMPLITUDES:
        found = correct(problem, origin + amplitude * along, along)
        if found is None or not 0.0 <= found.u[2] <= 1.0 or abs(found.u[2] - fraction) > 0.1:
            continue
        half = problem.states(found)[n - 1] - found.u[:2]
        if float(np.max(np.abs(half))) < 0.5 * amplitude:
            continue  # the orbit of half the period
        there = oscillator.with_parameter(parameter, found.value)
        orbit = find_orbit(there, found.u[:2] * scale, 2 * n, tolerance=tolerance)
        if orbit.converged and orbit.periods == 2 * n:
            return orbit
    return None
