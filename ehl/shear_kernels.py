"""Compiled kernels across the film: Eyring's flow in closed form, and heat.

Places across the film are zeta = z/h from -1/2 (first surface) to 1/2; phi = 1/eta there. Shear stress is
tau_m + h p' zeta and the shear rate tau0 phi sinh(tau/tau0); with Sig = h p'/(2 tau0) and t = tau_m/tau0 that is
tau0 phi sinh(t + 2 Sig zeta).
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from base import Array, hide_compilation

hide_compilation()

# Largest Sig sought. Only the flanks of a spike have more; there the oil thins no further under its pressure. Freely
# thinning flanks keep the iteration going round at heavy loads; with this bound the least film is up to 1 % thicker.
_MOST = 4.5


@njit(cache=True, error_model="numpy")
def eyring(phi: Array, zeta: Array, weights: Array, slide: float, sigma: float) -> tuple[float, float, float]:
    """Mean shear stress and flow of one film.

    Parameters
    ----------
    phi, zeta, weights : ndarray (m,)
        1/eta, the places, and their weights of integration over [-1/2, 1/2].
    slide : float
        (u(1/2) - u(-1/2))/(tau0 h), in the unit of phi.
    sigma : float
        Sig.

    Returns
    -------
    t : float
        tau_m/tau0.
    moment, slope : float
        J = int phi zeta sinh(t + 2 Sig zeta), of which the flow is u_m h - tau0 h^2 J, and dJ/dSig; both times
        exp(-|Sig|), so that they stay finite.
    """
    s = abs(sigma)
    scale = math.exp(-s)
    up = 0.0
    down = 0.0
    for j in range(phi.size):
        up += weights[j] * phi[j] * math.exp(2.0 * sigma * zeta[j] - s)
        down += weights[j] * phi[j] * math.exp(-2.0 * sigma * zeta[j] - s)
    t = math.asinh(slide * scale / math.sqrt(up * down)) - 0.5 * math.log(up / down)
    moment = 0.0
    c0 = 0.0
    c1 = 0.0
    c2 = 0.0
    for j in range(phi.size):
        x = t + 2.0 * sigma * zeta[j]
        if s > 20.0:
            rise = math.exp(x - s)
            fall = math.exp(-x - s)
            sinh = 0.5 * (rise - fall)
            cosh = 0.5 * (rise + fall)
        else:
            sinh = scale * math.sinh(x)
            cosh = scale * math.cosh(x)
        part = weights[j] * phi[j]
        moment += part * zeta[j] * sinh
        c0 += part * cosh
        c1 += part * zeta[j] * cosh
        c2 += part * zeta[j] ** 2 * cosh
    return t, moment, 2.0 * (c2 - c1 * c1 / c0)


@njit(cache=True, error_model="numpy")
def gradient(phi: Array, zeta: Array, weights: Array, slide: float, pushed: float, start: float) -> float:
    """Sig at which the pressure moves a given flow: J(Sig) - J(0) = pushed, by Newton's method in asinh."""
    sum_0 = 0.0
    sum_1 = 0.0
    for j in range(phi.size):
        sum_0 += weights[j] * phi[j]
        sum_1 += weights[j] * phi[j] * zeta[j]
    still = slide * sum_1 / sum_0
    _, _, unit = eyring(phi, zeta, weights, slide, 0.0)
    want = math.asinh(pushed / unit)
    low = -_MOST
    high = _MOST
    sigma = min(max(start, low), high)
    for _ in range(80):
        _, moment, slope = eyring(phi, zeta, weights, slide, sigma)
        grow = math.exp(abs(sigma))
        got = (moment * grow - still) / unit
        miss = want - math.asinh(got)
        if miss > 0.0:
            low = sigma
        else:
            high = sigma
        last = sigma
        sigma += miss * math.sqrt(1.0 + got * got) * unit / (slope * grow)
        if not low < sigma < high:
            sigma = 0.5 * (low + high)
        if abs(sigma - last) <= 1e-11 * (1e-6 + abs(sigma)):
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
) -> tuple[Array, Array, Array, Array, Array, Array]:
    """Flow of every node's film in which the pressure moves a given volume: stresses, velocities, heat.

    Parameters
    ----------
    viscosity : ndarray (n, m)
        eta [Pa s]; where the mean stress would pass its limit the film shears as if it were thinner.
    gap, limit, moved : ndarray (n,)
        h [m], the greatest mean stress [Pa] and what the pressure moves downhill [m2/s].
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
    mean_stress, effective, carry : ndarray (n,)
        tau_m [Pa]; eta_eff [Pa s] of h^3 p'/(12 eta_eff); share of u_m h that flows without a pressure gradient.
    thinning : ndarray (n,)
        -d ln(eta_eff)/d ln(eta), of which 1 is Newtonian; near 0 where sliding thins.
    speed, heat : ndarray (n, m)
        u [m/s] and tau du/dz [W/m3].
    """
    n, m = viscosity.shape
    mean_stress = np.empty(n)
    effective = np.empty(n)
    carry = np.empty(n)
    thinning = np.empty(n)
    speed = np.empty((n, m))
    heat = np.empty((n, m))
    phi = np.empty(m)
    rate = np.empty(m)
    for i in range(n):
        h = gap[i]
        for j in range(m):
            phi[j] = 1.0 / viscosity[i, j]
        sheared = slide / (stress * h)
        s = sigma[i]
        for _ in range(3):
            sum_0 = 0.0
            sum_1 = 0.0
            for j in range(m):
                sum_0 += weights[j] * phi[j]
                sum_1 += weights[j] * phi[j] * zeta[j]
            carry[i] = 1.0 - slide * sum_1 / (sum_0 * mean_speed)
            pushed = moved[i] / (stress * h * h)
            s = gradient(phi, zeta, weights, sheared, pushed, s)
            t, moment, slope = eyring(phi, zeta, weights, sheared, s)
            excess = abs(t) * stress / limit[i]
            if excess <= 1.0 + 1e-9:
                break
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
        mean_stress[i] = t * stress
        still = sheared * sum_1 / sum_0
        if abs(s) < 1e-3:
            _, _, slope = eyring(phi, zeta, weights, sheared, 0.0)
            effective[i] = 1.0 / (6.0 * slope)
        else:
            effective[i] = s / (6.0 * (moment * math.exp(abs(s)) - still))
        thinning[i] = 1.0 - math.tanh(t) ** 2
        for j in range(m):
            tau = t + 2.0 * s * zeta[j]
            rate[j] = stress * phi[j] * math.sinh(tau)
            heat[i, j] = stress * tau * rate[j]
        for j in range(m):
            total = 0.0
            for k in range(m):
                total += sum_up[j, k] * rate[k]
            speed[i, j] = mean_speed - 0.5 * slide + h * total
    return mean_stress, effective, carry, thinning, speed, heat


@njit(cache=True, error_model="numpy")
def heat_across(
    x: Array,
    gap: Array,
    flow: Array,
    heat: Array,
    expanding: Array,
    conductivity: float,
    zeta: Array,
    derive: Array,
    derive_2: Array,
    sum_up: Array,
    bodies: Array,
    bulk: Array,
    first: int,
    last: int,
    temperature: Array,
    into: Array,
    backward: bool,
) -> None:
    """Sweep once along the film for the temperature across it and in both surfaces.

    At every place across, c g dT/dx + c V dT/dzeta = (k/h) d2T/dzeta2 + h (heat + expanding T), g = rho u h and V
    from its continuity; upwind along x (second order with the flow, first against it), collocation across;
    at the surfaces T = bulk + bodies @ flux.

    Parameters
    ----------
    x, gap : ndarray (n,)
        Nodes and h [m].
    flow : ndarray (n, m)
        c g [W/(m K)] per zeta.
    heat, expanding : ndarray (n, m)
        Dissipation [W/m3] and the expansion times u p' [W/(m3 K)].
    conductivity : float
        k [W/(m K)].
    zeta, derive, derive_2, sum_up : ndarray
        Places (m,); matrices (m, m) of the first and second derivative and of the integral from -1/2.
    bodies : ndarray (2, n, n)
        Temperature of either surface per heat flux into it [K m2/W].
    bulk : ndarray (2,)
        Bulk temperatures [K].
    first, last : int
        First and last node that are solved.
    temperature, into : ndarray (n, m), (2, n)
        T [K] and the heat flux into either body [W/m2]; changed in place.
    backward : bool
        From the outlet to the inlet.
    """
    m = zeta.size
    system = np.empty((m, m))
    right = np.empty(m)
    down_flow = np.empty(m)
    for step in range(first, last + 1):
        i = last + first - step if backward else step
        h = gap[i]
        d1 = x[i] - x[i - 1]
        for j in range(m):
            total = 0.0
            for k in range(m):
                total += sum_up[j, k] * (flow[i, k] - flow[i - 1, k])
            down_flow[j] = -total / d1
        for j in range(1, m - 1):
            for k in range(m):
                system[j, k] = down_flow[j] * derive[j, k] - conductivity / h * derive_2[j, k]
            source = h * heat[i, j]
            system[j, j] -= h * expanding[i, j]
            g = flow[i, j]
            if g >= 0.0 and i > first:
                d2 = x[i] - x[i - 2]
                a2 = -d1 / (d2 * (d2 - d1))
                a1 = d2 / (d1 * (d2 - d1))
                system[j, j] += g * (a1 + a2)
                source += g * (a1 * temperature[i - 1, j] + a2 * temperature[i - 2, j])
            elif g >= 0.0:
                system[j, j] += g / d1
                source += g / d1 * temperature[i - 1, j]
            elif i < last:
                d = x[i + 1] - x[i]
                system[j, j] -= g / d
                source -= g / d * temperature[i + 1, j]
            right[j] = source
        for side in range(2):
            row = 0 if side == 0 else m - 1
            sign = -1.0 if side == 0 else 1.0
            far = bulk[side]
            for k in range(last + 1):
                if k != i:
                    far += bodies[side, i, k] * into[side, k]
            for k in range(m):
                system[row, k] = sign * bodies[side, i, i] * conductivity / h * derive[row, k]
            system[row, row] += 1.0
            right[row] = far
        solved = np.linalg.solve(system, right)
        for j in range(m):
            temperature[i, j] = solved[j]
        low = 0.0
        high = 0.0
        for k in range(m):
            low += derive[0, k] * solved[k]
            high += derive[m - 1, k] * solved[k]
        into[0, i] = conductivity / h * low
        into[1, i] = -conductivity / h * high
