"""Error against cost of the finite elements: single-pair stiffness and mesh cycle, by mesh.

Run with ``python benchmarks/fem_error_cost.py``; about half a minute. Nothing is compiled at run time; the first
call pays for imports and is left out. The reference is the mesh refined three times.
"""

from __future__ import annotations

import sys
import time

import numpy as np

import fem
from gears import Gear, GearPair
from meshes import Sizes

PAIRS = {
    "article pair 36/40": GearPair(Gear(36), Gear(40), 2e-3, 0.04),
    "undercut limit 17/43": GearPair(Gear(17), Gear(43), 2e-3, 0.04),
    "large wheel 20/1000": GearPair(Gear(20), Gear(1000), 2e-3, 0.04),
}
CRUDE = Sizes(flank=0.7, fillet=0.5, root=0.7, top=0.7, corner=0.04, rim=1.2, layer_growth=1.8)


def timed(call):
    began = time.perf_counter()
    result = call()
    return result, time.perf_counter() - began


def main():
    fem.compliance(next(iter(PAIRS.values())))
    names = ("pair", "mesh", "unknowns", "annuli", "seconds", "estimate", "k error", "TE error")
    print("{:22s} {:>12s} {:>9s} {:>10s} {:>8s} {:>9s} {:>9s} {:>9s}".format(*names))
    for name, pair in PAIRS.items():
        rho1 = np.linspace(pair.points.A, pair.points.E, 41)[1:-1]
        force, torque = pair.normal_force(300.0), 300.0

        def figures(bodies, pair=pair, rho1=rho1, force=force, torque=torque):
            k = fem.single_pair_stiffness(pair, force, rho1, bodies)
            cycle = fem.mesh_cycle(pair, torque, 40, bodies, beyond_path=False)
            return k, np.ptp(cycle.transmission_error)

        exact_k, exact_te = figures(fem.compliance(pair, refinements=3))
        meshes = [("crude", CRUDE, 1), ("refined 1x", None, 1), ("refined 2x", None, 2)]
        for label, sizes, level in meshes:
            bodies, seconds = timed(
                lambda s=sizes, n=level, p=pair: fem.compliance(p, sizes=s, refinements=n)
            )
            k, te = figures(bodies)
            print(
                f"{name:22s} {label:>12s} {bodies.cost.unknowns:9d} {bodies.cost.annulus_unknowns:10d} {seconds:8.3f} "
                f"{bodies.error:9.1e} {np.max(np.abs(k / exact_k - 1)):9.1e} {abs(te / exact_te - 1):9.1e}"
            )
    pair = PAIRS["article pair 36/40"]
    bodies = fem.compliance(pair)
    for beyond in (False, True):
        cycle, seconds = timed(lambda b=beyond: fem.mesh_cycle(pair, 500.0, 40, bodies, beyond_path=b))
        steps = cycle.cost.iterations
        print(f"a further torque, tip edges {beyond}: {1e3 * seconds:.1f} ms, {steps} Newton steps")
    parts = ", ".join(f"{stage} {seconds:.3f}" for stage, seconds in bodies.cost.parts.items())
    print(f"seconds by stage at a tolerance of 0.1 % (two meshes, both gears): {parts}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
