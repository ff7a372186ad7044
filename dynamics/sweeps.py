"""One-parameter sweeps that carry the motion from value to value."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from base import Cost, Faults, Stopwatch
from dynamics.flow import Tables, checked_state, period_map, tables
from dynamics.oscillator import GearOscillator
from dynamics.shooting import find_orbit, motion_label

__all__ = ["APERIODIC", "DIVERGED", "SweepResult", "rest_state", "settling_periods", "sweep"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
APERIODIC = "aperiodic"
DIVERGED = "diverged"
CREEP = 0.02  # change per round, over the size of the motion, below which a motion may creep to an orbit
LEAVING = 2_000  # periods a motion is given to creep away from an unstable orbit
MOST_PATIENT = 20_000  # periods a creeping motion is followed on


@dataclass(frozen=True, eq=False)
class SweepResult:
    """Motions met by a sweep.

    Parameters
    ----------
    parameter : str
        What was varied.
    direction : str
        "up" or "down".
    values : ndarray, shape (m,)
        Its values, in the order given.
    states : ndarray, shape (m, kept, 2)
        X and V at tau = 0 mod the excitation period, after the transient.
    labels : tuple of str
        n-p-q of each motion, "aperiodic" if it did not repeat, "diverged" if it grew without bound.
    periods : ndarray of int, shape (m,)
        n, 0 if the motion did not repeat.
    impacts : ndarray of float, shape (m, 2)
        Exits from X > D and entries into X < -D per excitation period, mean over those kept.
    error : float
        Relative error of one period map, the largest met: the change with half the cell. (An error of the
        orbit itself is this one amplified by its instability; in chaos only statistics are meaningful.)
    cost : Cost
        Effort.
    converged : bool
        Whether every motion stayed bounded.
    message : str
        What to know about the result.
    """

    parameter: str
    direction: str
    values: FloatArray
    states: FloatArray
    labels: tuple[str, ...]
    periods: IntArray
    impacts: FloatArray
    error: float
    cost: Cost
    converged: bool
    message: str

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """States, shape (values, kept, 2)."""
        return self.states.astype(dtype if dtype is not None else np.float64)


def rest_state(oscillator: GearOscillator) -> FloatArray:
    """State at rest with the flanks pressed together by the mean force, at the centre without one."""
    force, k = oscillator.mean_force, oscillator.stiffness.mean
    if force == 0.0 or k == 0.0:
        return np.zeros(2)
    return np.array([math.copysign(oscillator.half_backlash, force) + force / k, 0.0])


def settling_periods(oscillator: GearOscillator, low: int = 200, high: int = 5000) -> int:
    """Periods in which damping alone shrinks a disturbance by 1e-6, within [low, high]."""
    decay = oscillator.damping_ratio * oscillator.period
    return high if decay <= 0.0 else int(min(max(math.log(1e6) / decay, low), high))


def sweep(
    oscillator: GearOscillator,
    parameter: str = "frequency",
    values: npt.ArrayLike = (),
    direction: str = "up",
    *,
    keep: int = 64,
    transient: int | None = None,
    initial: npt.ArrayLike | None = None,
    max_period: int = 16,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Sweep a parameter up or down; each motion starts from the last state of the one before.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        As in `GearOscillator.with_parameter`.
    values : array_like, shape (m,)
        Parameter values, in any order.
    direction : str
        "up" visits the values in rising order, "down" in falling order; the result keeps the order given.
    keep : int
        Periods kept, at least twice `max_period`.
    transient : int, optional
        Periods dropped before those. Left out: as many as damping needs for a disturbance to shrink by 1e-6,
        between 200 and 5000.
    initial : array_like, shape (2,), optional
        State at the first value visited. Left out: at rest in contact under the mean force.
    max_period : int
        Longest period that is recognised, in excitation periods.
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
    states = np.full((len(grid), kept, 2), np.nan)
    impacts = np.full((len(grid), 2), np.nan)
    labels, periods = [""] * len(grid), np.zeros(len(grid), dtype=np.int64)
    error, total, lost = 0.0, 0, []
    for done, i in enumerate(order, start=1):
        here = oscillator.with_parameter(parameter, float(grid[i]))
        skip = settling_periods(here) if wait is None else wait
        motion = _settle(here, state, skip, kept, longest, patient=wait is None)
        total += motion.used
        if motion.found:
            states[i], periods[i], labels[i] = motion.states, motion.n, motion.label
            impacts[i] = motion.counts.mean(axis=0)
            error = max(error, _map_error(here, states[i, -2], states[i, -1]))
            state = motion.states[-1].copy()
        else:
            lost.append(float(grid[i]))
            labels[i] = DIVERGED
            state = restart.copy()
        if progress is not None:
            progress(done, len(grid))
    message = f"{len(grid)} values, {labels.count(APERIODIC)} aperiodic"
    if lost:
        message += f"; unbounded at {len(lost)}, first {parameter} = {lost[0]:g}: check the parameters there"
    cost = Cost(watch.seconds, 0, 0, total)
    return SweepResult(
        parameter, direction, grid, states, tuple(labels), periods, impacts, error, cost, not lost, message
    )  # fmt: skip


def checked_sweep(
    values: npt.ArrayLike, direction: str, max_period: int, keep: int, transient: int | None
) -> tuple[FloatArray, IntArray, int, int, int | None]:
    """Values, the order in which they are visited, longest period, periods kept, and periods dropped if given.

    Raises
    ------
    InputError
        With every argument that is out of range.
    """
    faults = Faults()
    grid = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if grid.ndim != 1 or len(grid) == 0 or not np.all(np.isfinite(grid)):
        faults.add(
            "values",
            f"shape {grid.shape}",
            "must be finite numbers in one dimension",
            "give at least one value",
        )
    if direction not in ("up", "down"):
        faults.add("direction", direction, "must be 'up' or 'down'", "call twice for both")
    longest = faults.whole("max_period", max_period, 1, 10_000, "16 is usual")
    kept = faults.whole("keep", keep, 2 * longest, 10**7, "keep at least twice max_period")
    wait = None if transient is None else faults.whole("transient", transient, 0, 10**9, "give 0 or more")
    faults.raise_if_any()
    ascending = np.argsort(grid, kind="stable")
    return grid, ascending if direction == "up" else ascending[::-1], longest, kept, wait


def repeat_after(states: FloatArray, longest: int, tolerance: float = 1e-6) -> int:
    """Smallest number of periods after which all states (kept, 2) repeat; 0 if there is none."""
    scale = max(float(np.max(np.abs(states))), 1e-300)
    for n in range(1, longest + 1):
        if float(np.max(np.abs(states[n:] - states[:-n]))) <= tolerance * scale:
            return n
    return 0


@dataclass(frozen=True, eq=False)
class _Motion:
    """A motion after its transient."""

    states: FloatArray
    counts: IntArray
    n: int
    label: str
    used: int
    found: bool


def _settle(
    oscillator: GearOscillator, start: FloatArray, skip: int, kept: int, longest: int, patient: bool
) -> _Motion:
    """Follow a motion past its transient; one that creeps is followed on, or its orbit found by Newton's method.

    Next to a bifurcation a multiplier is close to the unit circle, and damping does not tell how long a motion takes.
    """
    from dynamics.kernels.searching import calm

    table = tables(oscillator)
    state, states, counts = start.copy(), np.empty((kept, 2)), np.zeros((kept, 2), dtype=np.int64)
    room, tallies = np.empty((2 * longest, 2)), np.zeros((2 * longest, 2), dtype=np.int64)
    waited = int(calm(table.arrays, state, skip, room, tallies, 1e-13))
    used = abs(waited) + kept
    if waited < 0 or not _follow(table, state, 0, states, counts):
        return _Motion(states, counts, 0, DIVERGED, used, False)
    n = repeat_after(states, longest)
    label = ""
    if n and waited == skip:
        n, label = _named(oscillator, states, n)
    for _ in range(3 if patient else 0):
        if n:
            break
        n, label, more = creeping(oscillator, table, states, longest)
        if more == 0:
            break
        used += more
        if not _follow(table, state, more - kept, states, counts):
            return _Motion(states, counts, 0, DIVERGED, used, False)
        n = n or repeat_after(states, longest)
    if n and not label:
        p, q = counts[kept - n :].sum(axis=0)
        label = motion_label(n, (int(p), int(q)))
    return _Motion(states, counts, n, label or APERIODIC, used, True)


def _named(oscillator: GearOscillator, states: FloatArray, n: int) -> tuple[int, str]:
    """Period and label of the orbit that a motion which nearly repeats after n periods is on its way to.

    Close to a period doubling a motion of period n/2 may still alternate.
    """
    orbit = find_orbit(oscillator, states[-1], periods=n)
    scale = max(float(np.max(np.abs(states))), 1e-300)
    if orbit.converged and orbit.stable and orbit.periods < n:
        gap = float(np.max(np.abs(orbit.state - states[-1])))
        if gap < 0.05 * scale:
            return orbit.periods, orbit.label
    return n, ""


def creeping(
    oscillator: GearOscillator, table: Tables, states: FloatArray, longest: int
) -> tuple[int, str, int]:
    """Period and label of the stable orbit that a motion creeps to, and periods to follow it on; zeros if none.

    A motion that creeps away from an unstable orbit has no label yet, and is followed on for a while.
    """
    scale = max(float(np.max(np.abs(states))), 1e-300)
    drift = [float(np.max(np.abs(states[-1] - states[-1 - n]))) for n in range(1, longest + 1)]
    away = 0
    for n in (int(k) + 1 for k in np.argsort(drift)[:2]):
        if drift[n - 1] > CREEP * scale:
            break
        if drift[n - 1] < 0.1 * CREEP * scale:
            away = max(LEAVING, len(states))
        orbit = find_orbit(oscillator, states[-1], periods=n)
        if not (orbit.converged and orbit.stable):
            continue
        gap = float(np.max(np.abs(orbit.state - states[-1])))
        rate = float(np.max(np.abs(orbit.multipliers)))
        if gap > 0.1 * scale or not rate > 0.0:
            continue
        rounds = math.log(max(gap / (1e-7 * scale), 2.0)) / -math.log(min(rate, 1.0 - 1e-12))
        more = int(min(orbit.periods * math.ceil(rounds) + len(states), MOST_PATIENT))
        ahead = period_map(table, states[-1], 1, skip=orbit.periods * 20 - 1).state
        if not float(np.max(np.abs(ahead - orbit.state))) < gap:
            continue  # it does not come nearer: passing by
        return orbit.periods, orbit.label, max(more, len(states))
    return 0, "", away


def _follow(table: Tables, state: FloatArray, skip: int, states: FloatArray, counts: IntArray) -> bool:
    """Fill `states` and `counts`, leave the last state in `state`; False if the motion is lost."""
    from dynamics.kernels.flow import iterate

    unused = np.eye(2)
    return not iterate(table.arrays, state, skip, 0, unused, states, counts)


def _map_error(oscillator: GearOscillator, before: FloatArray, after: FloatArray) -> float:
    """Relative change of one period's map with half the cell."""
    again = np.empty((1, 2))
    _follow(tables(oscillator, refinement=2), before.copy(), 0, again, np.zeros((1, 2), dtype=np.int64))
    return float(np.max(np.abs(again[0] - after))) / max(float(np.max(np.abs(after))), 1e-300)
