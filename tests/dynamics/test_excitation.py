"""Transmission errors of several harmonics: exact responses, shifts in time, derivatives, other integrators."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import InputError
from dynamics import (
    FourierStiffness,
    GearOscillator,
    PowerContact,
    SmoothOscillator,
    continue_branch,
    find_orbit,
    period_map,
    sweep,
    trajectory,
)
from dynamics.attraction.manifolds import reversed_tables
from dynamics.branches.sensitivity import map_derivatives
from dynamics.flow.exact_flow import exact_flow
from dynamics.flow.protocol import propagated
from dynamics.flow.stepwise_flow import StepwiseFlow
from tests.seeds import SEED

SERIES = FourierStiffness(1.0, (0.3, 0.1), (0.4, -1.1))
ERROR, PHASE = (0.2, -0.05, 0.02, 0.0, 0.008), (0.0, 1.0, -2.0, 0.0, 0.5)
unit = st.floats(-1.0, 1.0)


def five(**changes) -> GearOscillator:
    return replace(GearOscillator(SERIES, 0.05, 0.1, ERROR, 0.6, 0.2, PHASE), **changes)


def smooth(osc: GearOscillator) -> SmoothOscillator:
    law = PowerContact(stiffness=SERIES, half_backlash=osc.half_backlash, exponent=1.0)
    return SmoothOscillator(law, 0.05, 0.1, osc.error_amplitude, osc.frequency, osc.error_phase)


@pytest.mark.parametrize("flow", [lambda osc: osc, smooth])
def test_one_harmonic_is_the_number_to_the_last_digit(flow):
    one = flow(five(error_amplitude=0.2, error_phase=0.3))
    same = flow(five(error_amplitude=[0.2], error_phase=[0.3]))
    assert same == one
    assert same.parameters == one.parameters
    silent = flow(five(error_amplitude=(0.2, 0.0, 0.0), error_phase=(0.3, 1.0, 2.0)))
    a, b = (period_map(osc, (0.5, 0.1), 3) for osc in (one, silent))
    assert np.array_equal(a.states, b.states)
    assert np.array_equal(a.jacobian, b.jacobian)


@pytest.mark.parametrize("damping", [0.01, 0.3])
def test_linear_response_is_the_sum_of_its_harmonics(damping):
    """Constant stiffness, no backlash: every harmonic answers by itself, as 1/(1 - (j w)^2 + 2 i zeta j w)."""
    osc = five(stiffness=FourierStiffness(1.0), damping_ratio=damping, half_backlash=0.0)
    j = np.arange(1, 6)
    frequency = j * osc.frequency
    push = np.array(ERROR) * frequency**2 * np.exp(1j * np.array(PHASE))
    response = push / (1.0 - frequency**2 + 2j * damping * frequency)
    orbit = find_orbit(osc, osc.rest_state())
    wanted = [osc.mean_force + response.sum().real, (1j * frequency * response).sum().real]
    np.testing.assert_allclose(orbit.state, wanted, rtol=0, atol=1e-13)


@settings(max_examples=30, deadline=None)
@given(st.integers(1, 63), st.tuples(unit, unit))
def test_another_instant_for_zero_shifts_all_phases(place, state):
    """The state at tau_0 starts the same motion of the oscillator whose harmonics are shifted by j w tau_0."""
    osc = five()
    path = trajectory(osc, state, 2, 64)
    shift = 2.0 * np.pi * place / 64
    phases = tuple(p + (j + 1) * shift for j, p in enumerate(SERIES.phases))
    turned = replace(
        osc,
        stiffness=FourierStiffness(1.0, SERIES.amplitudes, phases),
        error_phase=tuple(p + (j + 1) * shift for j, p in enumerate(PHASE)),
    )
    image = period_map(turned, (path.x[place], path.v[place]))
    np.testing.assert_allclose(image.state, (path.x[64 + place], path.v[64 + place]), rtol=0, atol=1e-11)


@pytest.mark.parametrize("frequency", [0.31, 0.6, 1.3])
def test_scipy_follows_the_same_motion(integrate, frequency):
    osc = five(frequency=frequency)
    wanted, jacobian, counts = integrate(osc, (0.5, 0.1), 5 * osc.period)
    found = period_map(osc, (0.5, 0.1), 5)
    np.testing.assert_allclose(found.state, wanted, rtol=0, atol=1e-9)
    np.testing.assert_allclose(found.jacobian, jacobian, rtol=0, atol=1e-8 * np.abs(jacobian).max())
    assert tuple(found.counts.sum(axis=0)) == counts


@pytest.mark.slow
def test_400_speeds_against_two_integrators(integrate):
    """Both by their own crossing of the backlash; a graze between would part them. Scipy's follows every tenth.

    Which of them do is the seed's choice.
    """
    worst = 0.0
    for number, frequency in enumerate(np.linspace(0.3, 1.8, 400)):
        osc = five(frequency=float(frequency))
        found = period_map(osc, (0.5, 0.1), 5).state
        others = [period_map(smooth(osc), (0.5, 0.1), 5).state]
        if number % 10 == SEED % 10:
            others.append(integrate(osc, (0.5, 0.1), 5 * osc.period)[0])
        worst = max(worst, *(float(np.abs(found - other).max()) for other in others))
    assert worst < 1e-9


def test_the_stepwise_flow_is_the_exact_one():
    osc = five()
    exact, stepwise = period_map(osc, (0.5, 0.1), 4), period_map(smooth(osc), (0.5, 0.1), 4)
    np.testing.assert_allclose(stepwise.state, exact.state, rtol=0, atol=1e-10)
    np.testing.assert_allclose(stepwise.jacobian, exact.jacobian, rtol=0, atol=1e-8)


@pytest.mark.parametrize("name", ["error_amplitude[0]", "error_amplitude[4]", "error_phase[1]", "frequency"])
def test_derivatives_of_both_flows_against_differences(name):
    osc = five()
    at, step, state = osc.get(name), 1e-5, np.array([0.5, 0.1])
    low, high = (period_map(osc.with_parameter(name, at + way * step), state).state for way in (-1.0, 1.0))
    wanted = (high - low) / (2.0 * step)
    exact = map_derivatives(osc, state, (name,))
    np.testing.assert_allclose(exact.slope[:, 0], wanted, rtol=1e-7, atol=1e-8)
    stepwise = StepwiseFlow(smooth(osc), 1e-13, (name,)).follow(state)
    np.testing.assert_allclose(stepwise.slope[:, 0], wanted, rtol=1e-7, atol=1e-8)


def test_time_runs_back():
    osc = five()
    there = propagated(exact_flow(osc), [(0.5, 0.1), (-0.4, 0.3)], 1)
    back = propagated(reversed_tables(osc), there, 1, backwards=True)
    np.testing.assert_allclose(back, [(0.5, 0.1), (-0.4, 0.3)], rtol=0, atol=1e-12)


def test_a_branch_over_one_of_its_amplitudes():
    """Every point is an orbit of the oscillator with that amplitude."""
    osc = five(error_amplitude=(0.05, 0.01), error_phase=(0.0, 1.0))
    branch = continue_branch(find_orbit(osc, osc.rest_state()), "error_amplitude[1]", (0.0, 0.03))
    for value, state in list(zip(branch.values, branch.states, strict=True))[::7]:
        image = period_map(osc.with_parameter("error_amplitude[1]", value), state)
        np.testing.assert_allclose(image.state, state, rtol=0, atol=1e-10)


def test_a_sweep_takes_them():
    """Far above resonance the gears stay in contact, and there is one motion."""
    osc = five(frequency=3.0, error_amplitude=(0.01, 0.002), error_phase=0.0)
    found = sweep(osc, "frequency", np.linspace(3.0, 3.1, 3), transient=400)
    orbit = find_orbit(replace(osc, frequency=3.1), osc.rest_state())
    assert orbit.stable
    np.testing.assert_allclose(found.states[-1, 0], orbit.state, rtol=0, atol=1e-12)


def test_faults_name_what_is_wrong():
    with pytest.raises(InputError, match="must be 2 phases, one per amplitude"):
        five(error_amplitude=(0.1, 0.2), error_phase=(0.0, 1.0, 2.0))
    with pytest.raises(InputError, match="must be 1 to 1000 harmonics"):
        five(error_amplitude=(), error_phase=())
    with pytest.raises(InputError, match=r"error_amplitude\[1\]"):
        five(error_amplitude=(0.1, float("nan")), error_phase=0.0)
    with pytest.raises(InputError, match=r"error_amplitude\[4\]"):
        five().get("error_amplitude")
    assert five(error_amplitude=(0.1, 0.2), error_phase=0.0).error_phase == (0.0, 0.0)
