"""Boundaries, edges, manifolds and ends of chaos of drive trains: a train of one freedom has those of its pair."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics import (
    GearOscillator,
    basin_boundary,
    basins,
)
from dynamics.flow.motions import turning_points
from tests.dynamics.test_drives import same_as
from tests.validation.article_motion import lubricated

PAIR = lubricated(0.6)
TRAIN = same_as(PAIR)
BOX = ((-1.0, 1.0), (-1.0, 1.0))


def moved(pair: GearOscillator, states):
    """States of the train of one freedom that stand for those of the pair: its displacement is X and the error."""
    return same_as(pair).lifted(np.atleast_2d(np.asarray(states, dtype=np.float64)), np.zeros(1))


def test_extrema_are_those_of_the_pair():
    theirs = turning_points(PAIR, (0.5, 0.2), 3)
    ours = turning_points(TRAIN, moved(PAIR, (0.5, 0.2))[0], 3)
    assert len(theirs) > 3
    assert ours[:, :3] == pytest.approx(theirs[:, :3], abs=1e-10)


@pytest.fixture(scope="module")
def reached():
    """Attractors of the pair and of the train, in one order."""
    theirs = {a.label: a for a in basins(PAIR, (-1, 1, 8), (-1, 1, 8)).attractors}
    ours = {a.label: a for a in basins(TRAIN, (-1, 1, 8), (-1, 1, 8)).attractors}
    assert theirs.keys() == ours.keys() == {"1-0-0", "1-1-1"}
    return theirs, ours


def test_the_boundary_is_that_of_the_pair(reached):
    theirs, ours = reached
    of_pair = basin_boundary(PAIR, list(theirs.values()), BOX, cells=4, levels=3)
    attractors, through = [ours[label] for label in theirs], moved(PAIR, (0.0, 0.0))[0]
    of_train = basin_boundary(TRAIN, attractors, BOX, cells=4, levels=3, through=through)
    assert np.array_equal(of_train.counts, of_pair.counts)
    assert of_train.points == pytest.approx(of_pair.points, abs=1e-14)
    assert of_train.shares == pytest.approx(of_pair.shares, abs=1e-14)
    elsewhere = basin_boundary(TRAIN, attractors, BOX, cells=4, levels=3)  # through the state at rest
    assert not np.array_equal(elsewhere.counts, of_pair.counts)
