"""Flamant and McEwen against equilibrium, Hooke's law, force balance and quadrature."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from fem.elasticity import flamant
from fem.elasticity.plane_elasticity import PlaneElasticity

LAWS = [PlaneElasticity("strain", 206e9, 0.3), PlaneElasticity("stress", 206e9, 0.25)]
LOAD, INWARD = np.array([0.3, -0.2]), np.array([np.cos(2.0), np.sin(2.0)])
SIDE = np.array([-INWARD[1], INWARD[0]])


def around(theta, r=1.0):
    return LOAD + r * (np.multiply.outer(np.cos(theta), INWARD) + np.multiply.outer(np.sin(theta), SIDE))


@pytest.mark.parametrize("lean", [0.0, 0.3, -0.5 * np.pi])
@pytest.mark.parametrize("law", LAWS, ids=["strain", "stress"])
def test_displacement_and_stress_obey_hookes_law_everywhere_off_the_cut(law, lean):
    points = around(np.linspace(-3.0, 3.0, 25), 0.7)
    h, slope = 1e-6, np.empty((25, 2, 2))
    for axis in (0, 1):
        step = np.zeros(2)
        step[axis] = h
        ahead, behind = (
            flamant.displacement(points + s, LOAD, INWARD, law, 2.0, lean) for s in (step, -step)
        )
        slope[:, :, axis] = (ahead - behind) / (2 * h)
    strain = 0.5 * (slope + slope.swapaxes(1, 2))
    lam, mu = law.lame
    sigma = lam * np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(2) + 2 * mu * strain
    wanted = flamant.stress(points, LOAD, flamant.leaning(INWARD, lean))
    np.testing.assert_allclose(sigma, wanted, rtol=0, atol=1e-7)


@pytest.mark.parametrize("lean", [0.5 * np.pi, -0.5 * np.pi])
@pytest.mark.parametrize("law", LAWS, ids=["strain", "stress"])
def test_a_tangential_load_presses_the_edge_down_ahead_and_lifts_it_behind(law, lean):
    """Johnson 1985, section 2.3; with Maxwell and Betti, the edge moves towards a normal load."""
    along = flamant.leaning(INWARD, lean)
    places = LOAD + np.array([[0.4], [-0.4]]) * along
    by_tangent = flamant.displacement(places, LOAD, INWARD, law, 2.0, lean)
    step = (1 - law.plane_poisson) / (2 * law.plane_modulus)
    np.testing.assert_allclose(by_tangent @ INWARD, [step, -step], rtol=1e-12)
    log = -2 / (np.pi * law.plane_modulus) * np.log(0.2)
    np.testing.assert_allclose(by_tangent @ along, [log, log], rtol=1e-12)
    by_normal = flamant.displacement(places, LOAD, INWARD, law, 2.0)
    np.testing.assert_allclose(by_normal @ along, [-step, step], rtol=1e-12)


@pytest.mark.parametrize("lean", [0.0, 0.3, -0.5 * np.pi])
def test_half_circle_carries_the_load_and_the_edge_is_free(lean):
    along = flamant.leaning(INWARD, lean)
    total = np.zeros(2)
    t, weight = np.polynomial.legendre.leggauss(40)
    for theta, w in zip(0.5 * np.pi * t, 0.5 * np.pi * weight, strict=True):
        point = around(np.array([theta]), 0.01)
        normal = (point - LOAD) / 0.01
        total += w * 0.01 * flamant.traction(point, normal, LOAD, along)[0]
    np.testing.assert_allclose(total, -along, atol=1e-12)
    for theta in (0.5 * np.pi, -0.5 * np.pi):
        edge = around(np.array([theta]), np.array([0.3]))
        np.testing.assert_allclose(flamant.traction(edge, -INWARD[None], LOAD, along), 0.0, atol=1e-12)


@pytest.mark.parametrize("law", LAWS, ids=["strain", "stress"])
def test_hertz_indentation_is_the_flamant_edge_averaged_over_the_pressure(law):
    a, length = 0.17e-3, 2e-3

    def edge(x):
        u = flamant.displacement(
            around(np.array([0.5 * np.pi]), np.array([abs(x)])), LOAD, INWARD, law, length
        )
        return float(u[0] @ INWARD) * 2 / (np.pi * a) * np.sqrt(1 - (x / a) ** 2)

    mean = 2 * quad(edge, 0, a, epsabs=0, epsrel=1e-10, limit=200)[0]
    assert float(flamant.hertz_indentation(a, law, length)) == pytest.approx(mean, rel=1e-8)


def test_length_unit_cancels_between_indentation_and_displacement():
    law, point = LAWS[0], around(np.array([1.0]), np.array([0.01]))
    for length in (1e-3, 1.0):
        shift = (
            flamant.displacement(point, LOAD, INWARD, law, length)[0]
            - flamant.displacement(point, LOAD, INWARD, law, 1e-2)[0]
        )
        indented = flamant.hertz_indentation(1e-4, law, length) - flamant.hertz_indentation(1e-4, law, 1e-2)
        np.testing.assert_allclose(shift, indented * INWARD, rtol=1e-10)


def test_mcewen_is_flamant_spread_over_the_pressure():
    a, peak = 1.0, 1e9
    for theta, r in ((0.3, 0.4), (-0.9, 1.7), (1.2, 3.0), (0.0, 0.2)):
        point = around(np.array([theta]), np.array([r]))
        spread = np.zeros((2, 2))
        for i in range(2):
            for j in range(2):
                f = lambda s, i=i, j=j, point=point: (  # noqa: E731
                    peak * np.sqrt(1 - s**2) * flamant.stress(point, LOAD + a * s * SIDE, INWARD)[0, i, j]
                )
                spread[i, j] = quad(f, -1, 1, epsabs=1e-6 * peak, limit=200)[0] * a
        np.testing.assert_allclose(
            flamant.hertz_stress(point, LOAD, INWARD, a, peak)[0], spread, atol=2e-6 * peak
        )


def test_greatest_shear_under_a_line_contact():
    """0.300 p at 0.786 a below the surface (K. L. Johnson, Contact Mechanics, section 4.2)."""

    def shear(depth):
        s = flamant.hertz_stress((LOAD + depth * INWARD)[None], LOAD, INWARD, 1.0, 1.0)[0]
        one, two = np.linalg.eigvalsh(s)
        return -0.5 * (two - one)

    best = minimize_scalar(shear, bounds=(0.1, 2.0), method="bounded")
    assert best.x == pytest.approx(0.786, abs=1e-3)
    assert -best.fun == pytest.approx(0.300, abs=5e-4)


def test_half_width():
    """a = sqrt(8 w R/(pi E')): the peak 2w/(pi a) equals E' a/(4 R)."""
    a = flamant.hertz_half_width(443e3, np.array([6e-3]), 226e9)[0]
    assert 2 * 443e3 / (np.pi * a) == pytest.approx(226e9 * a / (4 * 6e-3), rel=1e-12)
