"""Trends that a published study of spur gears states for its film, about the pitch point of its pair.

Speed 1500, 2000, 2500 rpm; torque 100, 200, 500 N m; viscosity 0.04, 0.08, 0.12 Pa s; pressure-viscosity 19.6, 22.6,
32.6 /GPa. Its figures are not read off: only the directions it puts in words are checked.
"""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import RangeWarning
from ehl import solve
from tests.validation.article import OIL, PITCH


def films(contacts, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        found = [solve(contact, **options) for contact in contacts]
    assert all(film.converged for film in found)
    return found


def rising(values):
    return bool((np.diff(values) > 0).all())


@pytest.fixture(scope="module")
def speeds():
    return films([replace(PITCH, entrainment=2.579 * n / 2000) for n in (1500, 2000, 2500)], spike=0.03)


def test_speed_thickens_the_film_and_moves_the_spike_to_the_inlet(speeds):
    assert rising([f.minimum_thickness for f in speeds])
    assert rising([-f.spike.position / f.contact.half_width for f in speeds])
    assert rising([f.spike.pressure for f in speeds])


def test_torque_raises_the_spike_and_thins_the_film():
    found = films([replace(PITCH, load=4.434e5 * T / 600) for T in (100, 200, 500)], spike=0.03)
    assert rising([-f.minimum_thickness for f in found])
    assert rising([f.spike.pressure for f in found])
    # over the Hertz pressure, which figures of such studies show, the spike falls
    assert rising([-f.spike.pressure / f.contact.peak_pressure for f in found])


def test_viscosity_raises_spike_film_and_neck_and_moves_the_spike_from_the_outlet():
    contacts = [replace(PITCH, lubricant=replace(OIL, viscosity=v)) for v in (0.04, 0.08, 0.12)]
    found = films(contacts, spike=0.03)
    assert rising([f.spike.pressure for f in found])
    assert rising([f.central_thickness for f in found])
    assert rising([f.minimum_thickness for f in found])
    assert rising([f.outlet - f.spike.position for f in found])


def test_pressure_viscosity_thickens_the_film():
    contacts = [
        replace(PITCH, lubricant=replace(OIL, pressure_viscosity=a * 1e-9)) for a in (19.6, 22.6, 32.6)
    ]
    assert rising([f.minimum_thickness for f in films(contacts)])
