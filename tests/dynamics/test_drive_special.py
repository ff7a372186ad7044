"""Special points of drive trains over several parameters: a train of one freedom has those of its pair."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import (
    DriveOscillator,
    FourierStiffness,
    GearOscillator,
    carried_point,
    continue_branch,
    continue_locus,
    find_orbit,
    special_sensitivities,
)
from dynamics.branches.sensitivity import map_derivatives
from tests.dynamics.test_drives import chain, same_as

PAIR = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
TRAIN = replace(same_as(PAIR), free_mesh_damping=None)
# the train's name of a parameter, and what one unit of it is of the pair's
NAMES = {
    "mean_force": ("mean_force[0]", 1.0),
    "damping_ratio": ("mesh_damping", 2.0),
    "half_backlash": ("half_backlash", 1.0),
    "error_amplitude": ("error_amplitude", 1.0),
    "stiffness.amplitudes[0]": ("mesh_stiffness.amplitudes[0]", 1.0),
}


@pytest.fixture(scope="module")
def branches():
    """The branch on which the pair leaves contact, of the pair and of the train."""
    start = find_orbit(PAIR, (0.35, 0.0))
    shift = TRAIN.lifted(start.state[None], np.zeros(1))[0]
    return [continue_branch(orbit, "frequency", (0.62, 0.67)) for orbit in (start, find_orbit(TRAIN, shift))]


def special_points(branches, kind: str):
    return [branch.special(kind)[0] for branch in branches]


@pytest.mark.parametrize("state", [(0.5, 0.2), (0.1, -0.6)])
def test_second_derivatives_are_those_of_the_pair(state):
    names = ["mean_force", "half_backlash"]
    theirs = map_derivatives(PAIR, state, tuple(names), 2)
    here = TRAIN.lifted(np.array([state]), np.zeros(1))[0]
    ours = map_derivatives(TRAIN, here, tuple(NAMES[name][0] for name in names), 2)
    assert sum(theirs.counts) > 0
    assert ours.counts == theirs.counts
    assert ours.jacobian == pytest.approx(theirs.jacobian, abs=1e-10)
    assert ours.slope == pytest.approx(theirs.slope, abs=1e-8)
    assert ours.second == pytest.approx(theirs.second, abs=1e-7 * np.max(np.abs(theirs.second)))


@pytest.mark.parametrize("kind", ["saddle-node", "grazing"])
def test_sensitivities_are_those_of_the_pair(branches, kind):
    theirs, ours = special_points(branches, kind)
    assert ours.parameter == pytest.approx(theirs.parameter, abs=1e-9)
    exact = special_sensitivities(PAIR, "frequency", theirs, list(NAMES))
    by_train = special_sensitivities(TRAIN, "frequency", ours, [name for name, _ in NAMES.values()])
    for name, (known, unit) in NAMES.items():
        assert by_train[known] * unit == pytest.approx(exact[name], rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("kind", ["saddle-node", "grazing"])
def test_a_locus_is_that_of_the_pair(branches, kind):
    theirs, ours = special_points(branches, kind)
    bounds = ((0.6, 0.7), (0.095, 0.105))
    of_pair = continue_locus(PAIR, theirs, ("frequency", "mean_force"), bounds)
    of_train = continue_locus(TRAIN, ours, ("frequency", "mean_force[0]"), bounds, step=0.05, max_step=0.1)
    assert of_train.ended == of_pair.ended
    assert of_train.converged
    for locus in (of_pair, of_train):
        assert {*locus.values[[0, -1], 1].round(12).tolist()} == {0.095, 0.105}
    order = np.argsort(of_pair.values[:, 1])
    between = np.interp(of_train.values[:, 1], *of_pair.values[order].T[::-1])
    ends = [0, -1]
    assert np.sort(of_train.values[ends, 0]) == pytest.approx(np.sort(of_pair.values[ends, 0]), abs=1e-9)
    assert of_train.values[:, 0] == pytest.approx(between, abs=1e-4)  # chords of the pair's curve


def test_a_point_is_carried_to_where_that_of_the_pair_is(branches):
    theirs, ours = special_points(branches, "saddle-node")
    there = FourierStiffness(1.0, (0.18, 0.05), (0.0, 1.0))
    of_pair = carried_point(PAIR, "frequency", theirs, there)
    of_train = carried_point(TRAIN, "frequency", ours, there)
    assert of_train.parameter == pytest.approx(of_pair.parameter, abs=1e-9)
    assert abs(of_train.parameter - ours.parameter) > 1e-3


def test_a_force_that_nothing_holds_may_not_change_alone():
    """Two free gears are the oscillator of their mesh, mass 1.2: all other derivatives are those of one freedom."""
    free = DriveOscillator(
        np.diag([2.0, 3.0]), np.zeros((2, 2)), np.zeros((2, 2)), [1.0, -1.0], PAIR.stiffness, 0.1, [0.1, -0.1],
        0.2, 0.58, 0.2,
    )  # fmt: skip
    mesh = DriveOscillator([[1.2]], [[0.0]], [[0.0]], [1.0], PAIR.stiffness, 0.1, [0.1], 0.2, 0.58, 0.2)
    slopes = []
    for train in (free, mesh):
        orbit = find_orbit(train, train.rest_state(), transient=300)
        fold = continue_branch(orbit, "frequency", (0.5, 0.62)).special("saddle-node")[0]
        slopes.append(special_sensitivities(train, "frequency", fold))
    assert np.isnan(slopes[0].pop("mean_force[0]"))
    assert np.isnan(slopes[0].pop("mean_force[1]"))
    assert np.isfinite(slopes[1].pop("mean_force[0]"))
    assert slopes[0].keys() == slopes[1].keys()
    for name, slope in slopes[0].items():
        assert slope == pytest.approx(slopes[1][name], rel=1e-6, abs=1e-7)


LOUD = {"mean_force": [0.4, 0.0, 0.0, 0.5], "error_amplitude": 0.2, "error_phase": 0.0}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "start", "bounds", "kind"),
    [
        ({}, 1.3, (1.275, 1.31), "saddle-node"),
        (LOUD, 0.4975, (0.494, 0.498), "neimark-sacker"),
        (LOUD, 0.4975, (0.494, 0.498), "grazing"),
    ],
)
def test_points_of_four_freedoms_move_as_their_derivatives_say(changes, start, bounds, kind):
    """Against the points located again on the branch with another mean force."""
    train, name = chain(**changes), "mean_force[0]"
    places = {}
    for push in (-1e-5, 0.0, 1e-5):
        here = train.with_parameter(name, train.get(name) + push)
        orbit = find_orbit(here.with_parameter("frequency", start), here.rest_state(), transient=300)
        places[push] = continue_branch(orbit, "frequency", bounds).special(kind)[0]
    slope = special_sensitivities(train, "frequency", places[0.0], [name])[name]
    moved = (places[1e-5].parameter - places[-1e-5].parameter) / 2e-5
    assert slope == pytest.approx(moved, rel=1e-4)
