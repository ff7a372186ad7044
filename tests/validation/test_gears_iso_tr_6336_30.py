"""ISO/TR 6336-30, example 1, as an open program quotes it: z 17/103, m_n 8 mm, beta 15.8 degrees, a 500 mm.

c_gamma of the source is 1.5e-4 smaller: its contact ratio, 1.5491, is rounded, while these gears have 1.5493. The exact
one is used.
"""

from __future__ import annotations

import math

import pytest

from gears import BasicRack, Gear, GearPair, closed_form


@pytest.fixture(scope="module")
def pair() -> GearPair:
    rack = BasicRack(h_aP=1.0, h_fP=1.4, rho_fP=0.39)
    beta = math.radians(15.8)
    return GearPair(Gear(17, 0.145), Gear(103), 8e-3, 0.1, rack, centre_distance=0.5, helix_angle=beta)


def test_geometry(pair):
    assert math.degrees(pair.transverse_pressure_angle) == pytest.approx(20.7197, abs=5.1e-5)
    assert math.degrees(pair.working_pressure_angle) == pytest.approx(21.0661, abs=5.1e-5)
    assert math.degrees(pair.base_helix_angle) == pytest.approx(14.8245, abs=5.1e-5)
    assert 2e3 * pair.base_radii[0] == pytest.approx(132.1986, abs=5.1e-5)
    assert 2e3 * pair.base_radii[1] == pytest.approx(800.9678, abs=5.1e-5)
    assert pair.overlap_ratio == pytest.approx(1.0834, abs=5.1e-5)
    assert pair.contact_ratio == pytest.approx(1.5493, abs=5.1e-5)
    assert pair.helix.virtual_teeth(17) == pytest.approx(18.905, abs=5.1e-4)
    assert pair.helix.virtual_teeth(103) == pytest.approx(114.543, abs=5.1e-4)


def test_stiffness(pair):
    stiffness = closed_form.iso6336(pair)
    assert stiffness.c_th == pytest.approx(17.85584, abs=5.1e-6)
    assert stiffness.c_prime == pytest.approx(12.37047, abs=5.1e-6)
    assert stiffness.c_gamma == pytest.approx(17.4672, abs=5.1e-5)
    assert stiffness.c_gamma_beta == pytest.approx(14.8471, abs=5.1e-5)
    with_their_ratio = stiffness.c_prime * (0.75 * 1.5491 + 0.25)
    assert with_their_ratio == pytest.approx(17.46485, abs=5e-4)  # 1.5491 has four digits
    assert 0.85 * with_their_ratio == pytest.approx(14.84512, abs=5e-4)


def test_contact_factors(pair):
    factors = closed_form.iso6336_2(pair, force=1e4)
    assert pytest.approx(2.39533, abs=5.1e-6) == factors.Z_H
    assert factors.Z_eps == pytest.approx(0.803, abs=5.1e-4)
    assert factors.Z_beta == pytest.approx(1.01944, abs=5.1e-6)
