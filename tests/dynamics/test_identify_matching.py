"""The inverse problem: which point an event is, and what a match is worth, on points made up for it."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from dynamics import FourierStiffness, GearOscillator, SpecialPoint
from dynamics.inverse import Event
from dynamics.inverse.events import Problem
from dynamics.inverse.matching import match
from dynamics.inverse.scoring import by_chance, probabilities

TRUE = GearOscillator(FourierStiffness(1.0, (0.1,), (0.0,)), 0.02, 0.08, 0.2, 0.4, 0.8)


def point(kind, label, value):
    return SpecialPoint(kind, value, np.zeros(2), np.zeros(2), label, 0.0)


def test_labels_with_stars_fit_what_they_leave_open():
    event = Event("saddle-node", "2-*-1", 1.0, 3)
    fits = [event.names(label) for label in ("2-1-1", "U2-3-1", "2-1-0", "1-1-1")]
    assert fits == [True, True, False, False]


def test_events_of_a_branch_keep_their_order_against_the_nearest_number():
    """Folds at 1.0, 0.5, 0.9: 0.91, 0.52, 1.02 is that order read backwards, 1.0, 0.9, 0.5 is neither."""
    line = [point("saddle-node", "1-1-0", x) for x in (1.0, 0.5, 0.9)]
    forward = match([line], [Event("saddle-node", "1-1-0", x, 2, branch="b") for x in (0.98, 0.55)], 1.0)
    assert [p.parameter for p in forward] == [1.0, 0.5]
    backward = match(
        [line], [Event("saddle-node", "1-1-0", x, 2, branch="b") for x in (0.91, 0.52, 1.02)], 1.0
    )
    assert [p.parameter for p in backward] == [0.9, 0.5, 1.0]
    crossed = match([line], [Event("saddle-node", "1-1-0", x, 2, branch="b") for x in (1.0, 0.9, 0.5)], 1.0)
    found = [p if p is None else p.parameter for p in crossed]
    assert found != [1.0, 0.9, 0.5]  # not an order along the branch
    assert sum(x is None for x in found) == 1


def test_order_holds_on_one_branch_not_across_two():
    lines = [[point("grazing", "1-0-0", 0.5)], [point("grazing", "1-0-0", 0.8)]]
    found = match(lines, [Event("grazing", "1-0-0", x, 2, branch="b") for x in (0.5, 0.8)], 1.0)
    assert sum(p is None for p in found) == 1
    free = match(lines, [Event("grazing", "1-0-0", x, 2) for x in (0.5, 0.8)], 1.0)
    assert [p.parameter for p in free] == [0.5, 0.8]


def test_no_point_is_taken_twice_and_kind_and_label_decide():
    line = [
        point("saddle-node", "1-1-0", 0.5),
        point("saddle-node", "U1-1-0", 0.6),
        point("grazing", "1-1-0", 0.51),
    ]
    events = [Event("saddle-node", "1-1-0", x, 3) for x in (0.501, 0.502)]
    found = [p.parameter for p in match([line], events, 1.0)]
    assert sorted(found) == [0.5, 0.6]
    other = match(
        [line], [Event("period-doubling", "1-1-0", 0.5, 3), Event("saddle-node", "2-1-0", 0.5, 3)], 1.0
    )
    assert other == (None, None)


def test_chance_is_that_of_events_at_random():
    """Monte Carlo: five events spread evenly, the nearest of three points each."""
    rng = np.random.default_rng(5)
    where = np.array([0.2, 0.5, 0.8])
    events = [Event("saddle-node", "1-1-0", 0.5, 9) for _ in range(5)]
    line = [point("saddle-node", "1-1-0", x) for x in where]
    five = Problem(TRUE, "frequency", tuple(events), {}, (0.0, 1.0))
    values = rng.uniform(0.0, 1.0, (4000, 5))
    off = np.min(np.abs(values[:, :, None] - where), axis=2) / 1e-9
    tails = np.array([by_chance(five, probabilities(five, [line], row), 0, 1) for row in off])
    for level in (0.5, 0.2, 0.05, 0.01):
        share = float(np.mean(tails < level))
        assert share <= level + 4.0 * math.sqrt(level / 4000)
        assert share >= 0.3 * level


def test_chance_counts_every_way_to_meet_as_many_events_as_unknowns():
    """Seven events at random, two unknowns that move them linearly: the best of the 21 exact fits is no surprise."""
    rng = np.random.default_rng(6)
    events = tuple(Event("saddle-node", "1-1-0", 0.5, 9) for _ in range(7))
    problem = Problem(TRUE, "frequency", events, {}, (0.0, 1.0))
    least = []
    for _ in range(300):
        slopes, values = rng.normal(size=(7, 2)), rng.uniform(0.0, 1.0, 7)
        found = []
        for pair in itertools.combinations(range(7), 2):
            rest = values - slopes @ np.linalg.solve(slopes[list(pair)], values[list(pair)])
            off = (rest + 0.5) % 1.0 - 0.5  # evenly spread over the range
            found.append(by_chance(problem, probabilities(problem, [], off / 1e-9), 2, 1))
        least.append(min(found))
    surprises = float(np.mean(np.array(least) < 0.1))
    assert surprises <= 0.1 + 4.0 * math.sqrt(0.1 / 300)
    assert float(np.mean(np.array(least) / math.comb(7, 2) < 0.1)) > 0.3  # were the ways not counted


def test_chance_grows_with_trials_and_a_missing_event_does_not_help():
    events = tuple(Event("saddle-node", "1-1-0", 0.5, 6) for _ in range(4))
    problem = Problem(TRUE, "frequency", events, {}, (0.0, 1.0))
    good = by_chance(problem, np.array([1e-6, 1e-6, 1e-5, 1e-5]), 2, 10)
    assert by_chance(problem, np.array([1e-6, 1e-6, 1e-5, 1e-5]), 2, 1000) == pytest.approx(100 * good)
    assert by_chance(problem, np.array([1e-6, 1e-6, 1e-5, 1.0]), 2, 10) > 1e3 * good
