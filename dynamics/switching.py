"""From a period doubling on to the branch of twice the period."""

from __future__ import annotations

import numpy as np

from base import Faults
from dynamics.continuation import orbits_over
from dynamics.flows import flow_of
from dynamics.protocol import Oscillator
from dynamics.shooting import Orbit, find_orbit
from dynamics.special import SpecialPoint
from dynamics.states import scale_of

__all__ = ["doubled_orbit"]

AMPLITUDES = (1e-3, 3e-3, 1e-2, 3e-4, 3e-2, 1e-4, 0.1)  # over the size of the motion


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
    faults = Faults()
    if point.kind != "period-doubling":
        faults.add("point", point.kind, "must be a period-doubling", "take one from Branch.special")
    faults.raise_if_any()
    n = point.periods
    scale = scale_of(oscillator, point.state)
    problem = orbits_over(oscillator, parameter, 2 * n, bounds, scale, tolerance)
    here = oscillator.with_parameter(parameter, point.parameter)
    values, vectors = np.linalg.eig(flow_of(here, tolerance).follow(point.state, n).jacobian)
    along = np.append(np.real(vectors[:, int(np.argmin(np.abs(values + 1.0)))]), 0.0)
    along /= np.linalg.norm(along)
    origin = problem.unknowns(point.state, point.parameter)
    for amplitude in AMPLITUDES:
        found = problem.correct(origin + amplitude * along, along)
        if found is None or not 0.0 <= found.u[2] <= 1.0 or abs(found.u[2] - origin[2]) > 0.1:
            continue
        if float(np.max(np.abs(problem.half_way(found) - found.u[:2]))) < 0.5 * amplitude:
            continue  # the orbit of half the period
        there = oscillator.with_parameter(parameter, found.value)
        orbit = find_orbit(there, found.u[:2] * scale, periods=2 * n, tolerance=tolerance)
        if orbit.converged and orbit.periods == 2 * n:
            return orbit
    return None
