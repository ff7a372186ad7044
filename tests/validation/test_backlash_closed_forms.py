"""Closed forms of the oscillator with backlash: free oscillation, the touch without parametric excitation, and the
square-root law next to a grazing (the normal form of a grazing at a continuous corner of the force).
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from dynamics import FourierStiffness, GearOscillator, contact_grazing, period_map, trajectory
from dynamics.branches.grazing import contact_orbit
from dynamics.flow.exact_flow import exact_flow


@settings(max_examples=40, deadline=None)
@given(st.floats(0.01, 3.0), st.floats(1e-3, 3.0))
def test_free_oscillation_period(d, excess):
    """zeta = 0, kappa = 0, no forcing: amplitude A > D comes back after 2 pi + 4 D/(A - D)."""
    amplitude = d + excess
    exact = 2 * np.pi + 4 * d / excess
    osc = GearOscillator(FourierStiffness(1.0), 0.0, 0.0, 0.0, 2 * np.pi / exact, half_backlash=d)
    # one rounding a cell, and that of A in A - D
    rounding = np.finfo(float).eps * (8.0 + osc.cells + 2.0 * amplitude / excess)
    image = period_map(osc, (amplitude, 0.0))
    # a start at rest: the state feels an error of the period in V, to first order
    np.testing.assert_allclose(image.state, (amplitude, 0.0), rtol=0, atol=rounding * exact * (amplitude + 1))
    assert image.counts.tolist() == [[1, 1]]
    events = trajectory(osc, (amplitude, 0.0)).events
    crossing = 2 * d / excess
    times = np.array([np.pi / 2, np.pi / 2 + crossing, 1.5 * np.pi + crossing, 1.5 * np.pi + 2 * crossing])
    np.testing.assert_allclose(events[:, 0], times, rtol=0, atol=rounding * exact)


def touch_frequencies(eps: float, force: float, zeta: float) -> list[float]:
    """(eps^2 - Fm^2) w^4 + Fm^2 (2 - 4 zeta^2) w^2 - Fm^2 = 0: amplitude of the linear orbit equals Fm."""
    roots = np.roots([eps**2 - force**2, force**2 * (2 - 4 * zeta**2), -(force**2)])
    return sorted(float(np.sqrt(r.real)) for r in roots if abs(r.imag) < 1e-12 and r.real > 0)


@pytest.mark.parametrize(
    ("eps", "values"),
    [
        (0.20, [0.578072859698843]),
        (0.10, [0.708881205008336]),
        (0.05, [0.820631087712087, 1.407088466022592]),
        (0.02, [0.925181719474818, 1.103157038964211]),
    ],
)
def test_touch_without_parametric_excitation(eps, values):
    osc = GearOscillator(FourierStiffness(1.0, (0.0,), (0.0,)), 0.05, 0.1, eps, 1.0, half_backlash=0.2)
    found = np.asarray(contact_grazing(osc, bounds=(0.3, 2.5)))
    assert len(found) == len(values)
    np.testing.assert_allclose(found, values, rtol=1e-12)


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.floats(0.01, 0.5), st.floats(0.02, 0.5), st.floats(0.005, 0.3))
def test_touch_without_parametric_excitation_anywhere(eps, force, zeta):
    osc = GearOscillator(FourierStiffness(1.0), zeta, force, eps, 1.0, half_backlash=0.1)
    assume(abs(eps - force) > 1e-3)
    exact = [w for w in touch_frequencies(eps, force, zeta) if 0.3 < w < 2.5]
    assume(all(0.35 < w < 2.4 for w in exact))
    assume(len(exact) < 2 or exact[1] - exact[0] > 0.05)  # else closer than the scan
    found = np.asarray(contact_grazing(osc, bounds=(0.3, 2.5)))
    assert len(found) == len(exact)
    np.testing.assert_allclose(found, exact, rtol=1e-9)


@pytest.mark.parametrize(("kappa", "zeta", "phi"), [(0.18, 0.05, 0.0), (0.3, 0.02, 1.0), (0.0, 0.1, 0.0)])
def test_grazing_normal_form(kappa, zeta, phi):
    """Past a touch by p the speed jumps by (4 sqrt 2/3) K a^(-1/2) p^(3/2), DP by 2 sqrt 2 K a^(-1/2) p^(1/2)."""
    osc = GearOscillator(FourierStiffness(1.0, (kappa,), (phi,)), zeta, 0.1, 0.2, 0.6, half_backlash=0.2)
    point = contact_grazing(osc, bounds=(0.4, 0.9)).points[0]
    osc = osc.with_parameter("frequency", point.parameter)
    linear = osc.with_parameter("half_backlash", 0.0)
    shift = np.array([osc.half_backlash, 0.0])
    orbit = contact_orbit(osc)
    # the touch carries a kick in V: at tau, and from there to the end of the period through the linear flow
    rest = _flow_from(linear, point.tau)
    forth = _flow_to(linear, point.tau)
    for p in (1e-5, 1e-6):
        start = orbit.state + np.linalg.solve(forth, [-p, 0.0])  # p too low at the instant of the touch
        apart = period_map(osc, start).state - shift - period_map(linear, start - shift).state
        kick = np.linalg.solve(rest, apart)
        law = 4 * np.sqrt(2) / 3 * point.stiffness * point.acceleration**-0.5 * p**1.5
        assert abs(kick[1]) == pytest.approx(law, rel=20 * np.sqrt(p))
        change = period_map(osc, start).jacobian - period_map(linear, start - shift).jacobian
        local = np.linalg.solve(rest, change) @ np.linalg.inv(forth)  # [[0, 0], [c, 0]] at the touch
        law = 2 * np.sqrt(2) * point.stiffness * point.acceleration**-0.5 * p**0.5
        assert abs(local[1, 0]) == pytest.approx(law, rel=20 * np.sqrt(p))


def _flow_to(linear: GearOscillator, tau: float) -> np.ndarray:
    """Flow matrix from 0 to tau of the equation without backlash, by scipy."""
    from scipy.integrate import solve_ivp

    def rhs(t, y):
        k = linear.stiffness(linear.frequency * t)
        c = 2 * linear.damping_ratio
        return [y[2], y[3], -k * y[0] - c * y[2], -k * y[1] - c * y[3]]

    done = solve_ivp(rhs, (0.0, tau), [1.0, 0.0, 0.0, 1.0], method="DOP853", rtol=1e-13, atol=1e-15)
    return done.y[:, -1].reshape(2, 2)


def _flow_from(linear: GearOscillator, tau: float) -> np.ndarray:
    """Flow matrix from tau to the end of the period."""
    return period_map(exact_flow(linear), (0.1, 0.1)).jacobian @ np.linalg.inv(_flow_to(linear, tau))
