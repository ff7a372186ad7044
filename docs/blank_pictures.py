"""Draws rims on webs beside ISO 6336 and prints what is drawn: python docs/blank_pictures.py; half a minute.

A wheel of 70 teeth, m 3, on a hub of 60 mm with a bore of 40 mm, meshes with a solid pinion of 25 teeth. The stiffness
is that of one pair at C by 200 N/mm, without the wind-up of the bodies, which closed forms do not have; the root stress
is the greatest tension of the wheel by a load at its outer point of single contact. Both go over those of a solid disc.
"""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from runs import save

import fem
from base import Array
from flankfilm.figures.style import MARK, colours, sheet
from gears import Blank, Gear, GearPair
from gears.closed_form.root_stress import rim_factor
from gears.closed_form.tooth_stiffness import blank_factor

MODULE, WIDTH, LINE_LOAD = 3e-3, 30e-3, 2e5
DEPTH = 2.25
"""Tooth depth [modules]."""

WEBS = (0.1, 0.2, 0.3, 0.5)
RIMS = np.array([0.55, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0, 3.0])
"""Rim thickness over tooth depth."""


def pair(wheel: Gear) -> GearPair:
    """A solid pinion with a wheel."""
    return GearPair(Gear(25), wheel, MODULE, WIDTH)


def on_web(rim: float, web: float) -> GearPair:
    """Wheel whose rim is so many tooth depths thick, with a web of so many face widths."""
    blank = Blank(rim * DEPTH * MODULE, web * WIDTH, hub_radius=0.03)
    return pair(Gear(70, bore_radius=0.02, blank=blank))


def held(rim: float) -> GearPair:
    """Disc whose bore leaves that rim."""
    root = pair(Gear(70)).root_radii[1]
    return pair(Gear(70, bore_radius=root - rim * DEPTH * MODULE))


def stiffness(gear_pair: GearPair) -> float:
    """Of one pair at C, against the teeth [N/m]."""
    bodies = fem.compliance(gear_pair, 0.002).without("hub_windup")
    force = LINE_LOAD * WIDTH
    return float(fem.single_pair_stiffness(gear_pair, force, np.array([gear_pair.points.C]), bodies)[0])


def root_stress(gear_pair: GearPair) -> float:
    """Greatest tension of the wheel's root per line load [1/m]."""
    rho = gear_pair.line_of_action - gear_pair.points.B
    return float(fem.fillets(gear_pair, 0.005).wheel.stress(0, np.array([rho]))[0, 0].max())


def drawn(stiffer: dict[float, Array], stressed: dict[float, Array], at_bore: tuple[Array, Array]) -> Figure:
    """Factors of finite elements (marks) and of ISO 6336 (lines) over the rim."""
    fine = np.linspace(RIMS[0], RIMS[-1], 200)
    with sheet(None, 1, 2, height=3.4, legend=3) as (figure, (left, right)):
        for web, colour, mark in zip(WEBS, colours(len(WEBS)), "ov^D", strict=True):
            look: dict[str, Any] = {"color": colour, "linestyle": "-", "marker": mark, "ms": 4, "lw": 0.8}
            left.plot(RIMS, stiffer[web], label=f"b_s/b = {web:g}", **look)
            right.plot(RIMS, stressed[web], **look)
            if web > 0.1:
                iso = [blank_factor(on_web(rim, web).teeth_profiles[1]) for rim in fine]
                left.plot(fine, iso, "--", color=colour)
        for axes, values in zip((left, right), at_bore, strict=True):
            axes.plot(RIMS, values, "s:", color=MARK, ms=4, lw=0.8, label="disc held at its bore")
        right.plot(fine, [rim_factor(rim) for rim in fine], "k--", label="ISO 6336")
        left.plot([], [], "k--", label="ISO 6336")
        left.set(xlabel="rim over tooth depth, s_R/h_t [-]", ylabel="stiffness over that of a disc,\nC_R [-]")
        right.set(
            xlabel="rim over tooth depth, s_R/h_t [-]", ylabel="root stress over that of a disc,\nY_B [-]"
        )
    return figure


def main() -> None:
    """Write docs/images/blanks.png."""
    warnings.simplefilter("ignore")
    disc = pair(Gear(70, bore_radius=0.02))
    stiff, stress = stiffness(disc), root_stress(disc)
    stiffer, stressed = {}, {}
    for web in WEBS:
        wheels = [on_web(float(rim), web) for rim in RIMS]
        stiffer[web] = np.array([stiffness(gear_pair) for gear_pair in wheels]) / stiff
        stressed[web] = np.array([root_stress(gear_pair) for gear_pair in wheels]) / stress
        iso = [blank_factor(gear_pair.teeth_profiles[1]) for gear_pair in wheels]
        for name, values in (("C_R", stiffer[web]), ("C_R of ISO", iso), ("Y_B", stressed[web])):
            print(f"b_s/b {web:3.1f} {name:10}", " ".join(f"{value:6.3f}" for value in values))
    discs = [held(float(rim)) for rim in RIMS]
    at_bore = (
        np.array([stiffness(gear_pair) for gear_pair in discs]) / stiff,
        np.array([root_stress(gear_pair) for gear_pair in discs]) / stress,
    )
    for name, row in (
        ("C_R", at_bore[0]),
        ("Y_B", at_bore[1]),
        ("Y_B of ISO", [rim_factor(r) for r in RIMS]),
    ):
        print(f"held at bore {name:10}", " ".join(f"{value:6.3f}" for value in row))
    save({"blanks": drawn(stiffer, stressed, at_bore)})


if __name__ == "__main__":
    main()
