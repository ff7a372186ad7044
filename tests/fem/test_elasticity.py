"""Exact solutions: linear fields, Lame's ring under pressure and under torque, and scikit-fem's own matrix."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

from fem import FemError
from fem.elasticity import PlaneElasticity, nodal_stress_matrix, stiffness_matrix, stress_at
from fem.flexibility import hub_windup
from meshes import gear_mesh, mesh_sector
from tests.fem.conftest import edge_load, quadratic_ring

STRAIN = PlaneElasticity("strain", 206e9, 0.3)
STRESS = PlaneElasticity("stress", 206e9, 0.3)


def solve(points, triangles, law, force, held):
    K = stiffness_matrix(points, triangles, law)
    free = np.setdiff1d(np.arange(2 * len(points)), held)
    u = np.zeros(2 * len(points))
    u[free] = spsolve(csc_array(K[free][:, free]), force.ravel()[free])
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
    at = np.array([0.2]), np.array([0.3])
    np.testing.assert_allclose(
        stress_at(mesh.points, mesh.triangles, u, law, *at),
        np.broadcast_to(sigma, (len(mesh.triangles), 1, 2, 2)),
        rtol=1e-9,
    )
    nodal = (nodal_stress_matrix(mesh.points, mesh.triangles, law) @ u.ravel()).reshape(-1, 3)
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


def test_matrix_is_that_of_scikit_fem():
    import skfem
    from skfem.models.elasticity import lame_parameters, linear_elasticity

    points, triangles, _, _ = quadratic_ring(1.0, 2.0, 8, 2)
    corners = np.unique(triangles[:, :3])
    new = np.full(len(points), -1)
    new[corners] = np.arange(len(corners))
    flat = skfem.MeshTri(points[corners].T, new[triangles[:, :3]].T)
    curved = skfem.MeshTri2.from_mesh(flat)
    # scikit-fem's own numbering of the middles: by the facets' corners
    middle = {}
    for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        for p, q, r in zip(new[triangles[:, a]], new[triangles[:, b]], triangles[:, m], strict=True):
            middle[tuple(sorted((int(p), int(q))))] = r
    places = np.array(curved.doflocs)
    mine = np.concatenate([corners, [middle[tuple(sorted(f))] for f in flat.facets.T.tolist()]])
    places[:, :] = points[mine].T
    curved = skfem.MeshTri2(places, curved.t)
    basis = skfem.Basis(curved, skfem.ElementVector(skfem.ElementTriP2()), intorder=4)
    theirs = linear_elasticity(*lame_parameters(206e9, 0.3)).assemble(basis).toarray()
    # their unknowns by place: component by component of each node
    where = {tuple(np.round(p, 12)): i for i, p in enumerate(points)}
    order = np.empty(theirs.shape[0], dtype=int)
    component = np.empty(theirs.shape[0], dtype=int)
    vector = np.zeros((2, *basis.doflocs.shape[1:]))
    assert vector.shape[0] == 2
    locations = basis.doflocs.T
    for k in (0, 1):
        one = basis.zeros()
        dofs = np.concatenate([basis.nodal_dofs[k], basis.facet_dofs[k]])
        one[dofs] = 1
        component[dofs] = k
    for dof, place in enumerate(
        places[:, np.argmin(np.linalg.norm(places.T[:, None] - locations[None], axis=2), axis=0)].T
    ):
        order[dof] = where[tuple(np.round(place, 12))]
    mine_at = 2 * order + component
    K = stiffness_matrix(points, triangles, STRAIN).toarray()
    np.testing.assert_allclose(K[np.ix_(mine_at, mine_at)], theirs, rtol=0, atol=1e-12 * np.abs(theirs).max())


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
        shear = 1e6
        around = lambda place: (
            np.stack([-place[..., 1], place[..., 0]], -1) / np.linalg.norm(place, axis=-1, keepdims=True)
        )  # noqa: E731
        force = edge_load(points, outer, lambda place, normal: shear * around(place))
        nodes = np.unique(inner)
        u = solve(points, triangles, STRAIN, force, np.concatenate([2 * nodes, 2 * nodes + 1]))
        rim = np.unique(outer[:, :2])
        turn = np.einsum("na,na->n", u[rim], around(points[rim])).mean() / b
        torque = shear * 2 * np.pi * b**2
        base = 0.0338
        # a force F on the base circle: torque F r_b, way turn r_b
        errors.append(abs(turn * base / (torque / base) / hub_windup(base, a, b, STRAIN) - 1))
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
    with pytest.raises(FemError, match="plane"):
        PlaneElasticity("strains", 206e9, 0.3)


def test_whole_ring_of_teeth_holds_a_torque(article_pair):
    profile = article_pair.teeth_profiles[0]
    gear = gear_mesh(mesh_sector(profile))
    hub = np.unique(gear.facets["bore"])
    arcs = np.concatenate([gear.facets["root_left"], gear.facets["root_right"]])
    around = lambda place: (
        np.stack([-place[..., 1], place[..., 0]], -1) / np.linalg.norm(place, axis=-1, keepdims=True)
    )  # noqa: E731
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
