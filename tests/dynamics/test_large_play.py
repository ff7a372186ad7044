"""Play that is large against the deflection moves a motion and changes nothing about it."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import (
    FourierStiffness,
    GearOscillator,
    continue_branch,
    continue_locus,
    doubled_orbit,
    find_orbit,
)
from dynamics.branches.sizes import size_of
from tests.dynamics.test_drives import same_as


def pair(play: float, **changes) -> GearOscillator:
    return GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, play, **changes)


def branch(play: float, **changes):
    osc = pair(play, **changes)
    return osc, continue_branch(find_orbit(osc, (play + 0.1, 0.0)), "frequency", (0.45, 1.2))


@pytest.fixture(scope="module")
def without_back_flank():
    return branch(0.2, one_sided=True)[1]


@pytest.mark.parametrize(("play", "digits"), [(0.0, 12), (30.0, 11), (100.0, 11), (1e4, 9)])
def test_a_branch_is_moved_by_the_play(without_back_flank, play: float, digits: int):
    """The back flank is never met; a branch with play 450 times the load has all its folds."""
    _, found = branch(play, one_sided=play == 0.0)
    assert found.converged
    assert found.ended == ("bound", "bound")
    kinds = ["grazing", "saddle-node", "saddle-node", "period-doubling"]
    assert [p.kind for p in found.points] == kinds == [p.kind for p in without_back_flank.points]
    for mine, other in zip(found.points, without_back_flank.points, strict=True):
        assert mine.parameter == pytest.approx(other.parameter, abs=10.0**-digits)
        assert mine.state - [play, 0.0] == pytest.approx(other.state - [0.2, 0.0], abs=10.0 ** (1 - digits))


def test_a_train_is_moved_by_the_play(without_back_flank):
    osc = same_as(pair(100.0))
    found = continue_branch(find_orbit(osc, osc.rest_state()), "frequency", (0.58, 0.7), max_points=120)
    marks = {p.kind: p.parameter for p in without_back_flank.points[:2]}
    assert {p.kind: p.parameter for p in found.points} == pytest.approx(marks, abs=1e-9)


def test_doubled_orbits_and_loci_in_much_play(without_back_flank):
    osc, found = branch(1e3)
    doubled = doubled_orbit(osc, "frequency", found.special("period-doubling")[0], (0.45, 1.2))
    assert doubled.label.lstrip("U").startswith("2-2")
    bounds = ((0.6, 0.7), (0.095, 0.105))
    there, here = (
        continue_locus(
            pair(play, one_sided=True), b.special("saddle-node")[0], ("frequency", "mean_force"), bounds
        )
        for play, b in ((1e3, found), (0.2, without_back_flank))
    )
    assert there.ended == here.ended == ("bound", "bound")
    assert there.values[[0, -1]] == pytest.approx(here.values[[0, -1]], abs=1e-9)


def test_a_motion_is_measured_without_play_that_it_does_not_reach():
    for play in (10.0, 1e4):
        osc = pair(play)
        orbit = find_orbit(osc, (play + 0.1, 0.0))
        assert size_of(osc, orbit.state, 1) == pytest.approx(0.8, abs=0.2)
    across = pair(0.2).with_parameter("frequency", 0.7)  # one that meets both flanks
    orbit = find_orbit(across, (1.0, 0.5))
    assert orbit.label == "1-1-1"
    assert size_of(across, orbit.state, 1) == np.max(np.abs(orbit.state))
