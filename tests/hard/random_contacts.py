"""Random line contacts for hard cases, and what a refused film has to be."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ehl import Film, LineContact, Lubricant


def refused(film: Film) -> str:
    """Hold a film without a solution to having no figures; give its message."""
    assert not film.converged
    assert math.isnan(film.central_thickness)
    assert math.isnan(film.minimum_thickness)
    assert math.isnan(film.stiffness("tangent"))
    return film.message


def random_contact(rng: np.random.Generator) -> LineContact:
    """Return a contact of p_H 0.2 to 3 GPa, u 0.05 to 30 m/s, R 2 to 50 mm, eta0 0.005 to 0.5, alpha 10 to 30 /GPa."""
    while True:
        viscosity, alpha = np.exp(rng.uniform(np.log(0.005), np.log(0.5))), rng.uniform(10e-9, 30e-9)
        oil = Lubricant(viscosity, alpha)
        radius = np.exp(rng.uniform(np.log(2e-3), np.log(50e-3)))
        load = 2 * np.pi * radius * rng.uniform(0.2e9, 3e9) ** 2 / 2.2e11
        contact = LineContact(load, np.exp(rng.uniform(np.log(0.05), np.log(30))), radius, 2.2e11, oil)
        if 0.2 <= oil.z <= 1 and contact.moes_L <= 25:
            return contact


def random_gear_contact(rng: np.random.Generator) -> LineContact:
    """Return a sliding contact of gears: p_H 0.3 to 2 GPa, u 0.5 to 30 m/s, sliding 0 to 1.5 u either way.

    Oils of VG 32 to 680 at 40 to 120 degC, mineral, with the slope of their grade; Eyring stress 5 to 10 MPa.
    """
    grade = int(rng.choice([32, 46, 68, 100, 150, 220, 320, 460, 680]))
    temperature = 273.15 + rng.uniform(40.0, 120.0)
    oil, warmer = (Lubricant.from_iso_vg(grade, temperature + d) for d in (0.0, 2.0))
    oil = replace(
        oil,
        temperature=temperature,
        viscosity_slope=0.5 * math.log(oil.viscosity / warmer.viscosity),
        eyring_stress=rng.uniform(5e6, 10e6),
    )
    radius = np.exp(rng.uniform(np.log(3e-3), np.log(50e-3)))
    load = 2 * np.pi * radius * rng.uniform(0.3e9, 2e9) ** 2 / 2.26e11
    speed = np.exp(rng.uniform(np.log(0.5), np.log(30.0)))
    return LineContact(load, speed, radius, 2.26e11, oil, sliding=rng.uniform(-1.5, 1.5) * speed)
