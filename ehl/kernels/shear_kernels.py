"""Compiled kernels across the film: Eyring's flow in closed form.

Places across the film are zeta = z/h from -1/2 (first surface) to 1/2; phi = 1/eta there. Shear stress is
tau_m + h p' zeta and the shear rate tau0 phi sinh(tau/tau0); with Sig = h p'/(2 tau0) and t = tau_m/tau0 that is
tau0 phi sinh(t + 2 Sig zeta).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from base import Array, hide_compilation

hide_compilation("ehl")

_MOST = 300.0  # largest Sig sought
_SMALL = 1e-3  # Sig below which flow and slope are in proportion


@njit(cache=True, error_model="numpy")
def eyring(
    phi: Array, zeta: Array, weights: Array, slide: float, sigma: float
) -> tuple[float, float, float, float]:
    """Mean shear stress and flow of one film.

    Parameters
    ----------
    phi, zeta, weights : ndarray (m,)
        1/eta, the places, and their weights of integration over [-1/2, 1/2]; places and weights are symmetric.
    slide : float
        (u(1/2) - u(-1/2))/(tau0 h), in the unit of phi.
    sigma : float
        Sig.

    Returns
    -------
    t : float
        tau_m/tau0.
    moment, by_sigma, by_phi : float
        J = int phi zeta sinh(t + 2 Sig zeta), of which the flow is u_m h - tau0 h^2 J, dJ/dSig and dJ/dln(phi); all
        times exp(-|Sig|), so that they stay finite.
    """
    m = phi.size
    s = abs(sigma)
    scale = math.exp(-s)
    grown = np.empty(m)
    up = 0.0
    down = 0.0
    for j in range(m):
        grown[j] = math.exp(2.0 * sigma * zeta[j] - s)
    for j in range(m):
        up += weights[j] * phi[j] * grown[j]
        down += weights[j] * phi[j] * grown[m - 1 - j]
    pulled = slide * scale / math.sqrt(up * down)
    t = math.asinh(pulled) - 0.5 * math.log(up / down)
    rise = 0.5 * math.exp(t)
    fall = 0.25 / rise
    moment = 0.0
    c0 = 0.0
    c1 = 0.0
    c2 = 0.0
    for j in range(m):
        part = weights[j] * phi[j]
        more = rise * grown[j]
        less = fall * grown[m - 1 - j]
        moment += part * zeta[j] * (more - less)
        c0 += part * (more + less)
        c1 += part * zeta[j] * (more + less)
        c2 += part * zeta[j] ** 2 * (more + less)
    by_phi = moment - c1 * pulled / math.sqrt(1.0 + pulled * pulled)
    return t, moment, 2.0 * (c2 - c1 * c1 / c0), by_phi


@njit(cache=True, error_model="numpy")
def still(phi: Array, zeta: Array, weights: Array, slide: float) -> tuple[float, float]:
    """J(0) and dJ/dSig there."""
    c0 = 0.0
    c1 = 0.0
    c2 = 0.0
    for j in range(phi.size):
        part = weights[j] * phi[j]
        c0 += part
        c1 += part * zeta[j]
        c2 += part * zeta[j] ** 2
    return slide * c1 / c0, 2.0 * math.sqrt(1.0 + (slide / c0) ** 2) * (c2 - c1 * c1 / c0)


@njit(cache=True, error_model="numpy")
def gradient(phi: Array, zeta: Array, weights: Array, slide: float, pushed: float, start: float) -> float:
    """Sig at which the pressure moves a given flow: J(Sig) - J(0) = pushed, by Newton's method in asinh."""
    level, unit = still(phi, zeta, weights, slide)
    want = math.asinh(pushed / unit)
    low = -_MOST
    high = _MOST
    sigma = min(max(start, low), high)
    for _ in range(80):
        _, moment, slope, _ = eyring(phi, zeta, weights, slide, sigma)
        grow = math.exp(abs(sigma))
        got = (moment * grow - level) / unit
        miss = want - math.asinh(got)
        if miss > 0.0:
            low = sigma
        else:
            high = sigma
        last = sigma
        sigma += miss * math.sqrt(1.0 + got * got) * unit / (slope * grow)
        if not low < sigma < high:
            sigma = 0.5 * (low + high)
        if abs(sigma - last) <= 1e-6 * (1e-4 + abs(sigma)):  # the next step would be the square of it
            break
    return sigma


@njit(cache=True, error_model="numpy")
def flow_across(
    viscosity: Array,
    gap: Array,
    limit: Array,
    moved: Array,
    mean_speed: float,
    slide: float,
    stress: float,
    zeta: Array,
    weights: Array,
    sum_up: Array,
    sigma: Array,
) -> tuple[Array, Array, Array, Array, Array]:
    """Flow of every cell's film in which the pressure moves a given volume: stresses, velocities, heat.

    Parameters
    ----------
    viscosity : ndarray (n, m)
        eta [Pa s]; where the mean stress would pass its limit the film shears as if it were thinner.
    gap, limit, moved : ndarray (n,)
        h [m], the maximum mean stress [Pa] and what the pressure moves upstream [m2/s].
    mean_speed, slide, stress : float
        u_m, u2 - u1 [m/s], tau0 [Pa].
    zeta, weights : ndarray (m,)
        Places and weights.
    sum_up : ndarray (m, m)
        Integral from -1/2 to each place, of nodal values.
    sigma : ndarray (n,)
        Start of Sig; holds the solution afterwards.

    Returns
    -------
    flow : ndarray (n, 5)
        tau_m [Pa]; eta_eff [Pa s] of h^3 p'/(12 eta_eff); share of u_m h that flows without a pressure gradient;
        d ln(flow moved)/d ln(p') and -d ln(flow moved)/d ln(eta), of which 1 is Newtonian.
    speed, across, rate, yielding : ndarray (n, m)
        u [m/s], tau [Pa], du/dz [1/s] and d(du/dz)/dtau [1/(Pa s)], 0 where the mean stress stands at its limit.
    """
    n, m = viscosity.shape
    flow = np.empty((n, 5))
    speed = np.empty((n, m))
    across = np.empty((n, m))
    rate = np.empty((n, m))
    yielding = np.zeros((n, m))
    phi = np.empty(m)
    for i in range(n):
        h = gap[i]
        for j in range(m):
            phi[j] = 1.0 / viscosity[i, j]
        sheared = slide / (stress * h)
        s = sigma[i]
        limited = False
        for _ in range(3):
            level, unit = still(phi, zeta, weights, sheared)
            pushed = moved[i] / (stress * h * h)
            s = gradient(phi, zeta, weights, sheared, pushed, s)
            t, moment, slope, by_phi = eyring(phi, zeta, weights, sheared, s)
            excess = abs(t) * stress / limit[i]
            if excess <= 1.0 + 1e-9:
                break
            limited = True
            bound = math.copysign(limit[i] / stress, t)
            up = 0.0
            down = 0.0
            for j in range(m):
                up += weights[j] * phi[j] * math.exp(2.0 * s * zeta[j])
                down += weights[j] * phi[j] * math.exp(-2.0 * s * zeta[j])
            thinner = sheared / (math.sqrt(up * down) * math.sinh(bound + 0.5 * math.log(up / down)))
            for j in range(m):
                phi[j] *= max(thinner, 1.0)
        sigma[i] = s
        flow[i, 0] = t * stress
        flow[i, 2] = 1.0 - stress * h * level / mean_speed
        if abs(s) < _SMALL:
            flow[i, 1] = 1.0 / (6.0 * unit)
            flow[i, 3] = 1.0
            flow[i, 4] = 1.0 - math.tanh(t) ** 2
        else:
            scale = math.exp(-abs(s))
            pushes = moment - level * scale
            flow[i, 1] = s * scale / (6.0 * pushes)
            flow[i, 3] = s * slope / pushes
            flow[i, 4] = by_phi / pushes
        rise = 0.5 * math.exp(t)
        for j in range(m):
            grown = math.exp(2.0 * s * zeta[j])
            more = rise * grown
            less = 0.25 / more
            rate[i, j] = stress * phi[j] * (more - less)
            across[i, j] = stress * (t + 2.0 * s * zeta[j])
            if not limited:
                yielding[i, j] = phi[j] * (more + less)
        for j in range(m):
            total = 0.0
            for k in range(m):
                total += sum_up[j, k] * rate[i, k]
            speed[i, j] = mean_speed - 0.5 * slide + h * total
    return flow, speed, across, rate, yielding
