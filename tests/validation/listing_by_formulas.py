"""The published listing of a helical pair, z 24/95, rated anew from the formulas of the standards alone.

Nothing of `gears` is used, so that a slip in its code cannot be in here as well. Units are those of the standards: N,
mm, um, MPa, N/(mm um), 1/min, degC. `readings` replace what the print leaves open.
"""

from __future__ import annotations

from math import acos, atan, cos, log, log10, pi, radians, sin, sqrt, tan
from typing import Any

MODULE, TEETH, SHIFTS = 14.0, (24, 95), (0.48, 0.6691)
WIDTH, DISTANCE, HELIX, ALPHA = 360.0, 861.0, radians(10.0), radians(20.0)
TORQUE, SPEED, POWER = 40953.0, 1165.9, 5000.0
K_A, K_HBETA = 1.25, 1.15
OIL = {"nu_40": 220.0, "nu_100": 19.0, "density": 0.89, "theta": 80.0}


def geometry(**readings: Any) -> dict[str, Any]:
    """Transverse section and path of contact."""
    alpha_t = atan(tan(ALPHA) / cos(HELIX))
    d = [MODULE * z / cos(HELIX) for z in TEETH]
    d_b = [each * cos(alpha_t) for each in d]
    working = acos(sum(d_b) / (2.0 * DISTANCE))
    k = readings.get("alteration", -0.938)
    d_a = [each + 2.0 * MODULE * (1.0 + x) + 2.0 * k for each, x in zip(d, SHIFTS, strict=True)]
    d_f = [each - 2.0 * MODULE * (1.25 - x) for each, x in zip(d, SHIFTS, strict=True)]
    p_bt = pi * MODULE / cos(HELIX) * cos(alpha_t)
    line = DISTANCE * sin(working)
    E1 = sqrt(d_a[0] ** 2 - d_b[0] ** 2) / 2.0
    A2 = sqrt(d_a[1] ** 2 - d_b[1] ** 2) / 2.0
    C1 = d_b[0] / 2.0 * tan(working)
    after, before = (E1 - C1) / p_bt, (A2 - (line - C1)) / p_bt
    return {
        "alpha_t": alpha_t, "working": working, "d": d, "d_b": d_b, "d_a": d_a, "d_f": d_f, "line": line, "C1": C1,
        "E1": E1, "after": after, "before": before, "eps_alpha": after + before,
        "eps_beta": WIDTH * sin(HELIX) / (pi * MODULE), "base_helix": acos(sqrt(1.0 - (sin(HELIX) * cos(ALPHA)) ** 2)),
        "u": TEETH[1] / TEETH[0],
    }  # fmt: skip


def load_factors(m_red: float = 0.36503, **readings: Any) -> dict[str, float]:
    """K_v by method B and K_Halpha, with the blank's C_R 0.898 and the reduced mass as printed."""
    g = geometry(**readings)
    torque = readings.get("torque", TORQUE)
    load = 2000.0 * torque / g["d"][0] / WIDTH
    z_n = [z / (cos(g["base_helix"]) ** 2 * cos(HELIX)) for z in TEETH]
    if readings.get("cube"):
        z_n = [z / cos(HELIX) ** 3 for z in TEETH]
    (x1, x2), (n1, n2) = SHIFTS, z_n
    q = 0.04723 + 0.15551 / n1 + 0.25791 / n2 - 0.00635 * x1 - 0.11654 * x1 / n1 - 0.00193 * x2
    q += -0.24188 * x2 / n2 + 0.00529 * x1**2 + 0.00182 * x2**2
    basic_rack = 1.0 + 0.5 * (1.2 - 1.25)
    c = 0.8 * readings.get("C_R", 0.898) * basic_rack / q * cos(HELIX) * readings.get("stiffness", 1.0)
    c_gamma = c * (0.75 * g["eps_alpha"] + 0.25)
    resonance = 30000.0 / (pi * TEETH[0]) * sqrt(c_gamma / m_red)
    N = SPEED / resonance
    f_pb = readings.get("f_pt", 17.0) * cos(g["alpha_t"])
    f_falpha, y = readings.get("f_falpha", 22.0), 0.075 * f_pb
    total = g["eps_alpha"] + g["eps_beta"]
    loaded = load * K_A
    C_a = readings.get("C_a", (1500.0 / 97.0 - 18.45) ** 2 / 18.0 + 1.5)
    parts = (
        0.32 * c * (f_pb - y) / loaded,
        0.57 / (total - 0.3) * c * (f_falpha - y) / loaded,
        0.096 / (total - 1.56) * abs(1.0 - c * C_a / loaded),
    )
    K_v = 1.0 + N * sum(parts)
    transverse = loaded * K_v * K_HBETA
    K_Halpha = 0.9 + 0.4 * sqrt(2.0 * (total - 1.0) / total) * c_gamma * (f_falpha - y) / transverse
    return {
        "load": load, "c_gamma": c_gamma, "n_E1": resonance, "N": N, "K_v": K_v, "K_Halpha": K_Halpha,
        "contact": K_A * K_v * K_HBETA * K_Halpha,
    }  # fmt: skip


def pitting(**readings: Any) -> dict[str, Any]:
    """Contact stress, its limits and safeties."""
    g, loads = geometry(**readings), load_factors(**readings)
    Z_H = sqrt(2.0 * cos(g["base_helix"]) * cos(g["working"]) / (cos(g["alpha_t"]) ** 2 * sin(g["working"])))
    Z_E = sqrt(206000.0 / (2.0 * pi * (1.0 - 0.3**2)))
    Z_eps, Z_beta = sqrt(1.0 / g["eps_alpha"]), 1.0 / sqrt(cos(HELIX))
    u, d1 = g["u"], g["d"][0]
    nominal = Z_H * Z_E * Z_eps * Z_beta * sqrt(loads["load"] / d1 * (u + 1.0) / u)
    sigma_H = nominal * sqrt(loads["contact"])
    velocity = pi * d1 * SPEED / 60000.0
    radii = [0.5 * each * tan(g["working"]) for each in g["d_b"]]
    radius = radii[0] * radii[1] / sum(radii)
    Rz_10 = 4.8 * (10.0 / radius) ** (1.0 / 3.0)
    C_L = C_R = 0.91, 0.08
    Z_L = C_L[0] + 4.0 * (1.0 - C_L[0]) / (1.2 + 134.0 / OIL["nu_40"]) ** 2
    Z_V = 0.93 + 2.0 * (1.0 - 0.93) / sqrt(0.8 + 32.0 / velocity)
    Z_R = (3.0 / Rz_10) ** C_R[1]
    cycles = [60.0 * SPEED * 175200.0 / ratio for ratio in (1.0, u)]
    Z_NT = [max(0.85, (5e7 / n) ** (log(1.0 / 0.85) / log(1e10 / 5e7))) for n in cycles]
    limits = [1500.0 * Z_L * Z_V * Z_R * life for life in Z_NT]
    return {
        "sigma_H": sigma_H, "Z_L": Z_L, "Z_V": Z_V, "Z_R": Z_R, "Z_NT": Z_NT, "sigma_HG": limits,
        "S_H": [limit / sigma_H for limit in limits],
    }  # fmt: skip


def bending() -> dict[str, Any]:
    """Limits of the root stress: factors of life, notch, surface and size, with the notch parameters as given."""
    u = TEETH[1] / TEETH[0]
    cycles = [60.0 * SPEED * 175200.0 / ratio for ratio in (1.0, u)]
    Y_NT = [max(0.85, (3e6 / n) ** (log(1.0 / 0.85) / log(1e10 / 3e6))) for n in cycles]
    return {"Y_NT": Y_NT, "Y_RrelT": 1.674 - 0.529 * 21.0**0.1, "Y_X": 1.05 - 0.01 * MODULE}


def scuffing(**readings: Any) -> dict[str, Any]:
    """Integral temperature and safety; `line_load` takes w_Bt as printed."""
    g, loads = geometry(**readings), load_factors(**readings)
    w_Bt = readings.get("line_load", loads["load"] * loads["contact"])
    total = g["eps_alpha"] + g["eps_beta"]
    K_Bgamma = 1.0 + 0.2 * sqrt((total - 2.0) * (5.0 - total))
    low, high = (log10(log10(nu + 0.8)) for nu in (OIL["nu_40"], OIL["nu_100"]))
    share = log((OIL["theta"] + 273.15) / 313.15) / log(373.15 / 313.15)
    nu = 10.0 ** (10.0 ** (low + (high - low) * share)) - 0.8
    eta = readings.get("viscosity", nu * (OIL["density"] - 0.0007 * (OIL["theta"] - 15.0)))
    velocity = pi * g["d"][0] * SPEED / 60000.0
    radii = [0.5 * each * tan(g["working"]) / cos(g["base_helix"]) for each in g["d_b"]]
    rho_C = radii[0] * radii[1] / sum(radii)
    rolling = 2.0 * velocity * tan(g["working"]) * cos(g["alpha_t"])
    X_R = 2.2 * (0.6 / rho_C) ** 0.25
    mu = 0.045 * (w_Bt * K_Bgamma / (rolling * rho_C)) ** 0.2 * eta**-0.05 * X_R
    B_M = sqrt(50.0 * 7750.0 * 490.0) / 1000.0
    X_M = (206000.0 / (1.0 - 0.3**2)) ** 0.25 * sqrt(1000.0) / B_M
    working = g["working"]
    X_ab = 1.22 * (sin(working) * cos(ALPHA) * cos(HELIX)) ** 0.25 / sqrt(cos(working) * cos(g["alpha_t"]))
    rho1, rho2, u = g["E1"], g["line"] - g["E1"], g["u"]
    X_BE = 0.51 * sqrt(u + 1.0) * (sqrt(rho1) - sqrt(rho2 / u)) / (rho1 * rho2) ** 0.25
    e1, e2, eps = g["after"], g["before"], g["eps_alpha"]
    X_eps = (0.7 * (e1**2 + e2**2) - 0.22 * eps + 0.52 - 0.6 * e1 * e2) / (2.0 * eps * e1)
    effective = K_A * loads["load"] / loads["c_gamma"]
    C_a = readings.get("C_a", (1500.0 / 97.0 - 18.45) ** 2 / 18.0 + 1.5)
    e = max(e1, e2)
    part = C_a / effective
    X_Ca = 1.0 + (0.06 + 0.18 * part) * e + (0.02 + 0.69 * part) * e**2
    flash = (
        mu * X_M * X_BE * X_ab * (w_Bt * K_Bgamma) ** 0.75 * sqrt(velocity) / DISTANCE**0.25 * X_eps / X_Ca
    )
    bulk = OIL["theta"] + 0.7 * flash
    integral = bulk + 1.5 * flash
    limit = 80.0 + 0.23 * 714.2 + 1.5 * 0.2 * 714.2 * (100.0 / OIL["nu_40"]) ** 0.02
    cold = mu * (nu * OIL["density"] / eta) ** -0.05  # with the density at 15 degC, as the print has it
    H_V = (
        pi * (u + 1.0) / (TEETH[0] * u * cos(g["base_helix"])) * (1.0 - eps + e1**2 + e2**2)
    )  # Ohlendorf's H_V
    return {
        "w_Bt": w_Bt, "K_Bgamma": K_Bgamma, "eta": eta, "mu": mu, "X_R": X_R, "B_M": B_M, "X_M": X_M,
        "X_alphabeta": X_ab, "X_BE": X_BE, "X_eps": X_eps, "X_Ca": X_Ca, "theta_flaint": flash, "theta_M": bulk,
        "theta_int": integral, "theta_Sint": limit, "S": limit / integral, "H_V": H_V, "loss_kW": POWER * cold * H_V,
    }  # fmt: skip
