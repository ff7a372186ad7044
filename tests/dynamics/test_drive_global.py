"""Boundaries, edges, manifolds and ends of chaos of drive trains: a train of one freedom has those of its pair."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    basin_boundary,
    basins,
    boundary_crisis,
    chaos_end,
    edge_saddles,
    find_orbit,
    find_orbits,
    manifold,
)
from dynamics.flow.motions import turning_points
from tests.dynamics.test_drives import same_as
from tests.validation.article_motion import lubricated

PAIR = lubricated(0.6)
TRAIN = same_as(PAIR)
BOX = ((-1.0, 1.0), (-1.0, 1.0))
CHAOTIC = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)


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


@pytest.mark.parametrize("label", ["1-0-0", "1-1-1"])
def test_the_saddle_on_the_edge_is_that_of_the_pair(reached, label):
    theirs, ours = reached
    (of_pair,) = edge_saddles(PAIR, theirs[label], rays=2)
    (of_train,) = edge_saddles(TRAIN, ours[label], rays=2)
    assert of_train.label == of_pair.label == "U1-1-0"
    assert of_train.state == pytest.approx(moved(PAIR, of_pair.state)[0], abs=1e-11)


def test_the_unstable_manifold_is_that_of_the_pair():
    saddle = find_orbit(PAIR, (0.5, 0.2))
    ours = find_orbit(TRAIN, moved(PAIR, saddle.state)[0])
    of_pair, of_train = (manifold(orbit, "unstable", length=1.0) for orbit in (saddle, ours))
    assert len(of_train.curves) == 2
    along = cKDTree(np.concatenate(of_pair.curves))
    for curve in of_train.curves:
        gaps, _ = along.query(TRAIN.in_plane(curve))
        assert np.max(gaps) < 0.02 * np.max(np.abs(saddle.state))  # the spacing
    ends = {tuple(TRAIN.in_plane(c[:2])[1].round(9)) for c in of_train.curves}
    assert len(ends) == 2


def test_a_stable_manifold_is_refused_with_what_is_missing():
    ours = find_orbit(TRAIN, moved(PAIR, find_orbit(PAIR, (0.5, 0.2)).state)[0])
    with pytest.raises(InputError, match="its flow backwards in time is missing"):
        manifold(ours, "stable")


@pytest.mark.slow
def test_chaos_ends_where_that_of_the_pair_does():
    """The bracket of the train by escapes holds the tangency of the pair, which manifolds know of alone."""
    train = same_as(CHAOTIC)
    start = moved(CHAOTIC.with_parameter("error_amplitude", 0.7795), (1.06, 0.459))[0]
    end = chaos_end(train, "error_amplitude", start, (0.7795, 0.79), periods=20_000, starts=8)
    assert end.converged
    assert end.last - 1e-3 < 0.779904 < end.first


def test_the_crisis_is_that_of_the_pair():
    (saddle,) = (orbit for orbit in find_orbits(CHAOTIC, (1,)).orbits if orbit.label == "U1-1-0")
    of_pair = boundary_crisis(saddle, "error_amplitude", (0.777, 0.783), points=20, periods=12)
    ours = find_orbit(same_as(CHAOTIC), moved(CHAOTIC, saddle.state)[0])
    of_train = boundary_crisis(ours, "error_amplitude", (0.777, 0.783), points=20, periods=12)
    assert of_train.converged
    assert of_train.side == of_pair.side
    assert of_train.parameter == pytest.approx(of_pair.parameter, rel=1e-9)
    assert (of_train.before, of_train.after) == (of_pair.before, of_pair.after)
