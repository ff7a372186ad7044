"""Periodic orbits by Newton shooting on the stepwise period map."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost, Faults, Stopwatch
from dynamics.flow import checked_state
from dynamics.shooting import floquet_multipliers, is_stable, motion_label, newton_step
from dynamics.smooth.flow import TOLERANCE, FlowMap, finer, follow
from dynamics.smooth.oscillator import Engine, SmoothOscillator

__all__ = ["SmoothOrbit", "find_orbit"]

FloatArray = npt.NDArray[np.float64]
NOISE = 50.0  # residual over tolerance and stretch of the map that the choice of steps leaves


@dataclass(frozen=True, eq=False)
class SmoothOrbit:
    """A periodic motion.

    Parameters
    ----------
    oscillator : SmoothOscillator
        What moves.
    state : ndarray, shape (2,)
        X and V at tau = 0; nan if not converged.
    periods : int
        Its least period n, in excitation periods; it may be a divisor of the number asked for.
    multipliers : ndarray, shape (2,)
        Floquet multipliers over n periods, the larger modulus first; complex if they are a pair.
    stable : bool
        Both multipliers within the unit circle.
    label : str
        n-p-q: periods, exits from X > D, entries into X < -D; "U" before it if unstable.
    counts : tuple of int
        p and q.
    jacobian : ndarray, shape (2, 2)
        Derivative of the n-period map.
    determinant : float
        Of the Jacobian, by its own equation along the motion.
    residual : float
        Largest component of map minus state.
    error : float
        Estimated relative error of the state: the Newton step that a finer tolerance would still take.
    cost : Cost
        Effort.
    converged : bool
        Whether the residual is down to the tolerance times the stretch of the map.
    message : str
        What happened, with a remedy if it did not converge.
    history : tuple of float
        Residual of every iteration.
    tolerance : float
        Of a step.
    """

    oscillator: SmoothOscillator
    state: FloatArray
    periods: int
    multipliers: npt.NDArray[np.complex128] | FloatArray
    stable: bool
    label: str
    counts: tuple[int, int]
    jacobian: FloatArray
    determinant: float
    residual: float
    error: float
    cost: Cost
    converged: bool
    message: str
    history: tuple[float, ...]
    tolerance: float


def find_orbit(
    oscillator: SmoothOscillator,
    guess: npt.ArrayLike,
    periods: int = 1,
    *,
    max_iterations: int = 60,
    transient: int = 0,
    tolerance: float = TOLERANCE,
) -> SmoothOrbit:
    """Find a periodic orbit, stable or not, by Newton's method on the period map.

    Parameters
    ----------
    oscillator : SmoothOscillator
        The oscillator.
    guess : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Period of the orbit sought, in excitation periods.
    max_iterations : int
        Newton iterations.
    transient : int
        Periods to follow the motion before Newton starts, to come close to an attractor.
    tolerance : float
        Of a step.

    Returns
    -------
    SmoothOrbit
        With converged = False and nan for its figures if Newton's method did not arrive.

    Raises
    ------
    InputError
        If an argument is out of range.
    """
    watch = Stopwatch()
    faults = Faults()
    n = faults.whole("periods", periods, 1, 100_000, "give the number of excitation periods")
    limit = faults.whole("max_iterations", max_iterations, 1, 100_000, "60 is ample")
    wait = faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    engine = Engine(oscillator, tolerance)
    state = checked_state(guess, "guess")
    used = wait
    if wait:
        state = follow(engine, state, 1, wait - 1, derivatives=False).state
    x, image, history = _newton(engine, state, n, limit)
    scale = max(float(np.max(np.abs(x))), oscillator.size)
    stretch = max(1.0, float(np.max(np.abs(image.jacobian))))
    good = bool(history[-1] <= NOISE * tolerance * scale * stretch and history[-1] <= 1e-6 * scale)
    error, message = math.nan, image.message or _remedy(history[-1], scale, stretch, tolerance)
    if good:
        n, image = _least_period(engine, x, n, image, stretch)
        there = follow(Engine(oscillator, finer(tolerance)), x, n, derivatives=False)
        error = float(np.max(np.abs(newton_step(image.jacobian, there.state - x)))) / scale
        good = error < 1e-3
        message = f"converged in {len(history) - 1} iterations"
        if n != periods:
            message += f"; the orbit has period {n}, a divisor of the {periods} asked for"
        if not good:
            message = (
                f"the orbit moves by {error:.0e} of its size with a finer tolerance: lower the tolerance"
            )
    cost = Cost(watch.seconds, 2, len(history) - 1, used + n * (len(history) + 2))
    return _assembled(engine, x, n, image, history, error, cost, good, message)


def _assembled(
    engine: Engine, x: FloatArray, n: int, image: FlowMap, history: list[float], error: float, cost: Cost,
    good: bool, message: str,
) -> SmoothOrbit:  # fmt: skip
    """Record of an orbit, of nan if it is not good."""
    if not good:
        lost = np.full(2, np.nan)
        return SmoothOrbit(
            engine.oscillator, lost, n, lost.copy(), False, "", (0, 0), np.full((2, 2), np.nan), math.nan,
            history[-1], math.nan, cost, False, message, tuple(history), engine.tolerance,
        )  # fmt: skip
    determinant = math.exp(image.log_determinant)
    multipliers = floquet_multipliers(float(np.trace(image.jacobian)), determinant)
    counts = (int(image.counts[:, 0].sum()), int(image.counts[:, 1].sum()))
    stable = is_stable(multipliers)
    return SmoothOrbit(
        engine.oscillator, x, n, multipliers, stable, motion_label(n, counts, stable), counts, image.jacobian,
        determinant, float(np.max(np.abs(image.state - x))), error, cost, True, message, tuple(history),
        engine.tolerance,
    )  # fmt: skip


def _newton(engine: Engine, start: FloatArray, n: int, limit: int) -> tuple[FloatArray, FlowMap, list[float]]:
    """Newton's method with step halving, until the residual no longer falls."""
    x, image = start, follow(engine, start, n)
    history = [float(np.max(np.abs(image.state - x)))]
    while len(history) <= limit and math.isfinite(history[-1]) and history[-1] > 0.0:
        step = newton_step(image.jacobian, image.state - x)
        factor, best = 1.0, None
        while factor >= 1.0 / 64.0 and np.all(np.isfinite(step)):
            trial = x + factor * step
            there = follow(engine, trial, n)
            size = float(np.max(np.abs(there.state - trial)))
            if best is None or size < best[0]:
                best = (size, trial, there)
            if size < history[-1]:
                break
            if float(np.max(np.abs(step))) <= 1e-9 * float(np.max(np.abs(x))):
                break  # this close a step that does not help is the noise of the steps
            factor *= 0.5
        if best is None or not best[0] < history[-1]:
            break
        x, image = best[1], best[2]
        history.append(best[0])
    return x, image, history


def _least_period(
    engine: Engine, x: FloatArray, n: int, image: FlowMap, stretch: float
) -> tuple[int, FlowMap]:
    """Smallest divisor of n after which the orbit closes."""
    scale = max(float(np.max(np.abs(image.states))), 1e-300)
    close = max(1e-9, NOISE * engine.tolerance * stretch) * scale
    for divisor in range(1, n // 2 + 1):
        if n % divisor == 0 and float(np.max(np.abs(image.states[divisor - 1] - x))) <= close:
            return divisor, follow(engine, x, divisor)
    return n, image


def _remedy(residual: float, scale: float, stretch: float, tolerance: float) -> str:
    """Why Newton's method stopped, and what to try."""
    if stretch * tolerance > 1e-6:
        return f"the map stretches by {stretch:.1e}: one shot loses all digits; lower the tolerance"
    return (
        f"stopped at a residual of {residual:.1e} (motion of size {scale:.1e}): start nearer, "
        "for an attractor with transient=300, or try another number of periods"
    )
