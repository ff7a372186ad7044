"""Harmonics of an unloaded error from its curve, and motions over a revolution, against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dynamics
import flankfilm as ff
from base import InputError
from flankfilm.coupling import error_series, given_series, over_revolution, unloaded_error
from gears import Gear, GearDeviations, GearPair, PitchDeviations, TipRelief

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(50e-6)
SERIES = given_series(4e8, [0.2], [0.3])


def motion(series=SERIES, **keys):
    return ff.pair_oscillator(PAIR, series, 200.0, 700.0, **keys)


def test_one_harmonic_in_a_list_gives_the_digits_of_the_number():
    number = motion(error_amplitude=7e-6, error_phase=0.4).oscillator
    listed = motion(error_amplitude=(7e-6,), error_phase=np.array([0.4])).oscillator
    assert number == listed
    assert np.array_equal(number.packed(), listed.packed())


def test_harmonics_are_scaled_and_turned_with_the_load():
    both = motion(error_amplitude=(7e-6, 2e-6), error_phase=(0.4, 0.1))
    series = both.oscillator.error_series
    assert series[0] * both.scales.length == pytest.approx([7e-6, 2e-6], rel=1e-12)
    assert series[1] == pytest.approx([0.4, 0.1])
    back = ff.pair_oscillator(PAIR, SERIES, -200.0, 700.0, error_amplitude=(7e-6, 2e-6))
    assert back.oscillator.error_series[1] == pytest.approx([math.pi, math.pi])


def test_a_triangle_has_its_known_harmonics_and_its_order_the_known_remainder():
    # e = 1 - 4|x - 1/2| on [0, 1]: amplitudes 8/(pi j)^2 of odd harmonics, -cos
    found = error_series([-1e-6, 1e-6, -1e-6], [0.0, 0.5, 1.0], share=0.02)
    j = np.arange(1, found.order + 1)
    exact = np.where(j % 2 == 1, 8e-6 / (math.pi * j) ** 2, 0.0)
    assert found.amplitude == pytest.approx(exact, abs=8e-6 / 4096**2 * 10)
    assert abs(found.phase[0]) == pytest.approx(math.pi)
    odd = np.arange(1, 20001, 2)
    power = (8 / (math.pi * odd) ** 2) ** 2 / 2

    def left(order):
        return math.sqrt(power[odd > order].sum() / power.sum())

    assert found.remainder == pytest.approx(left(found.order), rel=1e-3)
    assert left(found.order) <= 0.02 < left(found.order - 1)


def test_half_of_the_samples_say_the_same_of_a_smooth_curve():
    """Errors are those of harmonics that half of the samples miss: none here, half the amplitude of the 170th there."""
    theta = 2 * np.pi * (np.arange(400) + 0.5) / 400
    smooth = 3e-6 * np.cos(theta - 0.7)
    assert error_series(smooth, order=1).error == pytest.approx(0.0, abs=1e-12)
    rough = error_series(smooth + 3e-8 * np.cos(170 * theta), order=1)
    assert rough.error == pytest.approx(0.01, rel=0.02)


def test_samples_at_midpoints_and_points_from_elsewhere_agree():
    theta = 2 * np.pi * (np.arange(400) + 0.5) / 400
    curve = 3e-6 * np.cos(theta - 0.7) + 1e-6 * np.cos(5 * theta + 0.2)
    by_samples = error_series(curve, order=5)
    fine = np.linspace(-0.25, 0.75, 20001)
    other = 3e-6 * np.cos(2 * np.pi * fine - 0.7) + 1e-6 * np.cos(10 * np.pi * fine + 0.2)
    by_points = error_series(other, fine, order=5)
    for harmonic in (0, 4):
        assert by_samples.amplitude[harmonic] == pytest.approx((3e-6, 0, 0, 0, 1e-6)[harmonic], rel=1e-12)
        assert by_points.amplitude[harmonic] == pytest.approx(by_samples.amplitude[harmonic], rel=1e-6)
        assert by_points.phase[harmonic] == pytest.approx(by_samples.phase[harmonic], abs=1e-5)


def test_harmonics_near_a_resonance_in_the_range_are_kept():
    theta = 2 * np.pi * (np.arange(400) + 0.5) / 400
    curve = 1e-6 * np.cos(theta) + 1e-8 * np.cos(5 * theta)
    assert error_series(curve, share=0.02).order == 1
    assert error_series(curve, share=0.02, bounds=(0.15, 0.25), damping_ratio=0.05).order == 5


def test_perfect_involutes_have_no_error_and_a_relieved_pair_has_less_than_its_relief():
    assert unloaded_error(PAIR).range == 0.0
    relieved = [Gear(teeth=z, tip_relief=TipRelief(20e-6, 3e-3)) for z in (36, 40)]
    found = unloaded_error(GearPair(*relieved, module=2e-3, face_width=20e-3))
    assert 1e-6 < found.range < 20e-6


def test_a_slow_harmonic_of_a_revolution_is_the_linear_oscillator_s_response():
    tone = error_series(2e-6 * np.cos(2 * np.pi * (np.arange(400) + 0.5) / 400), meshes=20, order=1)
    base = motion(given_series(4e8, [0.0]), damping_ratio=0.05)
    found = ff.mesh_spectrum(base, tone, highest=1.0)
    w = base.frequency / 20
    answer = 2e-6 / base.scales.length * w**2 / math.hypot(1 - w**2, 0.1 * w)
    assert found.order[0] == pytest.approx(1 / 20)
    assert found.displacement[0] == pytest.approx(answer, rel=1e-9)
    assert np.max(found.displacement[1:]) < 1e-9 * answer
    assert found.sidebands == pytest.approx(1.0)


def test_a_revolution_without_deviations_moves_like_one_mesh():
    still = error_series(np.zeros(20), meshes=20, order=1)
    series = given_series(4e8, [0.2, 0.05], [0.3, 1.1])
    driven = motion(series, error_amplitude=(5e-6, 1e-6), error_phase=(0.0, 1.0))
    whole, mesh = ff.mesh_spectrum(driven, still, highest=3.0), ff.mesh_spectrum(driven, highest=3.0)
    kept = np.abs(whole.order - np.round(whole.order)) < 1e-9
    assert whole.displacement[kept] == pytest.approx(mesh.displacement, rel=1e-6, abs=1e-9)
    assert np.max(whole.displacement[~kept]) < 1e-8
    state = dynamics.find_orbit(driven.oscillator, driven.oscillator.rest_state()).state
    over = over_revolution(driven, still)
    assert dynamics.period_map(over, state).state == pytest.approx(state, abs=1e-10)


def test_a_single_late_tooth_is_a_comb_of_its_revolution():
    late = GearDeviations(pitch=PitchDeviations((4e-6,) + (0.0,) * 19))
    error = ff.revolution_error(PAIR, (late, None))
    assert (error.meshes, error.order) == (20, 60)
    # one pitch of twenty stands back by 4 um, but for the time in which the tooth before still bears
    assert 0.4 * 4e-6 < error.range <= 4e-6
    assert error.amplitude[0] == pytest.approx(error.amplitude[1], rel=0.05)
    assert ff.mesh_spectrum(motion(), error).sidebands > 1e-4


def test_both_gears_hunt_and_too_long_a_period_is_refused():
    uneven = [GearDeviations(pitch=PitchDeviations((3e-6,) + (0.0,) * (z - 1))) for z in (20, 30)]
    assert ff.revolution_error(PAIR, uneven).meshes == 60
    prime = GearPair(Gear(teeth=17), Gear(teeth=61), module=2e-3, face_width=20e-3)
    with pytest.raises(InputError, match="1037 meshes"):
        ff.revolution_error(
            prime, [GearDeviations(pitch=PitchDeviations((3e-6,) + (0.0,) * (z - 1))) for z in (17, 61)]
        )
    with pytest.raises(InputError, match="all teeth alike"):
        ff.revolution_error(PAIR, (None, None))


@pytest.mark.parametrize(
    ("error", "position", "said"),
    [
        ([0.0, 1e-6], None, "3 to"),
        ([0.0, math.nan, 1.0], None, "finite"),
        ([0.0, 1e-6, 0.0], [0.0, 0.5], "shape"),
        ([0.0, 1e-6, 0.0], [0.0, 0.5, 0.5], "rise"),
        ([0.0, 1e-6, 0.0], [0.0, 0.5, 1.5], "base pitches at most"),
    ],
)
def test_what_is_no_curve_is_refused(error, position, said):
    with pytest.raises(InputError, match=said):
        error_series(error, position)
