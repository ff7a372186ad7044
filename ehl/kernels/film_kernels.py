"""Compiled kernels of the line contact: plain arrays in and out, readable twins in the tests.

Everything here is dimensionless on a length a: X = x/a, P = p/p_a with p_a = 2w/(pi a), H = h R/a^2.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from base import Array, Integers, hide_compilation

hide_compilation("ehl")

# Beyond this many half-cells the closed form of a cell's integral cancels and its series has converged.
_FAR = 10.0


@njit(cache=True, error_model="numpy")
def log_potential(nodes: Array, points: Array) -> Array:
    """Integrals of ln|x - t| times the hat function of each node.

    Parameters
    ----------
    nodes : ndarray (n,)
        Increasing nodes of the piecewise linear pressure.
    points : ndarray (m,)
        Where the potential is wanted.

    Returns
    -------
    ndarray (m, n)
        Entry (i, j) is the integral of phi_j(t) ln|points_i - t| dt, exact to rounding.
    """
    n = nodes.size
    m = points.size
    out = np.zeros((m, n))
    for i in range(m):
        x = points[i]
        for c in range(n - 1):
            k = 0.5 * (nodes[c + 1] - nodes[c])
            d = x - 0.5 * (nodes[c + 1] + nodes[c])
            if abs(d) > _FAR * k:
                q = (k / d) ** 2
                s0 = q * (1 / 6 + q * (1 / 20 + q * (1 / 42 + q * (1 / 72 + q * (1 / 110 + q / 156)))))
                s1 = 1 / 3 + q * (1 / 15 + q * (1 / 35 + q * (1 / 63 + q * (1 / 99 + q / 143))))
                half_mean = k * (math.log(abs(d)) - s0)
                slope = -k * (k / d) * s1
            else:
                u = d + k
                v = d - k
                ul = u * math.log(abs(u)) if u != 0.0 else 0.0
                vl = v * math.log(abs(v)) if v != 0.0 else 0.0
                mean = ul - vl - 2.0 * k
                half_mean = 0.5 * mean
                slope = (d * mean - 0.5 * (u * ul - v * vl) + d * k) / (2.0 * k)
            out[i, c] += half_mean - slope
            out[i, c + 1] += half_mean + slope
    return out


@njit(cache=True, error_model="numpy")
def _opening(f: int, gap: Array, density: Array, faces: Array) -> tuple[float, float, float, float]:
    """Give w = 1/(rho H^3) at both ends of a cell and four times in its middle, and rho H in its middle."""
    ln_middle = 0.0
    for k in range(3):
        i = f - 1 + k
        if i >= 0:
            ln_middle += faces[f, k] * math.log(density[i] * gap[i])
    middle = math.exp(ln_middle)
    w_mid = 4.0 * (0.5 * (density[f] + density[f + 1])) ** 2 / middle**3
    return 1.0 / (density[f] * gap[f] ** 3), w_mid, 1.0 / (density[f + 1] * gap[f + 1] ** 3), middle


@njit(cache=True, error_model="numpy")
def _fluidity(f: int, ln_viscosity: Array, shear: Array) -> tuple[float, float]:
    """Mean of 1/eta over a cell, and how much more of it than half its first end decides."""
    ln_mean = 0.5 * (ln_viscosity[f] + ln_viscosity[f + 1])
    d = ln_viscosity[f] - ln_viscosity[f + 1]
    if shear.shape[0] > 0:
        ln_mean = shear[f, 0]
        d *= shear[f, 1]
    if abs(d) < 1e-3:
        return math.exp(-ln_mean) * (1.0 + d * d / 24.0), d / 12.0
    return math.exp(-ln_mean) * math.sinh(0.5 * d) / (0.5 * d), 0.5 / math.tanh(0.5 * d) - 1.0 / d


@njit(cache=True, error_model="numpy")
def pressure_flow(
    nodes: Array,
    pressure: Array,
    gap: Array,
    faces: Array,
    ln_viscosity: Array,
    density: Array,
    shear: Array,
    lam: float,
) -> Array:
    """Flow that the pressure moves upstream through each cell, (n-1,), at the present viscosities.

    The first term of the flux of :func:`reynolds`, whose arguments these are.
    """
    flow = np.empty(nodes.size - 1)
    for f in range(nodes.size - 1):
        w_left, w_mid, w_right, _ = _opening(f, gap, density, faces)
        fluidity, _ = _fluidity(f, ln_viscosity, shear)
        h = nodes[f + 1] - nodes[f]
        flow[f] = 6.0 * fluidity * (pressure[f + 1] - pressure[f]) / (lam * h * (w_left + w_mid + w_right))
    return flow


@njit(cache=True, error_model="numpy")
def reynolds(
    nodes: Array,
    pressure: Array,
    gap: Array,
    faces: Array,
    ln_viscosity: Array,
    ln_viscosity_slope: Array,
    density: Array,
    density_slope: Array,
    shear: Array,
    lam: float,
    upstream: Array,
) -> tuple[Array, Array]:
    """Flux through each cell and its derivatives by the pressures and gaps of three nodes.

    In the cell between the nodes f and f+1 the steady equation dP/eta = lambda (rho H - q) w dX with
    w = 1/(rho H^3) is integrated as it stands: the left side by the logarithmic mean of 1/eta (exact where
    ln eta is linear in P), the right side by Simpson's rule, whose middle value of rho H comes from the
    nodes f-1, f, f+1 with the weights faces[f] on its logarithm. So -q = F_f = mean(1/eta) dP/(lambda int w)
    - int rho H w / int w.

    The share upstream[f] of the second is rho H carried on from the nodes f-1, f to the middle of the cell instead,
    see :func:`ehl.discrete.grid.upstream_share`.

    Oil that thins under its shear moves more than in proportion to dP: the first term D is then linearised about
    the flow M for which the viscosity was found, M + g (D - M).

    Parameters
    ----------
    nodes, pressure, gap : ndarray (n,)
        X, P, H.
    faces : ndarray (n-1, 3)
        From :func:`ehl.discrete.grid.face_weights`.
    ln_viscosity, ln_viscosity_slope, density, density_slope : ndarray (n,)
        ln(eta/eta0), rho/rho0 and their derivatives by P.
    shear : ndarray (n-1, 5) or (0, 5)
        Of oil that thins, in each cell: ln of its viscosity over eta0; the factor that takes differences and slopes
        of ``ln_viscosity`` to it; M; g; and by how much the exponent of H in the first term exceeds 3 g.
    lam : float
        lambda.
    upstream : ndarray (n-1,)
        Share of the wedge term that comes from upstream.

    Returns
    -------
    flux : ndarray (n-1,)
        F_f.
    slopes : ndarray (n-1, 6)
        dF_f/dP at fixed H, then dF_f/dH at fixed P, at the nodes f-1, f, f+1.
    """
    n = nodes.size
    flux = np.empty(n - 1)
    slopes = np.zeros((n - 1, 6))
    for f in range(n - 1):
        h = nodes[f + 1] - nodes[f]
        fluidity, tilt = _fluidity(f, ln_viscosity, shear)
        w_left, w_mid, w_right, middle = _opening(f, gap, density, faces)
        density_sum = density[f] + density[f + 1]
        v_mid = w_mid * middle
        w = w_left + w_mid + w_right
        mean = (1.0 / gap[f] ** 2 + v_mid + 1.0 / gap[f + 1] ** 2) / w
        mobility = 6.0 * fluidity / (lam * h * w)
        drive = mobility * (pressure[f + 1] - pressure[f])
        moved = drive
        by_pressure = 1.0
        by_gap = 0.0
        if shear.shape[0] > 0:
            by_pressure = shear[f, 1]
            mobility *= shear[f, 3]
            moved = shear[f, 2] + shear[f, 3] * (drive - shear[f, 2])
            drive *= shear[f, 3]
            by_gap = 0.5 * shear[f, 4] * moved
        back = 0.5 * h / (nodes[f] - nodes[f - 1]) if f > 0 else 0.0
        ahead = max(f - 1, 0)
        extrapolation = (-back, 1.0 + back, 0.0)
        ln_carried = (1.0 + back) * math.log(density[f] * gap[f]) - back * math.log(
            density[ahead] * gap[ahead]
        )
        carried = upstream[f] * math.exp(ln_carried)
        kept = 1.0 - upstream[f]
        flux[f] = moved - kept * mean - carried
        # d flux = drive d ln(fluidity) + mobility d(dP) - (drive dw + kept (dv - mean dw))/w - d(carried), v = rho H w
        by_w = (kept * mean - drive) / w
        slopes[f, 1] = -mobility - drive * (0.5 - tilt) * by_pressure * ln_viscosity_slope[f]
        slopes[f, 2] = mobility - drive * (0.5 + tilt) * by_pressure * ln_viscosity_slope[f + 1]
        for k in range(1, 3):
            i = f - 1 + k
            w_end = w_left if k == 1 else w_right
            by_density = density_slope[i] / density[i]
            slopes[f, k] -= by_w * w_end * by_density
            slopes[f, k] += 2.0 * density_slope[i] / density_sum * (by_w * w_mid - kept * v_mid / w)
            slopes[f, 3 + k] += (-3.0 * by_w * w_end + 2.0 * kept / (gap[i] ** 2 * w) + by_gap) / gap[i]
        by_ln_middle = -3.0 * by_w * w_mid + 2.0 * kept * v_mid / w
        for k in range(3):
            i = f - 1 + k
            if i >= 0:
                by_ln = by_ln_middle * faces[f, k] - carried * extrapolation[k]
                slopes[f, k] += by_ln * density_slope[i] / density[i]
                slopes[f, 3 + k] += by_ln / gap[i]
    return flux, slopes


@njit(cache=True, error_model="numpy")
def newton_matrix(slopes: Array, influence: Array, weights: Array, free: Integers) -> Array:
    """Newton matrix of the free nodes and of the rigid separation, each row scaled to 1.

    Parameters
    ----------
    slopes : ndarray (n-1, 6)
        From :func:`reynolds`.
    influence : ndarray (n, n)
        dH_i/dP_j.
    weights : ndarray (n,)
        Integral of each hat function: the load row.
    free : ndarray (k,)
        Nodes inside the film, increasing, without the first and last node.

    Returns
    -------
    ndarray (k+1, k+2), Fortran order
        The matrix; its last column holds the factor by which each row was multiplied.
    """
    k = free.size
    n = weights.size
    out = np.zeros((k + 2, k + 1)).T
    row = np.empty(n)
    for r in range(k):
        i = free[r]
        c0 = slopes[i - 1, 3]
        c1 = slopes[i - 1, 4] - slopes[i, 3]
        c2 = slopes[i - 1, 5] - slopes[i, 4]
        c3 = slopes[i, 5]
        low = max(i - 2, 0)  # the weight of a node before the first is zero
        for j in range(n):
            row[j] = (
                c3 * influence[i + 1, j]
                - c2 * influence[i, j]
                - c1 * influence[i - 1, j]
                - c0 * influence[low, j]
            )
        for m in range(3):
            if i - 2 + m >= 0:
                row[i - 2 + m] -= slopes[i - 1, m]
            row[i - 1 + m] += slopes[i, m]
        by_gap = c3 - c2 - c1 - c0
        largest = abs(by_gap)
        for c in range(k):
            largest = max(largest, abs(row[free[c]]))
        scale = 1.0 / largest
        for c in range(k):
            out[r, c] = scale * row[free[c]]
        out[r, k] = scale * by_gap
        out[r, k + 1] = scale
    for c in range(k):
        out[k, c] = weights[free[c]]
    out[k, k + 1] = 1.0
    return out
