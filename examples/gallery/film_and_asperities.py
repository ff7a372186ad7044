"""The oil film along the path of contact, and over the speed the load that asperities carry where it gets thin.

This is the load sharing that a Stribeck curve follows from, not the curve itself: there is no friction in it.
"""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from page import MARK, from_zero, legend_over, looks, picture, sheet

import flankfilm as ff
from ehl import LineContact, Lubricant, Roughness, solve_mixed
from gears import STEEL, Gear, GearPair

TORQUE, RPM = 100.0, math.pi / 30.0  # N m, rad/s
OIL = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
SPEEDS = np.geomspace(20e3, 10.0, 25)  # rpm of the pinion
RA = 0.4e-6  # m, of both flanks
# sigma/beta: the tip radius of the asperities is known to a factor of ten at best
SLENDERNESS = (0.01, 0.001)


def draw() -> Figure:
    """Film along the path at 2000 rpm; film ratio and asperities' share of the load at C over the speed."""
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, material=STEEL)
    smooth = ff.film_along_path(pair, TORQUE, 2000 * RPM, OIL, tolerance=0.01)
    least = f"{1e6 * smooth.least_film:.3f} um ± {100 * smooth.least_film_error:.1g} %"
    print(f"smooth flanks, 2000 rpm: minimum film of the path {least}")

    at_c = pair.path_at(pair.points.C)
    contacts = [
        LineContact(
            load=pair.normal_force(TORQUE) / pair.face_width,
            entrainment=at_c.entrainment(speed * RPM).item(),
            radius=at_c.radius.item(),
            reduced_modulus=pair.reduced_modulus,
            lubricant=OIL,
        )
        for speed in SPEEDS.tolist()
    ]
    sigma, mixed = Roughness.from_drawing(mean=RA).deviation, {}
    for slender in SLENDERNESS:
        name = f"sigma/beta = {slender:g}"
        ground = Roughness.from_drawing(mean=RA, tip_radius=sigma / slender)
        mixed[name] = [solve_mixed(contact, ground) for contact in contacts]
        error = 100 * max(film.error for film in mixed[name])
        for k in (0, 8, 24):
            film, speed = mixed[name][k], float(f"{SPEEDS[k]:.3g}")
            print(
                f"{name}, {speed:g} rpm: film ratio {film.film_ratio:.2f} ± {error:.1g} %, asperities carry "
                f"{100 * film.asperity_share:.1f} % of the load"
            )

    with sheet(columns=2, height=3.4, legend=0) as (drawn, (path, stribeck)):
        travel = 1e3 * (smooth.rho1 - pair.points.A)
        path.plot(travel, 1e6 * smooth.central_thickness, label="central film")
        path.plot(travel, 1e6 * smooth.minimum_thickness, label="minimum film")
        path.axvline(1e3 * (pair.points.C - pair.points.A), color=MARK, linewidth=0.8)
        path.set(xlabel="distance from A on the path [mm]", ylabel="film thickness at 2000 rpm [µm]")
        from_zero(path)
        legend_over(path, 2)
        right = stribeck.twinx()
        for (name, films), look in zip(mixed.items(), looks(2), strict=True):
            stribeck.semilogx(
                SPEEDS, [100 * film.asperity_share for film in films], label=f"asperities, {name}", **look
            )
        right.semilogx(SPEEDS, [film.film_ratio for film in films], color="k", linewidth=0.9)
        stribeck.set(xlabel="speed of the pinion [rpm]", ylabel="share of the load on asperities [%]")
        from_zero(stribeck)
        right.set(ylabel="film ratio (thin black line) [-]", ylim=(0.0, None))
        right.grid(False)
        right.spines["right"].set_visible(True)
        legend_over(stribeck, 1)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
