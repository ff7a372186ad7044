import importlib.util
from pathlib import Path

import numpy as np
import pytest

from ehl import LineContact
from ehl.discrete.equations import Groups, Residual, film_gap, fluxes, inlet_pressure, make_grid
from ehl.discrete.grid import face_weights, graded_nodes, upstream_share
from ehl.kernels.film_kernels import log_potential, newton_matrix

_spec = importlib.util.spec_from_file_location("ehl_twins", Path(__file__).with_name("twins.py"))
twins = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(twins)

DOMAIN = (-6.0, 1.8)


def problem(open_inlet=True):
    contact = LineContact.from_moes(10.0, 8.0)
    nodes = graded_nodes(0.2, 40, DOMAIN)
    grid = make_grid(nodes, 1.0, upstream_share(nodes, 0.2), open_inlet=open_inlet)
    groups = Groups.on(contact, grid)
    P = np.sqrt(np.maximum(0.0, 1 - grid.nodes**2)) + 0.01 * np.exp(-(grid.nodes**2))
    P[-8:] = 0.0
    return grid, groups, P, 0.1


def test_log_potential_agrees_with_the_closed_form_in_extended_precision():
    nodes = graded_nodes(0.01, 60, (-30.0, 1.5))
    points = np.concatenate([nodes, [0.0, 1e-9, -29.9]])
    exact = twins.log_potential(nodes.astype(np.longdouble), points.astype(np.longdouble))
    got = log_potential(nodes, points)
    scale = np.abs(exact).max(axis=0)
    assert np.max(np.abs(got - exact) / scale) < 1e-12


def test_log_potential_of_an_ellipse_is_a_parabola():
    # dry contact: X^2/2 - (1/pi) int sqrt(1-t^2) ln|X-t| dt is constant, 1/4 + ln(2)/2, for |X| < 1
    flatness = []
    for n in (101, 201, 401):
        nodes = np.cos(np.linspace(np.pi, 0, n))
        inner = nodes[np.abs(nodes) < 0.9]
        gap = 0.5 * inner**2 - log_potential(nodes, inner) @ np.sqrt(np.maximum(0, 1 - nodes**2)) / np.pi
        flatness.append(np.max(np.abs(gap - 0.25 - 0.5 * np.log(2))))
    assert flatness[2] < 2e-5
    assert flatness[0] / flatness[1] > 3.5  # second order
    assert flatness[1] / flatness[2] > 3.5


@pytest.mark.parametrize("upwind", [False, True])
def test_flux_and_its_derivatives_agree_with_the_twin_by_complex_steps(upwind):
    grid, groups, P, H0 = problem()
    H = film_gap(grid, groups, P, H0)
    faces = face_weights(grid.nodes, upwind=upwind)
    oil = groups.lubricant

    def ln_eta(P):
        base = 1 + P * groups.pressure * 5.1e-9
        return oil.pressure_viscosity / 5.1e-9 / oil.z * (base**oil.z - 1)

    def rho(P):
        p = P * groups.pressure
        return 1 + 0.6e-9 * p / (1 + 1.7e-9 * p)

    flux, slopes = fluxes(grid, groups, P, H, faces)
    np.testing.assert_allclose(
        flux, twins.flux(grid.nodes, P, H, faces, ln_eta, rho, groups.lam, grid.upstream), rtol=1e-12
    )
    step = 1e-30
    for j in range(P.size):
        for by, (dP, dH) in enumerate([(1j * step, 0), (0, 1j * step)]):
            Pj, Hj = P.astype(complex), H.astype(complex)
            Pj[j] += dP
            Hj[j] += dH
            exact = twins.flux(grid.nodes, Pj, Hj, faces, ln_eta, rho, groups.lam, grid.upstream).imag / step
            got = np.zeros(P.size - 1)
            for k in range(3):
                f = j + 1 - k
                if 0 <= f < P.size - 1:
                    got[f] = slopes[f, 3 * by + k]
            np.testing.assert_allclose(got, exact, rtol=1e-8, atol=1e-8 * np.abs(slopes).max())


@pytest.mark.parametrize("open_inlet", [False, True])
def test_newton_matrix_agrees_with_differences_of_the_residual(open_inlet):
    grid, groups, P, H0 = problem(open_inlet)
    P[0] = inlet_pressure(grid, groups)
    H = film_gap(grid, groups, P, H0)
    _, slopes = fluxes(grid, groups, P, H, grid.quick)
    free = np.arange(1, 33)
    system = newton_matrix(slopes, -groups.compliance * grid.potential, grid.weights, free)
    matrix = system[:, :-1] / system[:, -1:]

    def all_residuals(P, H0):
        left = Residual.of(grid, groups, P, H0)
        return np.append(np.diff(left.flux)[free - 1], -left.short)

    step = 1e-6
    columns = []
    for j in free:
        bump = np.zeros(P.size)
        bump[j] = step
        columns.append((all_residuals(P + bump, H0) - all_residuals(P - bump, H0)) / (2 * step))
    columns.append((all_residuals(P, H0 + step) - all_residuals(P, H0 - step)) / (2 * step))
    exact = np.array(columns).T
    assert np.max(np.abs(matrix - exact) / np.abs(exact).max(axis=1, keepdims=True)) < 1e-7
