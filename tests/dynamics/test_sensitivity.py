"""Derivatives of the period map: against differences of the map itself, closed forms, and their own symmetries."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from base import InputError
from dynamics import FourierStiffness, GearOscillator, period_map
from dynamics.branches.sensitivity import map_derivatives
from dynamics.flow.motions import turning_points

STATE = np.array([0.5, 0.2])


def oscillator(**changes) -> GearOscillator:
    values = {
        "damping_ratio": 0.05, "mean_force": 0.1, "error_amplitude": 0.2, "frequency": 0.6, "half_backlash": 0.2,
        "error_phase": 0.1,
    }  # fmt: skip
    return GearOscillator(FourierStiffness(1.0, (0.2, 0.1), (0.3, -0.2)), **(values | changes))


@pytest.mark.parametrize(
    "osc",
    [
        oscillator(),
        oscillator(half_backlash=0.0),
        oscillator(one_sided=True),
        oscillator(damping_ratio=0.0),
        oscillator(free_damping_ratio=0.1),
        oscillator(one_sided=True, free_damping_ratio=0.01),
        oscillator(mean_force=0.0, half_backlash=0.1, free_damping_ratio=0.2),
    ],
)
def test_against_differences(osc):
    """Every parameter, first and second derivatives, four-point differences."""
    if osc.damping_ratio == 0.0:
        names = tuple(n for n in osc.parameters if n != "damping_ratio")  # no difference across its bound
    elif osc.half_backlash == 0.0:
        names = tuple(n for n in osc.parameters if n != "half_backlash")
    else:
        names = osc.parameters
    exact = map_derivatives(osc, STATE, names, periods=2)
    image = period_map(osc, STATE, periods=2)
    np.testing.assert_allclose(exact.state, image.state, rtol=0, atol=1e-13)
    np.testing.assert_allclose(
        exact.jacobian, image.jacobian, rtol=0, atol=1e-12 * np.max(np.abs(image.jacobian))
    )
    assert exact.counts == tuple(image.counts.sum(axis=0))
    h = 1e-4

    def at(direction: int, step: float):
        if direction < 2:
            there = period_map(osc, STATE + step * np.eye(2)[direction], periods=2)
        else:
            name = names[direction - 2]
            there = period_map(osc.with_parameter(name, osc.get(name) + step), STATE, periods=2)
        return np.column_stack([there.state, there.jacobian])

    first = np.column_stack([exact.jacobian, exact.slope])
    for k in range(2 + len(names)):
        step = h if k < 2 or names[k - 2] != "frequency" else 0.1 * h
        rise = 8.0 * (at(k, step) - at(k, -step)) - (at(k, 2 * step) - at(k, -2 * step))
        difference = rise / (12.0 * step)
        # f' jumps at the impacts: no more than second order in the step for the Jacobian
        np.testing.assert_allclose(
            difference[:, 0], first[:, k], rtol=1e-7, atol=1e-7 * np.max(np.abs(first))
        )
        np.testing.assert_allclose(
            difference[:, 1:], exact.second[k], rtol=1e-5, atol=1e-5 * np.max(np.abs(exact.second))
        )


def test_linear_parameters_in_closed_form():
    """kappa = 0 and no backlash: F_m enters as (1 - cos T)/1 for zeta = 0, and D not at all in X - D."""
    osc = GearOscillator(FourierStiffness(1.0), 0.0, 0.1, 0.2, 0.7, half_backlash=0.0)
    exact = map_derivatives(osc, STATE, ("mean_force",))
    t = osc.period
    np.testing.assert_allclose(exact.slope[:, 0], [1.0 - np.cos(t), np.sin(t)], rtol=0, atol=1e-14)
    contact = GearOscillator(FourierStiffness(1.0), 0.0, 5.0, 0.2, 0.7, half_backlash=0.3)
    moved = map_derivatives(contact, (5.5, 0.1), ("half_backlash",))
    assert moved.counts == (0, 0)
    np.testing.assert_allclose(moved.slope[:, 0], [1.0 - np.cos(t), np.sin(t)], rtol=0, atol=1e-13)


@settings(max_examples=30, deadline=None)
@given(st.floats(0.25, 2.5), st.floats(0.0, 0.2), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_determinant_is_differentiated_too(frequency, zeta, x, v):
    """det M = exp(-4 pi zeta/omega): its derivatives vanish but for zeta and omega, whose are known."""
    osc = oscillator(frequency=frequency, damping_ratio=zeta)
    turns = turning_points(osc, (x, v))
    assume(np.min(np.abs(np.abs(turns[:, 1]) - osc.half_backlash), initial=1.0) > 1e-4)
    assume(abs(abs(x) - osc.half_backlash) > 1e-6)
    d = map_derivatives(osc, (x, v))
    m = d.jacobian
    adjugate = np.array([[m[1, 1], -m[0, 1]], [-m[1, 0], m[0, 0]]])
    found = np.einsum("ij,kji->k", adjugate, d.second)
    det = np.exp(-2.0 * zeta * osc.period)
    expected = np.zeros(len(found))
    expected[2 + d.parameters.index("damping_ratio")] = -2.0 * osc.period * det
    expected[2 + d.parameters.index("frequency")] = 2.0 * zeta * osc.period / frequency * det
    size = np.max(np.abs(m)) * np.max(np.abs(d.second), axis=(1, 2)) + 1.0
    assert np.all(np.abs(found - expected) <= 1e-11 * size)


def test_bad_input():
    with pytest.raises(InputError, match="parameter"):
        map_derivatives(oscillator(), STATE, ("omega",))
    with pytest.raises(InputError, match="periods"):
        map_derivatives(oscillator(), STATE, periods=0)
