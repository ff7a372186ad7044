"""Flash temperature: Blok's theory by another route, the integral method at E, zero at C, and faults."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base import InputError
from gears import Gear, GearPair, peak_pressure
from gears.rating import flash_temperature
from gears.rating.scuffing import contact_coefficients

LOAD, SPEED, MU, BULK = 420e3, 209.44, 0.06, 353.15


def pair_of(helix=0.0):
    return GearPair(Gear(24, 0.3), Gear(51, 0.1), 3e-3, 30e-3, helix_angle=helix)


def flash_of(pair, places, **more):
    given = {"friction": MU, "temperature": BULK, "rho1": places, "share": np.ones(len(places))}
    return flash_temperature(pair, LOAD, SPEED, **(given | more))


def test_it_is_bloks_temperature_of_hertzian_contacts():
    """1.11 mu w |u1 - u2|/[(B1 sqrt(u1) + B2 sqrt(u2)) sqrt(2 b)], w the normal force, b Hertz's half-width.

    Constants of the standard, 0.51 and 1.22, are rounded: within 0.2 %.
    """
    pair = pair_of()
    places = np.linspace(pair.points.A, pair.points.E, 9)
    found = flash_of(pair, places).theta_fl
    force = LOAD / math.cos(pair.transverse_pressure_angle)
    rho2 = pair.line_of_action - places
    radius = places * rho2 / pair.line_of_action
    pressure = np.array([peak_pressure(force, float(R), pair.reduced_modulus) for R in radius])
    half_width = 2.0 * force / (math.pi * pressure)
    u1, u2 = SPEED * places, SPEED * pair.base_radii[0] / pair.base_radii[1] * rho2
    B = contact_coefficients(pair)[0]
    blok = 1.11 * MU * force * np.abs(u1 - u2) / (B * (np.sqrt(u1) + np.sqrt(u2)) * np.sqrt(2.0 * half_width))
    assert found == pytest.approx(blok, rel=2e-3)


def test_no_flash_at_the_pitch_point_and_the_bulk_adds():
    pair = pair_of(0.2)
    found = flash_of(pair, [pair.points.C, pair.points.E])
    assert found.theta_fl[0] == pytest.approx(0.0, abs=1e-9)
    assert found.theta_B == pytest.approx(BULK + found.theta_fl)
    assert found.theta_Bmax == found.theta_B[1]


def test_it_rises_with_the_share():
    pair = pair_of()
    half, whole = (flash_of(pair, [pair.points.E], share=[s]).theta_fl[0] for s in (0.5, 1.0))
    assert half == pytest.approx(0.5**0.75 * whole)


def test_faults_are_listed_together():
    pair = pair_of()
    with pytest.raises(InputError) as caught:
        flash_of(pair, [0.0, pair.points.C], share=[2.0, 1.0], friction=-0.1)
    assert {f.where for f in caught.value.faults} == {"rho1", "share", "friction"}
