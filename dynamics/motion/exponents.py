"""Lyapunov exponents from the derivative of the flow."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Stopwatch, quantity, record
from dynamics.flow.protocol import Flow, lost_motion
from dynamics.model.arrays import AsArray
from dynamics.model.limits import AVERAGED, TRANSIENT, checked_grid
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import Oscillator, settling_periods
from dynamics.model.reasons import FLOW
from dynamics.model.states import checked_state, start_state
from dynamics.motion.sweeps import long_flow


@record
class LyapunovResult(AsArray):
    """Lyapunov exponents, per unit of dimensionless time; two in one freedom."""

    no_error = FLOW

    headline = ("standard_error",)

    exponents: Array = quantity(
        "1", "the largest first; their sum is minus the mean of all damping, -2 zeta if it is linear in one freedom, "
        "which is not used to compute them", "exponent",
    )  # fmt: skip
    damping: float = quantity(
        "1", "mean along the motion of the trace of all linear damping, 2 zeta in one freedom"
    )
    standard_errors: Array = quantity(
        "1",
        "of each, from the scatter of 20 batches of the motion; equal to rounding where the sum is exact",
        "exponent",
    )
    error: float = quantity("1", "standard error of the largest over the largest modulus")
    state: Array = quantity("1", "last state", "coordinate")
    cost: Cost
    converged: bool = quantity(
        "1", "whether the sign of the larger exponent is certain: it exceeds three standard errors"
    )
    message: str = quantity("", "periodic, chaotic or what to do")

    @property
    def standard_error(self) -> float:
        """Of the largest exponent."""
        return float(self.standard_errors[0])

    def columns(self) -> Array:
        """Return the exponents."""
        return self.exponents


def lyapunov_exponents(
    oscillator: Oscillator,
    periods: int = 10_000,
    *,
    state: npt.ArrayLike | None = None,
    transient: int | None = None,
    tolerance: float | None = None,
) -> LyapunovResult:
    """Lyapunov exponents of the motion that starts at a state.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    periods : int
        Excitation periods averaged over, at least 20.
    state : array_like, shape (2,), optional
        X and V at tau = 0. Left out: at rest in contact under the mean force.
    transient : int, optional
        Periods dropped before. Left out: as in `sweep`.
    tolerance : float, optional
        Of the flow, as of `period_map`; 1e-9 for steps, rounding for the exact flow.

    Returns
    -------
    LyapunovResult
        The exponents and their standard error.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion cannot be followed.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> lyapunov_exponents(oscillator, 200).message
    'periodic'
    """
    watch = Stopwatch()
    with Faults() as faults:
        n = faults.whole("periods", periods, *AVERAGED)
        skip = settling_periods(oscillator)
        if transient is not None:
            skip = faults.whole("transient", transient, *TRANSIENT)
    at = start_state(oscillator, state)
    sizes = np.array([n // OPTIONS.batches + (i < n % OPTIONS.batches) for i in range(OPTIONS.batches)])
    motion = long_flow(oscillator, tolerance).stretches(at, [skip, *sizes.tolist()])
    if motion.message:
        raise lost_motion(at, motion.message)
    rates = motion.logs[1:] / (sizes[:, None] * oscillator.period)
    exponents = sizes / n @ rates
    order = np.argsort(exponents)[::-1]
    exponents = exponents[order]
    spread = np.std(rates[:, order], axis=0, ddof=1) / math.sqrt(OPTIONS.batches)
    largest = float(np.max(np.abs(exponents)))
    sure = abs(exponents[0]) > OPTIONS.sure * spread[0]
    message = "average more periods: the sign of the larger exponent is not certain"
    if sure:
        message = "chaotic" if exponents[0] > 0.0 else "periodic"
    cost = Cost(watch.seconds, periods=skip + n)
    error = float(spread[0]) / largest if largest > 0.0 else float(spread[0])
    damping = float(np.sum(motion.damped[1:])) / (n * oscillator.period)
    return LyapunovResult(exponents, damping, spread, error, motion.states[-1], cost, bool(sure), message)


@record
class LyapunovScan(AsArray):
    """Lyapunov exponents over a parameter."""

    no_error = FLOW

    headline = ("parameter", "defect")

    parameter: str = quantity("", "what was varied")
    values: Array = quantity("1", "its values, in the order given", "value")
    exponents: Array = quantity(
        "1", "the larger first; nan where the motion could not be followed", "value exponent"
    )
    standard_errors: Array = quantity("1", "standard errors of both", "value exponent")
    states: Array = quantity("1", "last states", "value coordinate")
    defect: float = quantity(
        "1",
        "largest departure of the sum from what linear damping makes it, -2 zeta in one freedom: a check of the flow",
    )
    error: float = quantity("1", "largest standard error")
    cost: Cost
    converged: bool = quantity("1", "whether the sign of the larger exponent is certain everywhere")
    message: str = quantity("", "remarks on the result")

    def columns(self) -> Array:
        """Columns value, larger exponent, smaller exponent, their standard errors."""
        return np.column_stack([self.values, self.exponents, self.standard_errors])


def lyapunov_scan(
    oscillator: Oscillator,
    parameter: str,
    values: npt.ArrayLike,
    periods: int = 2000,
    *,
    state: npt.ArrayLike | None = None,
    transient: int | None = None,
    tolerance: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LyapunovScan:
    """Both exponents over a parameter, the motion carried from value to value in the order given.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    values : array_like, shape (m,)
        Parameter values.
    periods : int
        Excitation periods averaged over at each value, at least 20.
    state : array_like, shape (2,), optional
        X and V at tau = 0 for the first value. Left out: at rest in contact under the mean force.
    transient : int, optional
        Periods dropped before. Left out: as in `sweep`.
    tolerance : float, optional
        Of the flow, as of `period_map`; 1e-9 for steps, rounding for the exact flow.
    progress : callable, optional
        Called with the number of values done and the number of all.

    Returns
    -------
    LyapunovScan
        Exponents and their standard errors.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> lyapunov_scan(oscillator, "frequency", [0.5, 0.6], periods=100).exponents.shape
    (2, 2)
    """
    watch = Stopwatch()
    with Faults() as faults:
        grid = checked_grid(faults, "values", values)
        n = faults.whole("periods", periods, *AVERAGED)
        if transient is not None:
            faults.whole("transient", transient, *TRANSIENT)
    start = None if state is None else checked_state(state, size=oscillator.dimension)
    exponents, errors = (np.full((len(grid), oscillator.directions), np.nan) for _ in range(2))
    states = np.full((len(grid), oscillator.dimension), np.nan)
    at, defect, used, unsure = start, 0.0, 0, 0
    for i, value in enumerate(grid):
        here = oscillator.with_parameter(parameter, float(value))
        try:
            result = lyapunov_exponents(here, n, state=at, transient=transient, tolerance=tolerance)
        except InputError:  # unbounded: the arguments have been checked
            at = start
            continue
        finally:
            if progress is not None:
                progress(i + 1, len(grid))
        exponents[i], errors[i], states[i] = result.exponents, result.standard_errors, result.state
        at = result.state
        defect = max(defect, abs(float(result.exponents.sum()) + result.damping))
        used += result.cost.periods
        unsure += not result.converged
    lost = int(np.sum(np.isnan(exponents[:, 0])))
    message = f"{len(grid)} values, {int(np.sum(exponents[:, 0] > OPTIONS.sure * errors[:, 0]))} chaotic"
    if unsure:
        message += f"; the sign is not certain at {unsure}: average more periods"
    if lost:
        message += f"; unbounded at {lost}: check the parameters there"
    error = float(np.nanmax(errors[:, 0], initial=0.0))
    cost = Cost(watch.seconds, periods=used)
    good = lost == unsure == 0
    return LyapunovScan(parameter, grid, exponents, errors, states, defect, error, cost, good, message)


def stretch_rate(flow: Flow, state: Array, periods: int) -> tuple[Array, float, float]:
    """States of a motion, shape (periods, 2), its larger exponent per period and the standard error of that.

    All nan if the motion is lost.
    """
    sizes = [len(part) for part in np.array_split(np.arange(periods), OPTIONS.batches)]
    motion = flow.stretches(state, sizes, keep=True)
    if motion.message:
        return np.full_like(motion.states, np.nan), math.nan, math.nan
    rates = motion.logs[:, 0] / sizes
    return motion.states, float(np.mean(rates)), float(np.std(rates, ddof=1)) / math.sqrt(OPTIONS.batches)
