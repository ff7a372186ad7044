"""Crises with a damping of its own in the dead zone: the end of chaos by escapes and by a tangency, and its saddle."""

from __future__ import annotations

import pytest

from dynamics import (
    FourierStiffness,
    GearOscillator,
    basins,
    boundary_crisis,
    chaos_end,
    edge_saddles,
    find_orbits,
)
from tests.dynamics.test_free_damping import oscillator

CHAOTIC = GearOscillator(
    FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8, free_damping_ratio=0.065
)


def crisis(free: float | None, bounds: tuple[float, float] = (0.76, 0.81)):
    osc = GearOscillator(CHAOTIC.stiffness, 0.06, 0.1, 0.778, 0.4, half_backlash=0.8, free_damping_ratio=free)
    saddle = next(o for o in find_orbits(osc, (1,)).orbits if o.label == "U1-1-0")
    return boundary_crisis(saddle, "error_amplitude", bounds, points=40, periods=16)


@pytest.mark.slow
def test_escapes_bracket_the_tangency():
    """Motions that leave know of no manifold; the damping between the flanks, a twelfth larger, moves both by .012."""
    found = crisis(CHAOTIC.free_damping_ratio)
    end = chaos_end(CHAOTIC, "error_amplitude", (1.06, 0.459), (0.7905, 0.8), periods=100_000, starts=16)
    assert found.converged
    assert end.converged
    assert (found.before, found.after) == ("aperiodic", "4-4-3")
    assert end.last - 1e-6 < found.parameter < end.first
    assert abs(found.parameter - crisis(None).parameter) > 0.01


@pytest.mark.slow
def test_equal_damping_out_of_contact_has_the_same_crisis():
    bounds = (0.775, 0.785)
    assert crisis(0.06, bounds).parameter == crisis(None, bounds).parameter


@pytest.mark.slow
@pytest.mark.parametrize("label", ["1-0-0", "1-1-1"])
def test_saddle_between_two_motions_is_met_from_both(label):
    """As a search over periods finds it."""
    osc = oscillator(free_damping_ratio=0.08)
    grid = basins(osc, (-1.0, 1.0, 8), (-1.0, 1.0, 8))
    attractor = next(a for a in grid.attractors if a.label == label)
    (met,) = edge_saddles(osc, attractor)
    (saddle,) = (o for o in find_orbits(osc, (1,)).orbits if not o.stable)
    assert met.label == saddle.label
    assert met.state == pytest.approx(saddle.state, abs=1e-12)
