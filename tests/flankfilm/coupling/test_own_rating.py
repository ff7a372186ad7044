"""Our own factors of a rating: limits of the motion, factors of the contact, safeties by them."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from flankfilm.coupling import (
    LoadedFactors,
    MotionFactor,
    given_series,
    loaded_factors,
    mesh_cycle,
    motion_factor,
    own_rating,
    pair_oscillator,
)
from flankfilm.coupling.rating.pitch_excitation import pitch_errors
from gears import Gear, GearPair
from gears.rating import RatedSteel, RatingData, rate
from tests.flankfilm.pictured import face, helical

PAIR = GearPair(Gear(36), Gear(40), module=2e-3, face_width=40e-3).with_backlash(100e-6)
DATA = RatingData(6, (RatedSteel("Eh", 1500e6, 430e6),) * 2, 3.6e7, 220e-6, 4.8e-6, (20e-6, 20e-6), 1.25)


def moving(speed=200.0, amplitude=0.1):
    return pair_oscillator(PAIR, given_series(7e8, [amplitude]), 300.0, speed)


def test_a_base_pitch_deviation_is_a_sawtooth_with_its_jump_at_a_or_e():
    """Harmonics f_pb/(pi j); a jump of f_pb at A, or at E, where the contact ratio ends."""
    first, second = pitch_errors(PAIR, 6e-6, 6)
    order = np.arange(1, 7)
    for error in (first, second):
        assert error.amplitude == pytest.approx(6e-6 / (math.pi * order), rel=1e-3)
        assert np.ptp(error.curve) == pytest.approx(6e-6, rel=1e-2)
    apart = 2.0 * math.pi * order * (PAIR.contact_ratio % 1.0)
    turned = np.exp(1j * (second.phase - first.phase + apart))
    assert turned == pytest.approx(-np.ones(6), abs=1e-2)


@pytest.mark.slow
def test_it_is_what_the_contact_has_without_load():
    """Base pitches that differ in the loaded contact: the wheel's shorter one jumps at A, the longer one at E."""
    bodies = fem.compliance(PAIR, tolerance=0.05)
    place = (np.arange(40) + 0.5) / 40
    for difference, error in zip((-6e-6, 6e-6), pitch_errors(PAIR, 6e-6, 6), strict=True):
        cycle = fem.mesh_cycle(
            PAIR, 300.0, 40, compliance=bodies, beyond_path=False, base_pitch_difference=difference
        )
        expected = np.interp(place, (np.arange(error.curve.size) + 0.5) / error.curve.size, error.curve)
        curve = cycle.unloaded_transmission_error
        assert curve - curve.mean() == pytest.approx(expected - expected.mean(), abs=1e-11)


def test_without_deviation_it_is_the_motion_alone():
    found = motion_factor(moving(), 200.0, 0.0)
    assert found.K_v == pytest.approx(found.even, rel=1e-12)
    assert found.converged


def test_slow_teeth_have_no_dynamic_force():
    """The force of the mesh goes to the mean one, whatever the deviation."""
    factors = [motion_factor(moving(speed), speed, 6e-6).K_v - 1.0 for speed in (40.0, 10.0, 2.0)]
    assert factors[0] > factors[1] > factors[2] > 0.0
    assert factors[2] < 0.01


def test_harmonics_that_resonate_are_there():
    """Below the resonance harmonic 1/N of the sawtooth is the largest answer; twice as many change little."""
    motion = moving(amplitude=0.05)
    assert motion.scales is not None
    for N in (1.0 / 6.0, 0.25, 0.5):
        found = motion_factor(motion, motion.scales.speed(N), 6e-6)
        assert found.error < 0.05
        assert found.K_v > found.even + 0.1


def test_a_linear_motion_answers_in_proportion():
    """Without parametric stiffness the dynamic part of the force goes with the deviation while teeth touch."""
    motion = moving(amplitude=0.0)
    small, large = (motion_factor(motion, 200.0, f).K_v - 1.0 for f in (1e-6, 2e-6))
    assert large == pytest.approx(2.0 * small, rel=1e-6)


def test_over_a_sweep_the_maximum_is_at_the_resonance():
    motion = moving()
    assert motion.scales is not None
    resonance = motion.scales.speed(1.0)
    found = motion_factor(motion, 200.0, 3e-6, np.linspace(0.6, 1.4, 17) * resonance)
    assert found.factor.shape == found.swept.shape == (17,)
    assert found.greatest == found.factor.max() > found.K_v
    assert found.greatest_at == pytest.approx(resonance, rel=0.15)


def test_faults_are_listed():
    with pytest.raises(InputError) as caught:
        motion_factor(moving(), -1.0, math.nan)
    assert {fault.where for fault in caught.value.faults} == {"speed", "deviation"}
    cycle = mesh_cycle(PAIR, 300.0, model="ishikawa")
    with pytest.raises(InputError, match="coupled finite elements"):
        loaded_factors(cycle)


def motion_of(K_v: float, error: float = 0.02) -> MotionFactor:
    return replace(motion_factor(moving(), 200.0, 0.0), K_v=K_v, error=error)


def test_factors_of_the_standard_give_its_safeties():
    rating = rate(PAIR, 300.0, 209.44, DATA)
    factors = rating.factors
    both = factors.K_Hbeta * factors.K_Halpha
    loaded = LoadedFactors(factors.K_Hbeta, factors.K_Halpha, both, 0.0, "", "", 0.01, helical=False)
    own = own_rating(rating, PAIR, motion=motion_of(factors.K_v), loaded=loaded)
    assert pytest.approx(rating.S_H, rel=1e-9) == own.S_H
    assert pytest.approx(rating.S_F, rel=1e-9) == own.S_F
    assert (own.S_H_error, own.S_F_error) == pytest.approx((0.015, 0.03))


def test_safeties_go_with_the_factors():
    """Twice the dynamic factor is half the safety against breakage, and 1/sqrt(2) of that against pitting."""
    rating = rate(PAIR, 300.0, 209.44, DATA)
    own = own_rating(rating, PAIR, motion=motion_of(2.0 * rating.factors.K_v))
    assert [2.0 * s for s in own.S_F] == pytest.approx(rating.S_F)
    assert [math.sqrt(2.0) * s for s in own.S_H] == pytest.approx(rating.S_H)
    assert own.K_H_error is None
    assert own.root_ratio is None


def test_stresses_by_finite_elements_are_compared_and_in_no_safety():
    rating = rate(PAIR, 300.0, 209.44, DATA)
    nominal = rating.bending.nominal.stresses
    own = own_rating(rating, PAIR, tensions=(1.1 * nominal[0], 1.2 * nominal[1]), tension_error=0.01)
    assert own.root_ratio == pytest.approx((1.1, 1.2))
    assert own.S_F == rating.S_F


@pytest.mark.slow
@pytest.mark.long
def test_a_crowned_face_has_the_factor_of_its_contact_and_pairs_that_carry_alone_share_1():
    cycle = face().values["dry cycle"]
    found = loaded_factors(cycle)
    assert found.K_Hbeta == cycle.contact.face.greatest_face_load_factor > 1.5
    assert found.K_Halpha == pytest.approx(1.0, abs=1e-3)
    assert found.K_Hbeta * found.K_Halpha == found.K_H


@pytest.mark.slow
@pytest.mark.long
def test_lines_of_contact_have_both_factors_together():
    cycle = helical().values["dry cycle"]
    found = loaded_factors(cycle)
    assert found.K_Hbeta is found.K_Halpha is None
    assert found.K_H == cycle.contact.lines.greatest_line_load_factor > 1.0
    assert found.error == cycle.contact.lines.error
