"""Films with heat of random gear contacts: how many are solved, and their errors against a grid twice as fine.

    python benchmarks/studies/thermal_errors.py [contacts] [seed]

Every fourth contact is solved again on twice as many cells as its estimate asked for.
"""

from __future__ import annotations

import sys
import warnings

import numpy as np

from base import RangeWarning
from ehl import ThermalFilm, solve_thermal
from tests.hard.random_contacts import random_gear_contact

FIGURES = (
    ("central film", "central_thickness", lambda film: film.error),
    ("least film", "minimum_thickness", lambda film: film.error),
    ("traction", "traction_coefficient", lambda film: film.traction_error),
    ("oil temperature", "oil_temperature_rise", lambda film: film.temperature_error),
    ("surface temperature", "surface_temperature_rise", lambda film: film.temperature_error),
)


def ratios(film: ThermalFilm, finer: ThermalFilm) -> list[tuple[float, float]]:
    """Error against the finer grid, and estimate, of every figure."""
    found = []
    for _, name, estimate in FIGURES:
        exact = getattr(finer, name)
        floor = 1.0 if "temperature" in name else 1e-4 if "traction" in name else 0.0
        found.append((abs(getattr(film, name) - exact) / max(abs(exact), floor), estimate(film)))
    return found


def study(contacts: int, seed: int) -> None:
    """Print what is solved, in what time, and how errors and estimates compare."""
    rng = np.random.default_rng(seed)
    rows, seconds, iterations, lost = [], [], [], []
    for k in range(contacts):
        contact = random_gear_contact(rng)
        oil = contact.lubricant
        heat = oil.viscosity * oil.viscosity_slope * contact.entrainment**2 / oil.conductivity
        film = solve_thermal(contact)
        seconds.append(film.cost.seconds)
        iterations.append(film.cost.iterations)
        if not film.converged:
            lost.append((k, heat, contact, film.message))
        elif k % 4 == 0:
            finer = solve_thermal(contact, nodes=2 * film.x.size - 1)
            if finer.converged:
                rows.append((k, ratios(film, finer), film.x.size))
            else:
                print(f"{k}: the grid twice as fine failed: {finer.message}")
    hot = sum(heat > 10.0 for _, heat, _, _ in lost)
    print(f"solved {contacts - len(lost)} of {contacts}; of the others {hot} with eta0 beta u^2/k above 10")
    print(
        f"seconds: median {np.median(seconds):.3f}, 95 % {np.quantile(seconds, 0.95):.3f}, most {max(seconds):.2f}"
    )
    for k, heat, contact, message in lost:
        print(
            f"  {k}: p_H {contact.peak_pressure / 1e9:.2f} GPa, u {contact.entrainment:.1f}, "
            f"sliding {contact.sliding / contact.entrainment:.2f} u, eta0 {contact.lubricant.viscosity:.3f}, "
            f"heat {heat:.2g}, M {contact.moes_M:.0f}, L {contact.moes_L:.1f}: {message}"
        )
    for j, (label, _, _) in enumerate(FIGURES):
        errors, estimates = np.array([row[1][j] for row in rows]).T
        covered = np.mean(estimates >= errors)
        print(
            f"{label}: estimate at least the error {100 * covered:.0f} %, error median {np.median(errors):.1e}, "
            f"most {errors.max():.1e}; estimate median {np.median(estimates):.1e}"
        )
        for (k, _, n), error, estimate in zip(rows, errors, estimates, strict=True):
            if error > estimate:
                print(f"    {k} ({n} nodes): error {error:.2e}, estimate {estimate:.2e}")


if __name__ == "__main__":
    warnings.simplefilter("ignore", RangeWarning)
    study(*(int(v) for v in (sys.argv[1:] + ["400", "1"][len(sys.argv) - 1 :])))
