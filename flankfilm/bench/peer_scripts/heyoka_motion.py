"""Motion with backlash by heyoka's Taylor integrator; runs in the peer's environment, with nothing of ours."""

import json
import math
import sys
import time
from importlib import import_module
from typing import Any


def integrator(hy: Any, osc: dict[str, float], start: list[float], tol: float) -> Any:
    """Integrator whose terminal events switch the spring on and off."""
    kappa, zeta, force, eps, w, d = (
        osc[name] for name in ("kappa", "zeta", "force", "error", "frequency", "half_backlash")
    )
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


def main() -> None:
    """Read the work as JSON, print what was found as JSON."""
    given = json.load(sys.stdin)
    try:
        hy = import_module("heyoka")
    except ImportError as error:
        print(json.dumps({"missing": str(error)}))
        return
    osc, start = given["oscillator"], given["start"]
    period, d = 2.0 * math.pi / osc["frequency"], osc["half_backlash"]
    side = 1.0 if start[0] > d else -1.0 if start[0] < -d else 0.0
    runs = []
    for tol in (1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-15):
        began = time.process_time()
        ta = integrator(hy, osc, start, tol)
        built = time.process_time() - began

        def follow(periods: int, ta: Any = ta) -> list[float]:
            ta.time = 0.0
            ta.state[:] = start
            ta.pars[:] = [abs(side), side]
            ta.reset_cooldowns()
            ta.propagate_until(periods * period)
            return [float(ta.state[0]), float(ta.state[1])]

        values = follow(given["periods"])
        seconds = []
        for _ in range(given["repeat"]):
            began = time.process_time()
            follow(given["timed_periods"])
            seconds.append(time.process_time() - began)
        runs.append({"level": f"tol {tol:g}", "seconds": min(seconds), "first": built, "values": values})
    note = "events call Python; first call: the integrator is compiled"
    print(json.dumps({"peer": "heyoka", "version": hy.__version__, "runs": runs, "note": note}))


if __name__ == "__main__":
    main()
