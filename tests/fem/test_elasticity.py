"""Exact solutions: linear fields, Lame's ring under pressure and under torque, and scikit-fem's own matrix."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from base import InputError
from fem.elasticity.plane_elasticity import (
    INTEGRATION,
    PlaneElasticity,
    curved_mesh,
    nodal_stress_matrix,
    stiffness_matrix,
)
from gears.closed_form import ring_wind_up
from meshes import gear_mesh, mesh_sector
from tests.fem.conftest import edge_load, quadratic_ring

STRAIN = PlaneElasticity("strain", 206e9, 0.3)
STRESS = PlaneElasticity("stress", 206e9, 0.3)


def around(place):
    """Unit vectors anticlockwise about the origin."""
    return np.stack([-place[..., 1], place[..., 0]], -1) / np.linalg.norm(place, axis=-1, keepdims=True)


def solve(points, triangles, law, force, held):
    K = stiffness_matrix(points, triangles, law)
    free = np.setdiff1d(np.arange(2 * len(points)), held)
    u = np.zeros(2 * len(points))
    u[free] = spsolve(csc_array(K[free][:, free]), force.ravel()[free], permc_spec="MMD_AT_PLUS_A")
    return u.reshape(-1, 2)


@pytest.mark.parametrize("law", [STRAIN, STRESS], ids=["strain", "stress"])
def test_patch_linear_displacement_gives_constant_stress_and_no_inner_force(article_pair, law):
    mesh = mesh_sector(article_pair.teeth_profiles[0])
    slope = np.array([[3.0, -1.0], [2.0, 5.0]]) * 1e-4
    u = mesh.points @ slope.T
    strain = 0.5 * (slope + slope.T)
    lam, mu = law.lame
    sigma = lam * np.trace(strain) * np.eye(2) + 2 * mu * strain
    inside = np.setdiff1d(np.arange(len(mesh.points)), np.unique(np.concatenate(list(mesh.facets.values()))))
    force = (stiffness_matrix(mesh.points, mesh.triangles, law) @ u.ravel()).reshape(-1, 2)
    largest = np.abs(sigma).max() * mesh.module
    assert np.abs(force[inside]).max() < 1e-11 * largest
    whole = np.ones(len(mesh.triangles))
    nodal = (nodal_stress_matrix(mesh.points, mesh.triangles, law, whole) @ u.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(
        nodal, np.broadcast_to([sigma[0, 0], sigma[1, 1], sigma[0, 1]], nodal.shape), rtol=1e-9
    )
    # the boundary forces are those of the traction sigma n
    edges = np.concatenate(list(mesh.facets.values()))
    pull = edge_load(mesh.points, edges, lambda place, normal: normal @ sigma)
    np.testing.assert_allclose(force, pull, rtol=0, atol=1e-10 * largest)


def test_rigid_motion_costs_nothing(article_pair):
    mesh = mesh_sector(article_pair.teeth_profiles[0])
    K = stiffness_matrix(mesh.points, mesh.triangles, STRAIN)
    x, y = mesh.points.T
    for u in (
        np.stack([np.ones_like(x), 0 * x], 1),
        np.stack([0 * x, np.ones_like(x)], 1),
        np.stack([-y, x], 1),
    ):
        assert np.abs(K @ u.ravel()).max() < 1e-11 * abs(K).max() * np.abs(u).max()


@pytest.mark.parametrize(
    ("around", "curved", "allowed"), [(8, False, 1e-12), (24, True, 1e-4), (48, True, 5e-6)]
)
def test_the_stiffness_matrix_is_that_of_an_independent_assembly(around, curved, allowed):
    """Element by element from the strain-displacement matrix, with a much finer quadrature.

    On straight elements both quadratures are exact; on curved ones the integrands are rational, and the
    difference falls with the fourth power of the elements' curvature.
    """
    points, triangles, _, _ = quadratic_ring(1.0, 2.0, around, around // 8, curved)
    lam, mu = STRAIN.lame
    law = np.array([[lam + 2 * mu, lam, 0], [lam, lam + 2 * mu, 0], [0, 0, mu]])
    node, weight = np.polynomial.legendre.leggauss(6)
    expected = np.zeros((2 * len(points), 2 * len(points)))
    for triangle in triangles:
        unknown = (2 * triangle[:, None] + np.arange(2)).ravel()
        for u, wu in zip(0.5 + 0.5 * node, 0.5 * weight, strict=True):
            for v, wv in zip(0.5 + 0.5 * node, 0.5 * weight, strict=True):
                xi, eta = u, v * (1 - u)  # Duffy's map of the square onto the triangle
                zeta = 1 - xi - eta
                slopes = np.array(
                    [
                        [1 - 4 * zeta, 4 * xi - 1, 0, 4 * (zeta - xi), 4 * eta, -4 * eta],
                        [1 - 4 * zeta, 0, 4 * eta - 1, -4 * xi, 4 * xi, 4 * (zeta - eta)],
                    ]
                )
                jacobian = slopes @ points[triangle]
                dx, dy = np.linalg.solve(jacobian, slopes)
                strain = np.zeros((3, 12))
                strain[0, 0::2], strain[1, 1::2] = dx, dy
                strain[2, 0::2], strain[2, 1::2] = dy, dx
                part = strain.T @ law @ strain * np.linalg.det(jacobian) * wu * wv * (1 - u)
                expected[np.ix_(unknown, unknown)] += part
    K = stiffness_matrix(points, triangles, STRAIN).toarray()
    np.testing.assert_allclose(K, expected, rtol=0, atol=allowed * np.abs(expected).max())


def lame_pressure(r, law, a, b, p):
    """Radial displacement of a ring under inner pressure, outer rim free (Lame 1852)."""
    E, nu = law.plane_modulus, law.plane_poisson
    c = p * a**2 / (b**2 - a**2)
    return c / E * ((1 - nu) * r + (1 + nu) * b**2 / r)


def pressure_error(around, layers, law, curved):
    a, b, p = 1.0, 2.0, 1e6
    points, triangles, inner, _ = quadratic_ring(a, b, around, layers, curved)
    # the inner rim runs anticlockwise, its material outside: the normal that edge_load takes points inwards
    force = edge_load(points, inner, lambda place, normal: p * normal)
    # three unknowns against rigid motion; exact by symmetry
    right = int(np.argmin(np.linalg.norm(points - [a, 0], axis=1)))
    left = int(np.argmin(np.linalg.norm(points - [-a, 0], axis=1)))
    top = int(np.argmin(np.linalg.norm(points - [0, a], axis=1)))
    u = solve(points, triangles, law, force, [2 * right + 1, 2 * left + 1, 2 * top])
    corners = np.unique(triangles[:, :3])
    r = np.linalg.norm(points[corners], axis=1)
    radial = np.einsum("na,na->n", u[corners], points[corners]) / r
    exact = lame_pressure(r, law, a, b, p)
    return np.max(np.abs(radial - exact)) / np.max(exact)


def test_scikit_fems_own_form_gives_the_same_matrix(article_pair):
    """It takes ten times as long; quadrature and curved triangles are the same."""
    from scipy.spatial import cKDTree
    from skfem import Basis, ElementTriP2, ElementVector
    from skfem.models.elasticity import linear_elasticity

    mesh = mesh_sector(article_pair.teeth_profiles[0])
    basis = Basis(
        curved_mesh(mesh.points, mesh.triangles), ElementVector(ElementTriP2()), intorder=INTEGRATION
    )
    component = np.zeros(basis.N, dtype=int)
    component[np.concatenate([basis.nodal_dofs[1], basis.facet_dofs[1]])] = 1
    apart, node = cKDTree(mesh.points).query(basis.doflocs.T)
    assert apart.max() < 1e-12 * mesh.module
    unknown = 2 * node + component
    theirs = linear_elasticity(*STRAIN.lame).assemble(basis)
    ours = stiffness_matrix(mesh.points, mesh.triangles, STRAIN)[unknown][:, unknown]
    assert abs(ours - theirs).max() < 1e-13 * abs(theirs).max()


@pytest.mark.parametrize("law", [STRAIN, STRESS], ids=["strain", "stress"])
def test_ring_under_pressure_converges_with_third_order_at_least(law):
    errors = [pressure_error(n, n // 4, law, True) for n in (8, 16, 32)]
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 1e-5
    assert np.all(rates > 3.0), (errors, rates)


def test_straight_sides_stall_at_second_order():
    curved, straight = (pressure_error(32, 8, STRAIN, kind) for kind in (True, False))
    assert straight > 50 * curved


def test_nearly_incompressible_ring_does_not_lock():
    assert pressure_error(32, 8, PlaneElasticity("strain", 206e9, 0.4999), True) < 4e-3


def test_ring_under_torque_is_the_hub_windup_exactly_in_the_limit():
    a, b = 0.017, 0.0335
    errors = []
    for n in (12, 24):
        points, triangles, inner, outer = quadratic_ring(a, b, n, n // 4)
        force = edge_load(points, outer, lambda place, normal: 1e6 * around(place))
        nodes = np.unique(inner)
        u = solve(points, triangles, STRAIN, force, np.concatenate([2 * nodes, 2 * nodes + 1]))
        rim = np.unique(outer[:, :2])
        turn = np.einsum("na,na->n", u[rim], around(points[rim])).mean() / b
        torque = 1e6 * 2 * np.pi * b**2
        base = 0.0338
        # a force F on the base circle: torque F r_b, travel turn r_b
        errors.append(abs(turn * base / (torque / base) / ring_wind_up(b, a, base, STRAIN.shear_modulus) - 1))
    assert errors[1] < 1e-5
    assert np.log2(errors[0] / errors[1]) > 3.0


def test_plane_constants():
    assert STRAIN.plane_modulus == pytest.approx(206e9 / 0.91)
    assert STRESS.plane_modulus == 206e9
    for law in (STRAIN, STRESS):
        lam, mu = law.lame
        # uniaxial stress in the plane law gives back E* and nu*
        eps = np.array([1.0, -law.plane_poisson]) / law.plane_modulus
        np.testing.assert_allclose(lam * eps.sum() + 2 * mu * eps, [1.0, 0.0], atol=1e-12)
    with pytest.raises(InputError, match="plane"):
        PlaneElasticity("strains", 206e9, 0.3)


def test_whole_ring_of_teeth_holds_a_torque(article_pair):
    profile = article_pair.teeth_profiles[0]
    gear = gear_mesh(mesh_sector(profile, refinements=1))
    hub = np.unique(gear.facets["bore"])
    arcs = np.concatenate([gear.facets["root_left"], gear.facets["root_right"]])
    force = edge_load(gear.points, arcs, lambda place, normal: 1e6 * around(place))
    torque = np.sum(gear.points[:, 0] * force[:, 1] - gear.points[:, 1] * force[:, 0])
    u = solve(gear.points, gear.triangles, STRAIN, force, np.concatenate([2 * hub, 2 * hub + 1]))
    # far below the teeth the turn is that of the ring
    r = np.linalg.norm(gear.points, axis=1)
    deep = np.flatnonzero((r > 1.2 * profile.bore_radius) & (r < 1.3 * profile.bore_radius))
    turn = np.einsum("na,na->n", u[deep], around(gear.points[deep])) / r[deep]
    exact = torque / (4 * np.pi * STRAIN.shear_modulus) * (1 / profile.bore_radius**2 - 1 / r[deep] ** 2)
    # coarse elements spread it a little along the circle; the mean is what the torque fixes
    assert np.mean(turn / exact) == pytest.approx(1.0, abs=3e-4)
    np.testing.assert_allclose(turn, exact, rtol=1e-3)
