"""An independent integrator to hold the exact flow against, and the oscillators of the tests."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dynamics import GearOscillator
from tests.validation.article_motion import lubricated


def cosines(series, by_square: bool = False) -> Callable[[float], float]:
    """Sum of a series of amplitudes and phases at an angle [rad], in plain numbers; terms times n^2 if asked for."""
    terms = [(n, n**2 * a if by_square else a, p) for n, (a, p) in enumerate(series, start=1)]
    return lambda angle: sum(a * math.cos(n * angle + p) for n, a, p in terms)


def step_by_step(osc: GearOscillator, state, duration: float):
    """Integrate in the stretches between crossings, which scipy's event location finds.

    Every stretch is integrated with the branch of f that holds in it, so that no step straddles a corner of
    f.
    """
    d, w = osc.half_backlash, osc.frequency
    wave = cosines(zip(osc.stiffness.amplitudes, osc.stiffness.phases, strict=True))
    push = cosines(osc.error_series.T.tolist(), by_square=True)  # of the error's acceleration
    x, v = float(state[0]), float(state[1])
    region = 1 if x > d else -1 if x < -d and not osc.one_sided else 0
    now, y = 0.0, np.array([x, v, 1.0, 0.0, 0.0, 1.0])
    counts = [0, 0]
    for _ in range(10_000):
        spring = 0.0 if region == 0 and (d > 0.0 or osc.one_sided) else 1.0
        c = 2.0 * osc.damping_ratios[0 if spring else 1]

        def rhs(t, y, spring=spring, region=region, c=c):
            x, v, a, b, da, db = y.tolist()
            k = spring * (osc.stiffness.mean + wave(w * t))
            acceleration = osc.mean_force + w**2 * push(w * t) - c * v - k * (x - region * d)
            return [v, acceleration, da, db, -k * a - c * da, -k * b - c * db]

        def upper(t, y):
            return y[0] - d

        def lower(t, y):
            return y[0] + d

        upper.terminal = lower.terminal = True
        # leaving only: the stretch begins on a boundary
        upper.direction = -1 if region == 1 else 1
        lower.direction = 1 if region == -1 else -1
        events = [upper] if region == 1 or osc.one_sided else [lower] if region == -1 else [upper, lower]
        if d == 0.0 and not osc.one_sided:
            events = None  # f(X) = X: nothing to cross
        done = solve_ivp(
            rhs, (now, duration), y, method="DOP853", rtol=3e-14, atol=1e-15, events=events, max_step=0.05
        )
        y = done.y[:, -1].copy()
        now = done.t[-1]
        if done.status != 1:
            break
        at_upper = region == 1 or (region == 0 and len(done.t_events[0]) > 0)
        counts[0] += region == 1
        pressed, free = osc.damping_ratios
        jump = 2.0 * (free - pressed) if region else 2.0 * (pressed - free)
        y[4:] -= jump * y[2:4]  # damping jumps, and with it the acceleration
        region = 0 if region else (1 if at_upper else -1)
        counts[1] += region == -1
        y[0] = d if at_upper else -d
    jacobian = np.array([[y[2], y[3]], [y[4], y[5]]])
    return y[:2], jacobian, tuple(counts)


@pytest.fixture(scope="session")
def integrate():
    """`(oscillator, state, duration) -> (state, jacobian, counts)` by scipy, independent of the exact flow."""

    def run(osc, state, duration):
        return step_by_step(osc, state, duration)

    return run


@pytest.fixture
def article():
    """The oscillator of the lubricated frequency scan: `article(frequency=0.6, ...)`."""

    def make(kappa=0.18, phi=0.0, **changes):
        return lubricated(kappa=kappa, phase=phi, **changes)

    return make


@pytest.fixture(scope="session", autouse=True)
def every_orbit_keeps_the_determinant():
    """Whatever orbit a test finds, det of its Jacobian is exp(-4 pi zeta n/omega), relative to the products in it."""
    from dynamics.orbits import shooting

    assemble = shooting.make_orbit

    def checked(*arguments, **named):
        orbit = assemble(*arguments, **named)
        if orbit.converged and len(orbit.nodes) == 0 and len(orbit.state) == 2:
            (a, b), (c, d) = orbit.jacobian
            size = max(abs(a * d) + abs(b * c), orbit.determinant)
            close = 1e-12 if not orbit.oscillator.has_steps else 1e3 * (orbit.tolerance or 1e-12)
            assert abs(a * d - b * c - orbit.determinant) <= close * size
        return orbit

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(shooting, "make_orbit", checked)
        yield
