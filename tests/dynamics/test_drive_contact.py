"""Where drive trains never leave contact: a linear problem, as of a pair, and the springs that hold a train."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, contact_grazing, find_orbit, trajectory
from dynamics.branches.grazing import contact_orbit
from tests.dynamics.test_drives import chain, same_as

PAIR = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
TRAIN = same_as(PAIR)


@pytest.mark.parametrize("side", [1, -1])
def test_the_linear_orbit_is_that_of_the_pair(side):
    theirs, ours = contact_orbit(PAIR, side), contact_orbit(TRAIN, side)
    assert ours.state == pytest.approx(TRAIN.lifted(theirs.state[None], np.zeros(1))[0], abs=1e-12)
    for name in ("clearance", "tau", "acceleration"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), abs=1e-9)


def test_contact_is_first_lost_where_the_pair_loses_it():
    theirs, ours = (contact_grazing(osc, "frequency", (0.6, 0.7), points=20) for osc in (PAIR, TRAIN))
    assert len(theirs.points) == len(ours.points) == 1
    assert ours.points[0].parameter == pytest.approx(theirs.points[0].parameter, abs=1e-12)
    assert ours.points[0].acceleration == pytest.approx(theirs.points[0].acceleration, abs=1e-9)


def test_the_linear_orbit_of_a_held_train_is_its_orbit_while_it_clears_the_backlash():
    """Springs to the ground bear what the backlash lets the train move; Newton's method on the whole map says so."""
    train = chain(mean_force=[0.4, 0.0, 0.0, 0.5], error_amplitude=0.01, error_phase=0.0)
    linear, orbit = contact_orbit(train), find_orbit(train, train.rest_state())
    assert linear.clearance > 0.0
    assert orbit.label == "1-0-0"
    assert linear.state == pytest.approx(orbit.state, abs=1e-10)
    y = trajectory(train, orbit.state, 1, 2000).x
    assert linear.clearance == pytest.approx(np.min(y) - train.half_backlash, abs=1e-5)


def test_acceleration_at_a_turning_point_at_the_beginning():
    """y'' at tau = 0 of a state whose contact coordinate stands still, against a parabola through its motion."""
    train = chain(half_backlash=0.0)
    state = train.rest_state()
    y, rate = train.contact_motion(np.zeros(1), state[None])
    assert abs(rate[0]) < 1e-14
    motion = trajectory(train, state, 1, 20_000)
    step = motion.tau[1]
    bend = 2.0 * (motion.x[1] - y[0]) / step**2
    assert train.turning_acceleration(state) == pytest.approx(bend, abs=5e-3)
