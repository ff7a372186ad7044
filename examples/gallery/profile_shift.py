"""How stiff a mesh is over the profile shift of its gears, by finite elements and by ISO 6336-1."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from page import looks, picture, sheet

import fem
from gears import STEEL, Gear, GearPair, closed_form

TORQUE, WIDTH = 600.0, 40e-3  # N m, m
PER_MM_UM = 1e-9 / WIDTH  # N/m to N/(mm um)
SHIFTS = np.linspace(0.0, 0.6, 7)  # of the pinion, x1
WAYS = {"x2 = x1": 1.0, "x2 = -x1, centre distance kept": -1.0}


def pair_of(shift: float, way: float) -> GearPair:
    """Gears of 36 and 40 teeth, module 2 mm, without backlash."""
    pinion, wheel = Gear(36, profile_shift=shift), Gear(40, profile_shift=way * shift)
    return GearPair(pinion, wheel, module=2e-3, face_width=WIDTH, material=STEEL)


def draw() -> Figure:
    """Mean mesh stiffness and contact ratio over the profile shift of the pinion."""
    with sheet(rows=2, height=4.6, legend=2) as (drawn, (stiffness, ratio)):
        for (name, way), look in zip(WAYS.items(), looks(2), strict=True):
            pairs = [pair_of(x, way) for x in SHIFTS.tolist()]
            # closed forms measure the deflection between the root circles, so the finite elements do it here
            cycles = [fem.mesh_cycle(pair, TORQUE, reference="teeth") for pair in pairs]
            mean = [PER_MM_UM * cycle.mean_secant_stiffness for cycle in cycles]
            iso = [closed_form.iso6336(pair, force=pair.normal_force(TORQUE)).c_gamma for pair in pairs]
            stiffness.plot(SHIFTS, mean, marker="o", markersize=4, label=f"finite elements, {name}", **look)
            stiffness.plot(SHIFTS, iso, linewidth=0.8, label=f"ISO 6336-1, {name}", **look)
            ratio.plot(SHIFTS, [pair.contact_ratio for pair in pairs], **look)
            error = 100 * max(cycle.errors["mean_secant_stiffness"] for cycle in cycles)
            for at in (0, -1):
                print(
                    f"{name}, x1 = {SHIFTS[at]:.1f}: {mean[at]:.2f} N/(mm um) ± {error:.1g} %, "
                    f"ISO 6336-1 {iso[at]:.1f}, contact ratio {pairs[at].contact_ratio:.3f}"
                )
            print(
                f"  by the shift: {100 * (mean[-1] / mean[0] - 1):+.1f} %, ISO {100 * (iso[-1] / iso[0] - 1):+.1f} %"
            )
        stiffness.set(ylabel="mean mesh stiffness\n[N/(mm µm)]")
        ratio.set(xlabel="profile shift of the pinion x1 [-]", ylabel="contact ratio [-]")
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
