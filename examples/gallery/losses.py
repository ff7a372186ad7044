"""Friction and what the mesh loses: along the path at two of Eyring's stresses, and over the speed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from page import from_zero, legend_over, looks, picture, sheet

import fem
import flankfilm as ff
from ehl import Lubricant
from gears import STEEL, Gear, GearPair

PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, material=STEEL)
TORQUE = 220.0  # N m, of the pinion
SPEEDS = (500.0, 2000.0, 8000.0)  # rpm, of the pinion
OIL = Lubricant(
    0.05, 18e-9, 860.0, temperature=343.15, viscosity_slope=0.042, conductivity=0.14, eyring_stress=5e6
)
STRESSES = (5e6, 10e6)  # Pa, between which most oils lie


def losses(bodies: fem.PairCompliance, rpm: float, stress: float) -> ff.coupling.MeshLosses:
    """Losses at a speed with an oil that yields at a stress."""
    oil = replace(OIL, eyring_stress=stress)
    return ff.mesh_losses(PAIR, TORQUE, rpm * np.pi / 30.0, oil, positions=24, compliance=bodies)


def draw() -> Figure:
    """Coefficient of friction and power lost along the path; loss over the speed."""
    bodies = fem.compliance(PAIR)
    by_stress = [[losses(bodies, rpm, stress) for rpm in SPEEDS] for stress in STRESSES]
    with sheet(rows=3, height=6.0, legend=0, sharex=False) as (drawn, (friction, power, over)):
        for stress, row, look in zip(STRESSES, by_stress, looks(2), strict=True):
            name, case = f"Eyring stress {1e-6 * stress:.0f} MPa", row[1]
            at = 1e3 * (case.path.rho1 - PAIR.points.C)
            friction.plot(at, case.path.friction_coefficient, label=name, **look)
            power.plot(at, case.path.sliding_loss + case.path.rolling_loss, **look)
            lost = [100 * each.mesh_loss / each.input_power for each in row]
            over.plot(SPEEDS, lost, marker="o", markersize=3, **look)
            print(", ".join(f"{part:.3f} % at {rpm:.0f} rpm" for part, rpm in zip(lost, SPEEDS, strict=True)))
            print(
                f"{name}, {SPEEDS[1]:.0f} rpm: friction {case.mean_friction:.4f}, lost {case.mesh_loss:.0f} W "
                f"of {1e-3 * case.input_power:.1f} kW ± {100 * case.error:.1g} %, "
                f"contacts to {case.greatest_contact_temperature - 273.15:.0f} degC"
            )
        for axes in (friction, power):
            axes.set(xlabel="radius of the pinion's flank from the pitch point [mm]")
        friction.set(ylabel="coefficient of\nfriction [-]")
        power.set(ylabel="power lost [W]")
        over.set(xlabel="speed of the pinion [rpm]", ylabel="lost in the mesh\n[%]", xscale="log")
        over.set_xticks(SPEEDS, [f"{rpm:.0f}" for rpm in SPEEDS])
        over.minorticks_off()
        from_zero(friction, power, over)
        legend_over(friction, 2)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
