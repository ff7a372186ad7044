"""Safeties of ISO 6336-2 and -3: their curves, how they scale, and faults."""

from __future__ import annotations

import math

import pytest

from base import InputError
from gears import Gear, GearPair
from gears.rating import (
    KINDS,
    RatedSteel,
    bending_safety,
    contact_curve,
    load_factors,
    pitting_safety,
    run_in,
    tolerances,
)
from gears.rating.bending import size_factor, slip_layer, surface_factor
from gears.rating.life import BENDING

HARD = RatedSteel("Eh", 1500e6, 430e6)
OIL = {"viscosity_40": 220e-6, "roughness": 4.8e-6, "Z_W": (1.0, 1.0), "Z_X": 1.0}
LIFE, SPEED = 3.6e7, 209.44


def rated(torque=600.0, steels=(HARD, HARD), life=LIFE, helix=0.0, **more):
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, helix_angle=helix)
    effective = run_in(pair, steels, SPEED, tolerances(pair, 6))
    given = {"effective": effective, "relief": 2e-6, "face_load_factor": 1.15}
    loads = load_factors(pair, torque, SPEED, application_factor=1.0, **given)
    pitting = pitting_safety(pair, torque, SPEED, loads, steels, life=life, **(OIL | more))
    roots = (20e-6, 20e-6)
    return pitting, bending_safety(pair, torque, SPEED, loads, steels, root_roughness=roots, life=life), loads


@pytest.mark.parametrize("kind", KINDS)
def test_life_curves_fall_and_are_inverted(kind):
    for curve in (contact_curve(kind), contact_curve(kind, pitting_permitted=True), BENDING[kind]):
        factors = [curve.factor(10.0**k) for k in range(1, 13)]
        assert factors == sorted(factors, reverse=True)
        assert curve.factor(curve.cycles[-1]) == factors[-1] == 0.85
        for cycles in (2e5, 1e6, 3e8, 9e9):
            if curve.cycles[0] < cycles:
                assert curve.life(curve.factor(cycles)) == pytest.approx(cycles, rel=1e-9)
        assert curve.life(1.01 * factors[0]) == 0.0
        assert curve.life(0.84) == math.inf
        for at, value in zip(curve.cycles, curve.factors, strict=True):
            assert curve.factor(at) == pytest.approx(value, rel=1e-12)


def test_slopes_of_the_standard():
    """Exponents 0.0756 and 0.0306 of Z_NT, 0.115, 0.16 and 0.02 of Y_NT, which the standard prints rounded."""

    def slope(curve, low, high):
        return math.log(curve.factor(low) / curve.factor(high)) / math.log(high / low)

    assert slope(contact_curve("Eh"), 1e6, 1e7) == pytest.approx(0.0756, abs=1e-4)
    assert slope(contact_curve("Eh"), 1e8, 1e9) == pytest.approx(0.0306, abs=1e-4)
    assert slope(contact_curve("Eh", True), 1e6, 9e6) == pytest.approx(0.0738, abs=1e-3)
    assert slope(BENDING["Eh"], 1e4, 1e6) == pytest.approx(0.115, abs=1e-3)
    assert slope(BENDING["V"], 2e4, 1e6) == pytest.approx(0.16, abs=1e-3)
    assert slope(BENDING["V"], 1e7, 1e9) == pytest.approx(0.02, abs=1e-4)


def test_safeties_scale_with_torque_and_strength():
    """Given load factors: S_H with the root of the torque, S_F with the torque, both with the strength."""
    pitting, bending, loads = rated()
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3)
    double = pitting_safety(pair, 1200.0, SPEED, loads, (HARD, HARD), life=LIFE, **OIL)
    assert double.S_H[0] == pytest.approx(pitting.S_H[0] / math.sqrt(2.0), rel=1e-12)
    strong = (RatedSteel("Eh", 1650e6, 473e6), HARD)
    stronger = bending_safety(pair, 600.0, SPEED, loads, strong, root_roughness=(20e-6, 20e-6), life=LIFE)
    assert stronger.S_F[0] == pytest.approx(1.1 * bending.S_F[0], rel=1e-12)
    assert stronger.S_F[1] == bending.S_F[1]
    assert pitting.safety == min(pitting.S_H)
    assert pitting.sigma_H[0] == pytest.approx(pitting.nominal.single_pair_stresses[0] * loads.contact**0.5)


def test_influences_of_soft_flanks_join_at_their_bounds():
    """Z_L, Z_V, Z_R over sigma_Hlim are continuous at 850 and 1200 MPa to the digits of the standard's constants."""
    for bound in (850e6, 1200e6):
        low, high = (rated(steels=(RatedSteel("Eh", bound * (1 + s), 430e6), HARD))[0] for s in (-1e-6, 1e-6))
        for name in ("Z_L", "Z_V", "Z_R"):
            assert getattr(low, name) == pytest.approx(getattr(high, name), rel=5e-4), name


def test_thicker_oil_smoother_flanks_and_higher_speed_do_good():
    base = rated()[0]
    assert rated(viscosity_40=460e-6)[0].Z_L > base.Z_L
    assert rated(roughness=2e-6)[0].Z_R > base.Z_R
    assert rated(Z_X=0.9)[0].S_H[0] == pytest.approx(0.9 * base.S_H[0])


def test_factors_of_the_root():
    assert slip_layer(RatedSteel("St", 400e6, 150e6, 300e6)) == pytest.approx(0.0833)
    assert slip_layer(RatedSteel("V", 640e6, 250e6, 1000e6)) == pytest.approx(0.0014)
    assert slip_layer(RatedSteel("NT", 1000e6, 400e6)) == 0.1005
    for kind in KINDS:
        assert surface_factor(kind, 10e-6) == pytest.approx(
            1.0, abs=6e-3
        )  # test gears have Rz 10 um; nitrided 0.9944
        assert surface_factor(kind, 0.999e-6) == pytest.approx(surface_factor(kind, 1.001e-6), rel=0.013)
        assert size_factor(kind, 5e-3) == pytest.approx(1.0)
        assert size_factor(kind, 0.1) < 0.86


def test_faults_are_listed_together():
    with pytest.raises(InputError) as caught:
        rated(roughness=0.0, viscosity_40=220.0, Z_W=(1.0, 0.0))
    assert {f.where for f in caught.value.faults} == {"roughness", "viscosity_40", "wheel.Z_W"}
    with pytest.raises(InputError, match="proof_stress"):
        rated(steels=(RatedSteel("V", 640e6, 250e6), HARD))
    with pytest.raises(InputError, match="cycles"):
        contact_curve("Eh").factor(-1.0)
