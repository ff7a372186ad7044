"""The Newton solver against a relaxed Gauss-Seidel iteration, the method of many papers on gears.

The iteration, as such papers describe it: Reynolds' equation by central differences of the pressure and a
first-order upwind wedge on uniform nodes; under-relaxed Gauss-Seidel sweeps that renew the film at every node,
with dipole changes (+ at a node, - at the one before) where the viscosity is so high that the wedge rules, as in
Venner's relaxation; viscosity renewed after each sweep; the rigid separation moved by a share of the missing load;
stopped when pressure changes by less than 1e-6 of its sum per sweep. The sweeps are compiled. The two factors of
relaxation are tried on a ladder from bold to careful, and the fastest that converges is reported: the tuning that a
user would have to repeat for each contact.

Run with ``OPENBLAS_NUM_THREADS=1 python benchmarks/ehl_relaxation.py``; takes about a minute.
"""

from __future__ import annotations

import math
import time
import warnings

import numpy as np
from numba import njit

from base import RangeWarning
from ehl import LineContact, Lubricant, solve
from ehl.kernels import log_potential

CASES = {
    "M2 L1": LineContact.from_moes(2.0, 1.0),
    "M5 L5": LineContact.from_moes(5.0, 5.0),
    "M20 L10": LineContact.from_moes(20.0, 10.0),
    "gear pitch point": LineContact(4.434e5, 2.579, 6.48e-3, 2.2e11, Lubricant(0.075, 19.6e-9)),
}
DOMAIN = (-4.0, 1.5)
LEAST_GAP = 1e-3
SWITCH = 0.05  # (left + right) coefficient below which the change is a dipole
LADDER = [(0.8, 0.2), (0.6, 0.1), (0.6, 0.05), (0.4, 0.02), (0.2, 0.02), (0.1, 0.005), (0.05, 0.001)]
MOST_SWEEPS = 6000


@njit(cache=True)
def sweep_once(P, H, K, eps, density, dX, relax, switch):
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


def relaxed(contact: LineContact, n: int, relax_p: float, relax_h: float) -> tuple[float, int] | None:
    """Return h at x = 0 [m] and the sweeps taken, or None without convergence."""
    b, p_H, oil = contact.half_width, contact.peak_pressure, contact.lubricant
    X = np.linspace(*DOMAIN, n)
    dX = X[1] - X[0]
    K = log_potential(X, X) / math.pi
    at_zero = log_potential(X, np.array([0.0]))[0] / math.pi
    lam = 12.0 * oil.viscosity * contact.entrainment * contact.radius**2 / (b**3 * p_H)
    P = np.sqrt(np.maximum(0.0, 1.0 - X**2))
    H0 = 0.3 - float((0.5 * X**2 - K @ P).min())
    for sweep in range(1, MOST_SWEEPS + 1):
        H = H0 + 0.5 * X**2 - K @ P
        if not np.isfinite(P).all() or P.max() > 1e3:
            return None
        H = np.maximum(H, LEAST_GAP)  # on the way bodies may overlap; at the end they may not
        density = oil.density_ratio(p_H * P)[0]
        eps = density * H**3 / (np.exp(oil.log_viscosity(p_H * P)[0]) * lam)
        change = sweep_once(P, H, K, eps, density, dX, relax_p, SWITCH)
        missing = 0.5 * math.pi - float(np.sum(P)) * dX
        H0 -= relax_h * missing
        if change < 1e-6 * P.sum() * relax_p and abs(missing) < 1e-5 and H.min() > LEAST_GAP:
            return (H0 - float(at_zero @ P)) * b**2 / contact.radius, sweep
    return None


def best_of_ladder(contact: LineContact, n: int) -> tuple[float, float, int, tuple[float, float]] | None:
    """Return film, seconds, sweeps and factors of the fastest converging setting."""
    found = None
    for factors in LADDER:
        start = time.process_time()
        result = relaxed(contact, n, *factors)
        seconds = time.process_time() - start
        if result is not None and (found is None or seconds < found[1]):
            found = (result[0], seconds, result[1], factors)
    return found


def newton(contact: LineContact, n: int) -> tuple[float, float]:
    """Return film and the least CPU seconds of three runs."""
    times = []
    for _ in range(3):
        start = time.process_time()
        film = solve(contact, nodes=n, domain=DOMAIN)
        times.append(time.process_time() - start)
    return film.central_thickness, min(times)


def main() -> None:
    warnings.simplefilter("ignore")
    warnings.simplefilter("ignore", RangeWarning)
    print(
        f"{'contact':18}{'nodes':>6}{'relaxed ms':>12}{'sweeps':>8}{'error':>9}{'Newton ms':>11}{'error':>9}"
    )
    for name, contact in CASES.items():
        exact = solve(contact, tolerance=2e-4, domain=DOMAIN).central_thickness
        for n in (65, 129, 257):
            film, seconds = newton(contact, n)
            ours = f"{1e3 * seconds:11.1f}{abs(film / exact - 1):9.1e}"
            found = best_of_ladder(contact, n)
            if found is None:
                print(f"{name:18}{n:6}{'none of the settings converges':>29}{ours}")
                continue
            value, spent, sweeps, factors = found
            print(
                f"{name:18}{n:6}{1e3 * spent:12.1f}{sweeps:8}{abs(value / exact - 1):9.1e}{ours}  {factors}"
            )


if __name__ == "__main__":
    main()
