"""Error against cost of the period map, and the speed of what is built on it.

Work: omega 0.6, kappa 0.2, D 0.2, zeta 0.05, F_m 0.1, eps 0.2, from (0.5, 0.2). Error: largest difference after five
periods to tables of a quarter of the cell and degree 30. Time: processor time a period over a long motion.
Compilation is done before the clock starts. The rivals are in `dynamics_rivals`.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from dynamics_rivals import compiled_dop853, heyoka_with_events, scipy_with_events

from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    continue_branch,
    continue_locus,
    diagram,
    find_orbit,
    find_orbits,
    lyapunov_exponents,
    period_map,
    sweep,
)
from dynamics.flow import Tables, tables
from dynamics.kernels.flow import iterate

START = (0.5, 0.2)
PERIODS = 5
MANY = 4000


def oscillator() -> GearOscillator:
    return GearOscillator(FourierStiffness(1.0, (0.2,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)


PAR = np.array([0.2, 0.05, 0.1, 0.2, 0.6, 0.2])  # the same, for the rivals


def seconds(work: Callable[[], object], least: float = 0.3) -> float:
    """Best processor time of repetitions that together last at least that long."""
    best, total = np.inf, 0.0
    while total < least:
        began = time.process_time()
        work()
        took = time.process_time() - began
        best, total = min(best, took), total + took
    return best


def states_only(table: Tables, periods: int) -> None:
    """The motion without its Jacobian, as the rivals compute it."""
    state, states, counts = np.array(START), np.empty((periods, 2)), np.zeros((periods, 2), dtype=np.int64)
    iterate(table.arrays, state, 0, 0, np.empty((3, 2)), states, counts)


def work_precision() -> None:
    """Error and time of the exact flow and of its rivals."""
    osc = oscillator()
    exact = period_map(tables(osc, refinement=4, degree=30), START, PERIODS).state
    rows: list[tuple[str, float, float]] = []
    for degree in (6, 8, 10, 12, 16):
        table = tables(osc, degree=degree)
        error = np.max(np.abs(period_map(table, START, PERIODS).state - exact))
        rows.append(
            (f"exact flow, degree {degree}", error, seconds(lambda t=table: states_only(t, MANY)) / MANY)
        )
        took = seconds(lambda t=table: period_map(t, START, MANY)) / MANY
        rows.append((f"exact flow, degree {degree}, Jacobian", error, took))
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13):
        error = np.max(np.abs(np.array(compiled_dop853(*START, PERIODS, rtol, PAR)) - exact))
        took = seconds(lambda r=rtol: compiled_dop853(*START, 400, r, PAR)) / 400
        rows.append((f"compiled DOP853 with events, rtol {rtol:.0e}", error, took))
    heyoka = heyoka_with_events(PAR)
    for tol in (1e-6, 1e-10, 1e-15) if heyoka else ():
        error = np.max(np.abs(np.array(heyoka(*START, PERIODS, tol)) - exact))
        rows.append(
            (f"heyoka with events, tol {tol:.0e}", error, seconds(lambda t=tol: heyoka(*START, 400, t)) / 400)
        )
    for rtol in (1e-4, 1e-8, 1e-12):
        error = np.max(np.abs(np.array(scipy_with_events(*START, PERIODS, rtol, PAR)) - exact))
        took = seconds(lambda r=rtol: scipy_with_events(*START, PERIODS, r, PAR)) / PERIODS
        rows.append((f"scipy DOP853 with events, rtol {rtol:.0e}", error, took))
    print(f"{'method':44s} {'error':>9s} {'us/period':>10s}")
    for name, error, took in rows:
        print(f"{name:44s} {error:9.1e} {1e6 * took:10.2f}")
    if heyoka is None:
        print("heyoka is not installed: left out")
    print(f"tables, once: {1e6 * seconds(lambda: tables(osc)):.1f} us")


def main() -> None:
    work_precision()
    osc = oscillator()
    total = 0.0
    for direction in ("up", "down"):
        began = time.process_time()
        result = sweep(osc, values=np.linspace(0.1, 2.1, 2000), direction=direction)
        took = time.process_time() - began
        total += took
        print(
            f"sweep of 2000 values {direction}: {took:.2f} s, {1e6 * took / result.cost.periods:.2f} us/period"
        )
    print(f"both: {total:.2f} s")
    start = find_orbit(osc.with_parameter("frequency", 0.5), (0.35, 0.0))
    for repeat in ("first call", "again"):
        began = time.process_time()
        branch = continue_branch(start, "frequency", (0.5, 1.2))
        took = time.process_time() - began
        each = 1e3 * took / len(branch.values)
        print(f"branch of {len(branch.values)} points ({repeat}): {took:.2f} s, {each:.3f} ms a point, "
              f"{len(branch.points)} special points, largest error {branch.error:.0e}")  # fmt: skip
    for repeat in ("first call", "again"):
        began = time.process_time()
        locus = continue_locus(
            osc, branch.points[0], ("frequency", "stiffness.amplitudes[0]"), ((0.3, 1.5), (0, 0.6))
        )
        took = time.process_time() - began
        print(
            f"locus of {len(locus.values)} points ({repeat}): {1e3 * took / len(locus.values):.2f} ms a point"
        )
    for what in (lambda: find_orbits(osc, (1, 2, 3, 4)), lambda: diagram(osc, "frequency", (0.3, 2.1))):
        for repeat in ("first call", "again"):
            began = time.process_time()
            print(f"{what().message} ({repeat}): {time.process_time() - began:.2f} s")
    for repeat in ("first call", "again"):
        began = time.process_time()
        result = basins(osc, x=(-1, 1, 200), v=(-1, 1, 200))
        print(f"basins of 200 x 200 starts ({repeat}): {time.process_time() - began:.2f} s, {result.message}")
    began = time.process_time()
    for x, v in np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)), axis=-1).reshape(-1, 2):
        compiled_dop853(x, v, 60, 1e-6, PAR)
    took = (time.process_time() - began) * 40_000 / 25
    print(
        f"compiled DOP853, rtol 1e-6, 60 periods from each of 40 000 starts: {took:.1f} s (from 25 of them)"
    )
    exponents = lyapunov_exponents(osc.with_parameter("frequency", 1.04), periods=10_000)
    off = exponents.exponents.sum() + 2 * osc.damping_ratio
    print(f"exponents over 10 000 periods: {exponents.cost.seconds:.2f} s, sum + 2 zeta = {off:.0e}")


if __name__ == "__main__":
    main()
