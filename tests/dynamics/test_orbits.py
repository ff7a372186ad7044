"""Shooting, sweeps and the grazing of the contact orbit."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

from dynamics import (
    FourierStiffness,
    GearOscillator,
    contact_grazing,
    continue_branch,
    find_orbit,
    find_orbits,
    period_map,
    sweep,
)
from dynamics.branches.grazing import contact_orbit
from dynamics.motion.sweeps import repeat_after
from dynamics.orbits.shooting import floquet_multipliers, is_stable


@pytest.mark.parametrize(
    ("frequency", "guess", "label"),
    [
        (0.6, (0.35, 0.0), "1-0-0"),
        (0.6, (0.5, 0.2), "U1-1-0"),
        (0.6, (0.53, 0.25), "1-1-1"),
        (2.0, (0.4, 0.0), "1-1-0"),
    ],
)
def test_orbits_close_and_keep_the_determinant(article, frequency, guess, label):
    osc = article(frequency=frequency)
    orbit = find_orbit(osc, guess, transient=0 if label.startswith("U") else 300)
    assert orbit.converged
    assert orbit.label == label
    assert orbit.residual < 1e-14
    assert orbit.error < 1e-12
    assert np.max(np.abs(period_map(osc, orbit.state).state - orbit.state)) < 1e-14
    assert np.linalg.det(orbit.jacobian) == pytest.approx(np.exp(-4 * np.pi * 0.05 / frequency), rel=1e-12)
    assert np.prod(orbit.multipliers).real == pytest.approx(orbit.determinant, rel=1e-14)
    np.testing.assert_allclose(
        np.sort_complex(orbit.multipliers), np.sort_complex(np.linalg.eigvals(orbit.jacobian)), rtol=1e-10
    )


def test_newton_converges_quadratically(article):
    history = find_orbit(article(), (0.5, 0.2)).history
    a, b, c = [r for r in history if r > 1e-13][-3:]
    assert a < 1e-2
    assert b < a**1.5
    assert c < b**1.5


def test_least_period_is_reported(article):
    orbit = find_orbit(article(), (0.35, 0.0), periods=6)
    assert orbit.periods == 1
    assert orbit.label == "1-0-0"
    assert "divisor" in orbit.message


def test_longer_orbit(article):
    orbit = find_orbit(article(frequency=1.22), (0.4, 0.0), periods=4, transient=2000)
    assert orbit.converged
    assert orbit.label == "4-4-2"
    assert np.abs(orbit.multipliers[0]) < 1


def test_no_orbit_is_said():
    osc = GearOscillator(FourierStiffness(1.0), 0.0, 0.1, 0.2, 1.0, half_backlash=0.0)  # undamped resonance
    orbit = find_orbit(osc, (0.3, 0.1))
    assert not orbit.converged
    assert np.all(np.isnan(orbit.state))
    assert orbit.label == ""
    assert orbit.message


def test_multipliers_far_apart_keep_their_digits():
    large, small = floquet_multipliers(1e9 + 1e-9, 1.0)
    assert large == pytest.approx(1e9, rel=1e-15)
    assert small == pytest.approx(1e-9, rel=1e-15)
    pair = floquet_multipliers(0.5, 1.0)
    assert abs(pair[0]) == pytest.approx(1.0, rel=1e-15)


@pytest.mark.parametrize(
    ("multipliers", "stable"),
    [
        ((0.9, -0.4), True),
        ((1.001, 0.5), False),
        ((0.5, -1.001), False),
        ((1.0, 0.3), False),
        ((0.6 + 0.8j, 0.6 - 0.8j), True),
        ((0.6006 + 0.8008j, 0.6006 - 0.8008j), False),
    ],
)
def test_stability_ends_on_the_unit_circle(multipliers, stable):
    """A real multiplier of one is a fold; a pair on the circle is what no damping leaves."""
    assert is_stable(np.array(multipliers)) is stable


def test_contact_orbit_is_the_orbit_while_it_clears_the_limit(article):
    osc = article(frequency=0.5)
    linear, orbit = contact_orbit(osc), find_orbit(osc, (0.35, 0.0))
    np.testing.assert_allclose(linear.state, orbit.state, rtol=0, atol=1e-15)
    np.testing.assert_allclose(linear.multipliers, orbit.multipliers, rtol=1e-13)
    assert linear.clearance > 0


def test_grazing_does_not_depend_on_the_backlash_and_mirrors(article):
    one = contact_grazing(article(), bounds=(0.4, 1.5)).points[0]
    for d in (0.0, 1e-13, 0.7):
        other = contact_grazing(article(half_backlash=d), bounds=(0.4, 1.5)).points[0]
        assert other.parameter == one.parameter
    mirrored = contact_grazing(
        article(mean_force=-0.1, error_amplitude=-0.2), bounds=(0.4, 1.5), side=-1
    ).points[0]
    assert mirrored.parameter == one.parameter
    assert mirrored.boundary == -1


def test_grazing_in_other_parameters_is_the_same_point(article):
    w = contact_grazing(article(), bounds=(0.4, 1.5)).points[0].parameter
    osc = article(frequency=w)
    for parameter, value, bounds in (
        ("error_amplitude", 0.2, (0.1, 0.3)),
        ("mean_force", 0.1, (0.05, 0.2)),
        ("stiffness.amplitudes[0]", 0.18, (0.1, 0.3)),
        ("damping_ratio", 0.05, (0.01, 0.09)),
    ):
        found = contact_grazing(osc, parameter, bounds).points
        assert min(abs(p.parameter / value - 1) for p in found) < 1e-12, parameter


def test_resonance_in_the_range_is_passed(article):
    """Without damping the contact orbit is infinite at omega = 1: amplitude eps w^2/|1 - w^2| on either side."""
    osc = article(kappa=0.0, damping_ratio=0.0, error_amplitude=0.05)
    result = contact_grazing(osc, bounds=(0.5, 1.5), points=101)
    assert np.isnan(result.clearance[50])  # omega = 1 is a value of the scan
    # eps w^2 = F_m |1 - w^2|
    np.testing.assert_allclose(np.asarray(result), np.sqrt([0.1 / 0.15, 0.1 / 0.05]), rtol=1e-12)


def test_touch_is_a_touch(article):
    point = contact_grazing(article(), bounds=(0.4, 1.5)).points[0]
    osc = article(frequency=point.parameter)
    assert point.acceleration == pytest.approx(float(osc.force(point.tau)), rel=1e-9)  # there K f = 0 = V
    assert point.stiffness == pytest.approx(float(osc.stiffness(osc.frequency * point.tau)))


@pytest.mark.parametrize("direction", ["up", "down"])
def test_sweep_finds_both_sides_of_the_hysteresis(article, direction):
    values = np.arange(0.552, 0.668, 0.004)
    result = sweep(article(), "frequency", values, direction, keep=32)
    assert np.asarray(result).shape == (len(values), 32, 2)
    one_zero_zero = np.array([label == "1-0-0" for label in result.labels])
    # up: contact until the saddle node at 0.65558, past the grazing at 0.63353 as 1-1-0; down: impacts until
    # 0.56940
    edge = 0.63353 if direction == "up" else 0.56940
    assert np.all(one_zero_zero == (values < edge))
    assert result.converged
    assert result.error < 1e-12
    labelled_by_hand = find_orbit(article(frequency=0.6), (0.35, 0.0) if direction == "up" else (0.53, 0.25))
    i = int(np.argmin(np.abs(values - 0.6)))
    np.testing.assert_allclose(result.states[i, -1], labelled_by_hand.state, rtol=0, atol=1e-6)


def test_sweep_result_keeps_the_order_given_and_pickles(article):
    values = np.array([0.62, 0.5, 0.56])
    result = sweep(article(), values=values, direction="down", keep=32)
    again = pickle.loads(pickle.dumps(result))
    assert np.array_equal(again.states, result.states)
    for value, states in zip(values, result.states, strict=True):
        assert np.allclose(
            period_map(article(frequency=value), states[-2]).state, states[-1], rtol=0, atol=1e-13
        )


def test_sweep_reports_progress(article):
    seen: list[tuple[int, int]] = []
    sweep(article(), values=[0.5, 0.51, 0.52], keep=32, progress=lambda done, all_: seen.append((done, all_)))
    assert seen == [(1, 3), (2, 3), (3, 3)]


def test_sweep_of_chaos_is_aperiodic(article):
    result = sweep(article(), values=[1.03, 1.05], keep=200)
    assert set(result.labels) == {"aperiodic"}
    assert set(result.periods) == {0}


def test_sweep_that_diverges_says_so():
    osc = GearOscillator(FourierStiffness(1.0, (0.9,), (0.0,)), 0.0, 0.1, 0.2, 2.0, half_backlash=0.1)
    result = sweep(osc, values=[2.0, 9.0], keep=32, transient=4000)
    assert not result.converged
    assert result.labels[0] == "diverged"
    assert np.all(np.isnan(result.states[0]))
    assert np.all(np.isfinite(result.states[1]))


def test_repeat_after():
    wave = np.cos(2 * np.pi * np.arange(30) / 3)[:, None] * [1.0, 2.0]
    assert repeat_after(wave, 8) == 3
    assert repeat_after(np.cos(np.arange(30.0))[:, None] * [1.0, 2.0], 8) == 0


def test_small_subharmonic_is_a_longer_period():
    wave = np.array([[1.0, 2.0]]) + 1e-3 * (-1.0) ** np.arange(40)[:, None]
    assert repeat_after(wave, 8) == 2


@pytest.mark.parametrize("off", [5e-4, 1e-4, 1e-5])
def test_slow_motions_next_to_a_period_doubling_are_named_right(article, off):
    """1-1-0 doubles at 0.8872414998606: with a multiplier of -1 + O(off) it takes up to 1e5 periods to settle."""
    doubling = 0.8872414998606
    before = article(frequency=doubling - off)
    orbit = next(o for o in find_orbits(before, (1,)).orbits if o.label == "1-1-0")
    assert orbit.multipliers[0] == pytest.approx(-1.0, abs=30 * off)
    result = sweep(before, values=[doubling - off], initial=orbit.state + np.array([1e-4, 0.0]), keep=32)
    assert result.labels == ("1-1-0",)
    result = sweep(before, values=[doubling + off], initial=orbit.state + np.array([1e-4, 0.0]), keep=32)
    assert result.periods[0] == 2


def test_a_settled_motion_is_not_followed_to_the_end(article):
    """The transient ends where the motion repeats to rounding; the states kept are the same."""
    long = sweep(article(), values=[0.5], transient=2000, keep=32)
    short = sweep(article(), values=[0.5], keep=32)
    assert long.cost.periods < 500
    np.testing.assert_allclose(long.states, short.states, rtol=0, atol=1e-12)


def test_one_sided_play_has_the_same_touch(article):
    both, one = (contact_grazing(article(one_sided=s), bounds=(0.4, 1.5)).points[0] for s in (False, True))
    assert both.parameter == one.parameter
    branch = continue_branch(
        find_orbit(article(frequency=0.5, one_sided=True), (0.35, 0.0)), "frequency", (0.5, 1.2)
    )
    assert branch.converged, branch.message
    assert branch.special("grazing")[0].parameter == pytest.approx(one.parameter, rel=0, abs=1e-13)
    assert {p.boundary for p in branch.special("grazing")} == {1}
