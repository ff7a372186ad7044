"""Orbits of several periods in a diagram, followed through all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import dynamics
from dynamics.attraction.returns import branch_returns, returns

OSCILLATOR = dynamics.GearOscillator(
    stiffness=dynamics.FourierStiffness(mean=1.0, amplitudes=(0.18,), phases=(0.0,)),
    damping_ratio=0.05,
    mean_force=0.1,
    error_amplitude=0.2,
    frequency=0.6,
    half_backlash=0.2,
)


@pytest.fixture(scope="module")
def found() -> dynamics.Diagram:
    return dynamics.diagram(
        OSCILLATOR, "frequency", (1.6, 1.8), periods=(1, 2), searches=2, swept=10, max_period=4
    )


def test_an_orbit_has_a_point_at_the_start_of_each_further_period(found: dynamics.Diagram):
    rows = returns(found)
    periods = {branch.periods for branch in found.branches}
    assert periods & {2, 4}
    for number, branch in enumerate(found.branches):
        mine = rows[rows[:, 0] == number]
        assert len(mine) == (branch.periods - 1) * len(branch.values)
        for which in range(1, branch.periods):
            own = mine[mine[:, 1] == which]
            middle = len(own) // 2
            there = OSCILLATOR.with_parameter("frequency", branch.values[middle])
            state = dynamics.period_map(there, branch.states[middle], periods=which).state
            assert own[middle, 3:5] == pytest.approx(state, abs=1e-9)


def test_the_picture_draws_all_points_of_an_orbit(found: dynamics.Diagram):
    """It drew one of n."""
    drawn = points_of(found)
    for row in returns(found):
        assert tuple(np.round(row[2:4], 9)) in drawn


def test_the_picture_of_a_branch_draws_all_points_of_an_orbit(found: dynamics.Diagram):
    alone = next(branch for branch in found.branches if branch.periods == 2)
    again = dynamics.continue_branch(
        dynamics.find_orbit(
            OSCILLATOR.with_parameter("frequency", alone.values[0]), alone.states[0], periods=2
        ),
        "frequency",
        (1.6, 1.8),
    )
    assert again.periods == 2
    for branch in (alone, again):
        drawn, rows = points_of(branch), branch_returns(branch, OSCILLATOR)
        assert len(rows) == len(branch.values)
        for row in rows:
            assert tuple(np.round(row[1:3], 9)) in drawn


def points_of(record: Any) -> set[tuple[float, ...]]:
    """All points of a record's picture, rounded."""
    from flankfilm.figures.views import register

    register()
    lines = record.plot().axes[0].lines
    return {tuple(np.round(point, 9)) for line in lines for point in line.get_xydata()}
