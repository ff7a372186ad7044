"""Shear and heat across the film against closed forms, and the bodies' heat against Blok's and Jaeger's."""

import numpy as np
import pytest
from scipy import special

from ehl.discrete.collocation import lobatto
from ehl.discrete.solids import Solid, surface_heating
from ehl.kernels.heat_kernels import heat_across
from ehl.kernels.shear_kernels import eyring, flow_across, gradient

ZETA, WEIGHTS, DERIVE, STIFFNESS, SUM_UP = lobatto()
FLAT = np.full(ZETA.size, 3.0)


def test_collocation_is_exact_for_polynomials():
    np.testing.assert_allclose(DERIVE @ ZETA**10, 10 * ZETA**9, atol=1e-13)
    assert pytest.approx(15.0 * 2.0**-6 / 7.0, rel=1e-12) == ZETA**3 @ STIFFNESS @ ZETA**5
    np.testing.assert_allclose(SUM_UP @ ZETA**9, (ZETA**10 - 2.0**-10) / 10, atol=1e-15)
    assert pytest.approx(2.0**-18 / 19, rel=1e-12) == ZETA**18 @ WEIGHTS


@pytest.mark.parametrize("sigma", [1e-3, 0.1, 1.0, -3.0, 6.0])
def test_flow_without_sliding_is_that_of_conry_wang_and_cusano(sigma):
    t, moment, slope, by_phi = eyring(FLAT, ZETA, WEIGHTS, 0.0, sigma)
    exact = 3.0 * (sigma * np.cosh(sigma) - np.sinh(sigma)) / (2.0 * sigma**2)
    assert abs(t) < 1e-12
    assert moment * np.exp(abs(sigma)) == pytest.approx(exact, rel=1e-9)
    assert by_phi == pytest.approx(moment, rel=1e-9)  # all of the flow is in proportion to the fluidity
    by_sigma = 3.0 * ((sigma**2 + 2) * np.sinh(sigma) - 2 * sigma * np.cosh(sigma)) / (2.0 * sigma**3)
    assert slope * np.exp(abs(sigma)) == pytest.approx(by_sigma, rel=1e-6)


@pytest.mark.parametrize("slide", [0.0, 1.0, -1e6, 1e12])
def test_a_thousand_stays_finite(slide):
    assert np.isfinite(eyring(FLAT * np.exp(ZETA), ZETA, WEIGHTS, slide, 1e3)).all()


def test_sliding_alone_shears_by_the_mean_stress():
    t, moment, _, _ = eyring(FLAT, ZETA, WEIGHTS, 60.0, 0.0)
    assert t == pytest.approx(np.arcsinh(20.0), rel=1e-12)
    assert abs(moment) < 1e-12


def test_what_pressure_moves_gives_its_slope_back_from_any_start():
    rng = np.random.default_rng(1)
    for _ in range(200):
        phi = 3.0 * np.exp(rng.uniform(-2, 2) * ZETA + rng.uniform(-2, 2) * ZETA**2)
        slide, sigma = 10 ** rng.uniform(-2, 3) * rng.choice([-1, 1]), rng.uniform(-4, 4)
        moved = eyring(phi, ZETA, WEIGHTS, slide, sigma)[1] * np.exp(abs(sigma))
        moved -= eyring(phi, ZETA, WEIGHTS, slide, 0.0)[1]
        for start in (-4.5, 0.0, 4.5):
            assert gradient(phi, ZETA, WEIGHTS, slide, moved, start) == pytest.approx(
                sigma, rel=1e-8, abs=1e-9
            )


def flow_of(viscosity, slide=2.0, stress=1e12, moved=0.0, limit=1e30, h=1e-6):
    sigma = np.zeros(1)
    found = flow_across(
        viscosity[None],
        np.array([h]),
        np.array([limit]),
        np.array([moved]),
        5.0,
        slide,
        stress,
        ZETA,
        WEIGHTS,
        SUM_UP,
        sigma,
    )
    flow, speed, across, rate, yielding = (row[0] for row in found)
    return flow, speed, across, rate, yielding, sigma[0]


def test_newtonian_flow_of_an_even_film():
    viscosity = np.full(ZETA.size, 0.2)
    (stress, effective, carry, steep, thinning), speed, across, rate, _, sigma = flow_of(
        viscosity, moved=1e-7
    )
    assert stress == pytest.approx(0.2 * 2.0 / 1e-6, rel=1e-9)
    assert effective == pytest.approx(0.2, rel=1e-9)
    assert (carry, steep, thinning) == pytest.approx((1.0, 1.0, 1.0))
    slope = 2e12 * sigma / 1e-6
    assert slope * 1e-18 / (12 * 0.2) == pytest.approx(1e-7, rel=1e-8)
    parabola = 5.0 + 2.0 * ZETA + slope * 1e-12 / 0.4 * (ZETA**2 - 0.25)
    np.testing.assert_allclose(speed, parabola, rtol=1e-8)
    np.testing.assert_allclose(across, stress + 1e-6 * slope * ZETA, rtol=1e-8)
    np.testing.assert_allclose(rate, across / 0.2, rtol=1e-8)


def test_a_limit_bounds_the_mean_stress():
    for stress in (5e6, 1e12):
        found = flow_of(np.full(ZETA.size, 1e4), stress=stress, limit=2e7)
        assert found[0][0] == pytest.approx(2e7, rel=1e-8)
        assert (found[1][0], found[1][-1]) == pytest.approx((4.0, 6.0))


def test_what_thinning_flow_does_next_is_its_difference():
    """Twice the flow, the viscosity and the slide, each by a little: steepness and thinning say what p' does."""
    viscosity = 0.2 * np.exp(2.0 * ZETA)
    base, less, thick, thin = (
        flow_of(viscosity * grown, slide=0.02, stress=1e4, moved=moved)
        for moved, grown in ((1e-7 + 1e-11, 1.0), (1e-7 - 1e-11, 1.0), (1e-7, 1.0001), (1e-7, 0.9999))
    )
    steep, thinning = flow_of(viscosity, slide=0.02, stress=1e4, moved=1e-7)[0][3:]
    assert steep > 1.2
    assert np.log(base[5] / less[5]) / 2e-4 == pytest.approx(1.0 / steep, rel=1e-5)
    assert np.log(thick[5] / thin[5]) / 2e-4 == pytest.approx(thinning / steep, rel=1e-5)


@pytest.mark.parametrize("number", [0.1, 1.0, 4.0])
def test_couette_flow_with_heat_is_nahmes(number):
    """Walls at T0, eta0 exp(-beta (T - T0)): e^(beta rise) = (1 + Na/8) sech^2(2 zeta s), s = asinh sqrt(Na/8)."""
    k, beta, h, slide = 0.14, 0.04, 1e-6, 2.0
    eta = number * k / (beta * slide**2)
    T, into, nothing = np.full((2, ZETA.size), 300.0), np.zeros((2, 2)), np.zeros((3, ZETA.size))
    for _ in range(12):
        (stress, *_), speed, across, rate, yielding, _ = flow_of(
            eta * np.exp(-beta * (T[1] - 300.0)), slide=slide
        )
        heat_across(
            np.array([0.0, 1e-4, 2e-4]),
            np.full(2, h),
            nothing,
            np.tile(eta * np.exp(-beta * (T[1] - 300.0)), (2, 1)),
            np.tile(across, (2, 1)),
            np.tile(rate, (2, 1)),
            np.full((2, ZETA.size), beta),
            np.tile(yielding, (2, 1)),
            np.tile(speed, (2, 1)),
            np.zeros(2),
            np.zeros((2, 2, 2)),
            np.full((2, 2), 300.0),
            np.zeros(2),
            np.zeros((2, ZETA.size)),
            T.copy(),
            T,
            into,
            np.zeros((2, 2)),
            0.0,
            k,
            ZETA,
            WEIGHTS,
            DERIVE,
            STIFFNESS,
            SUM_UP,
            1,
            1,
            False,
        )
    root = np.sqrt(number / 8.0)
    exact = np.log1p(number / 8.0) - 2.0 * np.log(np.cosh(2.0 * ZETA * np.arcsinh(root)))
    np.testing.assert_allclose(beta * (T[1] - 300.0), exact, atol=1e-8 * max(exact))
    exactly = eta * slide / h * np.arcsinh(root) / (root * np.sqrt(1.0 + number / 8.0))
    assert stress == pytest.approx(exactly, rel=1e-8)
    # all that is sheared leaves through the walls
    assert into[:, 1].sum() == pytest.approx(stress * slide, rel=1e-6)


def test_a_fast_surface_warms_as_blok_has_it_and_a_slow_one_as_jaeger():
    steel = Solid(46.0, 7850.0, 470.0)
    kappa = 46.0 / (7850.0 * 470.0)
    edges = np.linspace(0.0, 2e-4, 402)
    x, dx = 0.5 * (edges[1:] + edges[:-1]), edges[1]
    fast = surface_heating(edges, 50.0, steel, 0.01) @ np.full(401, 1e7)
    np.testing.assert_allclose(fast[40:], 2e7 / 46.0 * np.sqrt(kappa * x[40:] / (np.pi * 50.0)), rtol=5e-3)
    slow = surface_heating(edges, 0.5, steel, 0.01)
    s = x[300] - x[100]
    line = np.exp(0.25 * s / kappa) * special.k0(0.25 * s / kappa) / (np.pi * 46.0) * dx
    assert slow[300, 100] == pytest.approx(line, rel=1e-3)
    assert slow[100, 300] == pytest.approx(line * np.exp(-0.5 * s / kappa), rel=1e-3)
    # backwards is the mirror image
    back = surface_heating(edges, -0.5, steel, 0.01)
    np.testing.assert_allclose(back, slow[::-1, ::-1], rtol=1e-6, atol=1e-15)
    assert np.isfinite(surface_heating(edges, 0.0, steel, 0.01)).all()
