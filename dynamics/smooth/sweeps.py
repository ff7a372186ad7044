"""Motions on the stepwise flow that are carried on: sweeps and Lyapunov exponents."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from base import Cost, Fault, Faults, InputError, Stopwatch
from dynamics.exponents import BATCHES, LyapunovResult
from dynamics.flow import checked_state
from dynamics.shooting import motion_label
from dynamics.smooth.flow import REASONS, FlowMap, finer, follow
from dynamics.smooth.oscillator import Engine, SmoothOscillator
from dynamics.smooth.shooting import find_orbit
from dynamics.sweeps import APERIODIC, DIVERGED, SweepResult, checked_sweep, repeat_after

__all__ = ["force", "lyapunov_exponents", "rest_state", "sweep"]

FloatArray = npt.NDArray[np.float64]
TOLERANCE = 1e-9  # of a motion that is followed for long; orbits and branches have their own


def force(
    oscillator: SmoothOscillator, angle: npt.ArrayLike, x: npt.ArrayLike, v: npt.ArrayLike = 0.0
) -> FloatArray:
    """Restoring force and its derivatives with respect to X and V, last axis 3.

    Parameters
    ----------
    oscillator : SmoothOscillator
        Whose law is meant.
    angle, x, v : array_like
        Angle omega tau [rad], X and V, broadcast against each other.
    """
    from dynamics.smooth.kernels.carrying import probe

    theta, place, speed = np.broadcast_arrays(angle, x, v)
    engine = Engine(oscillator, TOLERANCE)
    out = np.empty((theta.size, 3 + len(engine.model[2])))
    points = np.column_stack([np.asarray(a, dtype=np.float64).ravel() for a in (theta, place, speed)])
    probe(engine.model, engine.surfaces, points, out)
    return out[:, :3].reshape(*theta.shape, 3)


def rest_state(oscillator: SmoothOscillator) -> FloatArray:
    """State at rest where the mean of the force over the angle balances the mean force; zeros if there is none."""
    angles = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    side = math.copysign(1.0, oscillator.mean_force)

    def excess(x: float) -> float:
        mean = float(force(oscillator, angles, np.full(64, side * x))[:, 0].mean())
        return side * (mean - oscillator.mean_force)

    low, high = 0.0, oscillator.size
    for _ in range(60):
        if excess(high) > 0.0:
            break
        low, high = high, 2.0 * high
    else:
        return np.zeros(2)
    if excess(low) > 0.0:
        return np.zeros(2)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if excess(middle) > 0.0 else (middle, high)
    return np.array([side * high, 0.0])


def sweep(
    oscillator: SmoothOscillator,
    parameter: str = "frequency",
    values: npt.ArrayLike = (),
    direction: str = "up",
    *,
    keep: int = 64,
    transient: int | None = None,
    initial: npt.ArrayLike | None = None,
    max_period: int = 16,
    tolerance: float = TOLERANCE,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Sweep a parameter up or down; each motion starts from the last state of the one before.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        As in `SmoothOscillator.parameters`.
    values : array_like, shape (m,)
        Parameter values, in any order.
    direction : str
        "up" visits the values in rising order, "down" in falling order; the result keeps the order given.
    keep : int
        Periods kept, at least twice `max_period`.
    transient : int, optional
        Periods dropped before those. Left out: as many as linear damping needs for a disturbance to shrink by 1e-6,
        between 200 and 5000; a motion that does not repeat then is given three times as many again.
    initial : array_like, shape (2,), optional
        State at the first value visited. Left out: at rest under the mean force.
    max_period : int
        Longest period that is recognised, in excitation periods.
    tolerance : float
        Of a step.
    progress : callable, optional
        Called with the number of values done and the number of all.

    Returns
    -------
    SweepResult
        States and labels.

    Raises
    ------
    InputError
        If an argument is out of range.
    """
    watch = Stopwatch()
    grid, order, longest, kept, wait = checked_sweep(values, direction, max_period, keep, transient)
    first = oscillator.with_parameter(parameter, float(grid[order[0]]))
    state = rest_state(first) if initial is None else checked_state(initial, "initial")
    restart = state.copy()
    states, impacts = np.full((len(grid), kept, 2), np.nan), np.full((len(grid), 2), np.nan)
    labels, periods = [DIVERGED] * len(grid), np.zeros(len(grid), dtype=np.int64)
    error, total, lost = 0.0, 0, list[float]()
    for done, i in enumerate(order, start=1):
        here = oscillator.with_parameter(parameter, float(grid[i]))
        motion, n, label, used = _settled(here, state, kept, wait, longest, tolerance)
        total += used
        if motion.message:
            lost.append(float(grid[i]))
            state = restart.copy()
        else:
            states[i], impacts[i] = motion.states, motion.counts.mean(axis=0)
            periods[i] = n
            labels[i] = label
            error = max(error, _map_error(here, states[i, -2], states[i, -1], tolerance))
            state = motion.states[-1].copy()
        if progress is not None:
            progress(done, len(grid))
    message = f"{len(grid)} values, {labels.count(APERIODIC)} aperiodic"
    if lost:
        message += f"; not followed at {len(lost)}, first {parameter} = {lost[0]:g}: check the law there"
    cost = Cost(watch.seconds, 0, 0, total)
    return SweepResult(
        parameter, direction, grid, states, tuple(labels), periods, impacts, error, cost, not lost, message
    )  # fmt: skip


def _settled(
    here: SmoothOscillator, state: FloatArray, kept: int, wait: int | None, longest: int, tolerance: float
) -> tuple[FlowMap, int, str, int]:
    """Motion after its transient, the periods after which it repeats, its label, the periods spent."""
    decay = here.damping_ratio * here.period
    skip = 5000 if decay <= 0.0 else int(min(max(math.log(1e6) / decay, 200), 5000))
    engine, used = Engine(here, tolerance), 0
    for attempt in range(4):
        skip = skip if wait is None else wait
        motion = follow(engine, state, kept, skip, derivatives=False)
        used += kept + skip
        n = 0 if motion.message else repeat_after(motion.states, longest, max(1e-6, 1e3 * tolerance))
        if n or motion.message or wait is not None or attempt == 3:
            break
        state = motion.states[-1]
    if n > 1:  # close to a period doubling a motion of period n/2 still alternates
        orbit = find_orbit(here, motion.states[-1], n, tolerance=tolerance)
        near = 0.05 * float(np.max(np.abs(motion.states)))
        gap = float(np.max(np.abs(orbit.state - motion.states[-1])))
        if orbit.converged and orbit.stable and orbit.periods < n and gap < near:
            return motion, orbit.periods, orbit.label, used
    p, q = motion.counts[kept - n :].sum(axis=0) if n else (0, 0)
    return motion, n, motion_label(n, (int(p), int(q))) if n else APERIODIC, used


def _map_error(here: SmoothOscillator, before: FloatArray, after: FloatArray, tolerance: float) -> float:
    """Relative change of one period's map with a finer tolerance."""
    again = follow(Engine(here, finer(tolerance)), before, 1, derivatives=False).state
    return float(np.max(np.abs(again - after))) / max(float(np.max(np.abs(after))), 1e-300)


def lyapunov_exponents(
    oscillator: SmoothOscillator,
    periods: int = 2000,
    *,
    state: npt.ArrayLike | None = None,
    transient: int = 200,
    tolerance: float = TOLERANCE,
) -> LyapunovResult:
    """Lyapunov exponents of the motion that starts at a state.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    periods : int
        Excitation periods averaged over, at least 20.
    state : array_like, shape (2,), optional
        X and V at tau = 0. Left out: at rest under the mean force.
    transient : int
        Periods dropped before.
    tolerance : float
        Of a step.

    Returns
    -------
    LyapunovResult
        The exponents and their standard error. Their sum is minus the mean of all damping, -2 zeta if it is linear,
        which is not used to compute them.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion cannot be followed.
    """
    from dynamics.smooth.kernels.carrying import stretch

    watch = Stopwatch()
    faults = Faults()
    n = faults.whole("periods", periods, BATCHES, 10**9, "10 000 gives two digits in chaos")
    skip = faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    at = rest_state(oscillator) if state is None else checked_state(state)
    engine = Engine(oscillator, tolerance)
    pieces = max(1, math.ceil(oscillator.period / 1.5))  # so that no stretch between two is large
    y, (going, on) = engine.vector(at, derivatives=True), engine.going()
    sizes = [skip, *(n // BATCHES + (i < n % BATCHES) for i in range(BATCHES))]
    rates = np.empty((BATCHES + 1, 3))
    for i, size in enumerate(sizes):
        logs = np.zeros(3)
        flag = int(
            stretch(
                engine.model, engine.surfaces, engine.tolerance, engine.size, y, going, on, size, pieces, logs
            )
        )
        if flag:
            fault = Fault("state", repr(state), "must start a motion that can be followed", REASONS[flag])
            raise InputError((fault,))
        rates[i] = logs / (max(size, 1) * oscillator.period)
    weights = np.array(sizes[1:]) / n
    order = np.argsort((weights @ rates[1:])[:2])[::-1]
    exponents = (weights @ rates[1:])[order]
    spreads = np.std(rates[1:, order], axis=0, ddof=1) / math.sqrt(BATCHES)
    spread = float(spreads[0])
    largest = float(np.max(np.abs(exponents)))
    sure = abs(exponents[0]) > 3.0 * spread
    message = "average more periods: the sign of the larger exponent is not certain"
    if sure:
        message = "chaotic" if exponents[0] > 0.0 else "periodic"
    cost = Cost(watch.seconds, 0, 0, skip + n)
    error = spread / largest if largest > 0.0 else spread
    return LyapunovResult(exponents, spreads, error, y[:2].copy(), cost, bool(sure), message)
