"""A steel pinion and a plastic wheel: contacts that move as the teeth deflect, against contacts that stay."""

from __future__ import annotations

from matplotlib.figure import Figure
from page import looks, picture, sheet

import fem
from gears import Gear, GearPair, Material

STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
PA66 = Material(youngs_modulus=3e9, poisson_ratio=0.4, density=1140.0)
TORQUES = (2.0, 5.0, 8.0)  # N m, of the pinion


def draw() -> Figure:
    """Mesh stiffness over a base pitch with moving contacts, and what it changes against contacts that stay."""
    pair = GearPair(Gear(17), Gear(51), module=2e-3, face_width=20e-3, material=(STEEL, PA66))
    pair = pair.with_backlash(0.2e-3)
    bodies = fem.compliance(pair)
    moving, staying = (
        fem.mesh_cycle(
            pair, TORQUES, positions=200, compliance=bodies, moving_contact=moves, reference="bore"
        )
        for moves in (True, False)
    )
    scale = 1e-9 / pair.face_width  # N/m to N/(mm um)
    with sheet(rows=2, height=4.6) as (drawn, (stiffness, change)):
        for torque, cycle, other, look in zip(TORQUES, moving, staying, looks(3), strict=True):
            off = 100 * (cycle.secant_stiffness / other.secant_stiffness - 1)
            stiffness.plot(cycle.position, scale * cycle.secant_stiffness, label=f"{torque:.0f} N m", **look)
            change.plot(cycle.position, off, **look)
            mean = scale * cycle.mean_secant_stiffness
            error = 100 * cycle.errors["mean_secant_stiffness"]
            print(
                f"{torque:.0f} N m, deflection {1e6 * cycle.transmission_error.max():.0f} um: "
                f"mean {mean:.4f} N/(mm um) ± {error:.1g} %, model of the contacts ± {100 * cycle.model_error:.1g} %\n"
                "  against contacts that stay: "
                f"{100 * (cycle.mean_secant_stiffness / other.mean_secant_stiffness - 1):+.2f} % in the mean, "
                f"{off.min():+.1f} to {off.max():+.1f} % over the pitch"
            )
        left_open = 100 * moving[-1].model_error
        change.axhspan(-left_open, left_open, color="#dddddd", linewidth=0)
        stiffness.set(ylabel="mesh stiffness\n[N/(mm µm)]")
        change.set(
            xlabel="position of the wheel after A [base pitches]", ylabel="change by the\nmoving contact [%]"
        )
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
