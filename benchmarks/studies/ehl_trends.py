"""How film, neck and pressure spike answer to speed, load and oil: the trends that papers on gears report.

About the pitch point of a spur-gear pair (443 N/mm, 2.58 m/s, R = 6.48 mm, E' = 220 GPa, eta0 = 0.075 Pa s, alpha =
19.6 /GPa), one quantity at a time. Run with ``OPENBLAS_NUM_THREADS=1 python benchmarks/studies/ehl_trends.py``;
takes about 10 s. With the supply held in two ways it also prints what a film yields when it starves.
"""

from __future__ import annotations

import warnings
from dataclasses import replace

from base import RangeWarning
from ehl import DEFINITIONS, Film, LineContact, Lubricant, Meniscus, OilLayer, solve

OIL = Lubricant(viscosity=0.075, pressure_viscosity=19.6e-9, density=910.0)
PITCH = LineContact(load=4.434e5, entrainment=2.579, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=OIL)
FACE = 0.04
STUDIES = {
    "speed [rpm]": {n: replace(PITCH, entrainment=2.579 * n / 2000) for n in (1500, 2000, 2500)},
    "torque [N m]": {T: replace(PITCH, load=4.434e5 * T / 600) for T in (100, 200, 500)},
    "eta0 [Pa s]": {v: replace(PITCH, lubricant=replace(OIL, viscosity=v)) for v in (0.04, 0.08, 0.12)},
    "alpha [1/GPa]": {
        a: replace(PITCH, lubricant=replace(OIL, pressure_viscosity=1e-9 * a)) for a in (19.6, 22.6, 32.6)
    },
}


def line(film: Film) -> str:
    b, p_H, tip = film.contact.half_width, film.contact.peak_pressure, film.spike
    shape = f"{1e6 * film.central_thickness:8.4f}{1e6 * film.minimum_thickness:8.4f}"
    shape += f"{film.minimum_position / b:9.4f}{film.outlet / b:8.4f}"
    if tip is None:
        return shape + "   no spike"
    return (
        shape + f"{tip.pressure / 1e9:8.3f}{tip.pressure / p_H:8.3f}{tip.position / b:9.4f}{tip.error:9.1e}"
    )


def trends() -> None:
    for study, contacts in STUDIES.items():
        heads = f"{'h_cen um':>8}{'h_min':>8}{'neck x/b':>9}{'end':>8}"
        print(f"\n{study:15}{heads}{'spike GPa':>10}{'/p_H':>6}{'x/b':>9}{'error':>9}")
        for value, contact in contacts.items():
            film = solve(contact, spike=0.01)
            if not film.converged:  # narrower than grids resolve; the film does not feel it
                film = replace(solve(contact, tolerance=1e-3), spike=None)
                print(f"{value:<15}{line(film).replace('no spike', 'spike not resolved')}")
                continue
            print(f"{value:<15}{line(film)}")


def supplies() -> None:
    flooded = solve(PITCH)
    print(f"\nflooded: {1e-9 * FACE * flooded.stiffness():.0f} N/nm at a face of 40 mm (approach)")
    print(
        f"{'h_cen/flooded':14}{'h_min um':>9}{'layer um':>9}{'x_in/b':>8}{'meniscus held':>15}{'layer held':>12}"
    )
    for share in (0.9, 0.81, 0.51, 0.3, 0.14, 0.05, 0.02):
        layer = solve(PITCH, supply=OilLayer(share * flooded.flow))
        meniscus = solve(PITCH, supply=Meniscus(layer.inlet))
        ratio = layer.central_thickness / flooded.central_thickness
        place = layer.inlet / PITCH.half_width
        both = (1e-9 * FACE * f.stiffness() for f in (meniscus, layer))
        print(
            f"{ratio:<14.3f}{1e6 * layer.minimum_thickness:9.4f}{1e6 * layer.flow:9.4f}{place:8.4f}"
            + "".join(f"{k:13.1f}" for k in both)
        )


def main() -> None:
    warnings.simplefilter("ignore", RangeWarning)
    trends()
    supplies()
    print("\nfilm stiffness at a face of 40 mm by every definition [N/m]")
    film = solve(PITCH, tolerance=1e-3)
    for definition in DEFINITIONS:
        print(f"{definition:18}{FACE * film.stiffness(definition):10.3e}")


if __name__ == "__main__":
    main()
