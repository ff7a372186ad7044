"""Starved rigid cylinder, constant viscosity: exact by quadrature.

The mass-conserving (Jakobsson-Floberg-Olsson) solution of a parabola H = 1 + X^2: P' = (H - Q)/H^3 between the
meniscus X_m and the exit X_e = sqrt(Q - 1), where P = P' = 0; P(X_m) = 0 fixes X_m for each flow Q; ahead of X_m
and behind X_e oil of the amount Q fills only a part of the gap.
"""

import math
import warnings

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from base import RangeWarning
from ehl import LineContact, Lubricant, Meniscus, OilLayer, solve

ETA, U, R, H_0 = 0.05, 1.0, 0.01, 1e-6
LENGTH = math.sqrt(2 * R * H_0)


def exact(Q):
    """Return meniscus, exit and load 6 int P dX of the parabola that carries Q."""
    exit = math.sqrt(Q - 1)

    def rise(X):
        return (1 + X**2 - Q) / (1 + X**2) ** 3

    meniscus = brentq(lambda m: quad(rise, m, exit)[0], -500.0, -exit * (1 + 1e-9), xtol=1e-12)
    load = quad(lambda X: -X * rise(X), meniscus, exit, limit=200)[0]
    return meniscus, exit, 12 * load


def contact_of(Q):
    _, _, load = exact(Q)
    # w = eta u (2 R/h0) 2 * load ... of P in 12 eta u LENGTH/h0^2, divided by 12 in `load`
    w = ETA * U * LENGTH**2 / H_0**2 * load
    oil = Lubricant(ETA, 0.0, compressible=False)
    return LineContact(w, U, R, 1e14, oil)


@pytest.mark.parametrize("Q", [1.05, 1.1, 1.15, 1.2, 1.22])
def test_a_held_meniscus(Q):
    meniscus, exit, _ = exact(Q)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(contact_of(Q), nodes=257, supply=Meniscus(meniscus * LENGTH))
    assert film.converged, film.message
    assert film.minimum_thickness == pytest.approx(H_0, rel=2e-3)
    assert film.flow == pytest.approx(Q * H_0, rel=2e-3)
    assert film.outlet == pytest.approx(exit * LENGTH, rel=2e-2)


@pytest.mark.parametrize("Q", [1.05, 1.15, 1.2])
def test_a_held_layer(Q):
    meniscus, exit, _ = exact(Q)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(contact_of(Q), nodes=257, supply=OilLayer(Q * H_0))
    assert film.converged, film.message
    assert film.flow == pytest.approx(Q * H_0, rel=1e-9)
    assert film.minimum_thickness == pytest.approx(H_0, rel=2e-3)
    # near the flooded flow (Q = 1.2257) the meniscus runs away as the flow falls short of it
    assert film.inlet == pytest.approx(meniscus * LENGTH, rel=1e-2 if Q < 1.2 else 5e-2)
    # behind the exit the film breaks into streamers that carry the same flow
    gap = H_0 * (1 + (film.x / LENGTH) ** 2)
    behind = film.x > 1.05 * exit * LENGTH
    np.testing.assert_allclose(film.fill[behind] * gap[behind], Q * H_0, rtol=5e-3)
    assert (film.fill[film.pressure > 0] == 1.0).all()


def test_more_oil_than_the_flooded_inlet_takes():
    # the flooded flow of Martin's film is 1.2257 h0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(contact_of(1.2), nodes=257, supply=OilLayer(3.0 * H_0))
        flooded = solve(contact_of(1.2), nodes=257)
    assert film.minimum_thickness == flooded.minimum_thickness
    assert film.flow / film.minimum_thickness == pytest.approx(1.2257, rel=1e-3)
    assert "flooded" in film.message
