"""Many steps at a time come to the points of single ones, and leave to these whatever lies between two points."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, continue_branch, doubled_orbit, find_orbit
from dynamics.branches.arclength import _Walker
from dynamics.branches.compiled_steps import BLOCK, alike
from dynamics.branches.crossings import ExactBranch

OSCILLATOR = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.5, half_backlash=0.2)


@pytest.fixture
def both(monkeypatch):
    """A branch by many steps at a time and by single ones, and how many single ones the former took."""

    def branches(*arguments, **options):
        single = []
        attempt = _Walker.attempt
        with monkeypatch.context() as patch:
            patch.setattr(_Walker, "attempt", lambda self, last: single.append(0) or attempt(self, last))
            many = continue_branch(*arguments, **options)
        with monkeypatch.context() as patch:
            patch.setattr(ExactBranch, "march", lambda *_: None)
            return many, continue_branch(*arguments, **options), len(single)

    return branches


def same(a, b):
    """Whether two branches are the same to rounding."""
    assert (a.ended, a.labels, a.message) == (b.ended, b.labels, b.message)
    np.testing.assert_allclose(a.values, b.values, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(a.states, b.states, rtol=0.0, atol=1e-13)
    np.testing.assert_allclose(a.multipliers, b.multipliers, rtol=1e-9, atol=1e-11)
    assert [p.kind for p in a.points] == [p.kind for p in b.points]
    np.testing.assert_allclose(
        [p.parameter for p in a.points], [p.parameter for p in b.points], rtol=0.0, atol=1e-13
    )


@pytest.mark.parametrize(
    ("parameter", "bounds"),
    [
        ("frequency", (0.45, 0.9)),  # saddle nodes, a doubling, grazings, other numbers of cells
        ("error_amplitude", (0.15, 0.3)),
        ("mean_force", (-0.1, 0.2)),
        ("half_backlash", (0.0, 0.5)),
        ("stiffness.amplitudes[0]", (-0.3, 0.3)),
    ],
)
@pytest.mark.parametrize("change", [{}, {"free_damping_ratio": 0.02}, {"one_sided": True}])
def test_points_and_events_are_those_of_single_steps(both, parameter, bounds, change):
    oscillator = replace(OSCILLATOR, **change)
    many, single, looked = both(find_orbit(oscillator, (0.35, 0.0)), parameter, bounds, max_points=300)
    same(many, single)
    assert looked < 0.5 * len(many.values) + 20 * len(many.points)


def test_most_points_are_passed_without_a_look(both):
    many, single, looked = both(
        find_orbit(OSCILLATOR, (0.35, 0.0)), "frequency", (0.5, 1.2), max_step=0.01, max_points=300
    )
    same(many, single)
    assert len(many.points) > 2
    assert looked < 0.2 * len(many.values)


def test_a_doubled_branch_ends_where_it_meets_its_parent(both):
    parent = continue_branch(find_orbit(OSCILLATOR, (0.35, 0.0)), "frequency", (0.5, 1.2))
    doubling = parent.special("period-doubling")[0]
    many, single, _ = both(
        doubled_orbit(OSCILLATOR, "frequency", doubling, (0.5, 1.2)), "frequency", (0.5, 1.2)
    )
    same(many, single)
    assert "meets the branch of half the period" in many.ended


def test_a_start_beside_an_event(both):
    branch = continue_branch(find_orbit(OSCILLATOR, (0.35, 0.0)), "frequency", (0.5, 1.2))
    for kind in ("grazing", "period-doubling"):
        event = branch.special(kind)[0]
        beside = replace(OSCILLATOR, frequency=event.parameter - 1e-7)
        start = find_orbit(beside, event.state)
        assert start.converged
        many, single, _ = both(start, "frequency", (0.5, 1.2), max_points=20)
        same(many, single)
        assert kind in [p.kind for p in many.points]


def test_steps_refused_again_and_again(both):
    """Large first steps over grazings in lightly damped motion, shortened many times."""
    oscillator = GearOscillator(FourierStiffness(1.0, (0.1,), (0.0,)), 0.01, 0.05, 0.2, 0.3, 1.0)
    orbit = find_orbit(oscillator, oscillator.rest_state(), transient=2000)
    many, single, _ = both(orbit, "frequency", (0.3, 0.6), step=0.3, max_step=0.3)
    same(many, single)
    assert len(many.special("grazing")) > 2


@pytest.mark.parametrize("limit", [1, 2, BLOCK, BLOCK + 1])
def test_as_many_points_as_are_allowed(both, limit):
    orbit = find_orbit(OSCILLATOR, (0.35, 0.0))
    many, single, _ = both(orbit, "frequency", (0.4999, 1.2), max_step=1e-3, max_points=limit)
    same(many, single)
    assert many.ended[1] == f"{limit} points: raise max_points"


def test_progress_says_every_point_and_may_interrupt():
    seen = []

    def progress(number, value):
        seen.append((number, value))
        if number == 100:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        continue_branch(
            find_orbit(OSCILLATOR, (0.35, 0.0)),
            "frequency",
            (0.4999999, 1.2),
            max_step=1e-3,
            progress=progress,
        )
    up = [pair for pair in seen if pair[1] > 0.5]
    assert [number for number, _ in up] == list(range(2, 101))
    assert len(set(up)) == len(up)


def test_extrema_of_neighbours():
    high, low = [0.2, 0.5, -1.0], [0.7, -0.1, 1.0]
    assert alike([high, low], [high, low], 0.2, 0.2, True)
    assert not alike([high, low], [high], 0.2, 0.2, True)  # one is new
    assert not alike(
        [high, low], [high, [0.7, -0.21, 1.0]], 0.2, 0.2, True
    )  # touches the second flank between
    assert alike([high, low], [high, [0.7, -0.21, 1.0]], 0.2, 0.2, False)
    assert not alike([high, low], [high, [0.7, -0.2, 1.0]], 0.2, 0.2, True)  # touches it
    assert not alike([high, low], [high, low], 0.4, 0.6, True)  # the flank has moved
    assert not alike([high, low], [[0.3, 0.5, -1.0], low], 0.2, 0.2, True)  # too far
    assert not alike([high, low], [high, [0.7, -0.1, -1.0]], 0.2, 0.2, True)  # another kind
