"""The dry contact of two cylinders: H. Hertz (1881); K. L. Johnson, Contact Mechanics (1985), section 4.2(c)."""

import warnings

import numpy as np
import pytest

from base import RangeWarning
from ehl import LineContact, Lubricant, hertz_approach, solve

OIL = Lubricant(viscosity=0.05, pressure_viscosity=2e-8)


def test_a_thin_film_leaves_the_pressure_of_the_dry_contact():
    deviations, separations = [], []
    for u in (1e-1, 1e-2, 1e-3):
        contact = LineContact(2e5, u, 0.01, 2.2e11, OIL)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            film = solve(contact, nodes=257)
        b = contact.half_width
        inner = np.abs(film.x) < 0.8 * b
        hertz = contact.peak_pressure * np.sqrt(1 - (film.x[inner] / b) ** 2)
        deviations.append(np.max(np.abs(film.pressure[inner] - hertz)) / contact.peak_pressure)
        separations.append(film.separation * contact.radius / b**2)
    assert deviations[2] < 2e-3
    assert deviations[0] > 2 * deviations[1] > 4 * deviations[2]
    assert separations[2] < 2e-3
    assert separations[0] > 3 * separations[1] > 9 * separations[2]


def test_the_scale_of_the_separation_is_the_dry_approach():
    contact = LineContact(2e5, 1e-3, 0.01, 2.2e11, OIL)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(contact, nodes=257)
    # the dry approach is hundreds of films: none of it may be left in the separation
    assert hertz_approach(contact) > 100 * film.central_thickness
    assert film.separation == pytest.approx(1.12 * film.central_thickness, rel=0.02)
