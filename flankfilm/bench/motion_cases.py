"""Cases of the motion: flow, orbit, branch, sweep, exponents."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from flankfilm.bench.case import Answer, Case, PeerWork, Series, Value, level
from flankfilm.bench.examples import PERIODS, START, oscillator
from flankfilm.bench.stepwise_cases import stepwise
from flankfilm.bench.work_cases import motion_work

if TYPE_CHECKING:
    from dynamics import Branch, Orbit
    from dynamics.exponents import LyapunovResult
    from dynamics.flow import Tables
    from dynamics.sweeps import SweepResult

__all__ = ["motions"]

Array = NDArray[np.float64]

MANY = 1000
STATE = "state"


def motions(quick: bool) -> tuple[Case, ...]:
    """All cases of the motion."""
    few = (_flow(quick), _orbit(quick))
    if quick:
        return few
    return (*few, _branch(), _sweep(), _exponents(), *stepwise(), motion_work())


def _flow(quick: bool) -> Case:
    """Exact flow by the degree of its tables."""
    from dynamics import period_map
    from dynamics.flow import tables

    osc = oscillator()

    def after(table: Tables) -> Array:
        return period_map(table, START, PERIODS).state

    def follow(table: Tables) -> Tables:
        period_map(table, START, MANY)
        return table

    def answer(degree: int, refinement: int) -> Any:
        def of(table: Tables) -> Answer:
            found, halved = after(table), after(tables(osc, 2 * refinement, degree))
            estimate = float(np.max(np.abs(found - halved)) / np.max(np.abs(halved)))
            return Answer(degree, {STATE: Value(found, estimate, over_largest=True)})

        return of

    degrees = (6, 8, 10, 13) if quick else (6, 7, 8, 9, 10, 11, 12, 13)
    series = tuple(
        Series(
            words,
            tuple(
                level(f"degree {d}", follow, answer(d, refinement), tables(osc, refinement, d))
                for d in degrees
            ),
        )
        for refinement, words in ((1, "exact flow"), (2, "half the cells"))
        if refinement == 1 or not quick
    )
    given = {
        "oscillator": {
            "kappa": 0.2,
            "zeta": osc.damping_ratio,
            "force": osc.mean_force,
            "error": osc.error_amplitude,
            "frequency": osc.frequency,
            "half_backlash": osc.half_backlash,
        },
        "start": START,
        "periods": PERIODS,
        "timed_periods": MANY,
    }
    return Case(
        "motion_flow",
        "Motion with backlash",
        f"Time of {MANY} excitation periods with all impacts and the derivatives by the start, tables at hand; "
        f"error of the state after {PERIODS} periods, over its largest component. Omega 0.6, kappa 0.2, D 0.2, "
        "zeta 0.05, F_m 0.1, eps 0.2. The estimate is the change with half the cells, as the sweep has it.",
        "degree of the Taylor tables",
        series,
        level("degree 30, a quarter of the cells", follow, answer(30, 4), tables(osc, 4, 30)),
        peers=tuple(PeerWork(f"{peer}_motion", given, STATE) for peer in ("scipy", "heyoka", "dop853")),
    )


def _orbit(quick: bool) -> Case:
    """Periodic orbit by Newton's method, and by waiting until the motion has settled."""
    from dynamics import find_orbit, period_map
    from dynamics.flow import tables

    osc = oscillator()
    table, exact = tables(osc), tables(osc, 4, 30)

    def newton() -> Orbit:
        return find_orbit(osc, START)

    def of_orbit(orbit: Orbit) -> Answer:
        failure = "" if orbit.converged else orbit.message
        return Answer(orbit.cost.periods, {STATE: Value(orbit.state, orbit.error, True)}, failure)

    def wait(periods: int) -> Array:
        return period_map(table, START, 1, periods - 1).state

    def waited(periods: int) -> Any:
        return lambda state: Answer(periods, {STATE: Value(state, None, True)})

    def finest() -> Array:
        """Newton's method on finer tables, written out, from the settled motion."""
        x = period_map(exact, START, 1, 299).state
        for _ in range(4):
            image = period_map(exact, x, 1)
            x = x + np.linalg.solve(np.eye(2) - image.jacobian, image.state - x)
        return x

    counts = (10, 20, 40) if quick else (10, 20, 40, 60, 80, 120)
    return Case(
        "motion_orbit",
        "Periodic orbit",
        "Orbit of period 1 at Omega 0.6 from (0.5, 0.2): Newton's method on the period map, or the motion followed "
        "until its transient has died out (which has no estimate). Error of the state, over its largest component.",
        "periods followed",
        (
            Series("Newton", (level("default", newton, of_orbit),)),
            Series("followed", tuple(level(f"{n} periods", wait, waited(n), n) for n in counts)),
        ),
        level("Newton on finer tables", finest, waited(0)),
    )


def _branch() -> Case:
    """Branch of orbits with its special points, by the largest step."""
    from dynamics import continue_branch, find_orbit

    start = find_orbit(oscillator(0.5), (0.35, 0.0))
    quantity = "places of all special points"

    def follow(step: float) -> Branch:
        return continue_branch(start, "frequency", (0.5, 1.2), step=min(0.005, step), max_step=step)

    def answer(branch: Branch) -> Answer:
        places = np.array([point.parameter for point in branch.points])
        failure = "" if branch.converged else branch.message
        return Answer(len(branch.values), {quantity: Value(places, branch.error)}, failure)

    return Case(
        "motion_branch",
        "Branch of orbits",
        "Continuation from Omega 0.5 to 1.2 through folds, period doublings and grazings, by the largest step. "
        "Error of the special points' frequencies: they are located, not read off the points.",
        "points of the branch",
        (
            Series(
                "largest step", tuple(level(f"{s:g}", follow, answer, s) for s in (0.08, 0.04, 0.02, 0.01))
            ),
        ),
        level("0.005", follow, answer, 0.005),
    )


def _sweep() -> Case:
    """Sweep by the periods that it drops."""
    from dynamics import sweep

    values = np.linspace(0.3, 0.9, 100)

    def follow(transient: int | None) -> SweepResult:
        return sweep(oscillator(), values=values, transient=transient)

    def answer(found: SweepResult) -> Answer:
        failure = "" if found.converged else found.message
        states = Value(found.states[:, -1], found.error, True)
        return Answer(found.cost.periods / values.size, {STATE: states}, failure)

    dropped = (10, 20, 50, 100, 200)
    return Case(
        "motion_sweep",
        "Sweep",
        "100 frequencies from 0.3 to 0.9 upwards, by the periods dropped at each; error of the last state of the worst "
        "of them, over the largest component. The estimate is of the period map alone: it does not see a transient "
        "that was cut short, which is why the default waits.",
        "periods per value",
        (
            Series("periods dropped", tuple(level(f"{n} dropped", follow, answer, n) for n in dropped)),
            Series("default", (level("as damping needs", follow, answer, None),)),
        ),
        level("5000 dropped", follow, answer, 5000),
    )


def _exponents() -> Case:
    """Lyapunov exponents of a chaotic motion by the periods averaged over."""
    from dynamics import lyapunov_exponents

    osc = oscillator(1.04)
    quantity = "larger exponent"

    def average(periods: int) -> LyapunovResult:
        return lyapunov_exponents(osc, periods=periods)

    def answer(periods: int) -> Any:
        def of(found: LyapunovResult) -> Answer:
            largest = found.exponents[:1]
            return Answer(periods, {quantity: Value(largest, found.standard_error / abs(float(largest[0])))})

        return of

    counts = (300, 1000, 3000, 10_000, 30_000, 100_000)
    return Case(
        "motion_exponents",
        "Lyapunov exponents",
        "Chaotic motion at Omega 1.04, averaged over periods. The error is random and falls with the root of their "
        "number; the estimate is the standard error from 20 batches.",
        "periods",
        (Series("periods", tuple(level(f"{n} periods", average, answer(n), n) for n in counts)),),
        level("1 000 000 periods", average, answer(1_000_000), 1_000_000),
        {quantity: 0.5},
    )
