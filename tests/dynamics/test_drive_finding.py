"""Orbits of drive trains by searches: a train of one freedom has those of its pair, and indices add up in all."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, find_orbit, find_orbits
from dynamics.flow.flows import flow_of
from dynamics.flow.protocol import Flow
from dynamics.orbits.hunting import hunted
from dynamics.orbits.index import index_at_infinity
from tests.dynamics.test_drives import chain, same_as

PAIR = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)


def test_orbits_are_those_of_the_pair():
    train = same_as(PAIR)
    of_pair, of_train = find_orbits(PAIR, (1, 2), batches=0), find_orbits(train, (1, 2), starts=5, batches=0)
    assert of_train.converged
    assert [orbit.label for orbit in of_train.orbits] == [orbit.label for orbit in of_pair.orbits]
    for mine, other in zip(of_train.orbits, of_pair.orbits, strict=True):
        assert mine.state == pytest.approx(train.lifted(other.state[None], np.zeros(1))[0], abs=1e-11)
    assert [c.expected for c in of_train.counts] == [c.expected for c in of_pair.counts] == [1, 1]


@pytest.mark.parametrize("known", [0, 1])
def test_searches_of_any_flow_are_those_of_the_kernel(known):
    """Newton's method of any flow, deflated or not, reaches the points that the compiled one of a pair does."""
    flow, orbit = flow_of(PAIR), find_orbit(PAIR, (0.5, 0.2))
    starts = np.random.default_rng(2).uniform(-1.0, 1.0, size=(60, 2))
    reached = []
    for search in (hunted, hunted.dispatch(Flow)):
        points = np.empty((64, 2))
        points[0] = orbit.state
        last, used = search(flow, starts, 1, 40, 1.0, points, known)
        assert used > 60
        reached.append(points[known:last])
    assert len(reached[0]) >= 2 - known
    assert reached[1] == pytest.approx(reached[0], abs=1e-10)


@pytest.mark.slow
def test_indices_of_four_freedoms_add_up():
    """The sum over the orbits is that of the linear train far out, which knows nothing of them."""
    train = chain(frequency=1.288)
    result = find_orbits(train, (1,), starts=4, batches=0)
    (count,) = result.counts
    assert count.expected == index_at_infinity(train, 1) == 1
    assert count.found == count.expected
    assert len(result) >= 3
    assert {orbit.stable for orbit in result.orbits} == {True, False}


def test_the_index_with_one_flank_is_not_known():
    assert index_at_infinity(chain(one_sided=True), 1) is None
