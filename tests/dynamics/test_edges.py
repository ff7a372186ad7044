"""Saddles on the edge of a basin against those that a search over periods finds."""

from __future__ import annotations

import pytest

from base import InputError
from dynamics import basins, edge_saddles, find_orbits
from tests.validation.article_motion import lubricated


@pytest.mark.parametrize("label", ["1-0-0", "1-1-1"])
def test_saddle_between_two_motions_is_met_from_both(label):
    osc = lubricated(0.6)
    grid = basins(osc, (-1.0, 1.0, 8), (-1.0, 1.0, 8))
    attractor = next(a for a in grid.attractors if a.label == label)
    (met,) = edge_saddles(osc, attractor)
    (saddle,) = (o for o in find_orbits(osc, (1,)).orbits if not o.stable)
    assert met.label == "U1-1-0"
    assert met.state == pytest.approx(saddle.state, abs=1e-12)


def test_edge_of_6_4_4_holds_the_saddle_of_its_crisis():
    """U3-3-1, with which the chaos beside 6-4-4 ends at 1.11974, parts the two at 1.13; no period is given."""
    grid = basins(lubricated(1.13), (-1.5, 1.5, 4), (-1.5, 1.5, 4))
    (attractor,) = (a for a in grid.attractors if a.label == "6-4-4")
    assert [o.label for o in edge_saddles(lubricated(1.13), attractor, rays=3)] == ["U3-3-1"]


def test_chaos_needs_many_samples():
    chaotic = basins(lubricated(1.04), (0.2, 0.4, 2), (0.0, 0.1, 2), limit=300).attractors[0]
    assert chaotic.orbit is None
    with pytest.raises(InputError, match="samples of its chaos"):
        edge_saddles(lubricated(1.04), chaotic)
