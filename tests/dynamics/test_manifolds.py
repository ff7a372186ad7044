"""Inverse of the period map, manifolds of saddles, stretches of branches, loops however small."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    continue_branch,
    find_orbit,
    find_orbits,
    manifold,
    period_map,
)
from dynamics.attraction.manifolds import reversed_tables
from dynamics.branches.branch import stretches
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.protocol import propagated
from tests.validation.article_motion import lubricated, starved


def test_running_backwards_undoes_the_map():
    osc = GearOscillator(
        FourierStiffness(1.0, (0.3, 0.1), (0.3, -1.0)), 0.05, 0.1, 0.3, 0.7, 0.25, error_phase=0.4
    )
    states = np.random.default_rng(1).normal(size=(100, 2))
    ahead = propagated(exact_flow(osc), states, 3)
    back = propagated(reversed_tables(osc), ahead, 3, backwards=True)
    stretch = max(np.max(np.abs(period_map(osc, s, 3).jacobian)) for s in states)
    assert np.max(np.abs(ahead - states)) > 0.1
    assert np.max(np.abs(back - states)) < 1e-13 * stretch / np.exp(-12 * np.pi * 0.05 / 0.7)


def saddle(frequency: float = 0.6):
    found = find_orbits(lubricated(frequency), (1,)).orbits
    (unstable,) = (o for o in found if not o.stable)
    return unstable, [o for o in found if o.stable]


def test_stable_manifold_parts_the_basins():
    """On one side motions come to 1-0-0, on the other to 1-1-1, a millionth away: the curve is the boundary."""
    unstable, stable = saddle()
    assert unstable.label == "U1-1-0"
    curves = manifold(unstable, "stable", length=8.0).curves
    ends = set()
    for curve in curves:
        for i in (len(curve) // 3, len(curve) // 2):
            chord = curve[i + 1] - curve[i]
            across = np.array([-chord[1], chord[0]]) / np.linalg.norm(chord)
            sides = []
            for sign in (-1.0, 1.0):
                last = period_map(lubricated(), curve[i] + sign * 1e-6 * across, skip=600).state
                sides.append(int(np.argmin([np.max(np.abs(o.state - last)) for o in stable])))
            assert sides[0] != sides[1]
            ends |= set(sides)
    assert ends == {0, 1}


def test_unstable_manifold_leads_to_both_attractors():
    unstable, stable = saddle()
    result = manifold(unstable, "unstable", length=6.0)
    assert result.error < 1e-8
    last = [period_map(lubricated(), curve[-1], skip=600).state for curve in result.curves]
    reached = {int(np.argmin([np.max(np.abs(o.state - s)) for o in stable])) for s in last}
    assert reached == {0, 1}


def test_manifolds_are_invariant():
    """The image of a curve's points lies on the curve, within the bend of its chords."""
    unstable, _ = saddle()
    curve = manifold(unstable, "unstable", length=4.0, spacing=0.002).curves[0]
    images = propagated(exact_flow(lubricated()), curve[: len(curve) // 3], 1)
    gap, _ = cKDTree(curve).query(images)
    assert max(gap) < 0.002 * 0.6


def test_manifold_refuses_what_has_none():
    _, stable = saddle()
    with pytest.raises(InputError, match="saddle"):
        manifold(stable[0], "sideways")


def test_small_isola_closes():
    """A loop of period 3 that spans a twentieth of the bounds is followed once, not until the points run out."""
    osc = starved(0.4277777777777778)
    orbit = find_orbit(osc, (1.18853132, -0.02896794), periods=3)
    branch = continue_branch(orbit, "frequency", (0.3, 2.6))
    assert branch.ended == ("closed", "closed")
    assert len(branch.values) < 200
    folds = sorted(p.parameter for p in branch.special("saddle-node"))
    assert len(folds) % 2 == 0
    assert 0.3 < folds[0] < folds[-1] < 0.6


def test_stretches_meet_at_special_points():
    branch = continue_branch(find_orbit(lubricated(0.5), (0.35, 0.0)), "frequency", (0.5, 0.8))
    found = stretches(branch)
    assert [s.label for s in found] == ["1-0-0", "1-1-0", "U1-1-0", "U1-1-1", "1-1-1"]
    first, touching, *_, last = found
    assert first.high == touching.low == pytest.approx(0.633533993217297, abs=1e-12)
    assert touching.high == pytest.approx(0.6555759637891, abs=1e-12)
    assert last.low == pytest.approx(0.5694026368887, abs=1e-12)
    assert (first.ends.kind, touching.ends.kind, last.begins.kind) == (
        "grazing",
        "saddle-node",
        "saddle-node",
    )
    for stretch in found:
        here = lubricated(stretch.value)
        assert find_orbit(here, stretch.state).label == stretch.label
