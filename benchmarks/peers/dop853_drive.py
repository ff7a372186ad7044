"""Motion of a drive train with backlash by DOP853 compiled with events.

The scheme of Dormand and Prince with Hairer's error estimate and step control, as in `dop853_motion`, for the drive
train of the benchmark: the matrices come multiplied by the inverse of the mass, and the mesh acts along g.
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


@njit(_nrt=False, **SAME)
def gap(t, y, g, par):
    """Contact coordinate and its rate; `par` holds kappa, c, eps, omega, D."""
    n = len(g)
    x, v = -par[2] * math.cos(par[3] * t), par[2] * par[3] * math.sin(par[3] * t)
    for i in range(n):
        x += g[i] * y[i]
        v += g[i] * y[n + i]
    return x, v


@njit(_nrt=False, **SAME)
def rates(t, y, region, g, stiff, drag, load, reach, par, out):
    """Speeds and accelerations; `reach` is the inverse mass times g."""
    n = len(g)
    x, v = gap(t, y, g, par)
    push = par[1] * v
    if region != 0:
        push += (1.0 + par[0] * math.cos(par[3] * t)) * (x - region * par[4])
    for i in range(n):
        total = load[i] - reach[i] * push
        for j in range(n):
            total -= stiff[i, j] * y[j] + drag[i, j] * y[n + j]
        out[i] = y[n + i]
        out[n + i] = total


@njit(_nrt=False, **SAME)
def one_step(t, y, h, region, g, stiff, drag, load, reach, par, k, trial, new):
    """One step of DOP853 from a known first stage; leaves the stages in `k` and the end in `new`."""
    size = len(y)
    for s in range(1, STAGES):
        for i in range(size):
            total = 0.0
            for j in range(s):
                total += A[s, j] * k[j, i]
            trial[i] = y[i] + h * total
        rates(t + C[s] * h, trial, region, g, stiff, drag, load, reach, par, k[s])
    for i in range(size):
        total = 0.0
        for j in range(STAGES):
            total += B[j] * k[j, i]
        new[i] = y[i] + h * total
    rates(t + h, new, region, g, stiff, drag, load, reach, par, k[STAGES])


@njit(_nrt=False, **SAME)
def outside(x, region, d):
    """Boundary that a region has been left through, 0 if none."""
    if region == 1:
        return 1 if x < d else 0
    if region == -1:
        return -1 if x > -d else 0
    return 1 if x > d else -1 if x < -d else 0


@njit(_nrt=False, **SAME)
def excess(y, new, h, rtol, k):
    """Error of a step over what is allowed."""
    size = len(y)
    e5 = e3 = 0.0
    for i in range(size):
        scale = 1e-3 * rtol + rtol * max(abs(y[i]), abs(new[i]))
        s5 = s3 = 0.0
        for j in range(STAGES + 1):
            s5 += E5[j] * k[j, i]
            s3 += E3[j] * k[j, i]
        e5 += (s5 / scale) ** 2
        e3 += (s3 / scale) ** 2
    return abs(h) * e5 / math.sqrt(max(e5 + 0.01 * e3, 1e-300) * size)


@njit(**SAME)
def compiled_dop853(start, periods, rtol, g, stiff, drag, load, reach, par):
    """State after whole periods."""
    d, length = par[4], 2.0 * math.pi / par[3]
    size = len(start)
    y, new, trial, k = start.copy(), np.empty(size), np.empty(size), np.empty((STAGES + 1, size))
    x = gap(0.0, y, g, par)[0]
    region = 1 if x > d else -1 if x < -d else 0
    h = 0.1
    for _ in range(periods):
        t = 0.0
        rates(t, y, region, g, stiff, drag, load, reach, par, k[0])
        while t < length:
            h = min(h, length - t)
            one_step(t, y, h, region, g, stiff, drag, load, reach, par, k, trial, new)
            norm = excess(y, new, h, rtol, k)
            factor = 0.9 * max(norm, 1e-12) ** (-0.125)
            if norm > 1.0 and h > 1e-9:
                h *= max(0.2, factor)
                continue
            hit = outside(gap(t + h, new, g, par)[0], region, d)
            if hit == 0:
                t += h
                y[:] = new
                k[0] = k[STAGES]
                h *= min(10.0, factor)
                continue
            low, high = 0.0, h
            begin, end = gap(t, y, g, par)[0], gap(t + h, new, g, par)[0]
            share = (hit * d - begin) / (end - begin)
            piece = min(share, 1.0) * h if share > 0.0 else h  # not the boundary just left
            for _ in range(50):
                one_step(t, y, piece, region, g, stiff, drag, load, reach, par, k, trial, new)
                x, v = gap(t + piece, new, g, par)
                if outside(x, region, d) != 0:
                    high = piece
                else:
                    low = piece
                move = -(x - hit * d) / v if v != 0.0 else 0.0
                if abs(move) <= 1e-15 * length:
                    break
                piece = piece + move if low < piece + move < high else 0.5 * (low + high)
            t += piece
            y[:] = new
            region = 0 if region != 0 else hit
            rates(t, y, region, g, stiff, drag, load, reach, par, k[0])
    return y


def settings(inputs: dict[str, Any]) -> Iterator[tuple[Any, ...]]:
    """Tolerances."""
    mass, damping, stiffness = (np.array(inputs[name]) for name in ("mass", "damping", "stiffness"))
    g, force = np.array(inputs["direction"]), np.array(inputs["mean_force"])
    inverse = np.linalg.inv(mass)
    fixed = (
        g,
        inverse @ stiffness,
        inverse @ damping,
        inverse @ force,
        inverse @ g,
        np.array(inputs["mesh"]),
    )
    for digits in range(4, 14):
        rtol = 10.0**-digits
        first, many = (
            partial(compiled_dop853, np.array(inputs["start"]), inputs[name], rtol, *fixed)
            for name in ("periods", "timed_periods")
        )
        yield f"rtol {rtol:.0e}", lambda first=first: first().tolist(), many, 1
