"""Motion with backlash by heyoka's Taylor integrator."""

import math
from collections.abc import Iterator
from functools import partial
from importlib import import_module
from typing import Any

hy: Any = import_module("heyoka")

PEER, VERSION = "heyoka", hy.__version__
NOTE = "events call Python; first call: the integrator is compiled"


def integrator(osc: list[float], start: list[float], tol: float) -> Any:
    """Integrator whose terminal events switch the spring on and off."""
    kappa, zeta, force, eps, w, d = osc
    x, v = hy.make_vars("x", "v")
    c = hy.cos(w * hy.time)
    touching, side = hy.par[0], hy.par[1]
    spring = touching * (x - side * d)
    system = [(x, v), (v, force + eps * w**2 * c - 2 * zeta * v - (1 + kappa * c) * spring)]

    def crossed(at: int) -> Any:
        def switch(ta: Any, direction: int) -> bool:
            if ta.pars[0] != 0.0:
                ta.pars[0] = 0.0
            else:
                ta.pars[0], ta.pars[1] = 1.0, float(at)
            return True

        return hy.t_event(x - at * d, callback=switch)

    return hy.taylor_adaptive(
        system, list(start), tol=tol, pars=[0.0, 0.0], t_events=[crossed(1), crossed(-1)]
    )


def settings(inputs: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """Tolerances."""
    osc, start = inputs["oscillator"], inputs["start"]
    period, d = 2.0 * math.pi / osc[4], osc[5]
    side = 1.0 if start[0] > d else -1.0 if start[0] < -d else 0.0
    built: dict[float, Any] = {}

    def follow(tol: float, periods: int) -> list[float]:
        if tol not in built:
            built[tol] = integrator(osc, start, tol)
        ta = built[tol]
        ta.time = 0.0
        ta.state[:] = start
        ta.pars[:] = [abs(side), side]
        ta.reset_cooldowns()
        ta.propagate_until(periods * period)
        return [float(ta.state[0]), float(ta.state[1])]

    for tol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15):
        first, many = (partial(follow, tol, inputs[name]) for name in ("periods", "timed_periods"))
        yield f"tol {tol:g}", first, many, 1
