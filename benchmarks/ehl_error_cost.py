"""Cost of the line-contact solver by the film that it starts from, compilation apart.

Run with ``OPENBLAS_NUM_THREADS=1 python benchmarks/ehl_error_cost.py`` (at these sizes threads cost more than they
give). Error against cost by nodes and by tolerance: ``flankfilm bench --only film``.
"""

from __future__ import annotations

import time
import warnings
from dataclasses import replace

import numpy as np

from base import RangeWarning
from ehl import DEFINITIONS, Film, LineContact, Lubricant, solve, solve_path

OIL = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
PITCH = LineContact(load=4.434e5, entrainment=2.579, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=OIL)


def timed(task, repeats: int = 9) -> tuple[float, Film]:
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        result = task()
        times.append(time.perf_counter() - start)
    return 1e3 * min(times), result  # the least: other work on the machine only adds


def by_start() -> None:
    print("\ngear pitch point at 0.5 %, by start")
    film = solve(PITCH)
    for what, load, start in [
        ("cold", 1.0, None),
        ("same contact", 1.0, film),
        ("load +0.01 %", 1.0001, film),
        ("load +2 %", 1.02, film),
        ("load halved", 0.5, film),
    ]:
        ms, found = timed(
            lambda f=load, s=start: solve(replace(PITCH, load=f * PITCH.load), start=s), repeats=31
        )
        print(f"{what:18}{ms:8.2f} ms {found.cost.iterations:4} Newton steps on grids {found.cost.grids}")
    contacts = [
        replace(
            PITCH,
            load=PITCH.load * (1.0 if abs(s) < 0.3 else 0.5),
            radius=PITCH.radius * (1 - 0.25 * s * s),
            entrainment=PITCH.entrainment * (1 + 0.05 * s),
        )
        for s in np.linspace(-1, 1, 101)
    ]
    start = time.perf_counter()
    films = solve_path(contacts)
    print(
        f"101 positions with two load jumps: {time.perf_counter() - start:.2f} s, largest estimate"
        f" {max(f.error for f in films):.1e}"
    )


def stiffnesses() -> None:
    film = solve(PITCH, tolerance=1e-3)
    print("\nfilm stiffness at the gear pitch point, face 40 mm [N/m]")
    for definition in DEFINITIONS:
        print(f"{definition:18}{0.04 * film.stiffness(definition):10.3e}")


def main() -> None:
    warnings.simplefilter("ignore", RangeWarning)
    start = time.perf_counter()
    solve(PITCH)
    print(f"first solution, with the kernels loaded or compiled: {time.perf_counter() - start:.2f} s\n")
    by_start()
    stiffnesses()


if __name__ == "__main__":
    main()
