"""Root stress: error against cost by mesh, against ISO 6336-3 by teeth, and the cost of drawing fields.

Run with ``python benchmarks/fem_root_stress.py``; about twenty seconds of processor time. Errors are of the greatest
stress on a fillet, over 15 loads along the flank, both fillets and both gears, against edges of 0.015 modules.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import fem
from fem.vtk import write_vtk_series
from gears import Gear, GearPair, closed_form

PAIR = GearPair(Gear(36), Gear(40), 2e-3, 0.04)


def timed(call):
    began = time.process_time()
    result = call()
    return result, time.process_time() - began


def greatest(found):
    stresses = []
    for gear in (found.pinion, found.wheel):
        rho = np.linspace(*gear.rho_range, 15)
        stresses.append(np.abs(gear.stress(0, rho)).max(axis=2))
    return np.array(stresses)


def main():
    fem.fillets(PAIR)
    exact = greatest(fem.fillets(PAIR, fillet_edge=0.03))
    print(f"{'edge/m':>8s} {'unknowns':>9s} {'CPU s':>7s} {'estimate':>9s} {'error':>9s}")
    for edge in (0.32, 0.16, 0.08):
        found, seconds = timed(lambda e=edge: fem.fillets(PAIR, fillet_edge=e))
        error = np.max(np.abs(greatest(found) / exact - 1))
        print(f"{edge / 2:8.3f} {found.cost.unknowns:9d} {seconds:7.3f} {found.error:9.1e} {error:9.1e}")
    print(
        "\none pair loaded at D: greatest tension over ISO 6336-3's, place of the tangent, stress at 30 degrees"
    )
    for teeth in (17, 20, 25, 36, 60, 100, 200):
        pair = GearPair(Gear(teeth), Gear(60), 2e-3, 0.04)
        gear = fem.fillets(pair).pinion
        stress = gear.stress(0, np.array([pair.points.D]))[0]
        nominal = closed_form.iso6336_3(pair, 1.0).stresses[0] * pair.face_width
        lean = gear.line.tangent_angle
        at_30 = np.interp(-np.pi / 6, -lean, stress[0])
        angle = np.degrees(lean[np.argmax(stress[0])])
        print(
            f"z {teeth:4d}  {stress[0].max() / nominal:.3f}  {angle:5.1f} deg  {at_30 / nominal:.3f}  "
            f"compression on the other side {stress[1].min() / nominal:.3f}"
        )
    bodies = fem.compliance(PAIR)
    found = fem.fillets(PAIR)
    cycle = fem.mesh_cycle(PAIR, 600.0, 40, bodies)
    root, seconds = timed(lambda: fem.root_stress(PAIR, cycle, found))
    for name, gear in (("pinion", root.pinion), ("wheel", root.wheel)):
        peak, other = gear.greatest_tension, gear.greatest_compression
        amplitude, mean = gear.fatigue()
        worst = int(np.argmax(amplitude[0]))
        print(
            f"{name}: tension {peak.stress_Pa / 1e6:.1f} MPa at {np.degrees(peak.tangent_angle):.1f} deg, "
            f"{peak.position:.3f} base pitches after A; compression {other.stress_Pa / 1e6:.1f} MPa; one tooth's "
            f"passage {mean[0, worst] / 1e6:.1f} +- {amplitude[0, worst] / 1e6:.1f} MPa"
        )
    print(f"a further torque, 40 positions: {1e3 * seconds:.1f} ms of processor time")
    few = fem.mesh_cycle(PAIR, 600.0, 20, bodies)
    with tempfile.TemporaryDirectory() as folder:
        _, seconds = timed(lambda: write_vtk_series(Path(folder), PAIR, few, bodies))
        size = sum(file.stat().st_size for file in Path(folder).rglob("*.vtu")) / 20e6
    print(f"20 positions for ParaView: {seconds:.2f} s of processor time, {size:.2f} MB a position")
    return 0


if __name__ == "__main__":
    sys.exit(main())
