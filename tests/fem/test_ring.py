"""One sector and the ring of links must give what the whole annulus, factorised at once, gives."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from base import InputError
from fem.elasticity.cyclic_structure import cyclic_structure
from fem.elasticity.flamant import hertz_indentation
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.elasticity.ring import ring_of
from fem.elasticity.singular_tractions import edge_points
from gears import Blank, Gear, GearPair
from gears.tooth.rotation import turned
from meshes import Sizes, gear_mesh, mesh_sector

LAW = PlaneElasticity("strain", 206e9, 0.3)
BLANKS = {"disc": None, "web": Blank(2.4e-3, 0.012, hub_radius=0.010), "web to the bore": Blank(6e-3, 0.004)}


@pytest.fixture(scope="module", params=list(BLANKS))
def profile(request):
    pinion = Gear(18, profile_shift=0.2, bore_radius=0.008, blank=BLANKS[request.param])
    return GearPair(pinion, Gear(24), 2e-3, 0.04).teeth_profiles[0]


@pytest.fixture(scope="module")
def ring(profile):
    return ring_of(mesh_sector(profile), LAW)


def harmonics(stiffness, links, j):
    """Readable twin of ``cyclic_structure``: discrete Fourier transform of the block-circulant matrix."""
    n = len(stiffness) // 2
    total = np.zeros((n, n), dtype=complex)
    for k in range(links):
        turn = np.exp(2j * np.pi * k / links)
        ring = stiffness[:n, :n] + stiffness[n:, n:] + stiffness[:n, n:] * turn + stiffness[n:, :n] / turn
        total += np.linalg.inv(ring) * turn**j / links
    assert np.abs(total.imag).max() < 1e-9 * np.abs(total.real).max()
    return total.real


def test_chain_of_links_is_the_fourier_sum(ring):
    links = cyclic_structure(ring.schur, ring.mesh.teeth)
    size = np.abs(links.influence(0)).max()
    for j in (-2, -1, 0, 1, 2, 9, 17, 18):
        np.testing.assert_allclose(
            links.influence(j), harmonics(ring.schur, 18, j), rtol=0, atol=1e-12 * size
        )


@pytest.mark.parametrize("links", [3, 5, 6, 7])
def test_chain_of_few_links_is_the_dense_ring(links):
    rng = np.random.default_rng(links)
    half = rng.normal(size=(8, 8))
    link = half @ half.T + 0.1 * np.eye(8)
    n, ring = 4, np.zeros((4 * links, 4 * links))
    for k in range(links):
        both = np.r_[n * k : n * k + n, n * ((k + 1) % links) : n * ((k + 1) % links) + n]
        ring[np.ix_(both, both)] += link
    exact = np.linalg.inv(ring)[:, :n]
    closed = cyclic_structure(link, links)
    for j in range(links):
        np.testing.assert_allclose(closed.influence(j), exact[n * j : n * j + n], rtol=0, atol=1e-11)
    force = rng.normal(size=n)
    np.testing.assert_allclose(closed.all_ends(force).ravel(), exact @ force, rtol=0, atol=1e-11)


def test_a_ring_that_nothing_holds_is_refused():
    free = np.kron(np.array([[1.0, -1.0], [-1.0, 1.0]]), np.eye(3))
    with pytest.raises((InputError, np.linalg.LinAlgError)):
        cyclic_structure(free, 12)


def whole_annulus(sector, others=None):
    gear = gear_mesh(sector, others=others)
    K = stiffness_matrix(gear.points, gear.triangles, LAW, gear.thickness)
    hub = np.unique(gear.facets["bore"])
    free = np.setdiff1d(np.arange(2 * len(gear.points)), np.concatenate([2 * hub, 2 * hub + 1]))
    options = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    factor = splu(csc_array(K[free][:, free]), **options)

    def solve(force):
        u = np.zeros(2 * len(gear.points))
        u[free] = factor.solve(force.ravel()[free])
        return u.reshape(-1, 2)

    return gear, solve


def test_forces_on_any_tooth_give_the_whole_annulus_displacements(ring):
    """Forces on the tops of two teeth, condensed by hand, against the factorised annulus."""
    sector, z = ring.mesh, ring.mesh.teeth
    gear, solve = whole_annulus(sector)
    rng = np.random.default_rng(4)
    top = np.unique(sector.facets["top"])
    pull = rng.normal(size=(len(top), 2))
    for tooth in (0, 5):
        local = np.zeros((len(sector.points), 2))
        local[top] = pull
        force = np.zeros((len(gear.points), 2))
        force[gear.nodes[tooth]] += turned(local, tooth * 2 * np.pi / z)
        exact = solve(force)
        reduced = ring.condensed.up(local.reshape(-1, 1))[0]
        inner = ring.condensed.down(np.zeros((len(ring.cut), 1)), reduced)[ring.inner, 0]
        cut_force = ring.polar.T @ (-ring.inner_by_cut.T @ local.ravel()[ring.inner])
        cuts = np.roll(ring.all_interfaces(cut_force), tooth, axis=0)
        for k in (0, 1, 4, 5, 6, 17):
            moved = np.zeros(sector.unknowns)
            on_cut = ring.polar @ cuts[k]
            moved[ring.cut] = on_cut
            moved[ring.inner] = (inner if k == tooth else 0.0) - ring.inner_by_cut @ on_cut
            mine = turned(moved.reshape(-1, 2), k * 2 * np.pi / z)
            np.testing.assert_allclose(mine, exact[gear.nodes[k]], rtol=0, atol=1e-11 * np.abs(exact).max())
            np.testing.assert_allclose(
                ring.interfaces(cut_force[:, None], k - tooth)[:, 0],
                cuts[k],
                rtol=0,
                atol=1e-12 * np.abs(cuts).max(),
            )


def test_resolved_hertz_pressure_on_the_whole_annulus_agrees(profile):
    """No singularity taken out: the pressure itself on elements of a fifth of its half-width.

    It acts along the line of action everywhere, as between equal bodies, whose contact area is flat. (Were it to
    follow one body's own curvature, the result would differ by kappa a (1 - nu*)/(2 E*) 4/(3 pi), 0.05 %.)
    """
    rho, a = 0.5 * sum(profile.flank_rho), 0.09 * profile.module
    fine = mesh_sector(profile, Sizes(flank=0.036), refinements=1)
    gear, solve = whole_annulus(mesh_sector(profile, refinements=1), {0: fine})
    edges, arcs = gear.nodes[0][fine.facets["flank_left"]], fine.parameters["flank_left"]
    middle = rho**2 / (2 * profile.base_radius)
    near = (arcs.max(axis=1) > middle - a) & (arcs.min(axis=1) < middle + a)
    t, weight = np.polynomial.legendre.leggauss(60)
    t, weight = 0.5 * (t + 1), 0.5 * weight
    at = flank_points(fine, np.array([rho]))
    size = np.zeros(len(gear.points))
    for edge, (start, end) in zip(edges[near], arcs[near], strict=True):
        _, along, shape = edge_points(gear.points, np.broadcast_to(edge, (60, 3)), t)
        off = start + t * (end - start) - middle
        pressure = 2 / (np.pi * a) * np.sqrt(np.maximum(1 - (off / a) ** 2, 0.0))
        size[edge] += (weight * pressure * np.linalg.norm(along, axis=1)) @ shape
    moved = solve(np.outer(size / size.sum(), at.inward[0]))
    resolved = float(at.component(moved[gear.nodes[0]])[0])
    sector = mesh_sector(profile, refinements=1)
    loads = line_loads(ring_of(sector, LAW), flank_points(sector, np.array([rho])))
    mine = float(loads.regular_at_load()[0] + hertz_indentation(a, LAW, profile.module))
    assert mine == pytest.approx(resolved, rel=1e-4)


def test_condensation_onto_the_cuts_is_the_schur_complement(ring):
    """By groups of elements, against a factorisation of the assembled sector."""
    stiffness = stiffness_matrix(ring.mesh.points, ring.mesh.triangles, LAW, ring.mesh.thickness)
    held = splu(csc_array(stiffness[ring.inner][:, ring.inner]))
    across = stiffness[ring.inner][:, ring.cut]
    inner_by_cut = held.solve(across.toarray())
    schur = stiffness[ring.cut][:, ring.cut] - across.T @ inner_by_cut
    size = np.abs(schur).max()
    np.testing.assert_allclose(ring.condensed.stiffness, schur, rtol=0, atol=1e-13 * size)
    np.testing.assert_allclose(ring.inner_by_cut, inner_by_cut, rtol=0, atol=1e-11)
    border = np.concatenate([ring.cut, ring.hub])
    np.testing.assert_allclose(
        ring.by_border.toarray(), stiffness[:, border].toarray(), rtol=0, atol=1e-12 * size
    )


def test_forces_pass_up_to_held_cuts_and_displacements_down_from_moved_ones(ring):
    stiffness = stiffness_matrix(ring.mesh.points, ring.mesh.triangles, LAW, ring.mesh.thickness)
    held = splu(csc_array(stiffness[ring.inner][:, ring.inner]))
    across = stiffness[ring.inner][:, ring.cut]
    rng = np.random.default_rng(5)
    force, cuts = rng.normal(size=(ring.mesh.unknowns, 2)), 1e-12 * rng.normal(size=(len(ring.cut), 2))
    inside = held.solve(force[ring.inner])
    for stiffer in (1.0, 3.0):
        reduced, on_cuts, work = ring.condensed.stiffer(stiffer).up(force)
        wanted = force[ring.cut] - across.T @ inside
        np.testing.assert_allclose(on_cuts, wanted, rtol=0, atol=1e-11 * np.abs(wanted).max())
        np.testing.assert_allclose(work * stiffer, np.sum(force[ring.inner] * inside, axis=0), rtol=1e-11)
        moved = ring.condensed.stiffer(stiffer).down(cuts, reduced)
        wanted = inside / stiffer - held.solve(across @ cuts)
        np.testing.assert_allclose(moved[ring.inner], wanted, rtol=0, atol=1e-11 * np.abs(wanted).max())
        np.testing.assert_array_equal(moved[ring.cut], cuts)
        assert not moved[ring.hub].any()
