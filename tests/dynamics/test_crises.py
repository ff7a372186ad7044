"""A boundary crisis of the lubricated scan: where chaos ends, two independent ways."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    boundary_crises,
    boundary_crisis,
    diagram,
    find_orbits,
)
from tests.validation.article_motion import lubricated


def saddle(label: str):
    return next(o for o in find_orbits(lubricated(1.13), (3,)).orbits if o.label == label)


@pytest.mark.slow
def test_chaos_beside_6_4_4_ends_where_it_meets_the_saddle():
    """The tangency with U3-3-1 does not depend on how many points follow its manifold, and parts lasting chaos from
    chaos that dies out: below it every start comes to 6-4-4 if one waits."""
    found = boundary_crisis(saddle("U3-3-1"), "frequency", (1.116, 1.13), points=500, periods=90)
    again = boundary_crisis(saddle("U3-3-1"), "frequency", (1.1175, 1.131), points=800, periods=120)
    assert found.converged
    assert found.saddle.label == "U3-3-1"
    assert found.overshoot[0] > 0.0 > found.overshoot[1]
    assert (found.before, found.after) == ("aperiodic", "6-4-4")
    assert found.parameter == pytest.approx(1.119740782, abs=2e-9)
    assert again.parameter == pytest.approx(found.parameter, abs=1e-9)
    for shift, kinds in ((-0.004, {"6-4-4"}), (0.004, {"6-4-4", "aperiodic"})):
        here = lubricated(found.parameter + shift)
        labels = {
            a.label for a in basins(here, (-1.5, 1.5, 8), (-1.5, 1.5, 8), limit=10_000).attractors if a.share
        }
        assert labels == kinds


def test_the_points_of_the_manifold_are_in_the_error():
    """More points, and points elsewhere: lobes that one of them meets first are seen by all of them."""
    osc = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)
    met = next(o for o in find_orbits(osc, (1,)).orbits if o.label == "U1-1-0")
    found = [
        boundary_crisis(met, "error_amplitude", (0.777, 0.783), points=points, periods=30)
        for points in (100, 120, 200)
    ]
    for one in found:
        assert one.converged
        assert one.error < 1e-10
        for other in found:
            assert abs(one.parameter - other.parameter) <= one.error * one.parameter


@pytest.mark.slow
def test_all_saddles_of_a_diagram():
    """The same crisis without its saddle being named."""
    whole = diagram(
        lubricated(1.13), "frequency", (1.117, 1.123), periods=(1, 3), searches=2, swept=0, max_period=3
    )
    found = boundary_crises(whole, values=4, points=250)
    assert "U3-3-1" in {c.saddle.label for c in found if c.before == "aperiodic"}
    (chaotic,) = (c for c in found if c.saddle.label == "U3-3-1" and c.after == "6-4-4")
    assert chaotic.parameter == pytest.approx(1.119740782, abs=2e-8)


def test_no_crisis_is_said_to_be_none():
    found = boundary_crisis(saddle("U3-3-1"), "frequency", (1.128, 1.132), points=200, periods=40)
    assert not found.converged
    assert np.isnan(found.parameter)
    assert "no crisis" in found.message


def test_only_saddles_are_taken():
    stable = next(o for o in find_orbits(lubricated(0.6), (1,)).orbits if o.stable)
    with pytest.raises(InputError, match="saddle"):
        boundary_crisis(stable, "frequency", (0.5, 0.7))
