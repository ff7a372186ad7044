"""Loaded contact of the article's pair: what rounded tips change, and what cycles and sweeps cost.

Run ``python benchmarks/fem_loaded_contact.py`` from the root; processor time, one core.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

import fem
from gears import Gear, GearPair

TORQUE = 600.0


def milliseconds(task: Callable[[], object], times: int) -> float:
    """Processor time of one call, after a first one."""
    task()
    began = time.process_time()
    for _ in range(times):
        task()
    return 1e3 * (time.process_time() - began) / times


def main() -> None:
    """Print both tables."""
    pair = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04)
    bodies = fem.compliance(pair)
    pitch_point = (pair.points.C - pair.points.A) / pair.base_pitch
    per_width = 1e-9 / pair.face_width  # N/m to N/(mm um)
    print("radius um | at C  edge N/mm | .75 p_b  edge  sum | mean secant | peak to peak um")
    for radius in (0.0, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6):
        cycle = fem.mesh_cycle(pair, TORQUE, 200, bodies, tip_rounding=radius)
        edge = np.where(cycle.edge, cycle.forces, 0.0).max(axis=1) * 1e-3 / pair.face_width
        total = cycle.forces.sum(axis=1) * 1e-3 / pair.face_width
        stiffness = cycle.secant_stiffness * per_width

        def at(place: float, values: np.ndarray, where: np.ndarray = cycle.position) -> float:
            return float(np.interp(place, where, values))

        print(
            f"{1e6 * radius:9.0f} | {at(pitch_point, stiffness):.2f} {at(pitch_point, edge):6.1f} |"
            f" {at(0.75, stiffness):.2f} {at(0.75, edge):6.1f} {at(0.75, total):6.1f} |"
            f" {stiffness.mean():.3f} | {1e6 * np.ptp(cycle.transmission_error):.2f}"
        )
    print("\nmilliseconds, 40 positions a pitch")
    torques = np.linspace(10.0, 900.0, 100)
    tasks: tuple[tuple[str, Callable[[], object], int], ...] = (
        ("held to the path", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, False), 50),
        ("with tip edges", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies), 50),
        ("rounded tips", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, tip_rounding=5e-5), 20),
        ("100 torques", lambda: fem.mesh_cycle(pair, torques, 40, bodies), 5),
        ("360 pitches", lambda: fem.mesh_cycle(pair, TORQUE, 40, bodies, pitches=360), 5),
    )
    for name, task, times in tasks:
        print(f"{name:17s} {milliseconds(task, times):7.2f}")


if __name__ == "__main__":
    main()
