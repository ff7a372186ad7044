"""Miner's sum: constant loads by hand, additivity, the life at a safety, and faults of spectra."""

from __future__ import annotations

import math

import pytest

from base import InputError
from gears import Gear, GearPair
from gears.rating import (
    LoadBin,
    RatedSteel,
    check_spectrum,
    contact_curve,
    load_factors,
    miner,
    pitting_safety,
    run_in,
    spectrum_safety,
    tolerances,
)
from gears.rating.pitting import load_cycles

CURVE = contact_curve("Eh")


def test_a_constant_load_fails_where_the_life_curve_has_its_factor():
    for cycles in (2e5, 5e7, 1e9):
        assert miner([cycles], [CURVE.factor(cycles)], CURVE).damage == pytest.approx(1.0, rel=1e-9)
    assert miner([1e9], [0.84], CURVE).damage == 0.0
    assert miner([1.0], [1.61], CURVE).damage == math.inf
    assert miner([1e9], [0.84], CURVE).life == math.inf


def test_sums_do_not_depend_on_order_or_on_cut_steps():
    steps = [(1e6, 1.3), (1e8, 0.95), (3e7, 0.0), (1e9, 0.9)]
    cycles, required = zip(*steps, strict=True)
    whole = miner(cycles, required, CURVE)
    assert miner(cycles[::-1], required[::-1], CURVE).damage == pytest.approx(whole.damage, rel=1e-12)
    halves = miner([0.5 * n for n in cycles] * 2, required * 2, CURVE)
    assert halves.damage == pytest.approx(whole.damage, rel=1e-12)
    assert whole.parts.sum() == pytest.approx(whole.damage)
    assert whole.parts[2] == 0.0
    assert miner([whole.life * n for n in cycles], required, CURVE).damage == pytest.approx(1.0, rel=1e-9)


def test_a_constant_load_has_the_safety_of_the_rating():
    """S_H of `pitting_safety` at its life is what the sum finds, by another way."""
    pair, speed, life = GearPair(Gear(36), Gear(40), 2e-3, 40e-3), 200.0, 3.6e6
    steels = (RatedSteel("Eh", 1500e6, 430e6),) * 2
    given = {"effective": run_in(pair, steels, speed, tolerances(pair, 6)), "relief": 2e-6}
    loads = load_factors(pair, 400.0, speed, application_factor=1.0, face_load_factor=1.1, **given)
    oil = {"viscosity_40": 220e-6, "roughness": 4.8e-6, "Z_W": (1.0, 1.0), "Z_X": 1.0}
    safety = pitting_safety(pair, 400.0, speed, loads, steels, life=life, **oil)
    required = [safety.Z_NT[0] / safety.S_H[0]]
    cycles = [load_cycles(pair, speed, life)[0]]
    found = spectrum_safety(lambda s: miner(cycles, required, CURVE, s).damage)
    assert found == pytest.approx(safety.S_H[0], rel=1e-9)


def test_damage_rises_with_the_safety():
    damages = [miner([1e6, 1e8], [1.2, 0.9], CURVE, safety).damage for safety in (0.8, 1.0, 1.1, 1.2)]
    assert damages == sorted(damages)


def test_faults_of_spectra_are_listed_together():
    wrong = [LoadBin(-5.0, 100.0, 1e6), LoadBin(10.0, 0.0, 1e6), LoadBin(10.0, 100.0, math.nan)]
    with pytest.raises(InputError) as caught:
        check_spectrum(wrong)
    assert [f.where for f in caught.value.faults] == [
        "spectrum[0].torque",
        "spectrum[1].speed",
        "spectrum[2].cycles",
    ]
    assert "reversed" in str(caught.value)
    for empty in ([], [LoadBin(0.0, 100.0, 1e6)]):
        with pytest.raises(InputError, match="with torque"):
            check_spectrum(empty)
    with pytest.raises(InputError) as caught:
        miner([1e6, -1.0], [1.0], CURVE, 0.0)
    assert {f.where for f in caught.value.faults} == {"safety", "required", "cycles[1]"}
