"""Readable counterparts of the compiled kernels; they also take complex arguments."""

import numpy as np


def log_potential(nodes, points):
    """Closed form of every cell, in the precision of the arguments (np.longdouble for a sharp check)."""
    out = np.zeros((len(points), len(nodes)), dtype=np.asarray(points).dtype)
    for i, x in enumerate(points):
        for c in range(len(nodes) - 1):
            a, b = nodes[c], nodes[c + 1]
            u, v = x - a, x - b

            def first(s):  # antiderivative of ln|s|
                return s * np.log(abs(s)) - s if s != 0 else 0 * s

            def second(s):  # antiderivative of s ln|s|
                return s**2 / 2 * np.log(abs(s)) - s**2 / 4 if s != 0 else 0 * s

            plain = first(u) - first(v)  # int ln|x - t| dt
            moment = x * plain - (second(u) - second(v))  # int t ln|x - t| dt
            out[i, c] += (b * plain - moment) / (b - a)
            out[i, c + 1] += (moment - a * plain) / (b - a)
    return out


def flux(nodes, P, H, faces, ln_eta, rho, lam, upstream):
    """Flux through each cell; ``ln_eta`` and ``rho`` are functions of P."""
    n = len(nodes)
    ln_eta, rho = ln_eta(P), rho(P)
    out = []
    for f in range(n - 1):
        h = nodes[f + 1] - nodes[f]
        low, high = np.exp(-ln_eta[f]), np.exp(-ln_eta[f + 1])
        same = abs(ln_eta[f] - ln_eta[f + 1]) < 1e-9
        fluidity = 0.5 * (low + high) if same else (low - high) / (ln_eta[f + 1] - ln_eta[f])
        middle = np.exp(
            sum(faces[f, k] * np.log(rho[f - 1 + k] * H[f - 1 + k]) for k in range(3) if f - 1 + k >= 0)
        )
        w = [
            1 / (rho[f] * H[f] ** 3),
            ((rho[f] + rho[f + 1]) / 2) ** 2 / middle**3,
            1 / (rho[f + 1] * H[f + 1] ** 3),
        ]
        rho_h = [rho[f] * H[f], middle, rho[f + 1] * H[f + 1]]
        simpson = np.array([1, 4, 1]) / 6
        integral = sum(simpson * w)
        mean = sum(simpson * w * rho_h) / integral
        before = max(f - 1, 0)
        grown = rho_h[0] / (rho[before] * H[before])
        carried = rho_h[0] * grown ** (0.5 * h / (nodes[f] - nodes[before]) if f else 0.0)
        wedge = (1 - upstream[f]) * mean + upstream[f] * carried
        out.append(fluidity * (P[f + 1] - P[f]) / (h * lam * integral) - wedge)
    return np.array(out)
