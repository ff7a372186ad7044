"""Cases of the motion: flow, orbit, branch, sweep, exponents."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.bench.case import Answer, Case, Levels, PeerWork, Series, answer, case, level, over, value
from flankfilm.bench.examples import PERIODS, START, drive_train, oscillator
from flankfilm.bench.stepwise_cases import stepwise
from flankfilm.bench.work_cases import work_motion

if TYPE_CHECKING:
    from base import Array
    from dynamics import Branch, Orbit
    from dynamics.motion.exponents import LyapunovResult
    from dynamics.motion.sweeps import SweepResult


MANY = 1000
STATE = "state"


def motions(quick: bool) -> tuple[Case, ...]:
    """All cases of the motion."""
    few = (motion_flow(quick), motion_drive(quick), motion_orbit(quick))
    if quick:
        return few
    return (*few, motion_branch(), motion_sweep(), motion_exponents(), *stepwise(), work_motion())


@case("Motion with backlash", "degree of the Taylor tables")
def motion_flow(quick: bool) -> Levels:
    """Exact flow by the degree of its tables.

    Time of {MANY} excitation periods with all impacts and the derivatives by the start, tables at hand; error of the
    state after {PERIODS} periods, over its largest component. Omega 0.6, kappa 0.2, D 0.2, zeta 0.05, F_m 0.1, eps
    0.2. The estimate is the change with half the cells, as the sweep has it.
    """
    from dynamics import period_map
    from dynamics.flow.exact_flow import exact_flow

    osc = oscillator()
    degrees = (6, 8, 10, 13) if quick else (6, 7, 8, 9, 10, 11, 12, 13)
    refinements = {1: "exact flow"} if quick else {1: "exact flow", 2: "half the cells"}
    at_hand = {
        (r, d): exact_flow(osc, r, d) for r, d in [(4, 30), *((r, d) for r in refinements for d in degrees)]
    }

    def follow(refinement: int, degree: int) -> tuple[int, int]:
        period_map(at_hand[refinement, degree], START, MANY)
        return refinement, degree

    def state(resolution: tuple[int, int]) -> Answer:
        refinement, degree = resolution
        reached, halved = (
            period_map(exact_flow(osc, cells, degree), START, PERIODS).state
            for cells in (refinement, 2 * refinement)
        )
        estimate = float(np.max(np.abs(reached - halved)) / np.max(np.abs(halved)))
        return Answer(degree, {STATE: value(reached, estimate, over_largest=True)})

    label = "degree {}".format
    names = ("damping_ratio", "mean_force", "error_amplitude", "frequency", "half_backlash")
    inputs = {
        "oscillator": [osc.stiffness.amplitudes[0], *(getattr(osc, name) for name in names)],
        "start": START,
        "periods": PERIODS,
        "timed_periods": MANY,
    }
    return Levels(
        tuple(over(degrees, label, follow, state, r, name=words) for r, words in refinements.items()),
        level("degree 30, a quarter of the cells", follow, state, 4, 30),
        peers=tuple(PeerWork(f"{peer}_motion", inputs, STATE) for peer in ("scipy", "heyoka", "dop853")),
    )


@case("Drive train of four freedoms", "degree of the Taylor polynomials")
def motion_drive(quick: bool) -> Levels:
    """Exact flow in four freedoms by the degree of its polynomials.

    Time of {MANY} excitation periods with all impacts, states alone, tables at hand; error of the state after {PERIODS}
    periods, over its largest component. Motor, pinion, wheel and load, omega 0.9, D 0.15. The estimate is the change
    with half the cells, as the sweep has it.
    """
    from dynamics.flow.drive_flow import DriveFlow, tabulated

    osc = drive_train()
    start, cells = osc.rest_state() + 0.3, math.ceil(osc.cells)
    degrees = (8, 12, 16) if quick else (6, 8, 10, 12, 14, 16)

    def follow(flow: DriveFlow, degree: int) -> tuple[DriveFlow, int]:
        flow.follow(start, MANY, derivatives=False)
        return flow, degree

    def state(resolution: tuple[DriveFlow, int]) -> Answer:
        flow, degree = resolution
        finer = tabulated(osc, 2 * flow.cells, degree)
        reached, halved = (
            drive_flow.follow(start, PERIODS, derivatives=False).state for drive_flow in (flow, finer)
        )
        estimate = float(np.max(np.abs(reached - halved)) / np.max(np.abs(halved)))
        return Answer(degree, {STATE: value(reached, estimate, over_largest=True)})

    levels = (level(f"degree {d}", follow, state, tabulated(osc, cells, d), d) for d in degrees)
    names = ("mass", "damping", "stiffness", "direction", "mean_force")
    inputs = {
        **{name: np.asarray(getattr(osc, name)).tolist() for name in names},
        "mesh": [0.2, osc.mesh_damping, osc.error_amplitude, osc.frequency, osc.half_backlash],
        "start": start.tolist(),
        "periods": PERIODS,
        "timed_periods": MANY,
    }
    return Levels(
        (Series("exact flow", tuple(levels)),),
        level("degree 24, a quarter of the cells", follow, state, tabulated(osc, 4 * cells, 24), 24),
        peers=(PeerWork("dop853_drive", inputs, STATE),),
    )


@case("Periodic orbit", "periods followed")
def motion_orbit(quick: bool) -> Levels:
    """Periodic orbit by Newton's method, and by waiting until the motion has settled.

    Orbit of period 1 at Omega 0.6 from (0.5, 0.2): Newton's method on the period map, or the motion followed until its
    transient has died out (which has no estimate). Error of the state, over its largest component.
    """
    from dynamics import find_orbit, period_map
    from dynamics.flow.exact_flow import exact_flow

    osc = oscillator()
    table, exact = exact_flow(osc), exact_flow(osc, 4, 30)

    def newton() -> Orbit:
        return find_orbit(osc, START)

    def of_orbit(orbit: Orbit) -> Answer:
        return answer(orbit.cost.periods, {STATE: value(orbit.state, orbit.error, True)}, orbit)

    def wait(periods: int) -> tuple[int, Array]:
        return periods, period_map(table, START, 1, periods - 1).state

    def waited(settled: tuple[int, Array]) -> Answer:
        return Answer(settled[0], {STATE: value(settled[1], None, True)})

    def finest() -> tuple[int, Array]:
        """Newton's method on finer tables, written out, from the settled motion."""
        x = period_map(exact, START, 1, 299).state
        for _ in range(4):
            image = period_map(exact, x, 1)
            x = x + np.linalg.solve(np.eye(2) - image.jacobian, image.state - x)
        return 0, x

    counts = (10, 20, 40) if quick else (10, 20, 40, 60, 80, 120)
    series = (
        Series("Newton", (level("default", newton, of_orbit),)),
        over(counts, "{} periods".format, wait, waited, name="followed"),
    )
    return Levels(series, level("Newton on finer tables", finest, waited))


@case("Branch of orbits", "points of the branch")
def motion_branch() -> Levels:
    """Branch of orbits with its special points, by the largest step.

    Continuation from Omega 0.5 to 1.2 through folds, period doublings and grazings, by the largest step. Error of the
    special points' frequencies: they are located, not read off the points.
    """
    from dynamics import continue_branch, find_orbit

    start = find_orbit(oscillator(0.5), (0.35, 0.0))

    def follow(step: float) -> Branch:
        return continue_branch(start, "frequency", (0.5, 1.2), step=min(0.005, step), max_step=step)

    def special(branch: Branch) -> Answer:
        places = value([point.parameter for point in branch.points], branch.error)
        return answer(len(branch.values), {"places of all special points": places}, branch)

    series = over((0.08, 0.04, 0.02, 0.01), "{:g}".format, follow, special, name="largest step")
    return Levels((series,), level("0.005", follow, special, 0.005))


@case("Sweep", "periods per value")
def motion_sweep() -> Levels:
    """Sweep by the periods that it drops.

    100 frequencies from 0.3 to 0.9 upwards, by the periods dropped at each; error of the last state of the worst of
    them, over the largest component. The estimate is of the period map alone: it does not see a transient that was cut
    short, which is why the default waits.
    """
    from dynamics import sweep

    values = np.linspace(0.3, 0.9, 100)

    def follow(transient: int | None) -> SweepResult:
        return sweep(oscillator(), values=values, transient=transient)

    def last(swept: SweepResult) -> Answer:
        states = value(swept.states[:, -1], swept.error, True)
        return answer(swept.cost.periods / values.size, {STATE: states}, swept)

    series = (
        over((10, 20, 50, 100, 200), "{} dropped".format, follow, last, name="periods dropped"),
        Series("default", (level("as damping needs", follow, last, None),)),
    )
    return Levels(series, level("5000 dropped", follow, last, 5000))


@case("Lyapunov exponents", "periods")
def motion_exponents() -> Levels:
    """Lyapunov exponents of a chaotic motion by the periods averaged over.

    Chaotic motion at Omega 1.04, averaged over periods. The error is random and falls with the root of their number;
    the estimate is the standard error from 20 batches.
    """
    from dynamics import lyapunov_exponents

    osc = oscillator(1.04)
    quantity = "larger exponent"

    def average(periods: int) -> tuple[int, LyapunovResult]:
        return periods, lyapunov_exponents(osc, periods=periods)

    def larger(averaged: tuple[int, LyapunovResult]) -> Answer:
        periods, lyapunov = averaged
        largest = float(lyapunov.exponents[0])
        return Answer(periods, {quantity: value(largest, lyapunov.standard_error / abs(largest))})

    counts = (300, 1000, 3000, 10_000, 30_000, 100_000)
    series = over(counts, "{} periods".format, average, larger, name="periods")
    return Levels((series,), level("1 000 000 periods", average, larger, 1_000_000), {quantity: 0.5})
