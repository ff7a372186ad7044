"""Motion with backlash by scipy's solve_ivp with events."""

import math
from collections.abc import Iterator
from functools import partial
from importlib import import_module
from typing import Any

scipy: Any = import_module("scipy")
solve_ivp: Any = import_module("scipy.integrate").solve_ivp

FEW = 10
"""Periods that are timed: the many of the others would take a minute."""

PEER, VERSION, NOTE = "scipy solve_ivp", scipy.__version__, f"time of {FEW} periods, multiplied"


class Limit:
    """Event at a limit of the backlash; solve_ivp reads both attributes."""

    terminal = True
    direction = 0

    def __init__(self, place: float) -> None:
        self.place = place

    def __call__(self, t: float, y: Any, region: int) -> float:
        """Distance to the limit."""
        return float(y[0] - self.place)


def follow(osc: list[float], start: list[float], rtol: float, periods: int) -> list[float]:
    """State after whole periods, the integration stopped at every impact."""
    kappa, zeta, force, eps, w, d = osc
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


def settings(inputs: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """Tolerances."""
    for rtol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12):
        after = partial(follow, inputs["oscillator"], inputs["start"], rtol)
        first, few = partial(after, inputs["periods"]), partial(after, FEW)
        yield f"DOP853, rtol {rtol:g}", first, few, inputs["timed_periods"] / FEW
