"""Scuffing by the integral temperature: dimensionless limits, how it scales, and faults; oils over temperature."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from base import InputError
from gears import Gear, GearPair
from gears.rating import (
    GearOil,
    RatedSteel,
    load_factors,
    run_in,
    scuffing_friction,
    scuffing_safety,
    tolerances,
)
from gears.rating.scuffing import geometry_factor, helical_factor

STEELS = (RatedSteel("Eh", 1500e6, 430e6),) * 2
OIL = GearOil(220e-6, 19e-6, 890.0, 353.15)
TEST = {"test_torque": 450.1, "structure": 1.0, "supply": 1.0}


def rated(pair=None, oil=OIL, speed=209.44, torque=600.0, K_Hbeta=1.15, **more):
    pair = pair or GearPair(Gear(36), Gear(40), 2e-3, 40e-3)
    effective = run_in(pair, STEELS, speed, tolerances(pair, 6))
    given = {"effective": effective, "relief": 2e-6, "face_load_factor": K_Hbeta}
    loads = load_factors(pair, torque, speed, application_factor=1.0, **given)
    return scuffing_safety(pair, speed, loads, oil, **({"roughness": 0.6e-6, "relief": 2e-6} | TEST | more))


def test_oils_meet_their_data_and_fall():
    for temperature, viscosity in ((313.15, 220e-6), (373.15, 19e-6)):
        assert replace(OIL, temperature=temperature).kinematic_viscosity == pytest.approx(
            viscosity, rel=1e-12
        )
    cold, warm = (replace(OIL, temperature=t) for t in (300.0, 340.0))
    assert cold.dynamic_viscosity > warm.dynamic_viscosity
    assert replace(OIL, temperature=288.15).dynamic_viscosity == pytest.approx(
        890.0 * replace(OIL, temperature=288.15).kinematic_viscosity
    )


def test_friction_by_its_exponents():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3)
    base = scuffing_friction(pair, 4e5, 200.0, 0.03, 0.5e-6)
    assert scuffing_friction(pair, 8e5, 200.0, 0.03, 0.5e-6) == pytest.approx(2.0**0.2 * base)
    assert scuffing_friction(pair, 4e5, 400.0, 0.03, 0.5e-6) == pytest.approx(0.5**0.2 * base)
    assert scuffing_friction(pair, 4e5, 200.0, 0.06, 0.5e-6) == pytest.approx(0.5**0.05 * base)
    assert scuffing_friction(pair, 4e5, 200.0, 0.03, 1.0e-6) == pytest.approx(2.0**0.25 * base)


def test_the_geometry_factor_is_zero_at_the_pitch_point():
    pair = GearPair(Gear(20, 0.3), Gear(50, 0.1), 3e-3, 30e-3)
    assert geometry_factor(pair, pair.points.C) == pytest.approx(0.0, abs=1e-12)
    assert geometry_factor(pair, pair.points.E) > 0.0 > geometry_factor(pair, pair.points.A)


def test_flash_temperature_scales_with_load_and_size():
    """theta_flaint of one line load w rises with w^0.95: 0.75 and 0.2 of the friction."""
    low, high = rated(K_Hbeta=1.0), rated(K_Hbeta=1.5)
    ratio = high.w_Bt / low.w_Bt
    assert high.theta_flaint == pytest.approx(ratio**0.95 * low.theta_flaint, rel=1e-12)
    assert high.theta_int - high.theta_M == pytest.approx(1.5 * high.theta_flaint)
    assert low.S_intS > high.S_intS


def test_helical_factor_joins():
    assert helical_factor(2.0 - 1e-9) == pytest.approx(helical_factor(2.0 + 1e-9), abs=1e-4)
    assert helical_factor(3.5) == pytest.approx(1.3)
    assert helical_factor(4.4) == pytest.approx(1.3)


def test_a_better_oil_stands_a_higher_stage():
    assert rated(test_torque=534.5).S_intS > rated().S_intS
    assert rated(supply=1.2).S_intS < rated().S_intS
    warm = rated(oil=replace(OIL, temperature=363.15))
    assert warm.theta_int > rated().theta_int


def test_faults_are_listed_together():
    with pytest.raises(InputError) as caught:
        rated(oil=GearOil(19e-6, 220e-6, 89.0, math.nan))
    assert {f.where for f in caught.value.faults} >= {
        "oil.density_15",
        "oil.temperature",
        "oil.viscosity_100",
    }
    with pytest.raises(InputError) as caught:
        rated(roughness=-1.0, test_torque=0.0)
    assert {f.where for f in caught.value.faults} == {"roughness", "test_torque"}
    approach = GearPair(Gear(50, -0.5), Gear(50, 0.5), 2e-3, 40e-3)
    with pytest.raises(InputError, match=r"approach|contact_ratio"):
        rated(approach)
