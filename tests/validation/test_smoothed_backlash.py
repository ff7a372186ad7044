"""An independent continuation of the system with a smoothed backlash, converging to the exact one.

f(X) is replaced by s [ln(1 + e^{(X - D)/s}) - ln(1 + e^{-(X + D)/s})], which differs from the backlash by s ln 2 at its
corners and has no corners. Orbit, Jacobian and derivative with respect to the frequency come from scipy's solve_ivp
on the variational equations, and folds from pseudo-arclength steps with a Newton corrector: nothing is shared with
the package but the equation.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from dynamics import FourierStiffness, GearOscillator, continue_branch, find_orbit
from tests.validation.article_motion import lubricated

EXACT = lubricated()
(KAPPA,) = EXACT.stiffness.amplitudes
ZETA, FORCE, EPS, D = EXACT.damping_ratio, EXACT.mean_force, EXACT.error_amplitude, EXACT.half_backlash


def shot(state, w: float, s: float):
    """Image after one period, Jacobian, derivative with respect to w; time in turns, so that the period is 2 pi."""

    def rhs(turn, y):
        x, v = y[0], y[1]
        c = np.cos(turn)
        k = 1 + KAPPA * c
        up, down = (x - D) / s, -(x + D) / s
        f = s * (np.logaddexp(0, up) - np.logaddexp(0, down))
        df = 0.5 * (1 + np.tanh(up / 2)) + 0.5 * (1 + np.tanh(down / 2))
        a = FORCE + EPS * w**2 * c - 2 * ZETA * v - k * f
        out = [v / w, a / w]
        for j in range(3):
            p, q = y[2 + 2 * j], y[3 + 2 * j]
            extra = (-v / w**2, -a / w**2 + 2 * EPS * c) if j == 2 else (0.0, 0.0)
            out += [q / w + extra[0], (-k * df * p - 2 * ZETA * q) / w + extra[1]]
        return out

    start = [*state, 1, 0, 0, 1, 0, 0]
    y = solve_ivp(rhs, (0, 2 * np.pi), start, method="DOP853", rtol=1e-10, atol=1e-12).y[:, -1]
    return y[:2], y[2:6].reshape(2, 2).T, y[6:8]


def corrected(u, row, s):
    """Newton's method in the plane row . (u - guess) = 0 for (X, V, w)."""
    guess = u.copy()
    for _ in range(12):
        image, jacobian, slope = shot(u[:2], u[2], s)
        matrix = np.vstack([np.column_stack([jacobian - np.eye(2), slope]), row])
        step = np.linalg.solve(matrix, -np.array([*(image - u[:2]), row @ (u - guess)]))
        u = u + step
        if np.max(np.abs(step)) < 1e-9:
            return u, np.cross(*np.column_stack([jacobian - np.eye(2), slope]))
    raise AssertionError("Newton's method did not arrive")


def fold(state, w: float, s: float) -> float:
    """Frequency of the next fold when the branch is followed upwards: an extremum of w, from three points."""
    u, tangent = corrected(np.array([*state, w]), np.array([0.0, 0.0, 1.0]), s)
    tangent = tangent / np.linalg.norm(tangent) * np.sign(tangent[2])
    points, step = [u], 0.004
    for _ in range(200):
        u, new = corrected(u + step * tangent, tangent, s)
        new = new / np.linalg.norm(new)
        tangent = new * np.sign(new @ tangent)
        points.append(u)
        if tangent[2] < 0:
            break
    else:
        raise AssertionError("no fold")
    # closer and closer by the same steps: the fold is where the tangent's third part vanishes
    a, b = points[-2], points[-1]
    for _ in range(40):
        middle, way = corrected(0.5 * (a + b), (b - a) / np.linalg.norm(b - a), s)
        a, b = (middle, b) if way @ (b - a) * way[2] > 0 else (a, middle)
        if np.linalg.norm(b - a) < 1e-5:
            break
    return float(0.5 * (a + b)[2])


def exact_fold() -> float:
    osc = GearOscillator(FourierStiffness(1.0, (KAPPA,), (0.0,)), ZETA, FORCE, EPS, 0.62, half_backlash=D)
    branch = continue_branch(find_orbit(osc, (0.4, 0.0)), "frequency", (0.6, 0.68))
    return max(p.parameter for p in branch.special("saddle-node"))


@pytest.mark.slow
def test_fold_of_the_smoothed_system_converges():
    """A smooth corner of width s moves the fold by s^2: halving gains four, and the rest extrapolates to zero."""
    errors = smoothed_errors((0.008, 0.004, 0.002))
    assert errors[0] / errors[1] == pytest.approx(4.0, abs=0.3)
    assert errors[1] / errors[2] == pytest.approx(4.0, abs=0.15)
    assert abs(4 * errors[2] - errors[1]) / 3 < 3e-6


def smoothed_errors(widths) -> list[float]:
    osc = GearOscillator(FourierStiffness(1.0, (KAPPA,), (0.0,)), ZETA, FORCE, EPS, 0.62, half_backlash=D)
    state = find_orbit(osc, (0.4, 0.0)).state
    target = exact_fold()
    assert target == pytest.approx(0.6555759637891, abs=1e-12)
    return [abs(fold(state, 0.62, s) - target) for s in widths]
