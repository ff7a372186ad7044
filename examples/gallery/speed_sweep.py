"""A pair swept up and down in speed: contact is lost, and the motion jumps."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from page import MARK, looks, picture, sheet

import flankfilm as ff
from gears import STEEL, Gear, GearPair

TORQUE, RPM = 300.0, math.pi / 30.0  # N m, rad/s
SPEEDS = np.linspace(4000.0, 14000.0, 161)  # rpm of the pinion


def draw() -> Figure:
    """Maximum tooth force over the speed, up and down, with the speeds at which a stable motion ends."""
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, material=STEEL).with_backlash(50e-6)
    cycle = ff.mesh_cycle(pair, TORQUE)
    swept_over = SPEEDS[0] * RPM, SPEEDS[-1] * RPM
    motion = ff.pair_oscillator(pair, cycle, TORQUE, swept_over[0], error_amplitude=10e-6, speeds=swept_over)
    swept = ff.speed_sweep(motion, SPEEDS * RPM)
    diagram = ff.jump_speeds(motion, swept_over, max_period=2)

    lost = swept.least_grazing * diagram.speed_of_one / RPM
    print(f"contact first lost at {lost:.0f} rpm ± {100 * swept.least_grazing_error:.1g} %")
    for jump in diagram.jumps:
        way = "rises" if jump.rising else "falls"
        speed = jump.frequency * diagram.speed_of_one / RPM
        print(f"{jump.label} ends at {speed:.0f} rpm ± {100 * jump.error:.1g} % as the speed {way}")
    with sheet(height=3.8, legend=4) as (drawn, (axes,)):
        for (way, force), mark, look in zip(swept.force_factor.items(), (9, 5), looks(2), strict=True):
            axes.plot(
                SPEEDS,
                force,
                ".",
                markersize=mark,
                color=look["color"],
                label={"up": "speed rises", "down": "speed falls"}[way],
            )
        for k, speed in enumerate(diagram.jump_speed / RPM):
            label = None if k else "jumps"
            axes.axvline(speed, color=MARK, linewidth=0.9, label=label)
        axes.axvline(lost, color=MARK, linewidth=0.9, linestyle=":", label="contact first lost")
        axes.set(xlabel="speed of the pinion [rpm]", ylabel="maximum force over the mean force [-]")
        axes.set(xlim=(SPEEDS[0], SPEEDS[-1]), ylim=(0.0, None))
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
