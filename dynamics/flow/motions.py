"""Motions of any oscillator by themselves: period map and sampled motion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Stopwatch, quantity, record
from dynamics.flow.flows import flow_of
from dynamics.flow.protocol import Flow, MapResult
from dynamics.flow.samples import mesh_force, samples_of
from dynamics.model.arrays import AsArray
from dynamics.model.limits import PERIODS, POINTS, TRANSIENT
from dynamics.model.protocol import Oscillator, PeriodicOscillator, periodic_only
from dynamics.model.reasons import FLOW
from dynamics.model.states import checked_state


@record
class Trajectory(AsArray):
    """Motion at equal times, and its impacts."""

    no_error = FLOW

    headline = ("points_per_period",)

    tau: Array = quantity("1", "dimensionless time from 0, both ends included", "sample")
    x: Array = quantity("1", "displacement X; in several freedoms y, which the backlash limits", "sample")
    v: Array = quantity("1", "speed dX/dtau", "sample")
    states: Array = quantity("1", "displacements and speeds: X and V, or all of them", "sample coordinate")
    points_per_period: int = quantity("1", "samples per excitation period")
    events: Array = quantity(
        "1",
        "time, X (+-D), speed and region entered (1, 0, -1) at every crossing of the backlash's limits",
        "event column",
    )
    extrema: Array = quantity("1", "time, X and acceleration at every extremum of X", "extremum column")
    error: float = quantity(
        "1",
        "difference to the motion on a finer flow, largest over the samples, over the largest size of X and of V",
    )
    cost: Cost

    converged = True  # a motion that cannot be followed raises
    message = ""

    def columns(self) -> Array:
        """Columns tau, then those of the state."""
        return np.column_stack([self.tau, self.states])

    @property
    def poincare(self) -> Array:
        """States at tau = 0 mod the excitation period, shape (periods + 1, dimension)."""
        return self.states[:: self.points_per_period]


def period_map(
    oscillator: Oscillator | Flow,
    state: npt.ArrayLike,
    periods: int = 1,
    skip: int = 0,
    *,
    parameters: tuple[str, ...] = (),
    extrema: bool = False,
    tolerance: float | None = None,
) -> MapResult:
    """Follow a state at tau = 0 over whole excitation periods.

    Parameters
    ----------
    oscillator : Oscillator or Flow
        The oscillator; its flow (`dynamics.flow.flows.flow_of`) made once saves the cost of that in repeated calls, and
        the error estimate.
    state : array_like, shape (dimension,)
        State at tau = 0: X and V, or displacements and speeds.
    periods : int
        Number of periods kept.
    skip : int
        Periods followed before those; the derivatives cover them too.
    parameters : tuple of str
        Parameters to differentiate by, stepwise flow alone; `map_derivatives` serves the exact one.
    extrema : bool
        Whether extrema of X are among the events, stepwise flow alone; the exact one has `turning_points`.
    tolerance : float, optional
        Of a step, or of one period's map where the flow is exact.

    Returns
    -------
    MapResult
        States, Jacobian and counts of impacts.

    Raises
    ------
    InputError
        If the state is not finite or an argument out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.0, 0.6, half_backlash=0.2)
    >>> period_map(oscillator, (0.3, 0.0)).state.round(12) + 0.0
    array([0.3, 0. ])
    """
    watch = Stopwatch()
    if isinstance(oscillator, Flow):
        at = checked_state(state, size=oscillator.dimension)
        fine = periods > 0 <= skip  # the checks would cost as much as a period
        return oscillator.follow(at, *((periods, skip) if fine else _checked_spans(periods, skip)))
    flow = flow_of(oscillator, tolerance).slopes(parameters, extrema)
    at = checked_state(state, size=flow.dimension)
    n, n_skip = _checked_spans(periods, skip)
    here, there = flow.follow(at, n, n_skip), flow.finer().follow(at, n, n_skip, derivatives=False)
    size = max(float(np.max(np.abs(here.states))), oscillator.floor)
    error = float(np.max(np.abs(here.state - there.state))) / size
    cost = replace(here.cost + there.cost, seconds=watch.seconds)
    return replace(here, error=error, cost=cost)


def _checked_spans(periods: int, skip: int) -> tuple[int, int]:
    """Periods that are kept and those skipped, as whole numbers."""
    with Faults() as faults:
        n = faults.whole("periods", periods, *PERIODS)
        n_skip = faults.whole("skip", skip, *TRANSIENT)
    return n, n_skip


def trajectory(
    oscillator: Oscillator,
    state: npt.ArrayLike,
    periods: int = 1,
    points_per_period: int = 200,
    *,
    tolerance: float | None = None,
) -> Trajectory:
    """Sample the motion from a state at tau = 0; for phase portraits and Poincare points.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    state : array_like, shape (dimension,)
        State at tau = 0: X and V, or displacements and speeds.
    periods : int
        Excitation periods.
    points_per_period : int
        Samples per period; on the exact flow more of them are not more accurate, and a step of the other ends at each.
    tolerance : float, optional
        As of `period_map`.

    Returns
    -------
    Trajectory
        The samples, impacts (crossings of the first two surfaces of a law) and extrema.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion cannot be followed.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> trajectory(oscillator, (0.5, 0.2), periods=2, points_per_period=50).x.shape
    (101,)
    """
    watch = Stopwatch()
    with Faults() as faults:
        n = faults.whole("periods", periods, *PERIODS)
        points = faults.whole("points_per_period", points_per_period, *POINTS)
    flow = flow_of(oscillator, tolerance)
    at = checked_state(state, size=flow.dimension)
    here = samples_of(oscillator, flow, at, n, points)
    finer, _, _ = flow.finer().sampled(at, n, points)
    off, size = np.max(np.abs(here.states - finer)), np.max(np.abs(here.states))
    return Trajectory(
        tau=here.tau,
        x=here.x,
        v=here.v,
        states=here.states,
        points_per_period=points,
        events=here.events,
        extrema=here.turns[:, :3],
        error=float(off / max(size, np.finfo(float).tiny)),
        cost=Cost(watch.seconds, periods=2 * n),
    )


@periodic_only
def turning_points(oscillator: PeriodicOscillator | Flow, state: npt.ArrayLike, periods: int = 1) -> Array:
    """Every extremum of X, in several freedoms of y, from a state at tau = 0.

    Parameters
    ----------
    oscillator : GearOscillator, DriveOscillator or Flow
        The oscillator, or its exact flow.
    state : array_like, shape (dimension,)
        State at tau = 0.
    periods : int
        Excitation periods.

    Returns
    -------
    ndarray, shape (k, 5)
        Time, X, acceleration, region (1, 0, -1) and the coordinate of the region (X - D, X, X + D), which
        keeps its digits next to the limit of the backlash.

    Raises
    ------
    InputError
        If the state is not finite, or the motion grows beyond all bounds.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> turning_points(oscillator, (0.5, 0.2)).shape[1]
    5
    """
    flow = oscillator if isinstance(oscillator, Flow) else flow_of(oscillator)
    return flow.sampled(checked_state(state, size=flow.dimension), periods, 0)[1]


@record
class ForceRange:
    """Minimum and maximum force of a motion, over the mean force."""

    headline = ("least", "greatest")

    least: float = quantity("1", "minimum of K(tau) f(X) / F_m; negative where the back flanks touch")
    greatest: float = quantity("1", "maximum of K(tau) f(X) / F_m")
    error: float = quantity("1", "change of the two with half as many samples, the larger one")


@periodic_only
def force_range(
    oscillator: PeriodicOscillator,
    state: npt.ArrayLike,
    periods: int = 1,
    samples: int = 400,
    *,
    load: float | None = None,
) -> ForceRange:
    """Minimum and maximum force of a motion.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    state : array_like, shape (dimension,)
        State at tau = 0.
    periods : int
        Excitation periods.
    samples : int
        Samples per period, even; the force is taken there, on the exact motion.
    load : float, optional
        Mean force of the mesh, not zero. Left out: that of a `GearOscillator`.

    Raises
    ------
    InputError
        If there is no mean force, or an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbit
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> forces = force_range(osc, find_orbit(osc, (0.35, 0.0)).state)
    >>> round(forces.least, 3), round(forces.greatest, 3)
    (0.182, 2.277)
    """
    with Faults() as faults:
        number = faults.whole("samples", samples, 4, 10**6, "400 is ample")
        mean = getattr(oscillator, "mean_force", 0.0) if load is None else load
        if np.ndim(mean) or mean == 0.0:
            faults.add(
                "load" if np.ndim(mean) else "mean_force", mean, "must be one number, not zero", "give a load"
            )
    flow = flow_of(oscillator)
    at, n = checked_state(state, size=flow.dimension), _checked_spans(periods, 0)[0]
    force = mesh_force(oscillator, samples_of(oscillator, flow, at, n, number)) / mean
    low, high, coarse = float(np.min(force)), float(np.max(force)), force[::2]
    error = max(abs(float(np.min(coarse)) - low), abs(float(np.max(coarse)) - high))
    return ForceRange(low, high, error)
