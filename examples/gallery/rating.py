"""From the tolerances of a grade to safeties: what gears as made have, beside the rating that takes all tolerances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from page import looks, picture, sheet
from scipy.stats import qmc

from gears import Gear, GearPair
from gears.rating import DeviationShares, RatedSteel, RatingData, rate

PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3)
STEELS = (RatedSteel("Eh", contact_strength=1500e6, bending_strength=430e6),) * 2
DATA = RatingData(
    grade=6,
    steels=STEELS,
    life=20000 * 3600.0,
    viscosity_40=220e-6,
    flank_roughness=4.8e-6,
    root_roughness=(20e-6, 20e-6),
    application_factor=1.25,
)
TORQUE, SPEED = 250.0, 209.44  # N m, rad/s of the pinion
GRADES, DRAWN = (5, 7, 9), 1024


def safety(grade: int, shares: DeviationShares) -> float:
    """Smaller safety against pitting of both gears."""
    return min(rate(PAIR, TORQUE, SPEED, replace(DATA, grade=grade, shares=shares)).S_H)


def draw() -> Figure:
    """Share of pairs below a safety, for three grades, with the safety at full tolerances."""
    draws = qmc.Sobol(3, scramble=True, rng=1).random(DRAWN).tolist()
    below = (np.arange(DRAWN) + 0.5) / DRAWN
    with sheet(height=3.4) as (drawn, (axes,)):
        for grade, look in zip(GRADES, looks(len(GRADES)), strict=True):
            drawn_safeties = np.sort([safety(grade, DeviationShares(*shares)) for shares in draws])
            rated = safety(grade, DeviationShares())
            axes.plot(drawn_safeties, 100.0 * below, label=f"grade {grade}", **look)
            axes.plot(rated, 0.0, marker="o", color=look["color"], clip_on=False)
            low, middle = np.quantile(drawn_safeties, (0.05, 0.5))
            print(f"grade {grade}: rated {rated:.3f}, 5 % below {low:.3f}, half below {middle:.3f}")
        axes.axvline(1.0, color="#000000", linewidth=1.0, linestyle="-")
        axes.set_ylim(0.0, 100.0)
        axes.set(xlabel="safety against pitting $S_H$ [-]", ylabel="pairs below it [%]")
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
