"""Draws what the article shows in its sections 2 to 4, and prints our numbers: python docs/article_figures.py.

The films over speed, torque, viscosity and pressure-viscosity coefficient are drawn by docs/film_pictures.py, the
motions of section 6 by examples/motion/article.py.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from runs import example, save

import ehl
from flankfilm import figures
from flankfilm.figures.panels import PATH_LABEL, curves
from flankfilm.figures.reading import Reading
from flankfilm.figures.style import from_zero, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

OIL = ehl.Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)
CONTACT = ehl.LineContact(load=1e5, entrainment=1.0, radius=0.015, reduced_modulus=2.2e11, lubricant=OIL)


def contact() -> Figure:
    """Pressure and film of the single contact of section 2, on the article's grid and on one that follows it."""
    films = {
        "130 equal nodes, -4 to 1.2": ehl.solve(CONTACT, grid="article"),
        "grid around the spike": ehl.solve(CONTACT, tolerance=0.005, spike=0.01),
    }
    with sheet(None, 2, height=4.4) as (drawn, (upper, lower)):
        for (label, film), look, mark in zip(films.items(), looks(2), (".", ""), strict=True):
            x = film.x / CONTACT.half_width
            upper.plot(x, 1e-9 * film.pressure, label=label, marker=mark, markersize=4, **look)
            lower.plot(x, 1e6 * film.thickness, marker=mark, markersize=4, **look)
            thickness = (
                f"h_c {1e6 * film.central_thickness:.4f} um, h_min {1e6 * film.minimum_thickness:.4f} um"
            )
            after = film.x > 0.5 * CONTACT.half_width
            print(f"contact, {label}: {thickness}, spike {1e-9 * film.pressure[after].max():.3f} GPa")
        upper.set(ylabel="pressure [GPa]")
        from_zero(upper)
        lower.set(xlabel="distance from the line of centres [half-widths]", ylabel="film thickness [µm]")
        lower.set(xlim=(-2.0, 1.3), ylim=(0.0, 3e6 * film.central_thickness))
    return drawn


def deflection() -> Figure:
    """The five parts of Ishikawa's deflection of one pair under the whole force of 600 N m."""
    from gears import Gear, GearPair, Material, closed_form

    steel = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
    pair = GearPair(Gear(36), Gear(40), module=2e-3, face_width=0.04, material=steel)
    path, force = pair.path_of_contact(n=81), pair.normal_force(600.0)
    parts = {
        name.replace("_", " "): Reading(1e6 * force * compliance, "deflection of one pair", "µm")
        for name, compliance in closed_form.ishikawa(pair, path).parts.items()
    }
    for name, part in parts.items():
        print(f"deflection, {name}: {part.values[40]:.2f} um at C, {part.values[0]:.2f} um at A")
    with sheet(height=3.4, legend=5) as (drawn, (axes,)):
        curves(axes, 1e3 * path.position, parts)
        axes.set(xlabel=PATH_LABEL)
        from_zero(axes)
    return drawn


def report(name: str, results: xr.Dataset) -> None:
    """Print the numbers that docs/validation/article_figures.md compares."""
    face = 1e-9 / float(results.pair_face_width)
    dry, wet = results.dry_secant_stiffness.values, results.lubricated_secant_stiffness.values
    share = results.dry_load_share.values
    alone = np.nanmax(share, axis=1) > 0.9
    change = 100 * (wet / dry - 1)
    print(f"{name}: dry mean {face * dry.mean():.3f}, with film {100 * (wet.mean() / dry.mean() - 1):+.3f} %")
    print(
        f"{name}: one pair {face * dry[alone].mean():.2f}, two pairs {face * dry[~alone].mean():.2f} N/(mm um), "
        f"change {change[alone].mean():+.2f} and {change[~alone].mean():+.2f} %"
    )
    for curve, values in (("dry", dry), ("with film", wet)):
        spectrum = 2 * np.abs(np.fft.rfft(values)) / values.sum()
        print(f"{name}, {curve}: harmonics {', '.join(f'{h:.4f}' for h in spectrum[1:4])} of the mean")
    for definition in (n for n in results.data_vars if str(n).startswith("film_stiffness_")):
        k = results[definition].values
        print(f"{name}: {definition} {k.min():.3g} to {k.max():.3g} N/m")


def main() -> None:
    """Write docs/images/article_*.png."""
    ours, theirs = example("article"), example("independent_pairs")
    report("finite elements, solved film", ours)
    report("Ishikawa, formula for the film", theirs)
    save(
        {
            "article_contact": contact(),
            "article_deflection": deflection(),
            "article_kinematics": figures.kinematics(ours),
            "article_film_stiffness": figures.film_stiffness(ours),
            "article_series": figures.film_changes(theirs),
            "article_fourier": figures.fourier(theirs),
            "article_fourier_fem": figures.fourier(ours),
        },
        dpi=100,
    )


if __name__ == "__main__":
    main()
