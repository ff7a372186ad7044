"""The exact flow: period map, sampled motion, extrema and impacts."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Faults, Limit
from dynamics.oscillator import GearOscillator

__all__ = [
    "DEGREE",
    "MapResult",
    "Tables",
    "Trajectory",
    "period_map",
    "tables",
    "trajectory",
    "turning_points",
]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
DEGREE = (
    13  # of the Taylor tables; a quarter of a radian to each side of the middle leaves less than rounding
)
_REASONS = {1: "the motion grew beyond 1e150", 2: "a cell held more than 10 000 impacts"}


@dataclass(frozen=True, eq=False)
class Tables:
    """An oscillator tabulated for the compiled kernels.

    Parameters
    ----------
    packed : ndarray, shape (8 + 2 J,)
        Parameters as of `GearOscillator.packed`.
    coef, edge : ndarray
        See `dynamics.kernels`.
    """

    packed: FloatArray
    coef: FloatArray
    edge: FloatArray

    @property
    def arrays(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """What the kernels take."""
        return self.packed[:8], self.coef, self.edge

    @property
    def cells(self) -> int:
        """Cells per period."""
        return len(self.edge) // 2


@dataclass(frozen=True, eq=False)
class MapResult:
    """Image of a state under n periods.

    Parameters
    ----------
    states : ndarray, shape (periods, 2)
        X and V after each period.
    jacobian : ndarray, shape (2, 2)
        Derivative of the last state with respect to the first.
    counts : ndarray, shape (periods, 2)
        Exits from X > D and entries into X < -D during each period.
    message : str
        Empty, or why the map could not be followed; the states are then nan.
    """

    states: FloatArray
    jacobian: FloatArray
    counts: IntArray
    message: str

    @property
    def state(self) -> FloatArray:
        """Last state, shape (2,)."""
        return np.asarray(self.states[-1])


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Motion at equal times, and its impacts.

    Parameters
    ----------
    tau : ndarray, shape (n,)
        Dimensionless time from 0, both ends included.
    x, v : ndarray, shape (n,)
        Displacement X and speed dX/dtau.
    points_per_period : int
        Samples per excitation period.
    events : ndarray, shape (m, 4)
        Time, X (+-D), speed and region entered (1, 0, -1) at every crossing of the backlash's limits.
    extrema : ndarray, shape (k, 3)
        Time, X and acceleration at every extremum of X.
    error : float
        Difference to the motion on tables with half the cell, largest over the samples, over the largest
        ``|X|``, ``|V|``.
    """

    tau: FloatArray
    x: FloatArray
    v: FloatArray
    points_per_period: int
    events: FloatArray
    extrema: FloatArray
    error: float

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Columns tau, X, V."""
        return np.stack([self.tau, self.x, self.v], axis=1).astype(dtype if dtype is not None else np.float64)

    @property
    def poincare(self) -> FloatArray:
        """States at tau = 0 mod the excitation period, shape (periods + 1, 2)."""
        return np.stack([self.x, self.v], axis=1)[:: self.points_per_period]


def sufficient_degree(oscillator: GearOscillator, tolerance: float) -> int:
    """Degree of the Taylor tables that leaves less than a tolerance, at most the usual one.

    A cell is half a radian of the fastest time scale, so that the series of the speeds are cut at (1/4)^n/n!; a period
    adds at most as many of these as it has cells. The factor 4 is for the three series together.
    """
    left, degree = 4.0 * oscillator.cells * 0.25**6 / math.factorial(6), 6
    while left > tolerance and degree < DEGREE:
        degree += 1
        left *= 0.25 / degree
    return degree


def tables(
    oscillator: GearOscillator,
    refinement: int = 1,
    degree: int | None = None,
    *,
    tolerance: float | None = None,
) -> Tables:
    """Tabulate an oscillator.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    refinement : int
        Factor on the number of cells.
    degree : int, optional
        Of the Taylor polynomials, 6 or more. Left out: what `tolerance` asks for, or 13, which leaves rounding alone.
    tolerance : float, optional
        Error allowed in one period's map, over the size of the motion and the stretch of the map. A loose one makes
        impacts cheaper, by a fifth at 1e-6.

    Raises
    ------
    InputError
        If an argument is out of range, or both degree and tolerance are given.
    """
    from dynamics.kernels.tables import tabulate

    faults = Faults()
    faults.whole("refinement", refinement, 1, 1000, "2 is enough for an error estimate")
    if degree is not None:
        faults.whole("degree", degree, 6, 60, "13 leaves rounding alone")
    if tolerance is not None:
        faults.number("tolerance", tolerance, Limit(0.0, low_open=True, remedy="1e-9, say"))
        if degree is not None:
            faults.add("tolerance", tolerance, "must be left out where the degree is given", "leave one out")
    faults.raise_if_any()
    if degree is None:
        degree = DEGREE if tolerance is None else sufficient_degree(oscillator, tolerance)
    packed, order = oscillator.packed(), oscillator.stiffness.order
    cells = math.ceil(oscillator.cells) * refinement
    coef, edge = tabulate(packed[:8], packed[8 : 8 + order], packed[8 + order :], cells, degree)
    return Tables(packed, coef, edge)


def period_map(
    oscillator: GearOscillator | Tables, state: npt.ArrayLike, periods: int = 1, skip: int = 0
) -> MapResult:
    """Follow a state at tau = 0 over whole excitation periods.

    Parameters
    ----------
    oscillator : GearOscillator or Tables
        The oscillator; tables made once save their cost in repeated calls.
    state : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Number of periods kept.
    skip : int
        Periods followed before those; the Jacobian covers them too.

    Returns
    -------
    MapResult
        States, Jacobian and counts of impacts.

    Raises
    ------
    InputError
        If the state is not finite or a count out of range.
    """
    from dynamics.kernels.flow import iterate

    at = checked_state(state)
    faults = Faults()
    n = faults.whole("periods", periods, 1, 10**9, "give a positive number of periods")
    n_skip = faults.whole("skip", skip, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    t = oscillator if isinstance(oscillator, Tables) else tables(oscillator)
    states, counts, jacobian = np.empty((n, 2)), np.zeros((n, 2), dtype=np.int64), np.eye(2)
    flag = int(iterate(t.arrays, at, n_skip, 1, jacobian, states, counts))
    if flag:
        states[:], jacobian[:] = np.nan, np.nan
    return MapResult(states, jacobian, counts, _REASONS.get(flag, ""))


def trajectory(
    oscillator: GearOscillator, state: npt.ArrayLike, periods: int = 1, points_per_period: int = 200
) -> Trajectory:
    """Sample the motion from a state at tau = 0; for phase portraits and Poincare points.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    state : array_like, shape (2,)
        X and V at tau = 0.
    periods : int
        Excitation periods.
    points_per_period : int
        Samples per period; they lie on the exact solution, so that more of them are not more accurate.

    Returns
    -------
    Trajectory
        The samples, impacts and extrema.

    Raises
    ------
    InputError
        If an argument is out of range, or the motion grows beyond all bounds.
    """
    faults = Faults()
    n = faults.whole("periods", periods, 1, 10**7, "give a positive number of periods")
    points = faults.whole("points_per_period", points_per_period, 1, 10**6, "200 draws a smooth curve")
    faults.raise_if_any()
    samples, turns, events = _walk(tables(oscillator), checked_state(state), n, points)
    finer, _, _ = _walk(tables(oscillator, refinement=2), checked_state(state), n, points)
    return Trajectory(
        tau=np.arange(n * points + 1, dtype=np.float64) * (oscillator.period / points),
        x=samples[:, 0],
        v=samples[:, 1],
        points_per_period=points,
        events=events,
        extrema=turns[:, :3],
        error=float(np.max(np.abs(samples - finer)) / max(np.max(np.abs(samples)), np.finfo(float).tiny)),
    )


def turning_points(oscillator: GearOscillator | Tables, state: npt.ArrayLike, periods: int = 1) -> FloatArray:
    """Every extremum of X from a state at tau = 0.

    Parameters
    ----------
    oscillator : GearOscillator or Tables
        The oscillator.
    state : array_like, shape (2,)
        X and V at tau = 0.
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
    """
    t = oscillator if isinstance(oscillator, Tables) else tables(oscillator)
    return _walk(t, checked_state(state), periods, 0)[1]


def checked_state(state: npt.ArrayLike, where: str = "state") -> FloatArray:
    """Return a fresh array of X and V, or raise InputError."""
    at = np.array(state, dtype=np.float64)
    if at.shape != (2,) or not np.all(np.isfinite(at)):
        faults = Faults()
        faults.add(where, at.tolist(), "must be two finite numbers, X and V", "give the state at tau = 0")
        faults.raise_if_any()
    return at


def _walk(
    t: Tables, state: FloatArray, periods: int, points: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return samples, extrema and impacts; repeat with more room if the last two did not fit."""
    from dynamics.kernels.walking import walk

    room = 64 * periods
    while True:
        samples = np.empty((periods * points + 1 if points else 0, 2))
        turns, events = np.empty((room, 5)), np.empty((room, 4))
        flag, turned, happened = walk(t.arrays, state.copy(), periods, points, samples, turns, events)
        if flag:
            faults = Faults()
            faults.add(
                "state",
                state.tolist(),
                "must start a motion that stays bounded",
                f"{_REASONS[int(flag)]}: check the input",
            )
            faults.raise_if_any()
        if turned <= room and happened <= room:
            return samples, turns[:turned], events[:happened]
        room = max(turned, happened)
