"""Lyapunov exponents from the exact derivative of the flow."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.cost import Cost
from dynamics.errors import DynamicsError, Fault, Faults
from dynamics.flow import checked_state, tables
from dynamics.oscillator import GearOscillator
from dynamics.sweeps import rest_state, settling_periods

__all__ = ["LyapunovResult", "lyapunov_exponents"]

FloatArray = npt.NDArray[np.float64]
BATCHES = 20


@dataclass(frozen=True, eq=False)
class LyapunovResult:
    """Lyapunov exponents, per unit of dimensionless time.

    Parameters
    ----------
    exponents : ndarray, shape (2,)
        The larger first. Their sum is -2 zeta exactly, which is not used to compute them.
    standard_error : float
        Of the larger one, from the scatter of 20 batches of the motion.
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
    standard_error: float
    error: float
    state: FloatArray
    cost: Cost
    converged: bool
    message: str

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
    DynamicsError
        If an argument is out of range, or the motion grows beyond all bounds.
    """
    began = time.perf_counter()
    faults = Faults()
    n = faults.whole("periods", periods, BATCHES, 10**9, "10 000 gives two digits in chaos")
    skip = settling_periods(oscillator)
    if transient is not None:
        skip = faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    at = rest_state(oscillator) if state is None else checked_state(state)
    table = tables(oscillator).arrays
    frame = np.vstack([np.eye(2), np.zeros((1, 2))])
    flag = _advance(table, at, skip, frame)
    sizes = [n // BATCHES + (i < n % BATCHES) for i in range(BATCHES)]
    rates = np.empty((BATCHES, 2))
    total = np.zeros(2)
    for i, size in enumerate(sizes):
        frame[2] = 0.0
        flag = flag or _advance(table, at, size, frame)
        rates[i] = frame[2] / (size * oscillator.period)
        total += frame[2]
    if flag:
        fault = Fault("state", repr(state), "a motion that stays bounded", "check the parameters")
        raise DynamicsError((fault,))
    exponents = np.sort(total / (n * oscillator.period))[::-1]
    spread = float(np.std(rates[:, 0], ddof=1)) / math.sqrt(BATCHES)
    largest = float(np.max(np.abs(exponents)))
    sure = abs(exponents[0]) > 3.0 * spread
    message = "average more periods: the sign of the larger exponent is not certain"
    if sure:
        message = "chaotic" if exponents[0] > 0.0 else "periodic"
    cost = Cost(time.perf_counter() - began, 0, 0, skip + n)
    error = spread / largest if largest > 0.0 else spread
    return LyapunovResult(exponents, spread, error, at, cost, bool(sure), message)


def _advance(
    table: tuple[FloatArray, FloatArray, FloatArray], at: FloatArray, n: int, frame: FloatArray
) -> int:
    """Carry state and frame over n periods."""
    from dynamics.kernels.flow import iterate

    if n == 0:
        return 0
    one, counts = np.empty((1, 2)), np.zeros((1, 2), dtype=np.int64)
    return int(iterate(table, at, n - 1, 2, frame, one, counts))
