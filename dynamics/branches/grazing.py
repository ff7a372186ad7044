"""Where the orbit that never leaves contact first touches the limit of the backlash."""

from __future__ import annotations

import math
import warnings

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, RangeWarning, Stopwatch, quantity, record
from dynamics.branches.branch import SpecialPoint
from dynamics.flow.flows import refined_flow
from dynamics.flow.motions import period_map, turning_points
from dynamics.model.arrays import AsArray
from dynamics.model.limits import ordered
from dynamics.model.protocol import EPS, PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.orbits.shooting import multipliers_of


@record
class ContactOrbit:
    """Periodic solution of the equation with f(X) = X - side D everywhere, that is, without backlash.

    In several freedoms X is y, the displacement that the backlash limits.
    """

    no_error = FLOW

    headline = ("clearance", "tau", "acceleration")

    state: Array = quantity("1", "X and V at tau = 0, or displacements and speeds", "state")
    multipliers: npt.NDArray[np.complex128] | Array = quantity("1", "Floquet multipliers", "multiplier")
    clearance: float = quantity(
        "1",
        "how far the orbit stays from the limit, min(side X) - D; it exists with the backlash if not negative",
    )
    tau: float = quantity("1", "time of the point nearest to the limit")
    acceleration: float = quantity("1", "X'' there")


@record
class ContactGrazing(AsArray):
    """Parameter values at which the orbit that never leaves contact touches the limit."""

    no_error = FLOW

    headline = ("message",)

    points: tuple[SpecialPoint, ...] = quantity("", "grazings in the order of the parameter")
    values: Array = quantity("1", "parameter values of the scan", "value")
    clearance: Array = quantity(
        "1", "how far the orbit stays from the limit in the scan; negative where it would cross", "value"
    )
    error: float = quantity("1", "largest estimated relative error of a point")
    cost: Cost
    converged: bool = quantity("1", "whether every change of sign ended in a point")
    message: str

    def columns(self) -> Array:
        """Parameter values of the points."""
        return np.array([p.parameter for p in self.points])


class ResonanceError(InputError):
    """The linear equation has no bounded periodic solution: a multiplier is one."""


def contact_orbit(oscillator: PeriodicOscillator, side: int = 1, refinement: int = 1) -> ContactOrbit:
    """Periodic solution that feels no backlash: a linear problem, solved without iteration.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    side : int
        1 for the driving flanks (X > D), -1 for the others.
    refinement : int
        Factor on the number of cells.

    Raises
    ------
    ResonanceError
        If there is none, because a Floquet multiplier of the linear equation is one.
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> contact_orbit(osc).clearance > 0.0  # it does not feel the backlash
    True
    """
    if side not in (1, -1):
        raise InputError.at("side", side, "must be 1 or -1", "1 is the driving side")
    linear, shift = oscillator.in_contact(side)
    table = refined_flow(linear, refinement)
    origin = np.zeros(linear.dimension)
    image = period_map(table, origin)
    matrix = np.eye(len(origin)) - image.jacobian
    stretch = max(1.0, float(np.max(np.abs(image.jacobian))))
    if not np.all(np.isfinite(matrix)) or np.linalg.norm(matrix, -2) < 64.0 * EPS * stretch:
        allowed = "must have a linear equation without resonance"
        raise ResonanceError.at("oscillator", "multiplier 1", allowed, "change the frequency")
    state: Array = np.asarray(np.linalg.solve(matrix, image.state), dtype=np.float64)
    # one refinement, against rounding
    state += np.linalg.solve(matrix, period_map(table, state).state - state)
    turns, begin = turning_points(table, state), float(linear.in_plane(state[None])[0, 0])
    at = int(np.argmin(side * turns[:, 1])) if len(turns) else -1
    tau, nearest, acceleration = turns[at, :3] if len(turns) else (0.0, begin, 0.0)
    if side * begin < side * nearest:  # nearest at tau = 0 itself, where the motion begins and ends
        tau, nearest, acceleration = 0.0, begin, linear.turning_acceleration(state)
    return ContactOrbit(
        state=state + shift,
        multipliers=multipliers_of(image.jacobian, math.exp(image.log_determinant)),
        clearance=float(side * nearest),
        tau=float(tau),
        acceleration=float(acceleration),
    )


@periodic_only
def contact_grazing(
    oscillator: PeriodicOscillator,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.3, 2.0),
    *,
    points: int = 200,
    side: int = 1,
) -> ContactGrazing:
    """Find where the orbit that never leaves contact grazes the limit of the backlash.

    The clearance of the linear orbit is a smooth function of the parameter on both sides of the grazing, so
    that its roots are found to rounding. They do not depend on the backlash; those of a train do where springs hold it
    to the ground, since these bear what the backlash lets it move.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator; its value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    bounds : tuple of float
        Range of the parameter.
    points : int
        Values of the scan that brackets the roots; two roots between neighbours are missed.
    side : int
        1 for X = D, -1 for X = -D.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, contact_grazing
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> grazing = contact_grazing(osc, "frequency", (0.6, 0.7), points=20)
    >>> round(grazing.points[0].parameter, 6)
    0.633534
    """
    from scipy.optimize import brentq

    watch = Stopwatch()
    with Faults() as faults:
        n = faults.whole("points", points, 2, 10**6, "200 resolves an ordinary range")
        low, high = ordered(faults, "bounds", bounds)
    evaluations = 0

    def clearance(value: float, refinement: int = 1) -> float:
        nonlocal evaluations
        evaluations += 1
        here = oscillator.with_parameter(parameter, value)
        try:
            return contact_orbit(here, side, refinement).clearance
        except ResonanceError:
            return math.nan

    grid = np.linspace(low, high, n)
    gap = np.array([clearance(float(value)) for value in grid])
    scale = max(float(np.max(np.abs(gap[np.isfinite(gap)]), initial=0.0)), 1e-300)
    grazings: list[SpecialPoint] = []
    poles = 0
    for i in range(n - 1):
        if not gap[i] * gap[i + 1] < 0.0:  # also past a resonance, where there is no clearance
            continue
        root = float(brentq(clearance, grid[i], grid[i + 1], xtol=1e-300, rtol=4.0 * EPS, maxiter=200))
        here = oscillator.with_parameter(parameter, root)
        orbit = contact_orbit(here, side)
        if abs(orbit.clearance) > 1e-6 * max(abs(gap[i]), abs(gap[i + 1])):
            poles += 1  # a resonance: the orbit changes side through infinity
            continue
        slope = (gap[i + 1] - gap[i]) / (grid[i + 1] - grid[i])
        error = max(abs(clearance(root, 2) / slope / root) if root else 0.0, EPS)
        grazings.append(
            SpecialPoint(
                "grazing", root, orbit.state, orbit.multipliers, "1-0-0", error, 1, side, orbit.tau,
                orbit.acceleration, float(here.contact_stiffness(here.frequency * orbit.tau)),
            )
        )  # fmt: skip
    if not grazings and scale <= 64.0 * EPS:
        warnings.warn("the contact orbit lies on the limit throughout: no load", RangeWarning, stacklevel=2)
    message = f"{len(grazings)} grazings" + (f"; {poles} resonances in the range" if poles else "")
    cost = Cost(watch.seconds, oscillator.dimension, evaluations, 3 * evaluations)
    error = max((p.error for p in grazings), default=math.nan)
    return ContactGrazing(tuple(grazings), grid, gap, error, cost, True, message)
