"""The whole rating in one call: the same as its parts, all faults at once, and spectra."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from base import InputError, RangeWarning
from gears import Gear, GearPair, Material
from gears.rating import (
    FaceData,
    GearOil,
    LoadBin,
    RatedSteel,
    RatingData,
    Required,
    ScuffingData,
    contact_curve,
    load_factors,
    misalignment,
    pitting_safety,
    rate,
    run_in,
    run_in_relief,
    scuffing_safety,
    tolerances,
)

HARD = (RatedSteel("Eh", 1500e6, 430e6),) * 2
OIL = GearOil(220e-6, 19e-6, 890.0, 353.15)
TEST = ScuffingData(OIL, 0.6e-6, 450.1)
DATA = RatingData(6, HARD, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6), 1.25)
SPEED = 209.44


def pair_of(helix: float = 0.0, **more: object) -> GearPair:
    return GearPair(Gear(36), Gear(40), 2e-3, 40e-3, helix_angle=math.radians(helix), **more)


def test_it_is_its_parts_in_the_order_of_the_standard():
    pair = pair_of(15.0)
    found = rate(pair, 300.0, SPEED, replace(DATA, scuffing=TEST))
    grade = tolerances(pair, 6)
    given = {
        "application_factor": 1.25,
        "effective": run_in(pair, HARD, SPEED, grade),
        "relief": run_in_relief(HARD),
    }
    dynamic = load_factors(pair, 300.0, SPEED, face_load_factor=1.0, **given).K_v
    lead = misalignment(pair, 1.25 * dynamic * 300.0, SPEED, HARD, grade)
    loads = load_factors(pair, 300.0, SPEED, misalignment=lead.F_by, **given)
    oil = {"viscosity_40": 220e-6, "roughness": 4.8e-6, "life": 3.6e7, "Z_W": (1.0, 1.0), "Z_X": 1.0}
    assert found.pitting.S_H == pitting_safety(pair, 300.0, SPEED, loads, HARD, **oil).S_H
    test = {
        "roughness": 0.6e-6,
        "relief": found.relief,
        "test_torque": 450.1,
        "structure": 1.0,
        "supply": 1.0,
    }
    assert found.scuffing is not None
    assert scuffing_safety(pair, SPEED, loads, OIL, **test).S_intS == found.S_S
    assert found.misalignment is not None
    assert found.misalignment.F_by == lead.F_by


def test_a_given_factor_needs_no_misalignment():
    found = rate(pair_of(), 300.0, SPEED, replace(DATA, face=FaceData(1.15)))
    assert found.misalignment is None
    assert found.factors.K_Hbeta == 1.15


def test_all_faults_come_together():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, material=Material(3e9, 0.4, 1140.0))
    wrong = replace(
        DATA,
        grade=13,
        steels=(RatedSteel("PA66", 1500e6, 430e6), RatedSteel("V", 700e6, 250e6)),
        life=-1.0,
        root_roughness=(20e-6, 1.0),
        Z_W=(1.0, 3.0),
        scuffing=replace(TEST, oil=GearOil(19e-6, 220e-6, 890.0, 353.15)),
        spectrum=(LoadBin(0.0, 200.0, 1e6), LoadBin(-300.0, 200.0, 1e6)),
        required=Required(S_H=0.0),
    )
    with pytest.raises(InputError) as caught:
        rate(pair, 300.0, SPEED, wrong)
    assert {fault.where for fault in caught.value.faults} == {
        "grade", "pinion.material.youngs_modulus", "wheel.material.youngs_modulus", "pinion.steel.kind",
        "wheel.steel.proof_stress", "life", "wheel.root_roughness", "wheel.Z_W", "oil.viscosity_100", "spectrum",
        "spectrum[1].torque", "required.S_H",
    }  # fmt: skip


def test_the_wheel_drives_without_scuffing():
    front, back = (rate(pair_of(), torque, SPEED, replace(DATA, scuffing=TEST)) for torque in (300.0, -300.0))
    assert back.S_H == front.S_H
    assert back.S_S is None
    assert "driving pinion" in back.scuffing_fault


def test_a_constant_spectrum_is_the_rating_itself():
    """One step of the life rated has the safety of the rating, and its damage is 1 at that safety."""
    life = 3.6e7
    plain = rate(pair_of(), 300.0, SPEED, DATA)
    step = LoadBin(300.0, SPEED, SPEED * life / (2.0 * math.pi))
    at = Required(S_H=plain.S_H[1], S_F=plain.S_F[1])
    found = rate(pair_of(), 300.0, SPEED, replace(DATA, spectrum=(step,), required=at)).spectrum
    assert found is not None
    assert found.duration == pytest.approx(life, rel=1e-12)
    assert pytest.approx(plain.S_H, rel=1e-9) == found.S_H
    assert pytest.approx(plain.S_F, rel=1e-9) == found.S_F
    assert found.damage_H[1] == pytest.approx(1.0, rel=1e-9)
    assert found.damage_F[1] == pytest.approx(1.0, rel=1e-9)


def test_steps_without_load_do_no_damage_and_order_does_not_count():
    steps = (LoadBin(500.0, 150.0, 1e6), LoadBin(0.0, 50.0, 1e7), LoadBin(350.0, SPEED, 3e7))
    forward, backward = (
        rate(pair_of(), 300.0, SPEED, replace(DATA, spectrum=order)).spectrum
        for order in (steps, steps[::-1])
    )
    assert forward.parts_H[:, 1].tolist() == [0.0, 0.0]
    assert forward.damage_H == pytest.approx(backward.damage_H, rel=1e-12)
    assert forward.life == pytest.approx(backward.life, rel=1e-12)
    loaded = rate(pair_of(), 300.0, SPEED, replace(DATA, spectrum=steps[::2])).spectrum
    assert forward.damage_F == loaded.damage_F
    assert forward.duration > loaded.duration


def test_warnings_are_said_once():
    # the mass at which N is 1, since the pair's own is far below resonance at this speed
    mass = rate(pair_of(), 300.0, SPEED, DATA).factors
    at_resonance = replace(DATA, mass=mass.m_red / mass.N**2)
    with pytest.warns(RangeWarning, match="resonance ratio 1 is within") as heard:
        rate(pair_of(), 300.0, SPEED, at_resonance)
    assert len(heard) == 1
    with pytest.warns(RangeWarning, match="up to 30 deg") as heard:
        rate(pair_of(34.0), 300.0, SPEED, DATA)
    assert len([warning for warning in heard if "up to 30 deg" in str(warning.message)]) == 1


def test_lives_of_an_array_are_those_of_its_numbers():
    factors = np.array([2.0, 1.6, 1.3, 1.0, 0.9, 0.85, 0.84, 0.0])
    for curve in (
        contact_curve("Eh"),
        contact_curve("Eh", pitting_permitted=True),
        contact_curve("NV nitrocar"),
    ):
        expected = [curve.life(float(factor)) for factor in factors]
        assert curve.lives(factors) == pytest.approx(np.array(expected), rel=1e-9)
