"""Damping that jumps, at its extremes: none between the flanks, far more there, hardly any backlash, chatter."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import brentq

import dynamics
from dynamics import FourierStiffness, GearOscillator, find_orbit, period_map, trajectory
from dynamics.branches.sensitivity import map_derivatives
from tests.dynamics.conftest import step_by_step

STIFFNESS = FourierStiffness(1.0, (0.3, 0.1), (0.0, 0.7))
START = np.array([0.4, 0.3])


def oscillator(**changes) -> GearOscillator:
    given = {
        "stiffness": STIFFNESS, "damping_ratio": 0.05, "mean_force": 0.05, "error_amplitude": 0.3, "frequency": 0.8,
        "half_backlash": 0.2, "free_damping_ratio": 0.2,
    }  # fmt: skip
    return GearOscillator(**(given | changes))


HARD = {
    "none between": oscillator(free_damping_ratio=0.0),
    "none in contact": oscillator(damping_ratio=0.0, free_damping_ratio=0.3),
    "forty times more between": oscillator(free_damping_ratio=2.0),
    "overdamped between": oscillator(free_damping_ratio=5.0, half_backlash=0.01),
    "hardly any backlash": oscillator(half_backlash=1e-6, mean_force=0.0),
    "chatter on one side": oscillator(
        one_sided=True, frequency=0.15, damping_ratio=0.02, free_damping_ratio=0.01
    ),
    "chatter on both": oscillator(mean_force=0.0, error_amplitude=0.8, half_backlash=0.05, frequency=0.4),
    "long chatter on both": oscillator(
        mean_force=0.0, half_backlash=0.05, frequency=0.15, damping_ratio=0.02, free_damping_ratio=0.01
    ),
}


@pytest.mark.parametrize("osc", HARD.values(), ids=HARD)
def test_two_periods_against_an_integrator(osc):
    state, jacobian, counts = step_by_step(osc, START, 2 * osc.period)
    image = period_map(osc, START, 2)
    assert sum(counts) > 0
    assert tuple(image.counts.sum(axis=0)) == counts
    assert image.state == pytest.approx(state, abs=1e-11)
    assert image.jacobian == pytest.approx(jacobian, abs=1e-10 * max(1.0, np.max(np.abs(jacobian))))
    taken = np.linalg.slogdet(image.jacobian)[1]  # of the matrix as it is rounded
    rounding = 1e-13 * np.max(np.abs(image.jacobian)) ** 2 / math.exp(image.log_determinant)
    assert taken == pytest.approx(image.log_determinant, abs=1e-11 + rounding)


@pytest.mark.parametrize("depth", [1e-2, 1e-5, 1e-8, 1e-11])
def test_a_graze_however_light(depth):
    """The two jumps of a graze cancel: the map with a damping of its own goes over into that without, as the root."""
    plain = oscillator(
        free_damping_ratio=None, error_amplitude=0.0, mean_force=0.3, stiffness=FourierStiffness(1.0)
    )

    def gap(x: float) -> float:
        turns = trajectory(plain, (x, 0.0), 1, 10).extrema[:, 1]
        return float(np.min(turns)) - plain.half_backlash

    x = brentq(lambda x: gap(x) + depth, 0.55, 1.1, xtol=1e-15)
    dipped, jumping = np.array([x, 0.0]), dataclasses.replace(plain, free_damping_ratio=0.5)
    image = period_map(jumping, dipped)
    assert x > plain.half_backlash
    assert image.counts.sum() == 1
    if depth > 1e-3:  # lighter ones lie within a step of the integrator, which sees neither crossing
        state, _, counts = step_by_step(jumping, dipped, jumping.period)
        assert counts == tuple(image.counts[0])
        assert image.state == pytest.approx(state, abs=1e-11)
    smooth = period_map(plain, dipped)
    assert np.max(np.abs(image.state - smooth.state)) < 2.0 * depth + 1e-13
    assert np.max(np.abs(image.jacobian - smooth.jacobian)) < 20.0 * math.sqrt(depth)


def test_backlash_that_vanishes_takes_its_damping_along():
    """D to 0: what happens between the flanks takes a time of the order of D, and its jumps cancel."""
    closed = oscillator(half_backlash=0.0, mean_force=0.0)
    shut = period_map(closed, START, 2)
    for d in (1e-4, 1e-7, 1e-10):
        image = period_map(dataclasses.replace(closed, half_backlash=d), START, 2)
        assert np.max(np.abs(image.state - shut.state)) < 50.0 * d
        assert np.max(np.abs(image.jacobian - shut.jacobian)) < 500.0 * d + 1e-12


def test_orbits_found_where_damping_is_in_contact_alone():
    """Orbits, multipliers whose product is the determinant, and derivatives by the free damping at its bound 0."""
    osc = oscillator(free_damping_ratio=0.0)
    orbit = find_orbit(osc, START, transient=400)
    assert orbit.converged, orbit.message
    assert np.prod(orbit.multipliers).real == pytest.approx(orbit.determinant, rel=1e-9)
    slope = map_derivatives(osc, orbit.state, ("free_damping_ratio",), orbit.periods).slope[:, 0]
    ahead = period_map(osc.with_parameter("free_damping_ratio", 1e-7), orbit.state, orbit.periods).state
    assert (ahead - orbit.state) / 1e-7 == pytest.approx(slope, rel=1e-4, abs=1e-4 * np.max(np.abs(slope)))


@pytest.mark.slow
def test_an_index_that_adds_up_with_chatter_on_both_sides():
    found = dynamics.find_orbits(HARD["chatter on both"], (1, 2), starts=60)
    assert found.orbits
    for orbit in found.orbits:
        image = period_map(HARD["chatter on both"], orbit.state, orbit.periods)
        assert image.state == pytest.approx(orbit.state, abs=1e-9 * max(1.0, np.max(np.abs(image.jacobian))))
