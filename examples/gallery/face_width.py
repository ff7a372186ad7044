"""Crowning against misalignment: the line load over the face, and the crowning that bears best over a tolerance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure
from page import legend_over, looks, picture, sheet

import fem
from flankfilm.coupling import Flanks, LoadedTeeth, face_load_tolerance
from gears import STEEL, Alignment, Gear, GearPair, Lead

PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, material=STEEL)
TORQUE = 600.0  # N m, of the pinion
TOLERANCE = 10e-6  # m over the face, either way
CROWNINGS = np.linspace(0.0, 16e-6, 9)  # m, of the pinion
SHOWN = (0, 2, 8)  # of these, whose line loads are drawn
CELLS = 48


def crowned(bodies: fem.PairCompliance, crowning: float) -> LoadedTeeth:
    """The pair with a crowned pinion, and gears between walls: quicker than free ends."""
    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(crowning=crowning)))
    flanks = Flanks(cells=CELLS, face_model="walls")
    return LoadedTeeth(pair, TORQUE, compliance=replace(bodies, pair=pair), flanks=flanks)


def draw() -> Figure:
    """Line load at the pitch point with the axes out of parallel; face-load factor over the crowning."""
    bodies = fem.compliance(PAIR)
    factors = []
    with sheet(rows=2, height=4.8, legend=0, sharex=False) as (drawn, (load, factor)):
        styles = iter(looks(3))
        for k, crowning in enumerate(CROWNINGS.tolist()):
            teeth = crowned(bodies, crowning)
            tolerance = face_load_tolerance(teeth, TOLERANCE, positions=24)
            factors.append(tolerance.face_load_factor)
            if k in SHOWN:
                setting = {**teeth.setting, "alignment": Alignment(TOLERANCE)}
                cycle = fem.mesh_cycle(teeth.pair, TORQUE, 1, **setting)
                line = cycle.line_load[0].max(axis=0)
                label = f"crowning {1e6 * crowning:.0f} µm"
                load.plot(1e3 * cycle.face_position, 1e-3 * line, label=label, **next(styles))
                factor_in_line, worst = tolerance.face_load_factor[1], tolerance.robust_face_load_factor
                print(
                    f"crowning {1e6 * crowning:.0f} um: {factor_in_line:.3f} in line, {worst:.3f} "
                    f"with {1e6 * TOLERANCE:.0f} um ± {100 * tolerance.error:.1g} %"
                )
        meant, robust = np.array(factors)[:, 1], np.max(factors, axis=1)
        for name, values, look in zip(
            ("axes in line", "10 µm out of parallel"), (meant, robust), looks(2), strict=True
        ):
            factor.plot(1e6 * CROWNINGS, values, label=name, **look)
        best = int(np.argmin(robust))
        print(f"best of these: {1e6 * CROWNINGS[best]:.0f} um, {robust[best]:.3f}")
        factor.plot(1e6 * CROWNINGS[best], robust[best], "o", color="k", markersize=4)
        load.set(xlabel="place on the face [mm]", ylabel="line load [N/mm]")
        factor.set(xlabel="crowning of the pinion [µm]", ylabel="maximum face-load\nfactor [-]")
        for axes in (load, factor):
            legend_over(axes, 3)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
