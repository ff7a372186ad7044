"""The article's pair (z 36/40, m 2 mm, b 40 mm, 600 N m, E 206 GPa, nu 0.3, bores half the root radii).

Reference: an independent finite-element prototype of the same method (line load split into Flamant's half-plane
and a regular part, curved second-order triangles on the whole annulus; about 7000 unknowns a gear). Its own
numbers carry about a tenth of a per cent; a pair at the pitch point with Hertz's pressure resolved by elements
gives 14.851 N/(mm um) with our code (tests/fem/test_ring.py has that comparison on a smaller gear).
"""

from __future__ import annotations

import numpy as np
import pytest

import fem
from gears import Gear, GearPair
from tests.validation.article import (
    ELEMENTS_AT_C,
    ELEMENTS_MEAN,
    ELEMENTS_MEAN_SECANT,
    ELEMENTS_NINE,
    FORCE,
    PER_MM_UM,
    TORQUE,
)


@pytest.fixture(scope="module")
def bodies(article_pair):
    return fem.compliance(article_pair, tolerance=0.001)


@pytest.fixture(scope="module")
def cycle(article_pair, bodies):
    return fem.mesh_cycle(article_pair, TORQUE, 40, bodies, beyond_path=False, reference="bore")


def test_one_pair_at_nine_points(article_pair, bodies):
    rho1 = np.linspace(article_pair.points.A + 2e-5, article_pair.points.E - 2e-5, 9)
    k = fem.single_pair_stiffness(article_pair, FORCE, rho1, bodies) / PER_MM_UM
    np.testing.assert_allclose(k[1:-1], ELEMENTS_NINE[1:-1], rtol=0.002)
    # 20 um of rho from the tip corner is 8 um from it: there the prototype's own elements count
    np.testing.assert_allclose(k[[0, -1]], [ELEMENTS_NINE[0], ELEMENTS_NINE[-1]], rtol=0.0075)


@pytest.mark.parametrize(("part", "reference"), [(1.0, ELEMENTS_AT_C), (0.5, 14.41), (0.1, 13.53)])
def test_load_dependence_at_the_pitch_point(article_pair, bodies, part, reference):
    k = fem.single_pair_stiffness(article_pair, part * FORCE, [article_pair.points.C], bodies) / PER_MM_UM
    assert k[0] == pytest.approx(reference, rel=0.002)


def test_mean_stiffness(cycle):
    assert cycle.secant_stiffness.mean() / PER_MM_UM == pytest.approx(ELEMENTS_MEAN_SECANT, rel=0.0025)
    assert cycle.stiffness.mean() / PER_MM_UM == pytest.approx(ELEMENTS_MEAN, rel=0.0025)


def test_range_of_stiffness(cycle):
    assert cycle.secant_stiffness.min() / PER_MM_UM == pytest.approx(14.70, rel=0.002)
    assert cycle.secant_stiffness.max() / PER_MM_UM == pytest.approx(21.20, rel=0.0025)


def test_transmission_error(article_pair, bodies, cycle):
    assert np.ptp(cycle.transmission_error) == pytest.approx(9.254e-6, rel=0.002)
    many = fem.mesh_cycle(article_pair, TORQUE, 400, bodies, beyond_path=False, reference="bore")
    assert np.ptp(many.transmission_error) == pytest.approx(9.288e-6, rel=0.002)
    assert many.secant_stiffness.mean() / PER_MM_UM == pytest.approx(19.126, rel=0.0025)
    assert many.stiffness.mean() / PER_MM_UM == pytest.approx(19.771, rel=0.0025)


def test_harmonics_of_the_secant_stiffness(cycle):
    k = cycle.secant_stiffness
    harmonics = 2 * np.abs(np.fft.rfft(k))[1:4] / len(k) / k.mean()
    np.testing.assert_allclose(harmonics[:2], [0.1746, 0.0903], rtol=0.004)
    assert harmonics[2] == pytest.approx(0.0164, abs=2e-4)


@pytest.mark.parametrize("part", [0.2, 0.9])
def test_bore_decides(article_pair, part):
    """8.7 to 20.8 N/(mm um) at the pitch point for bores of 0.2 to 0.9 of the root radius."""
    gears = [Gear(z, bore_radius=part * r) for z, r in ((36, 0.0335), (40, 0.0375))]
    other = GearPair(*gears, 2e-3, 0.04)
    k = fem.single_pair_stiffness(other, FORCE, [other.points.C])[0] / PER_MM_UM
    assert k == pytest.approx({0.2: 8.7, 0.9: 20.8}[part], rel=0.005)


def test_neighbouring_teeth_couple(article_pair, bodies, cycle):
    """Independent pairs added overstate the double zone by 22 % (25.95 against 21.20)."""
    row = int(np.argmax(cycle.secant_stiffness))
    rho1 = cycle.rho1[row]
    alone = fem.single_pair_stiffness(article_pair, 0.5 * cycle.force, rho1, bodies).sum()
    assert alone / cycle.secant_stiffness[row] == pytest.approx(1.22, abs=0.02)
