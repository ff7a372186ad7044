"""What the face costs: both gears solved from nothing, memory at most, and a further torque or alignment.

``PYTHONPATH=. python benchmarks/studies/face_cost.py gears`` solves the article's gears in a new process (nothing
is kept, kernels are warm after a first run) and tells processor time and the greatest memory after every step.
``further`` solves them and times cycles of 40 positions and 64 cells, of which each has another torque or alignment.
Compare two states by running both in turn.
"""

from __future__ import annotations

import resource
import sys
import time

import numpy as np

import fem
from gears import Alignment, Gear, GearPair, Material

STEEL = Material(206e9, 0.3, 7850.0)
PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04, material=STEEL)
TORQUE, SLOPE, REPEATS = 600.0, 20e-6, 16


def told(step: str, start: float) -> float:
    """Print what a step took, and how much memory the process has had at most."""
    now = time.process_time()
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{step:32s} {now - start:6.2f} s of processor time, {most:5.0f} MB at most", flush=True)
    return time.process_time()


def solved_gears() -> fem.PairCompliance:
    """Both gears, plane, then waves along the face, then free ends."""
    at = told("imports", 0.0)
    bodies = fem.compliance(PAIR, tolerance=0.005)
    at = told("plane", at)
    fem.face_gears(bodies, "walls")
    at = told("waves along the face", at)
    fem.face_gears(bodies, "free-ends")
    told("free ends", at)
    return bodies


def further(bodies: fem.PairCompliance) -> None:
    """Cycles after the first one."""
    for beyond, where in ((False, "held to the path"), (True, "with tip edges")):
        for name in ("alignment", "torque"):
            taken = []
            for k in range(REPEATS + 1):
                torque = TORQUE * (1 - 0.03 * k * (name == "torque"))
                slope = SLOPE * (1 + 0.05 * k * (name == "alignment"))
                start = time.process_time()
                fem.mesh_cycle(
                    PAIR, torque, 40, bodies, beyond_path=beyond, alignment=Alignment(slope), cells=64
                )
                taken.append(1e3 * (time.process_time() - start))
            rest = np.array(taken[1:])
            print(
                f"further {name:10s}{where:18s} {rest.min():5.1f} {np.median(rest):5.1f} {rest.max():5.1f} ms: "
                f"least, median, most; the first {taken[0]:.0f} ms",
                flush=True,
            )


if __name__ == "__main__":
    gears = solved_gears()
    if "further" in sys.argv[1:]:
        further(gears)
