"""Motion with backlash by scipy's solve_ivp with events; runs in the peer's environment, with nothing of ours."""

import json
import math
import sys
import time
from importlib import import_module
from typing import Any

FEW = 10
"""Periods that are timed: the many of the others would take a minute."""


class Limit:
    """Event at a limit of the backlash; solve_ivp reads both attributes."""

    terminal = True
    direction = 0

    def __init__(self, place: float) -> None:
        self.place = place

    def __call__(self, t: float, y: Any, region: int) -> float:
        """Distance to the limit."""
        return float(y[0] - self.place)


def follow(
    solve_ivp: Any, osc: dict[str, float], start: list[float], periods: int, rtol: float
) -> list[float]:
    """State after whole periods, the integration stopped at every impact."""
    kappa, zeta, force, eps, w, d = (
        osc[name] for name in ("kappa", "zeta", "force", "error", "frequency", "half_backlash")
    )
    now, end, y = 0.0, periods * 2.0 * math.pi / w, list(start)
    region = 1 if y[0] > d else -1 if y[0] < -d else 0

    upper, lower = Limit(d), Limit(-d)

    def rhs(t: float, y: Any, region: int) -> list[float]:
        c = math.cos(w * t)
        f = 0.0 if region == 0 else y[0] - region * d
        return [y[1], force + eps * w**2 * c - 2 * zeta * y[1] - (1 + kappa * c) * f]

    while now < end:
        upper.direction = -1 if region == 1 else 1
        lower.direction = 1 if region == -1 else -1
        events = [upper] if region == 1 else [lower] if region == -1 else [upper, lower]
        done = solve_ivp(
            rhs, (now, end), y, method="DOP853", rtol=rtol, atol=1e-3 * rtol, events=events, args=(region,)
        )
        now, y = done.t[-1], done.y[:, -1].copy()
        if done.status == 1:
            at_upper = region == 1 or (region == 0 and len(done.t_events[0]) > 0)
            y[0] = d if at_upper else -d
            region = 0 if region else (1 if at_upper else -1)
    return [float(y[0]), float(y[1])]


def main() -> None:
    """Read the work as JSON, print what was found as JSON."""
    given = json.load(sys.stdin)
    try:
        scipy = import_module("scipy")
        solve_ivp = import_module("scipy.integrate").solve_ivp
    except ImportError as error:
        print(json.dumps({"missing": str(error)}))
        return
    osc, start = given["oscillator"], given["start"]
    runs = []
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        began = time.process_time()
        values = follow(solve_ivp, osc, start, given["periods"], rtol)
        first = time.process_time() - began
        seconds = []
        for _ in range(given["repeat"]):
            began = time.process_time()
            follow(solve_ivp, osc, start, FEW, rtol)
            seconds.append((time.process_time() - began) * given["timed_periods"] / FEW)
        runs.append(
            {"level": f"DOP853, rtol {rtol:g}", "seconds": min(seconds), "first": first, "values": values}
        )
    note = f"time of {FEW} periods, multiplied"
    print(
        json.dumps(
            {
                "peer": "scipy solve_ivp",
                "version": scipy.__version__,
                "runs": runs,
                "note": note,
            }
        )
    )


if __name__ == "__main__":
    main()
