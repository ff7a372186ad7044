"""The stepwise flow: period map with derivatives, sampled motion with events."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost, Fault, Faults, InputError, Stopwatch
from dynamics.flow import Trajectory, checked_state
from dynamics.smooth.oscillator import Engine, SmoothOscillator

__all__ = ["TOLERANCE", "FlowMap", "finer", "follow", "period_map", "trajectory"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
TOLERANCE = 1e-12
REASONS = {
    1: "the motion grew beyond 1e150",
    2: "more than 100 000 crossings in a period",
    3: "more than a million steps in a period, or one below 1e-14 of a radian: the law is not smooth, or its "
    "derivatives are wrong",
    4: "the motion sticks to a switching surface, which this flow does not follow",
}


@dataclass(frozen=True, eq=False)
class FlowMap:
    """Image of a state under n periods.

    Parameters
    ----------
    states : ndarray, shape (periods, 2)
        X and V after each period.
    jacobian : ndarray, shape (2, 2)
        Derivative of the last state with respect to the first.
    slope : ndarray, shape (2, m)
        Its derivative with respect to the parameters asked for, at the changed period if the frequency changes.
    log_determinant : float
        Logarithm of the determinant of the Jacobian, by its own equation (Liouville): the integral of minus all
        damping along the motion, and the jumps at switching surfaces. With linear damping -4 pi zeta n / omega.
    counts : ndarray, shape (periods, 2)
        Exits from X > D and entries into X < -D during each period.
    events : ndarray, shape (e, 6 + 2 + m)
        Angle (omega tau), surface, side entered, X, V, X'' and derivatives of X at each crossing; the last surface is
        V = 0 where extrema were asked for.
    error : float
        Largest difference of the last state to that of a finer tolerance, over the size of the motion; nan from
        `follow`, which does not compute it.
    cost : Cost
        Effort.
    evaluations : int
        Of the law.
    message : str
        Empty, or why the motion could not be followed; the figures are then nan.
    """

    states: FloatArray
    jacobian: FloatArray
    slope: FloatArray
    log_determinant: float
    counts: IntArray
    events: FloatArray
    error: float
    cost: Cost
    evaluations: int
    message: str

    @property
    def state(self) -> FloatArray:
        """Last state, shape (2,)."""
        return np.asarray(self.states[-1])


def finer(tolerance: float) -> float:
    """Tolerance of the second computation that an error is estimated by."""
    return max(tolerance / 32.0, 4e-15) if tolerance > 4e-15 else 2e-15


def follow(
    engine: Engine, state: FloatArray, periods: int = 1, skip: int = 0, derivatives: bool = True
) -> FlowMap:
    """Follow a state; without arguments checked and without an error estimate."""
    from dynamics.smooth.kernels.carrying import iterate

    watch = Stopwatch()
    room = 32 * (skip + periods)
    while True:
        y = engine.vector(state, derivatives)
        going, on = engine.going()
        states, counts = np.empty((periods, 2)), np.zeros((periods, 2), dtype=np.int64)
        events = np.empty((room, 6 + (engine.columns if derivatives else 0)))
        flag = int(
            iterate(
                engine.model, engine.surfaces, engine.tolerance, engine.size, y, going, on, skip, states, counts,
                events,
            )
        )  # fmt: skip
        met = int(going[2])
        if met <= room:
            break
        room = met
    if flag:
        states[:] = np.nan
        y[:] = np.nan
    rest = y[3:].reshape(-1, 2).T if derivatives else np.full((2, engine.columns), np.nan)
    cost = Cost(watch.seconds, 0, 0, skip + periods)
    return FlowMap(
        states, rest[:, :2].copy(), rest[:, 2:].copy(), float(y[2]) if derivatives else math.nan, counts,
        events[:met], math.nan, cost, int(going[3]), REASONS.get(flag, ""),
    )  # fmt: skip


def period_map(
    oscillator: SmoothOscillator,
    state: npt.ArrayLike,
    periods: int = 1,
    skip: int = 0,
    *,
    parameters: tuple[str, ...] = (),
    extrema: bool = False,
    tolerance: float = TOLERANCE,
) -> FlowMap:
    """Follow a state at tau = 0 over whole excitation periods.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    state : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Number of periods kept.
    skip : int
        Periods followed before those; the derivatives cover them too.
    parameters : tuple of str
        Parameters to differentiate by, named as in `SmoothOscillator.parameters`.
    extrema : bool
        Whether extrema of X are among the events.
    tolerance : float
        Of a step, relative to the size of the motion and of each derivative, 2e-15 to 0.1.

    Returns
    -------
    FlowMap
        With its error estimate.

    Raises
    ------
    InputError
        If an argument is out of range.
    """
    watch = Stopwatch()
    at = checked_state(state)
    faults = Faults()
    n = faults.whole("periods", periods, 1, 10**9, "give a positive number of periods")
    n_skip = faults.whole("skip", skip, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    here = follow(Engine(oscillator, tolerance, parameters, extrema), at, n, n_skip)
    there = follow(Engine(oscillator, finer(tolerance)), at, n, n_skip, derivatives=False)
    size = max(float(np.max(np.abs(here.states))), oscillator.size)
    error = float(np.max(np.abs(here.state - there.state))) / size
    cost = Cost(watch.seconds, 0, 0, 2 * (n + n_skip))
    return FlowMap(
        here.states, here.jacobian, here.slope, here.log_determinant, here.counts, here.events, error, cost,
        here.evaluations + there.evaluations, here.message,
    )  # fmt: skip


def trajectory(
    oscillator: SmoothOscillator,
    state: npt.ArrayLike,
    periods: int = 1,
    points_per_period: int = 200,
    *,
    tolerance: float = TOLERANCE,
) -> Trajectory:
    """Sample the motion from a state at tau = 0; for phase portraits and Poincare points.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    state : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Excitation periods.
    points_per_period : int
        Samples per period; a step ends at each.
    tolerance : float
        Of a step.

    Returns
    -------
    Trajectory
        Samples, crossings of the first two surfaces (region entered 1, 0, -1) and extrema.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion cannot be followed.
    """
    faults = Faults()
    n = faults.whole("periods", periods, 1, 10**7, "give a positive number of periods")
    points = faults.whole("points_per_period", points_per_period, 1, 10**6, "200 draws a smooth curve")
    faults.raise_if_any()
    at = checked_state(state)
    engine = Engine(oscillator, tolerance, (), turning=True)
    samples, events = _sampled(engine, at, n, points)
    again, _ = _sampled(Engine(oscillator, finer(tolerance), (), turning=True), at, n, points)
    turns = events[:, 1] == engine.levels
    crossings = events[~turns]
    entered = np.where(crossings[:, 1] == 0, np.maximum(crossings[:, 2], 0), np.minimum(crossings[:, 2], 0))
    tau = 1.0 / oscillator.frequency
    return Trajectory(
        tau=np.arange(n * points + 1, dtype=np.float64) * (oscillator.period / points),
        x=samples[:, 0],
        v=samples[:, 1],
        points_per_period=points,
        events=np.column_stack([crossings[:, 0] * tau, crossings[:, 3], crossings[:, 4], entered]),
        extrema=np.column_stack([events[turns, 0] * tau, events[turns, 3], events[turns, 5]]),
        error=float(np.max(np.abs(samples - again)) / max(np.max(np.abs(samples)), 1e-300)),
    )


def _sampled(engine: Engine, state: FloatArray, periods: int, points: int) -> tuple[FloatArray, FloatArray]:
    """Samples and events."""
    from dynamics.smooth.kernels.carrying import carry

    y, (going, on) = engine.vector(state, derivatives=False), engine.going()
    samples, unseen = np.empty((periods * points + 1, 2)), np.zeros(2, dtype=np.int64)
    samples[0] = y
    noted: list[FloatArray] = []
    angles = 2.0 * math.pi * np.arange(points + 1) / points
    for i in range(periods * points):
        going[2], place = 0.0, i % points
        room = np.empty((256, 6))
        flag = int(
            carry(
                engine.model, engine.surfaces, engine.tolerance, engine.size, float(angles[place]),
                float(angles[place + 1]), y, going, on, unseen, room, i // points,
            )
        )  # fmt: skip
        if flag or going[2] > len(room):
            reason = REASONS.get(flag, "more than 256 events between two samples: take more points")
            fault = Fault("state", repr(state.tolist()), "must start a motion that can be followed", reason)
            raise InputError((fault,))
        noted.append(room[: int(going[2])])
        samples[i + 1] = y
    return samples, np.concatenate(noted)
