"""Damping that is another one out of contact: an integrator, the determinant, limits, and what is built on the map."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import dynamics
from base import InputError
from dynamics import FourierStiffness, GearOscillator, find_orbit, period_map, trajectory
from dynamics.attraction.manifolds import reversed_tables
from dynamics.branches.sensitivity import map_derivatives
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.protocol import propagated
from tests.dynamics.conftest import step_by_step

STATE = np.array([0.5, 0.2])


def oscillator(**changes) -> GearOscillator:
    given = {
        "stiffness": FourierStiffness(1.0, (0.18,), (0.0,)), "damping_ratio": 0.05, "mean_force": 0.1,
        "error_amplitude": 0.2, "frequency": 0.6, "half_backlash": 0.2, "free_damping_ratio": 0.2,
    }  # fmt: skip
    return GearOscillator(**(given | changes))


CASES = {
    "more between": oscillator(),
    "less between": oscillator(damping_ratio=0.1, free_damping_ratio=0.01),
    "none between": oscillator(free_damping_ratio=0.0),
    "both flanks": oscillator(mean_force=0.0, error_amplitude=0.6),
    "one flank": oscillator(one_sided=True, free_damping_ratio=0.4),
}


@pytest.mark.parametrize("osc", CASES.values(), ids=CASES)
def test_against_an_integrator(osc):
    """Three periods with impacts: state and Jacobian within what the integrator's own tolerance leaves."""
    state, jacobian, counts = step_by_step(osc, STATE, 3 * osc.period)
    ours = period_map(osc, STATE, 3)
    assert counts[0] > 1
    assert tuple(ours.counts.sum(axis=0)) == counts
    assert ours.state == pytest.approx(state, abs=1e-11)
    assert ours.jacobian == pytest.approx(jacobian, abs=1e-11 * np.max(np.abs(jacobian)))


@pytest.mark.parametrize("osc", CASES.values(), ids=CASES)
def test_determinant_is_what_both_dampings_take(osc):
    """det = exp(-2 zeta t) over every part; the jumps between them have the determinant 1."""
    image = period_map(osc, STATE, 4)
    motion = trajectory(osc, STATE, 4, 10)
    edges = np.concatenate([[0.0], motion.events[:, 0], [4 * osc.period]])
    regions = np.concatenate([[float(STATE[0] > osc.half_backlash)], motion.events[:, 3]])
    pressed, free = osc.damping_ratios
    taken = np.sum(np.diff(edges) * np.where(regions != 0.0, pressed, free))
    assert 0.0 < np.sum(np.diff(edges)[regions == 0.0]) < 4 * osc.period
    assert image.log_determinant == pytest.approx(-2.0 * taken, rel=1e-13)
    assert np.linalg.slogdet(image.jacobian)[1] == pytest.approx(image.log_determinant, abs=1e-12)


def test_the_same_out_of_contact_gives_the_same_digits():
    plain = oscillator(free_damping_ratio=None)
    same = oscillator(free_damping_ratio=plain.damping_ratio)
    ours, theirs = (period_map(osc, STATE, 5) for osc in (same, plain))
    assert np.array_equal(ours.states, theirs.states)
    assert np.array_equal(ours.jacobian, theirs.jacobian)
    assert ours.log_determinant == theirs.log_determinant
    here, there = (dynamics.lyapunov_exponents(osc, 40, transient=20).exponents for osc in (same, plain))
    assert np.array_equal(here, there)


def test_one_name_for_both_moves_both():
    """Without a free damping ratio of its own the dead zone follows the parameter, in derivatives and on branches."""
    both = oscillator(free_damping_ratio=None)
    apart = oscillator(free_damping_ratio=both.damping_ratio)
    assert "free_damping_ratio" not in both.parameters
    whole = map_derivatives(both, STATE, ("damping_ratio",))
    parts = map_derivatives(apart, STATE, ("damping_ratio", "free_damping_ratio"))
    assert np.all(np.abs(parts.slope) > 1e-3)
    assert parts.slope.sum(axis=1) == pytest.approx(whole.slope[:, 0], abs=1e-13)
    assert parts.second[2:].sum(axis=0) == pytest.approx(whole.second[2], abs=1e-12)


def test_no_play_never_meets_it():
    shut = oscillator(half_backlash=0.0)
    ours, theirs = (
        period_map(osc, STATE, 3) for osc in (shut, dataclasses.replace(shut, free_damping_ratio=None))
    )
    assert np.array_equal(ours.states, theirs.states)
    assert np.array_equal(ours.jacobian, theirs.jacobian)
    assert ours.log_determinant == pytest.approx(theirs.log_determinant, rel=1e-14)


def test_free_flight_in_closed_form():
    """Between the flanks V falls as exp(-2 zeta t) towards F/(2 zeta)."""
    osc = oscillator(half_backlash=50.0, error_amplitude=0.0, mean_force=0.1)
    c, t, v = 2.0 * 0.2, osc.period, 0.7
    image = period_map(osc, (0.0, v))
    shrink = math.exp(-c * t)
    assert image.state[1] == pytest.approx(v * shrink + 0.1 / c * (1.0 - shrink), rel=1e-14)
    assert image.state[0] == pytest.approx(
        v / c * (1.0 - shrink) + 0.1 / c * (t - (1.0 - shrink) / c), rel=1e-14
    )


def test_backwards_and_forwards_again():
    osc = oscillator(mean_force=0.0, error_amplitude=0.6)
    ahead = propagated(exact_flow(osc), STATE, 1)
    assert propagated(reversed_tables(osc), ahead, 1, backwards=True)[0] == pytest.approx(STATE, abs=1e-12)


def test_exponents_add_up_to_the_mean_damping():
    osc = oscillator(mean_force=0.0, error_amplitude=0.6)
    found = dynamics.lyapunov_exponents(osc, 60, transient=40)
    assert 0.1 < found.damping < 0.4
    assert found.exponents.sum() == pytest.approx(-found.damping, abs=1e-13)
    assert dynamics.lyapunov_scan(osc, "frequency", [0.6], 60, transient=40).defect < 1e-12


def test_a_stiff_orbit_in_stretches_keeps_the_small_multiplier():
    """Slow and hardly damped: the determinant by the time in contact, counted along many stretches."""
    osc = oscillator(
        frequency=0.03, damping_ratio=0.02, free_damping_ratio=0.05, error_amplitude=0.0, mean_force=-0.05
    )
    osc = dataclasses.replace(osc, stiffness=FourierStiffness(0.2, (1.2,), (0.0,)))
    orbit = find_orbit(osc, (-1.0, 0.0))
    assert orbit.converged
    assert len(orbit.nodes) > 0
    assert -2.0 * 0.05 * osc.period < math.log(orbit.determinant) < -2.0 * 0.02 * osc.period


def test_branch_locates_folds_grazings_and_doublings():
    """Special points of a branch meet their condition by the map itself, and by the integrator's Jacobian."""
    osc = oscillator(frequency=0.64)
    branch = dynamics.continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.55, 0.68))
    assert branch.converged
    folds, touches = branch.special("saddle-node"), branch.special("grazing")
    assert folds
    assert touches
    for point in folds:
        here = osc.with_parameter("frequency", point.parameter)
        state, jacobian, _ = step_by_step(here, point.state, here.period)
        assert state == pytest.approx(point.state, abs=1e-9)
        assert np.linalg.eigvals(jacobian).real.max() == pytest.approx(1.0, abs=1e-5)
    for point in touches:
        extrema = trajectory(osc.with_parameter("frequency", point.parameter), point.state, 1, 10).extrema[
            :, 1
        ]
        assert np.min(np.abs(np.abs(extrema) - osc.half_backlash)) < 1e-10


def test_locus_of_folds_over_the_free_damping():
    """Newton's method on the fold in two parameters, of which one is the free damping: every point is a fold."""
    osc = oscillator(frequency=0.64)
    branch = dynamics.continue_branch(find_orbit(osc, (0.35, 0.0)), "frequency", (0.55, 0.68))
    fold = branch.special("saddle-node")[0]
    locus = dynamics.continue_locus(
        osc, fold, ("frequency", "free_damping_ratio"), ((0.4, 0.8), (0.15, 0.25))
    )
    assert locus.converged
    assert np.ptp(locus.values[:, 1]) > 0.05
    for values, state in zip(locus.values[::5], locus.states[::5], strict=True):
        here = osc.with_parameter("frequency", values[0]).with_parameter("free_damping_ratio", values[1])
        image = period_map(here, state)
        assert image.state == pytest.approx(state, abs=1e-11)
        assert 1.0 + math.exp(image.log_determinant) - np.trace(image.jacobian) == pytest.approx(
            0.0, abs=1e-9
        )


def test_attractors_of_basins_are_those_of_sweeps():
    osc = oscillator()
    found = dynamics.basins(osc, x=(-0.9, 0.9, 5), v=(-0.9, 0.9, 5), limit=80)
    swept = dynamics.sweep(osc, "frequency", [0.6], transient=200, keep=32).states[0, -1]
    homes = np.concatenate([np.atleast_2d(attractor.states) for attractor in found.attractors])
    assert np.min(np.max(np.abs(homes - swept), axis=1)) < 1e-8


@pytest.mark.parametrize("value", [-0.1, math.nan, "much"])
def test_refused_by_name(value):
    with pytest.raises(InputError, match="free_damping_ratio"):
        oscillator(free_damping_ratio=value)
