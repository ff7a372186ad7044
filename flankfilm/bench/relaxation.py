"""A rival of the film's solver: relaxed Gauss-Seidel iteration, the method of many papers on gears.

The iteration, as such papers describe it: Reynolds' equation by central differences of the pressure and a
first-order upwind wedge on uniform nodes; under-relaxed Gauss-Seidel sweeps that renew the film at every node,
with dipole changes (+ at a node, - at the one before) where the viscosity is so high that the wedge rules, as in
Venner's relaxation; viscosity renewed after each sweep; the rigid separation moved by a share of the missing load;
stopped when pressure changes by less than 1e-6 of its sum per sweep. The sweeps are compiled. The two factors of
relaxation are tried on a ladder from bold to careful, and the fastest that converges counts: the tuning that a
user would have to repeat for each contact.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numba import njit

from base import Array
from ehl.kernels.film_kernels import log_potential
from flankfilm.bench.examples import DOMAIN

if TYPE_CHECKING:
    from ehl import LineContact


LADDER = ((0.8, 0.2), (0.6, 0.1), (0.6, 0.05), (0.4, 0.02), (0.2, 0.02), (0.1, 0.005), (0.05, 0.001))
"""Factors of the pressure's and of the separation's changes."""

LEAST_GAP = 1e-3
SWITCH = 0.05
"""(Left + right) coefficient below which the change is a dipole."""
MOST_SWEEPS = 6000


@njit(cache=True)
def sweep_once(  # type: ignore[no-untyped-def]  # pragma: no cover - compiled
    P, H, K, eps, density, dX, relax, switch
):
    """One Gauss-Seidel sweep with the film renewed at every node; P and H are changed in place."""
    n = P.size
    total = 0.0
    for i in range(1, n - 1):
        left, right = 0.5 * (eps[i] + eps[i - 1]) / dX**2, 0.5 * (eps[i] + eps[i + 1]) / dX**2
        wedge = (density[i] * H[i] - density[i - 1] * H[i - 1]) / dX
        residual = left * (P[i - 1] - P[i]) + right * (P[i + 1] - P[i]) - wedge
        dipole = left + right < switch
        slope = -(left + right) + (density[i] * K[i, i] - density[i - 1] * K[i - 1, i]) / dX
        if dipole and P[i - 1] > 0.0:
            slope += -left - (density[i] * K[i, i - 1] - density[i - 1] * K[i - 1, i - 1]) / dX
        step = -relax * residual / slope
        step = max(step, -P[i])
        P[i] += step
        for k in range(n):
            H[k] -= K[k, i] * step
        if dipole and P[i - 1] > 0.0:
            back = max(-step, -P[i - 1])
            P[i - 1] += back
            for k in range(n):
                H[k] -= K[k, i - 1] * back
        total += abs(step)
    return total


def relaxed(contact: LineContact, nodes: int, factors: tuple[float, float]) -> tuple[float, int] | None:
    """Central film [m] and the sweeps taken, or None without convergence."""
    b, p_H, oil = contact.half_width, contact.peak_pressure, contact.lubricant
    X = np.linspace(*DOMAIN, nodes)
    dX = X[1] - X[0]
    K = log_potential(X, X) / math.pi
    at_zero = log_potential(X, np.array([0.0]))[0] / math.pi
    lam = 12.0 * oil.viscosity * contact.entrainment * contact.radius**2 / (b**3 * p_H)
    P: Array = np.sqrt(np.maximum(0.0, 1.0 - X**2))
    H0 = 0.3 - float((0.5 * X**2 - K @ P).min())
    for sweep in range(1, MOST_SWEEPS + 1):
        H = H0 + 0.5 * X**2 - K @ P
        if not np.isfinite(P).all() or P.max() > 1e3:
            return None
        H = np.maximum(H, LEAST_GAP)  # meanwhile the bodies may penetrate; at the end they may not
        density = oil.density_ratio(p_H * P)[0]
        eps = density * H**3 / (np.exp(oil.log_viscosity(p_H * P)[0]) * lam)
        change = sweep_once(P, H, K, eps, density, dX, factors[0], SWITCH)
        missing = 0.5 * math.pi - float(np.sum(P)) * dX
        H0 -= factors[1] * missing
        if change < 1e-6 * P.sum() * factors[0] and abs(missing) < 1e-5 and H.min() > LEAST_GAP:
            return (H0 - float(at_zero @ P)) * b**2 / contact.radius, sweep
    return None


def fastest_factors(contact: LineContact, nodes: int) -> tuple[float, float]:
    """Factors of the ladder that converge in the fewest sweeps; the most careful ones where none converges."""
    relaxations: dict[tuple[float, float], Any] = {
        factors: relaxed(contact, nodes, factors) for factors in LADDER
    }
    sweeps = {factors: answer[1] for factors, answer in relaxations.items() if answer is not None}
    return min(sweeps, key=lambda factors: sweeps[factors], default=LADDER[-1])
