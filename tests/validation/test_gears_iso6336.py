"""Tooth stiffness of ISO 6336-1: worked values of published sources.

z 17/43: c'_th 16.032, c' 12.505, c_gamma 18.330 N/(mm um); the article's pair, z 36/40: 17.242, 13.449, 20.540.
"""

from __future__ import annotations

import pytest

from gears import Gear, GearPair, closed_form


@pytest.mark.parametrize(
    ("z1", "z2", "c_th", "c_prime", "c_gamma"),
    [(17, 43, 16.032, 12.505, 18.330), (36, 40, 17.242, 13.449, 20.540)],
)
def test_worked_values(z1, z2, c_th, c_prime, c_gamma):
    found = closed_form.iso6336(GearPair(Gear(z1), Gear(z2), 2e-3, 40e-3))
    assert found.c_th == pytest.approx(c_th, abs=6e-4)
    assert found.c_prime == pytest.approx(c_prime, abs=6e-4)
    assert found.c_gamma == pytest.approx(c_gamma, abs=6e-4)
    turned = closed_form.iso6336(GearPair(Gear(z2), Gear(z1), 2e-3, 40e-3))
    assert turned.c_gamma == pytest.approx(found.c_gamma, rel=1e-12)


def test_shifts_enter_term_by_term():
    """q' of the standard's polynomial, its terms written out for x1 = 0.4, x2 = 0.15, z 20/50."""
    terms = [0.04723, 0.15551 / 20, 0.25791 / 50, -0.00635 * 0.4, -0.11654 * 0.4 / 20]
    terms += [-0.00193 * 0.15, -0.24188 * 0.15 / 50, 0.00529 * 0.16, 0.00182 * 0.0225]
    found = closed_form.iso6336(GearPair(Gear(20, 0.4), Gear(50, 0.15), 2e-3, 40e-3))
    assert 1 / found.c_th == pytest.approx(sum(terms), rel=1e-12)
