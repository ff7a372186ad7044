"""Error against cost of the stepwise flow, beside the exact flow and scipy's DOP853 on the same work.

Work: omega 0.6, kappa 0.2, D 0.2, zeta 0.05, F_m 0.1, eps 0.2, from (0.5, 0.2), five periods; contact with exponent 1
(where the exact flow is the truth), 10/9, and a table of eight harmonics. Error: largest difference of the last state
to the truth: the exact flow, or the stepwise flow at 3e-15. Time: processor time a period, least of repetitions;
compilation is done before the clock starts. scipy integrates the stretches between events that it locates itself.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from dynamics_rivals import compiled_dop853, scipy_with_events
from scipy.integrate import solve_ivp

from dynamics import (
    FourierStiffness,
    GearOscillator,
    PowerContact,
    SmoothOscillator,
    TabulatedContact,
    find_orbit,
    period_map,
    smooth,
)
from dynamics.flow import tables
from dynamics.sensitivity import map_derivatives
from dynamics.smooth.flow import follow
from dynamics.smooth.oscillator import Engine

START = np.array([0.5, 0.2])
PERIODS = 5
SERIES = FourierStiffness(1.0, (0.2,), (0.0,))
PAR = np.array([0.2, 0.05, 0.1, 0.2, 0.6, 0.2])  # the same, for the rivals


def seconds(work: Callable[[], object], least: float = 0.4) -> float:
    """Best processor time of repetitions that together last at least that long."""
    best, total = np.inf, 0.0
    while total < least:
        began = time.process_time()
        work()
        took = time.process_time() - began
        best, total = min(best, took), total + took
    return best


def laws() -> dict[str, object]:
    """The laws of the comparison."""
    depths = np.linspace(0.0, 1.0, 33) ** 2 * 1.5
    angles = 2 * np.pi * np.arange(20) / 20
    forces = SERIES(angles)[:, None] * depths ** (10 / 9)
    return {
        "exponent 1": PowerContact(stiffness=SERIES, half_backlash=0.2, exponent=1.0),
        "exponent 10/9": PowerContact(stiffness=SERIES, half_backlash=0.2),
        "table, 8 harmonics": TabulatedContact.from_forces(depths, forces, half_backlash=0.2, order=8),
    }


def scipy_power(exponent: float, rtol: float) -> np.ndarray:
    """State after five periods by scipy with events, its step restarted at every crossing."""
    kappa, zeta, force, eps, w, d = PAR
    now, end, y = 0.0, PERIODS * 2 * np.pi / w, START.copy()
    region = 1 if y[0] > d else 0

    def upper(t, y):
        return y[0] - d

    def lower(t, y):
        return y[0] + d

    upper.terminal = lower.terminal = True
    while now < end:

        def rhs(t, y, region=region):
            c = np.cos(w * t)
            deep = 0.0 if region == 0 else max(region * y[0] - d, 0.0)
            f = region * (1 + kappa * c) * deep**exponent
            return [y[1], force + eps * w**2 * c - 2 * zeta * y[1] - f]

        upper.direction, lower.direction = (-1, 0) if region == 1 else (1, 0)
        lower.direction = 1 if region == -1 else -1
        events = [upper] if region == 1 else [lower] if region == -1 else [upper, lower]
        done = solve_ivp(rhs, (now, end), y, method="DOP853", rtol=rtol, atol=1e-3 * rtol, events=events)
        now, y = done.t[-1], done.y[:, -1].copy()
        if done.status == 1:
            side = 1 if region == 1 or (region == 0 and len(done.t_events[0])) else -1
            y[0] = side * d
            region = 0 if region else side
    return y


def work_precision() -> None:
    """Rows of error and time."""
    exact = GearOscillator(SERIES, 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    print(f"{'method':52s} {'error':>9s} {'us/period':>10s} {'evaluations':>12s}")
    for name, law in laws().items():
        osc = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6)
        truth = follow(Engine(osc, 3e-15), START, PERIODS, derivatives=False).state
        if name == "exponent 1":
            truth = period_map(tables(exact, refinement=4, degree=30), START, PERIODS).state
        for tolerance in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14):
            for derivatives in (False, True):
                engine = Engine(osc, tolerance, ("frequency",))
                done = follow(engine, START, PERIODS, derivatives=derivatives)
                error = np.max(np.abs(done.state - truth))
                took = seconds(lambda e=engine, d=derivatives: follow(e, START, 200, derivatives=d)) / 200
                what = f"stepwise, {name}, {tolerance:.0e}{', with derivatives' if derivatives else ''}"
                print(f"{what:52s} {error:9.1e} {1e6 * took:10.1f} {done.evaluations / PERIODS:12.0f}")
        if name.startswith("exponent"):
            power = 1.0 if name == "exponent 1" else 10 / 9
            for rtol in (1e-4, 1e-8, 1e-12):
                error = np.max(np.abs(scipy_power(power, rtol) - truth))
                took = seconds(lambda p=power, r=rtol: scipy_power(p, r)) / PERIODS
                print(
                    f"{f'scipy DOP853 with events, {name}, {rtol:.0e}':52s} {error:9.1e} {1e6 * took:10.1f}"
                )
    for rtol in (1e-4, 1e-8, 1e-12):
        truth = period_map(tables(exact, refinement=4, degree=30), START, PERIODS).state
        error = np.max(np.abs(np.array(compiled_dop853(*START, PERIODS, rtol, PAR)) - truth))
        took = seconds(lambda r=rtol: compiled_dop853(*START, 400, r, PAR)) / 400
        print(f"{f'DOP853 compiled for exponent 1 alone, {rtol:.0e}':52s} {error:9.1e} {1e6 * took:10.1f}")
        error = np.max(np.abs(np.array(scipy_with_events(*START, PERIODS, rtol, PAR)) - truth))
        took = seconds(lambda r=rtol: scipy_with_events(*START, PERIODS, r, PAR)) / PERIODS
        print(f"{f'scipy of the rivals, exponent 1, {rtol:.0e}':52s} {error:9.1e} {1e6 * took:10.1f}")
    table = tables(exact)
    took = seconds(lambda: period_map(table, START, 4000)) / 4000
    print(f"{'exact flow with Jacobian':52s} {'':9s} {1e6 * took:10.1f}")


def branches() -> None:
    """A branch with its special points."""
    for name, law in laws().items():
        osc = SmoothOscillator(law, 0.05, 0.1, 0.2, 0.55)
        began = time.process_time()
        orbit = smooth.find_orbit(osc, (0.4, 0.0))
        branch = smooth.continue_branch(orbit, "frequency", (0.5, 1.0))
        took = time.process_time() - began
        each = 1e3 * took / len(branch.values)
        print(
            f"branch, {name}: {took:.2f} s, {each:.2f} ms a point, {branch.message}, largest error {branch.error:.0e}"
        )


def main() -> None:
    exact = GearOscillator(SERIES, 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    find_orbit(exact, START)
    map_derivatives(exact, START)
    for law in laws().values():
        smooth.find_orbit(SmoothOscillator(law, 0.05, 0.1, 0.2, 0.6), START)
    work_precision()
    branches()


if __name__ == "__main__":
    main()
