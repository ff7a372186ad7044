"""Transverse sections of z 36/40, m_n 2 mm, b 40 mm at three helix angles, computed by an independent program."""

from __future__ import annotations

import math

import pytest

from gears import Gear, GearPair, closed_form

# beta: a, beta_b, r_b1, p_bt, A, C, E (rho1), eps_alpha, eps_beta, c'_th, c_gamma_alpha
TABLE = {
    10: (77.1724, 9.3913, 34.28850, 5.98447, 7.65517, 12.67252, 17.62992, 1.66677, 1.10548, 17.376, 20.022),
    20: (80.8775, 18.7472, 35.72426, 6.23506, 8.94720, 13.83704, 18.67365, 1.55996, 2.17737, 17.761, 18.485),
    30: (87.7572, 28.0243, 38.32229, 6.68850, 11.44042, 16.10596, 20.72870, 1.38869, 3.18310, 18.350, 16.009),
}
DIGITS = (4, 4, 5, 5, 5, 5, 5, 5, 5, 3, 3)


@pytest.mark.parametrize("degrees", TABLE)
def test_every_printed_digit(degrees):
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, helix_angle=math.radians(degrees))
    points, stiffness = pair.points, closed_form.iso6336(pair)
    computed = (
        1e3 * pair.working_centre_distance,
        math.degrees(pair.base_helix_angle),
        1e3 * pair.base_radii[0],
        1e3 * pair.base_pitch,
        *(1e3 * rho for rho in (points.A, points.C, points.E)),
        pair.contact_ratio,
        pair.overlap_ratio,
        stiffness.c_th,
        stiffness.c_gamma,
    )
    for value, wanted, digits in zip(computed, TABLE[degrees], DIGITS, strict=True):
        assert value == pytest.approx(wanted, abs=0.51 * 10.0**-digits)


def test_axial_force_at_20_degrees():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, helix_angle=math.radians(20.0))
    assert pair.axial_force(600.0) == pytest.approx(5700.0, rel=1e-3)
