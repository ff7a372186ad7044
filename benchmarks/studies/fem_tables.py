"""Tables of the validation pages: rounded tips in loaded contact, root stress beside ISO 6336-3 by teeth.

Run with ``python benchmarks/studies/fem_tables.py``; half a minute. The costs of both are measured by
``flankfilm bench --only contact root-stress``.
"""

from __future__ import annotations

import numpy as np

import fem
from gears import Gear, GearPair, closed_form

TORQUE = 600.0
PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04)


def rounded_tips() -> None:
    """What the radius of the tip edges changes."""
    bodies = fem.compliance(PAIR)
    pitch_point = (PAIR.points.C - PAIR.points.A) / PAIR.base_pitch
    per_width = 1e-9 / PAIR.face_width  # N/m to N/(mm um)
    print("radius um | at C  edge N/mm | .75 p_b  edge  sum | mean secant | peak to peak um")
    for radius in (0.0, 10e-6, 20e-6, 50e-6, 100e-6, 200e-6):
        cycle = fem.mesh_cycle(PAIR, TORQUE, 200, bodies, tip_rounding=radius)
        edge = np.where(cycle.edge, cycle.forces, 0.0).max(axis=1) * 1e-3 / PAIR.face_width
        total = cycle.forces.sum(axis=1) * 1e-3 / PAIR.face_width
        stiffness = cycle.secant_stiffness * per_width
        at_C = [np.interp(pitch_point, cycle.position, curve) for curve in (stiffness, edge)]
        later = [np.interp(0.75, cycle.position, curve) for curve in (stiffness, edge, total)]
        print(
            f"{1e6 * radius:9.0f} | {at_C[0]:.2f} {at_C[1]:6.1f} | {later[0]:.2f} {later[1]:6.1f} {later[2]:6.1f} |"
            f" {stiffness.mean():.3f} | {1e6 * np.ptp(cycle.transmission_error):.2f}"
        )


def root_stress() -> None:
    """Greatest tension of one pair loaded at D over that of ISO 6336-3, and where; then of the mesh cycle."""
    print("\none pair loaded at D: tension over ISO 6336-3's, place of the tangent, stress at 30 degrees")
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
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    root = fem.root_stress(pair, fem.mesh_cycle(pair, TORQUE, 40), fem.fillets(pair))
    for name, gear in (("pinion", root.pinion), ("wheel", root.wheel)):
        peak, other = gear.greatest_tension, gear.greatest_compression
        amplitude, mean = gear.fatigue()
        worst = int(np.argmax(amplitude[0]))
        print(
            f"{name}: tension {peak.stress_Pa / 1e6:.1f} MPa at {np.degrees(peak.tangent_angle):.1f} deg; "
            f"compression {other.stress_Pa / 1e6:.1f} MPa; one tooth's passage "
            f"{mean[0, worst] / 1e6:.1f} +- {amplitude[0, worst] / 1e6:.1f} MPa"
        )


if __name__ == "__main__":
    rounded_tips()
    root_stress()
