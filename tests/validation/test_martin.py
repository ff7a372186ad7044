"""Rigid cylinder and constant viscosity: H. M. Martin, Engineering (London) 102 (1916) 119-121.

With Reynolds' outlet condition the exact solution gives w = 4.896 eta0 u R/h, that is h/(R sqrt(U2)) = 2.448/M;
here the constant is derived anew by quadrature.
"""

import math

import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from ehl import LineContact, Lubricant
from tests.ehl.films import quiet


def half_sommerfeld_with_reynolds_exit():
    """Return the dimensionless pressure, exit and load of a parabola H = 1 + X^2 with P' = (H - H_e)/H^3."""

    def rise(X, exit):
        return (X**2 - exit**2) / (1 + X**2) ** 3

    exit = brentq(lambda e: quad(rise, -math.inf, e, args=(e,))[0], 0.1, 1.0, xtol=1e-13)

    def pressure(X):
        return quad(rise, -math.inf, X, args=(exit,))[0]

    # int P dX = -int X P' dX, without boundary terms
    load = quad(lambda X: -X * rise(X, exit), -math.inf, exit)[0]
    return pressure, exit, load


def test_the_constant():
    _, exit, load = half_sommerfeld_with_reynolds_exit()
    assert exit == pytest.approx(0.475, abs=5e-4)
    # w = 12 eta u R/h * 2 * load for h = h0 (1 + X^2), x = sqrt(2 h0 R) X
    assert 24 * load == pytest.approx(4.896, abs=2e-3)


@pytest.mark.parametrize("M", [1e-12, 1e-6, 1e-3])
def test_rigid_isoviscous_limit(M):
    _, exit, load = half_sommerfeld_with_reynolds_exit()
    film = quiet(LineContact.from_moes(M, 0.0, compressible=False), nodes=513)
    assert film.minimum_moes * M == pytest.approx(12 * load, rel=1e-4 if M < 1e-4 else 1e-3)
    assert film.outlet / math.sqrt(2 * film.minimum_thickness * film.contact.radius) == pytest.approx(
        exit, rel=0.01
    )


def test_the_limit_is_reached_at_first_order_in_small_deformation():
    _, _, load = half_sommerfeld_with_reynolds_exit()
    gaps = [
        quiet(LineContact.from_moes(M, 0.0, compressible=False), nodes=257).minimum_moes * M / (12 * load) - 1
        for M in (0.05, 0.1, 0.2)
    ]
    assert gaps[0] < gaps[1] < gaps[2]
    assert abs(gaps[0]) < 2e-3


@pytest.mark.parametrize("crowding", [0.3, 0.7, 0.95])
def test_rigid_piezoviscous_limit(crowding):
    """Blok (1950): with Barus' law 1 - exp(-alpha p) = alpha q, q the pressure of the constant viscosity."""
    pressure, exit, _ = half_sommerfeld_with_reynolds_exit()
    highest = pressure(-exit)
    # load of p = -ln(1 - crowding Q)/alpha over that of q = crowding Q/alpha, Q = P/P_max
    piezo = quad(lambda X: -math.log1p(-crowding * pressure(X) / highest), -60.0, exit, limit=200)[0]
    piezo += crowding / highest / 6 / 60**2  # beyond: P = 1/(3 X^3)
    eta, u, h, R = 0.05, 1.0, 1e-6, 0.01
    # q_max = 12 eta u sqrt(2 R h)/h^2 highest = crowding/alpha
    q_max = 12 * eta * u * math.sqrt(2 * R * h) / h**2 * highest
    alpha = crowding / q_max
    load = piezo / alpha * math.sqrt(2 * R * h)
    oil = Lubricant(eta, alpha, roelands_z=1.0, compressible=False)
    film = quiet(LineContact(load, u, R, 1e14, oil), tolerance=5e-4)
    assert film.minimum_thickness == pytest.approx(h, rel=2e-3)
