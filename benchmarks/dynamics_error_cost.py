"""Error against cost of the period map, and the speed of what is built on it.

Work: omega 0.6, kappa 0.2, D 0.2, zeta 0.05, F_m 0.1, eps 0.2, from (0.5, 0.2). Error: largest difference after five
periods to tables of a quarter of the cell and degree 30. Time: processor time a period over a long motion.
Compilation is done before the clock starts. The rivals are in `dynamics_rivals`; heyoka takes part where it is
installed (`pip install heyoka`).
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

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
from dynamics.flow import DEGREE, Tables, tables
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


Row = tuple[str, str, float, float]  # method, setting, error, seconds a period


def ours(osc: GearOscillator, exact: np.ndarray) -> list[Row]:
    """The exact flow, without and with its Jacobian."""
    rows: list[Row] = []
    for degree in (6, 7, 8, 9, 10, 11, 12, DEGREE):
        table = tables(osc, degree=degree)
        error = float(np.max(np.abs(period_map(table, START, PERIODS).state - exact)))
        took = seconds(lambda t=table: states_only(t, MANY)) / MANY
        rows.append(("exact flow", f"degree {degree}", error, took))
        took = seconds(lambda t=table: period_map(t, START, MANY)) / MANY
        rows.append(("exact flow with Jacobian", f"degree {degree}", error, took))
    return sorted(rows, key=lambda row: row[0])


def rivals(exact: np.ndarray) -> list[Row]:
    """The same work by others."""
    methods = [
        ("compiled DOP853 with events", lambda *a: compiled_dop853(*a, PAR), 400, range(4, 14)),
        ("scipy DOP853 with events", lambda *a: scipy_with_events(*a, PAR), PERIODS, (4, 6, 8, 10, 12)),
    ]
    heyoka = heyoka_with_events(PAR)
    if heyoka:
        methods.insert(1, ("heyoka with events", heyoka, 400, (4, 6, 8, 10, 12, 15)))
    rows: list[Row] = []
    for name, method, periods, digits in methods:
        for digit in digits:
            tolerance = 10.0**-digit
            error = float(np.max(np.abs(np.array(method(*START, PERIODS, tolerance)) - exact)))
            took = seconds(lambda m=method, n=periods, t=tolerance: m(*START, n, t)) / periods
            rows.append((name, f"tolerance 1e-{digit}", error, took))
    return rows


def compare(rows: list[Row]) -> None:
    """Print all rows, with their time over that of the cheapest exact flow that is at least as accurate."""
    own = [row for row in rows if row[0] == "exact flow"]
    print(f"{'method':30s} {'setting':16s} {'error':>9s} {'us/period':>10s} {'over the exact flow':>20s}")
    for name, setting, error, took in rows:
        # below the rounding of the work itself all errors count as equal
        best = min(row[3] for row in own if row[2] <= max(error, 2e-15))
        print(f"{name:30s} {setting:16s} {error:9.1e} {1e6 * took:10.2f} {took / best:20.1f}")


def draw(rows: list[Row], path: Path) -> None:
    """Error over time, one line a method."""
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 4.2), layout="constrained")
    for marker, name in zip("os^vD", dict.fromkeys(row[0] for row in rows), strict=False):
        line = np.array([row[2:] for row in rows if row[0] == name])
        line = line[np.argsort(line[:, 0])]
        axes.loglog(1e6 * line[:, 1], np.maximum(line[:, 0], 1e-16), marker=marker, label=name)
    axes.set_xlabel("processor time per excitation period [µs]")
    axes.set_ylabel("error after five periods [-]")
    axes.grid(True, which="major", alpha=0.3)
    figure.legend(loc="outside upper center", ncols=2, frameon=False)
    figure.savefig(path, dpi=150)


def work_precision(figure: Path | None) -> None:
    """Error and time of the exact flow and of its rivals."""
    osc = oscillator()
    exact = period_map(tables(osc, refinement=4, degree=30), START, PERIODS).state
    rows = ours(osc, exact) + rivals(exact)
    compare(rows)
    if not any(row[0].startswith("heyoka") for row in rows):
        print("heyoka is not installed: left out")
    print(f"tables, once: {1e6 * seconds(lambda: tables(osc)):.1f} us")
    if figure is not None:
        draw(rows, figure)


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--figure", type=Path, help="PNG of error over time")
    parser.add_argument("--flow-only", action="store_true", help="leave out what is built on the flow")
    given = parser.parse_args()
    work_precision(given.figure)
    if not given.flow_only:
        applications()


def applications() -> None:
    """Sweeps, branches, loci, diagrams, basins and exponents: best of three, each compiled before."""
    osc = oscillator()
    values = np.linspace(0.1, 2.1, 2000)
    least = [best_of(lambda way=way: sweep(osc, values=values, direction=way)) for way in ("up", "down")]
    print(f"sweep of 2000 values up and down: {least[0][0] + least[1][0]:.2f} s")
    start = find_orbit(osc.with_parameter("frequency", 0.5), (0.35, 0.0))
    took, branch = best_of(lambda: continue_branch(start, "frequency", (0.5, 1.2)))
    print(f"branch of {len(branch.values)} points: {took:.2f} s, {1e3 * took / len(branch.values):.3f} ms a point, "
          f"{len(branch.points)} special points, largest error {branch.error:.0e}")  # fmt: skip
    plane = ("frequency", "stiffness.amplitudes[0]"), ((0.3, 1.5), (0.0, 0.6))
    took, locus = best_of(lambda: continue_locus(osc, branch.points[0], *plane))
    print(f"locus of {len(locus.values)} points: {1e3 * took / len(locus.values):.2f} ms a point")
    for what in (lambda: find_orbits(osc, (1, 2, 3, 4)), lambda: diagram(osc, "frequency", (0.3, 2.1))):
        took, found = best_of(what)
        print(f"{found.message}: {took:.2f} s")
    took, basin = best_of(lambda: basins(osc, x=(-1, 1, 200), v=(-1, 1, 200)))
    print(
        f"basins of 200 x 200 starts: {took:.2f} s, {basin.message}, {basin.cost.periods / 40_000:.1f} periods a start"
    )
    starts = np.stack(np.meshgrid(np.linspace(-1, 1, 5), np.linspace(-1, 1, 5)), axis=-1).reshape(-1, 2)
    periods = round(basin.cost.periods / 40_000)
    rival, _ = best_of(lambda: [compiled_dop853(x, v, periods, 1e-6, PAR) for x, v in starts])
    rival *= 40_000 / 25
    print(f"compiled DOP853, rtol 1e-6, as many periods from 40 000 starts: {rival:.1f} s (from 25 of them), "
          f"{rival / took:.1f} times as long")  # fmt: skip
    exponents = lyapunov_exponents(osc.with_parameter("frequency", 1.04), periods=10_000)
    off = exponents.exponents.sum() + 2 * osc.damping_ratio
    print(f"exponents over 10 000 periods: {exponents.cost.seconds:.2f} s, sum + 2 zeta = {off:.0e}")


def best_of(work: Callable[[], Any], times: int = 3) -> tuple[float, Any]:
    """Best processor time after one run to warm up, and the result."""
    result, best = work(), np.inf
    for _ in range(times):
        began = time.process_time()
        result = work()
        best = min(best, time.process_time() - began)
    return best, result


if __name__ == "__main__":
    main()
