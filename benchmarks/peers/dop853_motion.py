"""Motion with backlash by DOP853 compiled with events.

The scheme of Dormand and Prince with Hairer's error estimate and step control, for the one oscillator of the
benchmark, without overhead: no allocation in its loop, first-same-as-last, and an impact met by Newton's method on
the length of the step, from the state at its start.
"""

# mypy: disable-error-code="no-untyped-def, no-untyped-call"
from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import Any

import numba
import numpy as np
from numba import njit
from scipy.integrate import DOP853

PEER, VERSION, NOTE = "compiled DOP853", f"numba {numba.__version__}", ""
STAGES = 12
A, B, C, E3, E5 = (part.copy() for part in (DOP853.A, DOP853.B, DOP853.C, DOP853.E3, DOP853.E5))


SAME = {"error_model": "numpy", "fastmath": {"contract"}}  # compiled with the options of the exact flow


@njit(inline="always", **SAME)
def acceleration(t, x, v, region, par):
    """X'' in a region; `par` holds kappa, zeta, F_m, eps, omega, D."""
    c = math.cos(par[4] * t)
    f = 0.0 if region == 0 else x - region * par[5]
    return par[2] + par[3] * par[4] ** 2 * c - 2.0 * par[1] * v - (1.0 + par[0] * c) * f


@njit(_nrt=False, **SAME)
def one_step(t, x, v, h, region, par, k, a0):
    """One step of DOP853 from a known first stage; leaves the stages in `k`."""
    k[0, 0], k[0, 1] = v, a0
    for s in range(1, STAGES):
        dx = dv = 0.0
        for j in range(s):
            dx += A[s, j] * k[j, 0]
            dv += A[s, j] * k[j, 1]
        xs, vs = x + h * dx, v + h * dv
        k[s, 0], k[s, 1] = vs, acceleration(t + C[s] * h, xs, vs, region, par)
    dx = dv = 0.0
    for j in range(STAGES):
        dx += B[j] * k[j, 0]
        dv += B[j] * k[j, 1]
    x_new, v_new = x + h * dx, v + h * dv
    k[STAGES, 0], k[STAGES, 1] = v_new, acceleration(t + h, x_new, v_new, region, par)
    return x_new, v_new


@njit(_nrt=False, **SAME)
def outside(x, region, d):
    """Boundary that a region has been left through, 0 if none."""
    if region == 1:
        return 1 if x < d else 0
    if region == -1:
        return -1 if x > -d else 0
    return 1 if x > d else -1 if x < -d else 0


@njit(**SAME)
def compiled_dop853(x, v, periods, rtol, par):
    """State after whole periods."""
    d, length = par[5], 2.0 * math.pi / par[4]
    k = np.empty((STAGES + 1, 2))
    region = 1 if x > d else -1 if x < -d else 0
    h = 0.1
    for _ in range(periods):
        t = 0.0
        a0 = acceleration(t, x, v, region, par)
        while t < length:
            h = min(h, length - t)
            x_new, v_new = one_step(t, x, v, h, region, par, k, a0)
            e5 = e3 = 0.0
            for i in range(2):
                scale = 1e-3 * rtol + rtol * max(abs(x if i == 0 else v), abs(x_new if i == 0 else v_new))
                s5 = s3 = 0.0
                for j in range(STAGES + 1):
                    s5 += E5[j] * k[j, i]
                    s3 += E3[j] * k[j, i]
                e5 += (s5 / scale) ** 2
                e3 += (s3 / scale) ** 2
            norm = abs(h) * e5 / math.sqrt(max(e5 + 0.01 * e3, 1e-300) * 2.0)
            factor = 0.9 * max(norm, 1e-12) ** (-0.125)
            if norm > 1.0 and h > 1e-9:
                h *= max(0.2, factor)
                continue
            hit = outside(x_new, region, d)
            if hit == 0:
                t, x, v, a0 = t + h, x_new, v_new, k[STAGES, 1]
                h *= min(10.0, factor)
                continue
            low, high = 0.0, h
            share = (hit * d - x) / (x_new - x)
            trial = (
                min(share, 1.0) * h if share > 0.0 else h
            )  # the boundary just left is not the one that is met
            for _ in range(50):
                x_t, v_t = one_step(t, x, v, trial, region, par, k, a0)
                if outside(x_t, region, d) != 0:
                    high = trial
                else:
                    low = trial
                move = -(x_t - hit * d) / v_t if v_t != 0.0 else 0.0
                if abs(move) <= 1e-15 * length:
                    break
                trial = trial + move if low < trial + move < high else 0.5 * (low + high)
            t, x, v = t + trial, hit * d, v_t
            region = 0 if region != 0 else hit
            a0 = acceleration(t, x, v, region, par)
    return x, v


def settings(inputs: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """Tolerances."""
    x, v = inputs["start"]
    par = np.array(inputs["oscillator"])
    for digits in range(4, 14):
        rtol = 10.0**-digits
        first, many = (
            partial(compiled_dop853, x, v, inputs[name], rtol, par) for name in ("periods", "timed_periods")
        )
        yield f"rtol {rtol:.0e}", first, many, 1
