"""One-parameter sweeps that carry the motion from value to value."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, Integers, Stopwatch, quantity, record
from dynamics.flow.flows import flow_of, flows_along
from dynamics.flow.protocol import Flow
from dynamics.model.arrays import AsArray
from dynamics.model.limits import KEPT, LONGEST_PERIOD, TRANSIENT, checked_grid
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import EPS, Oscillator, settling_periods
from dynamics.model.reasons import FLOW
from dynamics.model.states import start_state
from dynamics.motion.map_errors import MapErrors
from dynamics.orbits.shooting import find_orbit, motion_label

APERIODIC = "aperiodic"
DIVERGED = "diverged"


@record
class SweepResult(AsArray):
    """Motions met by a sweep."""

    no_error = FLOW

    headline = ("parameter", "direction")

    parameter: str = quantity("", "what was varied")
    direction: str = quantity("", "up or down")
    values: Array = quantity("1", "its values, in the order given", "value")
    states: Array = quantity(
        "1", "X and V at tau = 0 mod the excitation period, after the transient", "value period coordinate"
    )
    labels: tuple[str, ...] = quantity(
        "",
        "n-p-q of each motion, aperiodic if it did not repeat, diverged if it could not be followed",
        "value",
    )
    periods: Integers = quantity("1", "n, 0 if the motion did not repeat", "value")
    impacts: Array = quantity(
        "1",
        "exits from X > D and entries into X < -D per excitation period, mean over those kept",
        "value side",
    )
    error: float = quantity(
        "1", "relative error of one period map, the largest met: the change on a finer flow. (An error of the orbit "
        "itself is this one amplified by its instability; in chaos only statistics are meaningful.)"
    )  # fmt: skip
    cost: Cost
    converged: bool = quantity("1", "whether every motion could be followed")
    message: str = quantity("", "remarks on the result")

    def columns(self) -> Array:
        """States, shape (values, kept, dimension)."""
        return self.states


def long_flow(oscillator: Oscillator, tolerance: float | None) -> Flow:
    """Flow of a motion that is followed for long."""
    return flow_of(oscillator, long_tolerance(oscillator, tolerance))


def long_tolerance(oscillator: Oscillator, tolerance: float | None) -> float | None:
    """Tolerance of a motion that is followed for long: that given; without one the exact flow is no coarser."""
    return tolerance if tolerance is not None or not oscillator.has_steps else OPTIONS.long_step_tolerance


def sweep(
    oscillator: Oscillator,
    parameter: str = "frequency",
    values: npt.ArrayLike = (),
    direction: str = "up",
    *,
    keep: int = 64,
    transient: int | None = None,
    initial: npt.ArrayLike | None = None,
    max_period: int = 16,
    tolerance: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Sweep a parameter up or down; each motion starts from the last state of the one before.

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator; its own value of the parameter is not used.
    parameter : str
        One of its `parameters`.
    values : array_like, shape (m,)
        Parameter values, in any order.
    direction : str
        "up" visits the values in rising order, "down" in falling order; the result keeps the order given.
    keep : int
        Periods kept, at least twice `max_period`.
    transient : int, optional
        Periods dropped before those. Left out: as many as damping needs for a disturbance to shrink by 1e-6,
        between 200 and 5000; a motion that then creeps to an orbit is followed on.
    initial : array_like, shape (dimension,), optional
        State at the first value visited. Left out: at rest in contact under the mean force.
    max_period : int
        Longest period that is recognised, in excitation periods.
    tolerance : float, optional
        Of the flow, as of `period_map`; 1e-9 for steps, rounding for the exact flow.
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

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> sweep(oscillator, "frequency", [0.5, 0.6]).labels
    ('1-0-0', '1-0-0')
    """
    errors = MapErrors(1)
    swept = visited(
        oscillator, parameter, values, direction, errors, keep=keep, transient=transient, initial=initial,
        max_period=max_period, tolerance=tolerance, progress=progress,
    )  # fmt: skip
    return replace(swept, error=errors.largest.get(direction, 0.0))


def visited(
    oscillator: Oscillator,
    parameter: str,
    values: npt.ArrayLike,
    direction: str,
    errors: MapErrors,
    *,
    keep: int = 64,
    transient: int | None = None,
    initial: npt.ArrayLike | None = None,
    max_period: int = 16,
    tolerance: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> SweepResult:
    """Sweep as `sweep` does, with an error of nan: `errors` take what is met."""
    watch = Stopwatch()
    grid, order, longest, kept, wait = checked_sweep(values, direction, max_period, keep, transient)
    first = oscillator.with_parameter(parameter, float(grid[order[0]]))
    state = start_state(first, initial, "initial")
    restart = state.copy()
    flow_at = flows_along(oscillator, parameter, long_tolerance(oscillator, tolerance))
    states = np.full((len(grid), kept, oscillator.dimension), np.nan)
    impacts = np.full((len(grid), 2), np.nan)
    labels, periods = [DIVERGED] * len(grid), np.zeros(len(grid), dtype=np.int64)
    total, lost = 0, []
    for done, i in enumerate(order, start=1):
        here = oscillator.with_parameter(parameter, float(grid[i]))
        skip = settling_periods(here) if wait is None else wait
        flow = flow_at(here)
        motion = _settle(here, flow, state, skip, kept, longest, patient=wait is None)
        total += motion.used
        if motion.bounded:
            states[i], periods[i], labels[i] = motion.states, motion.n, motion.label
            impacts[i] = motion.counts.mean(axis=0)
            state = motion.states[-1].copy()
        else:
            lost.append(float(grid[i]))
            state = restart.copy()
        errors.met(int(i), direction, flow, states[i])
        if progress is not None:
            progress(done, len(grid))
    message = f"{len(grid)} values, {labels.count(APERIODIC)} aperiodic"
    if lost:
        message += f"; unbounded at {len(lost)}, first {parameter} = {lost[0]:g}: check the parameters there"
    cost = Cost(watch.seconds, periods=total)
    return SweepResult(
        parameter, direction, grid, states, tuple(labels), periods, impacts, math.nan, cost, not lost, message
    )  # fmt: skip


def checked_sweep(
    values: npt.ArrayLike, direction: str, max_period: int, keep: int, transient: int | None
) -> tuple[Array, Integers, int, int, int | None]:
    """Values, the order in which they are visited, longest period, periods kept, and periods dropped if given.

    Raises
    ------
    InputError
        With every argument that is out of range.
    """
    with Faults() as faults:
        grid = checked_grid(faults, "values", values)
        faults.choice("direction", direction, ("up", "down"), "call twice for both")
        longest = faults.whole("max_period", max_period, *LONGEST_PERIOD)
        kept = faults.whole("keep", keep, *KEPT._replace(low=2 * longest))
        wait = None if transient is None else faults.whole("transient", transient, *TRANSIENT)
    ascending = np.argsort(grid, kind="stable")
    return grid, ascending if direction == "up" else ascending[::-1], longest, kept, wait


def repeat_after(states: Array, longest: int, tolerance: float = EPS) -> int:
    """Smallest number of periods after which all states (kept, 2) repeat, on a flow of a tolerance; 0 if none."""
    close = max(OPTIONS.repeats, 1e3 * tolerance) * max(float(np.max(np.abs(states))), 1e-300)
    for n in range(1, longest + 1):
        if float(np.max(np.abs(states[n:] - states[:-n]))) <= close:
            return n
    return 0


class _Motion(NamedTuple):
    """A motion after its transient."""

    states: Array
    counts: Integers
    n: int
    label: str
    used: int
    bounded: bool


def _settle(
    oscillator: Oscillator, flow: Flow, start: Array, skip: int, kept: int, longest: int, patient: bool
) -> _Motion:
    """Follow a motion past its transient; one that creeps is followed on, or its orbit found by Newton's method.

    Next to a bifurcation a multiplier is close to the unit circle, and damping does not say how long a motion takes.
    """
    state, waited, message = flow.calm(start, skip, longest)
    used = waited + kept
    if message or (motion := flow.follow(state, kept, derivatives=False)).message:
        return _Motion(np.empty((0, 2)), np.empty((0, 2), dtype=np.int64), 0, DIVERGED, used, False)
    n = repeat_after(motion.states, longest, flow.tolerance)
    label = ""
    if n > 1 and waited == skip:
        n, label = _named(oscillator, flow, motion.states, n)
    for _ in range(3 if patient else 0):
        if n:
            break
        n, label, more = creeping(oscillator, flow, motion.states, longest)
        if more == 0:
            break
        used += more
        motion = flow.follow(motion.state, kept, more - kept, derivatives=False)
        if motion.message:
            return _Motion(motion.states, motion.counts, 0, DIVERGED, used, False)
        n = n or repeat_after(motion.states, longest, flow.tolerance)
    if n and not label:
        p, q = motion.counts[kept - n :].sum(axis=0)
        label = motion_label(n, (int(p), int(q)))
    return _Motion(motion.states, motion.counts, n, label or APERIODIC, used, True)


def _named(oscillator: Oscillator, flow: Flow, states: Array, n: int) -> tuple[int, str]:
    """Period and label of the orbit that a motion which nearly repeats after n periods is on its way to.

    Close to a period doubling a motion of period n/2 may still alternate.
    """
    orbit = find_orbit(oscillator, states[-1], periods=n, tolerance=orbit_tolerance(flow))
    scale = max(float(np.max(np.abs(states))), 1e-300)
    if orbit.converged and orbit.stable and orbit.periods < n:
        gap = float(np.max(np.abs(orbit.state - states[-1])))
        if gap < 0.05 * scale:
            return orbit.periods, orbit.label
    return n, ""


def orbit_tolerance(flow: Flow) -> float | None:
    """Tolerance for the orbits of a motion; those of the exact flow are always computed to rounding."""
    return None if flow.tolerance <= EPS else flow.tolerance


def creeping(oscillator: Oscillator, flow: Flow, states: Array, longest: int) -> tuple[int, str, int]:
    """Period and label of the stable orbit that a motion creeps to, and periods to follow it on; zeros if none.

    A motion that creeps away from an unstable orbit has no label yet, and is followed on for a while.
    """
    scale = max(float(np.max(np.abs(states))), 1e-300)
    drift = [float(np.max(np.abs(states[-1] - states[-1 - n]))) for n in range(1, longest + 1)]
    away = 0
    for n in (int(k) + 1 for k in np.argsort(drift)[:2]):
        if drift[n - 1] > OPTIONS.creep * scale:
            break
        if drift[n - 1] < 0.1 * OPTIONS.creep * scale:
            away = max(OPTIONS.leaving_periods, len(states))
        orbit = find_orbit(oscillator, states[-1], periods=n, tolerance=orbit_tolerance(flow))
        if not (orbit.converged and orbit.stable):
            continue
        gap = float(np.max(np.abs(orbit.state - states[-1])))
        rate = float(np.max(np.abs(orbit.multipliers)))
        if gap > 0.1 * scale or not rate > 0.0:
            continue
        rounds = math.log(max(gap / (1e-7 * scale), 2.0)) / -math.log(min(rate, 1.0 - 1e-12))
        more = int(min(orbit.periods * math.ceil(rounds) + len(states), OPTIONS.creep_periods))
        ahead = flow.follow(states[-1], 1, orbit.periods * 20 - 1, derivatives=False).state
        if not float(np.max(np.abs(ahead - orbit.state))) < gap:
            continue  # it does not come nearer: passing by
        return orbit.periods, orbit.label, max(more, len(states))
    return 0, "", away
