"""Error against cost of the period map: the exact flow at several degrees, against scipy with events.

Work: omega 0.6, kappa 0.2, D 0.2, from (0.5, 0.2). Error: largest difference after five periods to tables of a quarter
of the cell and degree 30. Compilation is done before the clock starts.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    continue_branch,
    find_orbit,
    lyapunov_exponents,
    period_map,
    sweep,
)
from dynamics.flow import tables

START = (0.5, 0.2)
PERIODS = 5


def oscillator() -> GearOscillator:
    return GearOscillator(FourierStiffness(1.0, (0.2,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)


def seconds(work: Callable[[], object], least: float = 0.2) -> float:
    """Best of repetitions that together last at least that long."""
    best, total = np.inf, 0.0
    while total < least:
        began = time.perf_counter()
        work()
        took = time.perf_counter() - began
        best, total = min(best, took), total + took
    return best


def plain(osc: GearOscillator, rtol: float) -> np.ndarray:
    """Integrate with scipy, without regard to the corners of f, as is commonly done."""

    def rhs(t: float, y: np.ndarray) -> list[float]:
        f = y[0] - min(max(y[0], -osc.half_backlash), osc.half_backlash)
        k = 1.0 + 0.2 * np.cos(osc.frequency * t)
        push = osc.mean_force + osc.error_amplitude * osc.frequency**2 * np.cos(osc.frequency * t)
        return [y[1], push - 2 * osc.damping_ratio * y[1] - k * f]

    span = (0.0, PERIODS * osc.period)
    return solve_ivp(rhs, span, START, method="DOP853", rtol=rtol, atol=1e-3 * rtol).y[:, -1]


def main() -> None:
    osc = oscillator()
    exact = period_map(tables(osc, refinement=4, degree=30), START, PERIODS).state
    sweep(osc, values=[0.6], keep=32)
    print(f"{'method':32s} {'error':>9s} {'us/period':>10s}")
    many = 20_000
    for degree in (6, 8, 10, 12, 14, 16, 18, 20):
        table = tables(osc, degree=degree)
        error = np.max(np.abs(period_map(table, START, PERIODS).state - exact))
        took = seconds(lambda table=table: period_map(table, START, many)) / many
        print(f"{f'exact flow, degree {degree}, Jacobian':32s} {error:9.1e} {1e6 * took:10.2f}")
    print(f"{'  (its tables, once)':32s} {'':9s} {1e6 * seconds(lambda: tables(osc)):10.2f}")
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        error = np.max(np.abs(plain(osc, rtol) - exact))
        took = seconds(lambda rtol=rtol: plain(osc, rtol)) / PERIODS
        print(f"{f'scipy DOP853, rtol {rtol:.0e}':32s} {error:9.1e} {1e6 * took:10.2f}")
    for direction in ("up", "down"):
        result = sweep(osc, values=np.linspace(0.1, 2.1, 400), direction=direction)
        per_period = 1e6 * result.cost.seconds / result.cost.periods
        print(f"sweep of 400 values {direction}: {result.cost.seconds:.2f} s, {per_period:.2f} us/period")
    start = find_orbit(osc.with_parameter("frequency", 0.5), (0.35, 0.0))
    for repeat in ("first call", "again"):
        branch = continue_branch(start, "frequency", (0.5, 1.2))
        each = 1e3 * branch.cost.seconds / len(branch.values)
        print(f"branch of {len(branch.values)} points ({repeat}): {branch.cost.seconds:.2f} s, {each:.2f} ms a point, "
              f"{len(branch.points)} special points, largest error {branch.error:.0e}")  # fmt: skip
    for repeat in ("first call", "again"):
        result = basins(osc, x=(-1, 1, 100), v=(-1, 1, 100))
        print(f"basins of 100 x 100 starts ({repeat}): {result.cost.seconds:.2f} s, {result.message}")
    exponents = lyapunov_exponents(osc.with_parameter("frequency", 1.04), periods=10_000)
    off = exponents.exponents.sum() + 2 * osc.damping_ratio
    print(f"exponents over 10 000 periods: {exponents.cost.seconds:.2f} s, sum + 2 zeta = {off:.0e}")


if __name__ == "__main__":
    main()
