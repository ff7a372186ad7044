"""Profile curves and pitch deviations: interpolation, signs, closure, faults."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from gears import GearDeviations, PitchDeviations, ProfileDeviation, WearDepth


def test_the_curve_passes_through_its_points_and_does_not_overshoot():
    curve = ProfileDeviation([1e-3, 2e-3, 4e-3, 5e-3], [0.0, 3e-6, 3e-6, -2e-6])
    np.testing.assert_allclose(curve.at(np.array(curve.rho)), curve.material, atol=1e-20)
    fine = curve.at(np.linspace(1e-3, 5e-3, 1001))
    assert fine.max() <= 3e-6 * (1 + 1e-12)
    assert fine.min() >= -2e-6 * (1 + 1e-12)
    np.testing.assert_allclose(curve.at(np.linspace(2e-3, 4e-3, 11)), 3e-6, rtol=1e-14)
    assert curve.at(np.array([0.0, 1.0])) == pytest.approx([0.0, -2e-6])  # held beyond the ends


def test_a_straight_curve_stays_straight_and_the_slope_is_continuous():
    rho = np.array([1.0, 1.1, 1.7, 2.0])
    line = ProfileDeviation(rho, 3 * rho - 1)
    at = np.linspace(1, 2, 57)
    np.testing.assert_allclose(line.at(at), 3 * at - 1, rtol=1e-14)
    bent = ProfileDeviation(rho, [0.0, 1.0, 1.5, 4.0])
    h = 1e-6
    for knot in rho[1:-1]:
        behind, here, ahead = bent.at(np.array([knot - h, knot, knot + h]))
        assert (ahead - here) / h == pytest.approx((here - behind) / h, rel=1e-4)


def test_smooth_curves_converge():
    at = np.linspace(0.0, 1.0, 777)
    error = []
    for n in (11, 21, 41):
        rho = np.linspace(0.0, 1.0, n)
        error.append(np.abs(ProfileDeviation(rho, np.exp(rho)).at(at) - np.exp(at)).max())
    assert error[0] / error[1] > 3.5
    assert error[1] / error[2] > 3.5


def test_roll_angle_is_rho_over_base_radius():
    curve = ProfileDeviation.over_roll_angle(0.03, [0.1, 0.2, 0.4], [0.0, 1e-6, 0.0])
    assert curve == ProfileDeviation([0.003, 0.006, 0.012], [0.0, 1e-6, 0.0])


def test_single_and_cumulative_pitch_deviations():
    single = np.array([3e-6, -1e-6, -4e-6, 2e-6])
    pitch = PitchDeviations.from_single(single)
    np.testing.assert_allclose(pitch.single, single, atol=1e-20)
    # the flank of tooth 1 stands by the pitch from tooth 0 to tooth 1 too far
    np.testing.assert_allclose(pitch.cumulative, [0.0, -1e-6, -5e-6, -3e-6], atol=1e-20)
    equal = PitchDeviations.from_single(np.full(7, 5e-6))
    np.testing.assert_allclose(equal.cumulative, 0.0, atol=1e-20)


def test_teeth_are_counted_round_the_gear():
    gear = GearDeviations(pitch=PitchDeviations([0.0, 1.0, 2.0]))
    np.testing.assert_array_equal(gear.late(np.array([[-1, 0], [4, 302]])), [[2.0, 0.0], [1.0, 2.0]])
    np.testing.assert_array_equal(gear.excess(np.ones(3)), 0.0)
    assert GearDeviations().late(np.arange(3)).tolist() == [0.0, 0.0, 0.0]


def test_all_faults_at_once_and_travel():
    bad = GearDeviations(ProfileDeviation([1.0, 1.0, np.nan], [0.0, 1.0]), PitchDeviations([0.0, np.inf]))
    assert [fault.where for fault in bad.faults("deviations[0]", 3)] == [
        "deviations[0].profile.rho",
        "deviations[0].profile",
        "deviations[0].pitch",
        "deviations[0].pitch",
    ]
    assert ProfileDeviation([1.0, 1.0], [0.0, 1.0]).faults()[0].value == "not growing"
    assert ProfileDeviation([1.0], [0.0]).faults()
    assert PitchDeviations.from_single([]).faults("pitch", 5)
    good = GearDeviations(ProfileDeviation([1.0, 2.0], [0.0, 1.0]), PitchDeviations([0.0] * 3))
    assert good.faults("x", 3) == ()
    assert pickle.loads(pickle.dumps(good)) == good


def test_straight_lines_between_points():
    at = np.linspace(0.5, 4.5, 41)
    curve = ProfileDeviation([1.0, 2.0, 4.0], [0.0, 3.0, -1.0], "linear")
    np.testing.assert_allclose(curve.at(at), np.interp(at, curve.rho, curve.material), rtol=1e-15)
    assert ProfileDeviation([1.0, 2.0], [0.0, 1.0], "cubic").faults()[0].where == "profile.form"


def test_traces_are_their_mean_and_what_each_tooth_has_beyond():
    rng = np.random.default_rng(4)
    traces = [ProfileDeviation(np.sort(rng.uniform(1, 2, n)), rng.normal(size=n)) for n in (5, 9, 7)]
    gear = GearDeviations(traces, wear=[WearDepth([1.0, 2.0], [d, 0.0]) for d in (0.0, 1.0, 2.0)])
    rho, tooth = np.linspace(1, 2, 11), np.array([[0], [1], [2], [-1], [4]])
    own = gear.excess(rho) + gear.of_tooth(tooth, rho)
    for row, k in enumerate((0, 1, 2, 2, 1)):
        np.testing.assert_allclose(own[row], traces[k].at(rho) - k * (2.0 - rho), atol=1e-14)
    # at the points of the trace that has most, the mean is that of all traces
    points = np.array(traces[1].rho)
    mean = np.mean([trace.at(points) for trace in traces], axis=0)
    np.testing.assert_allclose(gear.mean.profile.at(points), mean, atol=1e-14)
    assert gear.mean.mean == gear.mean
    assert gear.mean.every_tooth_alike
    assert not gear.every_tooth_alike
    equal = GearDeviations([traces[0]] * 7)
    assert equal.mean.profile == traces[0]
    np.testing.assert_array_equal(equal.of_tooth(np.arange(9)[:, None], rho), 0.0)


def test_faults_of_traces_and_wear():
    good, bad = ProfileDeviation([1.0, 2.0], [0.0, 1.0]), ProfileDeviation([2.0, 1.0], [0.0, 1.0])
    gear = GearDeviations([good, bad], wear=WearDepth([1.0, 2.0], [0.0, -1e-6]))
    assert [(fault.where, fault.value) for fault in gear.faults("gear", 3)] == [
        ("gear.profile", "2 curves"),
        ("gear.profile[1].rho", "not growing"),
        ("gear.wear.depth", "-1e-06 m"),
    ]
    assert pickle.loads(pickle.dumps(gear)) == gear
