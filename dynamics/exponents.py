"""Lyapunov exponents from the exact derivative of the flow."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost, Fault, Faults, InputError, Stopwatch
from dynamics.flow import Tables, checked_state, tables
from dynamics.oscillator import GearOscillator
from dynamics.sweeps import rest_state, settling_periods

__all__ = ["LyapunovResult", "LyapunovScan", "lyapunov_exponents", "lyapunov_scan", "stretch_rate"]

FloatArray = npt.NDArray[np.float64]
BATCHES = 20


@dataclass(frozen=True, eq=False)
class LyapunovResult:
    """Lyapunov exponents, per unit of dimensionless time.

    Parameters
    ----------
    exponents : ndarray, shape (2,)
        The larger first. Their sum is -2 zeta exactly, which is not used to compute them.
    standard_errors : ndarray, shape (2,)
        Of both, from the scatter of 20 batches of the motion; equal to rounding, because the sum is exact.
    error : float
        Standard error over the larger modulus of the two.
    state : ndarray, shape (2,)
        Last state.
    cost : Cost
        Effort.
    converged : bool
        Whether the sign of the larger exponent is certain: it exceeds three standard errors.
    message : str
        "periodic", "chaotic" or what to do.
    """

    exponents: FloatArray
    standard_errors: FloatArray
    error: float
    state: FloatArray
    cost: Cost
    converged: bool
    message: str

    @property
    def standard_error(self) -> float:
        """Of the larger exponent."""
        return float(self.standard_errors[0])

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Return the two exponents."""
        return self.exponents.astype(dtype if dtype is not None else np.float64)


def lyapunov_exponents(
    oscillator: GearOscillator,
    periods: int = 10_000,
    *,
    state: npt.ArrayLike | None = None,
    transient: int | None = None,
) -> LyapunovResult:
    """Lyapunov exponents of the motion that starts at a state.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    periods : int
        Excitation periods averaged over, at least 20.
    state : array_like, shape (2,), optional
        X and V at tau = 0. Left out: at rest in contact under the mean force.
    transient : int, optional
        Periods dropped before. Left out: as in `sweep`.

    Returns
    -------
    LyapunovResult
        The exponents and their standard error.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion grows beyond all bounds.
    """
    watch = Stopwatch()
    faults = Faults()
    n = faults.whole("periods", periods, BATCHES, 10**9, "10 000 gives two digits in chaos")
    skip = settling_periods(oscillator)
    if transient is not None:
        skip = faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    at = rest_state(oscillator) if state is None else checked_state(state)
    table = tables(oscillator)
    frame = np.vstack([np.eye(2), np.zeros((1, 2))])
    flag = _advance(table, at, skip, frame)
    rates, weights = np.empty((BATCHES, 2)), np.empty(BATCHES)
    for i in range(BATCHES):
        size = n // BATCHES + (i < n % BATCHES)
        frame[2] = 0.0
        flag = flag or _advance(table, at, size, frame)
        rates[i], weights[i] = frame[2] / (size * oscillator.period), size / n
    if flag:
        fault = Fault("state", repr(state), "must start a motion that stays bounded", "check the parameters")
        raise InputError((fault,))
    exponents = weights @ rates
    order = np.argsort(exponents)[::-1]
    exponents = exponents[order]
    spread = np.std(rates[:, order], axis=0, ddof=1) / math.sqrt(BATCHES)
    largest = float(np.max(np.abs(exponents)))
    sure = abs(exponents[0]) > 3.0 * spread[0]
    message = "average more periods: the sign of the larger exponent is not certain"
    if sure:
        message = "chaotic" if exponents[0] > 0.0 else "periodic"
    cost = Cost(watch.seconds, 0, 0, skip + n)
    error = float(spread[0]) / largest if largest > 0.0 else float(spread[0])
    return LyapunovResult(exponents, spread, error, at, cost, bool(sure), message)


@dataclass(frozen=True, eq=False)
class LyapunovScan:
    """Both Lyapunov exponents over a parameter.

    Parameters
    ----------
    parameter : str
        What was varied.
    values : ndarray, shape (m,)
        Its values, in the order given.
    exponents : ndarray, shape (m, 2)
        The larger first; nan where the motion grew without bound.
    standard_errors : ndarray, shape (m, 2)
        Of both.
    states : ndarray, shape (m, 2)
        Last states.
    defect : float
        Largest departure of the sum from -2 zeta: a check of the flow, not used to compute anything.
    error : float
        Largest standard error.
    cost : Cost
        Effort.
    converged : bool
        Whether the sign of the larger exponent is certain everywhere.
    message : str
        What to know about the result.
    """

    parameter: str
    values: FloatArray
    exponents: FloatArray
    standard_errors: FloatArray
    states: FloatArray
    defect: float
    error: float
    cost: Cost
    converged: bool
    message: str

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Columns value, larger exponent, smaller exponent, their standard errors."""
        table = np.column_stack([self.values, self.exponents, self.standard_errors])
        return table.astype(dtype if dtype is not None else np.float64)


def lyapunov_scan(
    oscillator: GearOscillator,
    parameter: str,
    values: npt.ArrayLike,
    periods: int = 2000,
    *,
    state: npt.ArrayLike | None = None,
    transient: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> LyapunovScan:
    """Both exponents over a parameter, the motion carried from value to value in the order given.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        As in `GearOscillator.with_parameter`.
    values : array_like, shape (m,)
        Parameter values.
    periods : int
        Excitation periods averaged over at each value, at least 20.
    state : array_like, shape (2,), optional
        X and V at tau = 0 for the first value. Left out: at rest in contact under the mean force.
    transient : int, optional
        Periods dropped before. Left out: as in `sweep`.
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
    """
    watch = Stopwatch()
    faults = Faults()
    grid = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if grid.ndim != 1 or len(grid) == 0 or not np.all(np.isfinite(grid)):
        allowed = "must be finite numbers in one dimension"
        faults.add("values", f"shape {grid.shape}", allowed, "give at least one value")
    n = faults.whole("periods", periods, BATCHES, 10**9, "2000 draws a curve")
    if transient is not None:
        faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    start = None if state is None else checked_state(state)
    exponents, errors, states = (np.full((len(grid), 2), np.nan) for _ in range(3))
    at, defect, used, unsure = start, 0.0, 0, 0
    for i, value in enumerate(grid):
        here = oscillator.with_parameter(parameter, float(value))
        try:
            result = lyapunov_exponents(here, n, state=at, transient=transient)
        except InputError:  # unbounded: the arguments have been checked
            at = start
            continue
        finally:
            if progress is not None:
                progress(i + 1, len(grid))
        exponents[i], errors[i], states[i] = result.exponents, result.standard_errors, result.state
        at = result.state
        defect = max(defect, abs(float(result.exponents.sum()) + 2.0 * here.damping_ratio))
        used += result.cost.periods
        unsure += not result.converged
    lost = int(np.sum(np.isnan(exponents[:, 0])))
    message = f"{len(grid)} values, {int(np.sum(exponents[:, 0] > 3.0 * errors[:, 0]))} chaotic"
    if unsure:
        message += f"; the sign is not certain at {unsure}: average more periods"
    if lost:
        message += f"; unbounded at {lost}: check the parameters there"
    error = float(np.nanmax(errors[:, 0], initial=0.0))
    cost = Cost(watch.seconds, 0, 0, used)
    good = lost == unsure == 0
    return LyapunovScan(parameter, grid, exponents, errors, states, defect, error, cost, good, message)


def stretch_rate(table: Tables, state: FloatArray, periods: int) -> tuple[FloatArray, float, float]:
    """States of a motion, shape (periods, 2), its larger exponent per period and the standard error of that.

    All nan if the motion is lost.
    """
    from dynamics.kernels.flow import iterate

    states, at = np.empty((periods, 2)), state.copy()
    frame = np.vstack([np.eye(2), np.zeros((1, 2))])
    rates = np.empty(BATCHES)
    for i, part in enumerate(np.array_split(states, BATCHES)):
        frame[2] = 0.0
        if iterate(table.arrays, at, 0, 2, frame, part, np.zeros((len(part), 2), dtype=np.int64)):
            return np.full_like(states, np.nan), math.nan, math.nan
        rates[i] = frame[2, 0] / len(part)
    return states, float(np.mean(rates)), float(np.std(rates, ddof=1)) / math.sqrt(BATCHES)


def _advance(table: Tables, at: FloatArray, n: int, frame: FloatArray) -> int:
    """Carry state and frame over n periods."""
    from dynamics.kernels.flow import iterate

    if n == 0:
        return 0
    one, counts = np.empty((1, 2)), np.zeros((1, 2), dtype=np.int64)
    return int(iterate(table.arrays, at, n - 1, 2, frame, one, counts))
