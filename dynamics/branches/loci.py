"""Curves of saddle nodes, period doublings and grazings in the plane of two parameters."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Stopwatch, quantity, record
from dynamics.branches.branch import UNBOUNDED, SpecialPoint, of_kind
from dynamics.branches.branch_problem import Steps, checked_range
from dynamics.branches.continuation import problem_of
from dynamics.branches.locus_predictor import both_ways, joined
from dynamics.branches.locus_tracing import DoublePoint, LocusTracer
from dynamics.branches.sizes import size_of
from dynamics.branches.special_orbits import Condition, special_orbit
from dynamics.model.arrays import AsArray
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.orbits.shooting import motion_label

CODIMENSION_TWO = ("cusp", "saddle-node and grazing", "period-doubling and grazing", "double grazing")


@record
class Locus(AsArray):
    """A curve of special points in two parameters."""

    no_error = FLOW

    headline = ("kind", "message")

    kind: str = quantity("", "saddle-node, period-doubling, grazing or, in several freedoms, neimark-sacker")
    boundary: int = quantity("1", "at a grazing 1 for X = D, -1 for X = -D; else 0")
    parameters: tuple[str, str] = quantity("", "the two parameters", "parameter")
    periods: int = quantity("1", "period of the orbits, in excitation periods")
    values: Array = quantity("1", "parameters along the curve", "point parameter")
    states: Array = quantity("1", "X and V at tau = 0, or displacements and speeds", "point state")
    multipliers: npt.NDArray[np.complex128] = quantity("1", "Floquet multipliers", "point multiplier")
    labels: tuple[str, ...] = quantity("", "n-p-q of each orbit", "point")
    points: tuple[DoublePoint, ...] = quantity("", "points of codimension two in their order along the curve")
    ended: tuple[str, str] = quantity("", "why the curve ended at its first and at its last point")
    error: float = quantity("1", "largest estimated relative error of a point of codimension two")
    cost: Cost
    converged: bool = quantity(
        "1",
        "whether both ends are at a bound, at the start again, at a grazing that ends the curve, or without bound",
    )
    message: str

    def special(self, kind: str) -> list[DoublePoint]:
        """Points of codimension two of one kind.

        Parameters
        ----------
        kind : str
            One of `CODIMENSION_TWO`.

        Raises
        ------
        InputError
            If there is no such kind.
        """
        return of_kind(self.points, kind, CODIMENSION_TWO)

    def columns(self) -> Array:
        """The two parameters, shape (m, 2)."""
        return self.values


@periodic_only
def continue_locus(
    oscillator: PeriodicOscillator,
    point: SpecialPoint,
    parameters: tuple[str, str],
    bounds: tuple[tuple[float, float], tuple[float, float]],
    *,
    step: float = 0.005,
    max_step: float = 0.02,
    min_step: float = 1e-7,
    max_points: int = 2000,
    progress: Callable[[int, Array], None] | None = None,
) -> Locus:
    """Follow a special point in two parameters, both ways.

    Unknowns are X, V and both parameters, equations that the orbit closes and that the special point's condition
    holds; all derivatives are exact, from the second derivatives of the map and those of the extrema. Those of a drive
    train by parameters, and all second ones, are differences.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator of the point: its value of the first parameter is replaced by the point's.
    point : SpecialPoint
        A saddle node, period doubling, grazing or Neimark-Sacker point found in the first parameter.
    parameters : tuple of str
        Two of its `parameters`.
    bounds : tuple
        Range of each parameter.
    step, max_step, min_step : float
        First, largest and smallest step, over the size of the motion and the width of the bounds.
    max_points : int
        Points in each direction.
    progress : callable, optional
        Called with the number of points and the parameters.

    Returns
    -------
    Locus
        The curve and its points of codimension two.

    Raises
    ------
    InputError
        If an argument is out of range, or the point cannot be met again.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, continue_branch, continue_locus, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    >>> branch = continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.62, 0.67))
    >>> (fold,) = branch.special("saddle-node")
    >>> locus = continue_locus(osc, fold, ("frequency", "mean_force"), ((0.6, 0.7), (0.095, 0.105)))
    >>> locus.ended
    ('bound', 'bound')
    """
    watch = Stopwatch()
    with Faults() as faults:
        start = oscillator.with_parameter(parameters[0], point.parameter)
        if parameters[0] == parameters[1]:
            faults.add("parameters", parameters, "must be two different parameters", "name another one")
        ranges = [
            checked_range(faults, f"bounds[{k}]", bounds[k], "point", name, start.get(name))
            for k, name in enumerate(parameters)
        ]
        steps = Steps(step, max_step, min_step, max_points)
        steps.check(faults)
    low, high = np.array(ranges).T
    problem = problem_of(
        start, parameters, point.periods, low, high, size_of(start, point.state, point.periods)
    )
    condition = Condition.of(start, point)
    guess = problem.unknowns(point.state, [start.get(name) for name in parameters])
    first = special_orbit(problem, condition, guess, np.eye(len(guess))[-1])
    if first is None:
        allowed, remedy = "must be a point that can be met again", "next to a grazing, start elsewhere"
        raise InputError.at("point", point.parameter, allowed, remedy)
    tracers = both_ways(lambda sign: LocusTracer(problem, condition, first, sign, steps, progress))
    points, double = joined([t.points for t in tracers], 1), joined([t.double for t in tracers])
    ended = (tracers[0].ended, tracers[-1].ended)
    fair = ("bound", "closed", "ends at a grazing", "the extremum that touches ends", UNBOUNDED)
    good = all(e in fair for e in ended)
    return Locus(
        condition.kind, condition.boundary, (parameters[0], parameters[1]), problem.periods,
        np.array([p.values for p in points]), np.array([p.state for p in points]),
        np.array([p.multipliers for p in points], dtype=np.complex128),
        tuple(motion_label(problem.periods, p.counts) for p in points), tuple(double), ended,
        max((p.error for p in double), default=0.0),
        Cost(watch.seconds, len(guess), len(points), 4 * problem.periods * len(points)), good,
        f"{len(points)} points, {len(double)} of codimension two; ended: {ended[0]}, {ended[1]}",
    )  # fmt: skip
