"""A contact that gets less and less oil: the films, and how near the oil has to come."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.figure import Figure
from page import from_zero, legend_over, picture, sheet

from ehl import LineContact, Lubricant, Meniscus, OilLayer, solve
from gears import STEEL, Gear, GearPair

OIL = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
LAYERS = (0.9, 0.6, 0.3)  # over the flow that a flooded contact takes


def draw() -> Figure:
    """Films of thin oil layers at C of a pair at 200 N m and 2000 rpm, and the film over the place of the meniscus."""
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3, material=STEEL)
    at_c = pair.path_at(pair.points.C)
    contact = LineContact(
        load=pair.normal_force(200.0) / pair.face_width,
        entrainment=at_c.entrainment(2000 * math.pi / 30).item(),
        radius=at_c.radius.item(),
        reduced_modulus=pair.reduced_modulus,
        lubricant=OIL,
    )
    flooded, width = solve(contact), contact.half_width
    whole = flooded.central_thickness
    print(f"flooded: central film {1e6 * whole:.3f} um ± {100 * flooded.error:.1g} %")
    layers = [solve(contact, supply=OilLayer(part * flooded.flow)) for part in LAYERS]

    ahead = np.geomspace(0.005, 8.0, 27)  # half-widths from the edge of the dry contact
    near = [solve(contact, supply=Meniscus(-(1 + far) * width)) for far in ahead.tolist()]
    central = np.array([film.central_thickness for film in near]) / whole
    print(f"starved films: ± {100 * max(film.error for film in (*layers, *near)):.1g} %")
    for wanted in (0.9, 0.5):
        far = math.exp(np.interp(wanted, central, np.log(ahead)))
        gap = 1e6 * far * width
        print(
            f"central film {wanted:.1f} of the flooded one: meniscus {far:.3f} half-widths ahead, {gap:.0f} um"
        )

    with sheet(columns=2, height=3.4, legend=0) as (drawn, (profile, starved)):
        for part, film in zip(("flooded", *LAYERS), (flooded, *layers), strict=True):
            profile.plot(
                film.x / width, 1e6 * film.thickness, label=part if part == "flooded" else f"layer {part}"
            )
        profile.set(xlim=(-2.0, 1.2), ylim=(0.0, 2.5e6 * whole))
        profile.set(xlabel="distance from C [half-widths]", ylabel="film thickness [µm]")
        legend_over(profile, 2)
        starved.semilogx(ahead, central, label="solved")
        starved.set(xlabel="dry contact to meniscus [half-widths]")
        starved.set(ylabel="central film over the flooded one [-]")
        from_zero(starved)
    return drawn


if __name__ == "__main__":
    picture(draw, __file__)
