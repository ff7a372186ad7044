"""Doubled branches end where they meet their parent, wherever the steps fall."""

from __future__ import annotations

import pytest

from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit

# a doubling 1.3e-6 behind a grazing of the doubled orbit
OSC = GearOscillator(
    FourierStiffness(1.0, (0.27453763443501317, 0.19618272785946111), (-1.7729432320197307, 0.32238217719136664)),
    0.03403981308014636, 0.11891695941692546, 0.37537741717197387, 0.6823614780010967, 0.8120925495895593,
)  # fmt: skip
BOUNDS = (0.005, 0.5)


@pytest.fixture(scope="module")
def doubled():
    return find_orbit(OSC, [-0.0542502603639943, 0.11672874396397082], periods=2)


@pytest.mark.parametrize(
    ("step", "most"), [(0.005, 0.02), (0.005, 0.05), (0.02, 0.2), (0.05, 0.4), (0.005, 0.005)]
)
def test_special_points_do_not_depend_on_the_steps(doubled, step, most):
    branch = continue_branch(doubled, "mean_force", BOUNDS, step=step, max_step=most)
    assert branch.converged
    assert branch.ended == ("bound", "meets the branch of half the period")
    found = {p.kind: p.parameter for p in branch.points}
    assert found == {
        "period-doubling": pytest.approx(0.214753986337, abs=1e-11),
        "saddle-node": pytest.approx(0.218231618522, abs=1e-11),
        "grazing": pytest.approx(0.218229835395, abs=1e-11),
    }
    assert branch.meetings[0] is None
    assert branch.meetings[1].parameter == pytest.approx(0.2182285205669, abs=1e-12)


def test_the_meeting_is_the_period_doubling_of_the_parent(doubled):
    rejoining_point = continue_branch(doubled, "mean_force", BOUNDS).meetings[1]
    there = OSC.with_parameter("mean_force", rejoining_point.parameter)
    parent = find_orbit(there, rejoining_point.state, periods=1)
    assert parent.periods == rejoining_point.periods == 1
    assert min(abs(m + 1.0) for m in parent.multipliers) < 1e-8
    (again,) = continue_branch(parent, "mean_force", (0.21, 0.2199)).special("period-doubling")
    assert again.parameter == pytest.approx(rejoining_point.parameter, abs=1e-13)
