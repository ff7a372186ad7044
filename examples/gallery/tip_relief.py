"""Where the transmission error is smallest, over tip relief and torque."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from page import picture, sheet

import fem
from gears import STEEL, Gear, GearPair, TipRelief

TORQUES = np.linspace(50.0, 600.0, 12)  # N m, of the pinion
RELIEFS = np.linspace(0.0, 36e-6, 19)  # m, of both gears
LENGTH = 3.2e-3  # m, along the line of action


def relieved(amount: float) -> GearPair:
    """Gears of 36 and 40 teeth with so much tip relief."""
    relief = TipRelief(amount, LENGTH) if amount else None
    gears = (replace(Gear(teeth), tip_relief=relief) for teeth in (36, 40))
    return GearPair(*gears, module=2e-3, face_width=40e-3, material=STEEL)


def draw() -> Figure:
    """Peak-to-peak transmission error over relief and torque, with the best relief of each torque."""
    cycles = [fem.mesh_cycle(relieved(amount), TORQUES, positions=60) for amount in RELIEFS.tolist()]
    swing = np.array(
        [[np.ptp(cycle.transmission_error) for cycle in row] for row in cycles]
    )  # (reliefs, torques)
    best = np.argmin(swing, axis=0)
    for k in (5, 11):
        for name, row in (("no relief", 0), (f"{1e6 * RELIEFS[best[k]]:.0f} um, the best", best[k])):
            cycle = cycles[row][k]
            error = 100 * cycle.errors["transmission_error_range"]
            print(
                f"{TORQUES[k]:.0f} N m, {name}: {1e6 * cycle.transmission_error_range:.2f} um ± {error:.1g} %"
            )
    with sheet(height=3.8, legend=1) as (drawn, (axes,)):
        shades = axes.contourf(TORQUES, 1e6 * RELIEFS, 1e6 * swing, 18, cmap="viridis")
        axes.plot(
            TORQUES,
            1e6 * RELIEFS[best],
            "wo",
            markeredgecolor="k",
            markersize=5,
            clip_on=False,
            label="minimum of each torque",
        )
        axes.set(xlabel="torque of the pinion [N m]", ylabel="tip relief of both gears [µm]")
        drawn.colorbar(shades, label="transmission error, peak to peak [µm]")
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
