"""Traction curves: single films, signs, limits, faults; the stress that made a curve is found again."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

from base import InputError
from ehl import LineContact, Lubricant, solve_thermal, traction_curve

pytestmark = pytest.mark.filterwarnings("ignore:Hertz pressure")

OIL = Lubricant(0.02, 17e-9, 860.0, temperature=353.15, viscosity_slope=0.036, eyring_stress=6e6)


def test_points_are_single_films_whatever_their_order():
    curve = traction_curve(OIL, 0.9e9, 5.0, [0.1, 0.0, -0.1, 0.02], radius=0.02)
    assert curve.converged
    assert curve.hertz_pressure == pytest.approx(0.9e9, rel=1e-12)
    mu = curve.traction_coefficient
    assert mu[1] == pytest.approx(0.0, abs=1e-6)
    assert mu[2] == pytest.approx(-mu[0], rel=curve.traction_error[0])
    assert 0.0 < mu[3] < mu[0]
    contact = replace(curve.contact, sliding=0.5)
    alone = solve_thermal(contact, bulk_temperatures=(353.15, 353.15))
    assert mu[0] == pytest.approx(alone.traction_coefficient, rel=curve.traction_error[0])
    assert curve.oil_temperature_rise[0] == pytest.approx(
        alone.oil_temperature_rise, rel=curve.temperature_error[0]
    )
    assert curve.greatest_traction == np.abs(mu).max()


def test_small_sliding_is_that_of_a_newtonian_oil_and_more_is_eyring_s():
    """mu = eta Du/h over the pressure at first; tau0 ln of it once it thins: twice the stress is less than twice."""
    ratios = [1e-4, 2e-4, 0.05]
    one, two = (
        traction_curve(
            replace(OIL, eyring_stress=stress), 0.9e9, 5.0, ratios, radius=0.02
        ).traction_coefficient
        for stress in (6e6, 12e6)
    )
    assert one[1] == pytest.approx(2 * one[0], rel=0.01)
    assert two[0] == pytest.approx(one[0], rel=0.02)
    assert 1.2 * one[2] < two[2] < 2.0 * one[2]


def test_temperature_is_that_of_the_bulk():
    warm = traction_curve(OIL, 0.9e9, 5.0, [0.05], radius=0.02, temperature=373.15)
    contact = replace(warm.contact, sliding=0.25)
    alone = solve_thermal(contact, bulk_temperatures=(373.15, 373.15))
    assert warm.traction_coefficient[0] == pytest.approx(alone.traction_coefficient, rel=1e-9)


def test_the_stress_of_a_curve_is_found_again():
    ratios = np.array([0.02, 0.1])
    measured = traction_curve(OIL, 0.9e9, 5.0, ratios, radius=0.02).traction_coefficient

    def miss(stress: float) -> float:
        curve = traction_curve(replace(OIL, eyring_stress=stress), 0.9e9, 5.0, ratios, radius=0.02)
        return float(np.sum((curve.traction_coefficient / measured - 1.0) ** 2))

    found = minimize_scalar(miss, bounds=(3e6, 12e6), method="bounded", options={"xatol": 3e4})
    assert found.x == pytest.approx(6e6, rel=0.02)


def test_faults_are_named_together():
    with pytest.raises(InputError) as told:
        traction_curve(replace(OIL, eyring_stress=None), -1.0, 5.0, [0.1, 3.0], radius=0.02)
    for name in ("pressure", "slide_roll", "eyring_stress"):
        assert name in str(told.value)
    with pytest.raises(InputError, match="radius"):
        traction_curve(OIL, 1e9, 5.0, 0.1, radius=-1.0)


@pytest.mark.slow
def test_a_disc_at_rest_and_oil_that_yields_by_a_limiting_stress_alone():
    oil = replace(OIL, eyring_stress=None, limiting_shear_ratio=0.047)
    curve = traction_curve(oil, 1e9, 5.0, [0.1, 0.5, 2.0], radius=0.02)
    assert curve.converged
    assert (np.abs(curve.traction_coefficient) < 0.047).all()
    assert isinstance(curve.contact, LineContact)
