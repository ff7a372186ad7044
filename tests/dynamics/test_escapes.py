"""Ends of chaos by escapes, against tangencies of manifolds that know nothing of them."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    boundary_crisis,
    chaos_end,
    edge_saddles,
    find_orbits,
    sweep,
)
from tests.validation.article_motion import starved

OSC = GearOscillator(FourierStiffness(1.0, (0.5,), (0.0,)), 0.06, 0.1, 0.778, 0.4, half_backlash=0.8)


@pytest.fixture(scope="module")
def end():
    return chaos_end(OSC, "error_amplitude", (1.06, 0.459), (0.7795, 0.79), periods=100_000, starts=16)


def test_escapes_bracket_the_tangency_with_u110(end):
    saddle = next(o for o in find_orbits(OSC, (1,)).orbits if o.label == "U1-1-0")
    crisis = boundary_crisis(saddle, "error_amplitude", (0.777, 0.783), points=20, periods=12)
    assert end.converged
    assert end.last < end.first
    assert end.last - 2e-4 < crisis.parameter < end.first
    assert np.all(end.escapes[end.values < crisis.parameter] == 0)


def test_rates_rise_past_the_end_and_say_what_a_narrower_bracket_costs(end):
    rates = end.rates[end.escapes > 0]
    assert rates[-1] > 3.0 * rates[0]
    assert end.needed > 0.0


@pytest.mark.long
@pytest.mark.slow
def test_saddle_of_the_end_is_found_without_being_named(end):
    past = OSC.with_parameter("error_amplitude", float(end.values[end.escapes >= 4][0]))
    saddles = edge_saddles(past, end.attractor)
    assert saddles[0].label == "U1-1-0"
    stays = OSC.with_parameter("error_amplitude", 0.7795)
    with pytest.raises(InputError, match="just past"):
        edge_saddles(stays, end.attractor)


def test_motions_that_repeat_are_refused():
    with pytest.raises(InputError, match="chaos"):
        chaos_end(OSC, "error_amplitude", (0.3, 0.0), (0.5, 0.6), periods=2000, starts=2)


@pytest.mark.long
@pytest.mark.slow
def test_chaos_of_330_ends_with_u18_18_0():
    """Starved scan: escapes and the tangency agree to 1e-8; a sweep of 4000 periods a value comes 3e-7 too late."""
    osc = starved(0.5215)
    first = sweep(osc, "frequency", np.linspace(0.5215, 0.52276, 161), initial=start_of(osc), transient=2000)
    end = chaos_end(osc, "frequency", first.states[-1, -1], (0.52276, 0.5228), periods=500_000)
    (saddle, *_) = edge_saddles(osc.with_parameter("frequency", 0.52278), end.attractor)
    crisis = boundary_crisis(saddle, "frequency", (0.52276, 0.52278), points=500, periods=6 * saddle.periods)
    assert saddle.label == "U18-18-0"
    assert crisis.converged
    assert crisis.parameter == pytest.approx(0.5227744001, abs=2e-9)
    assert end.last < crisis.parameter < end.first + 1e-8


def start_of(osc):
    from dynamics import multi_sweep

    met = multi_sweep(osc, "frequency", [0.5215], seeds=1, starts=12)
    return next(m.states[-1] for m in met.motions[0] if m.label == "6-6-0")
