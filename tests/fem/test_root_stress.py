"""Edge stress against Kirsch's hole; influence functions against a plain annulus; symmetry, scaling, rims."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

import fem
from base import InputError
from fem.elasticity.fillet import GAUSS, edge_strain_matrix, fillet_line, fillet_stress_matrix, local_cubic
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.elasticity.ring import ring_of
from fem.influence.fillet_influence import fillet_influence
from fem.pair.pair_fillets import fillets
from fem.stress.tooth_root import root_stress
from gears import BasicRack, Gear, GearPair, closed_form
from meshes import Sizes, gear_mesh, mesh_sector
from tests.fem.conftest import edge_load, quadratic_ring

LAW = PlaneElasticity("strain", 206e9, 0.3)
SMALL = GearPair(Gear(18, profile_shift=0.2), Gear(24), 2e-3, 0.04)


@pytest.fixture(scope="module")
def article_fillets(article_pair):
    return fillets(article_pair)


@pytest.fixture(scope="module")
def held(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False)


def kirsch(place, pull=1.0):
    """Stresses round a hole of radius 1 in an endless plate drawn along x (Kirsch 1898)."""
    r, t = np.hypot(place[..., 0], place[..., 1]), np.arctan2(place[..., 1], place[..., 0])
    c, s = np.cos(2 * t), np.sin(2 * t)
    rr = 0.5 * pull * ((1 - r**-2) + (1 - 4 * r**-2 + 3 * r**-4) * c)
    tt = 0.5 * pull * ((1 + r**-2) - (1 + 3 * r**-4) * c)
    rt = -0.5 * pull * (1 + 2 * r**-2 - 3 * r**-4) * s
    e = np.stack([np.cos(t), np.sin(t)], axis=-1)
    f = np.stack([-np.sin(t), np.cos(t)], axis=-1)

    def outer(a, b):
        return a[..., :, None] * b[..., None, :]

    shear = rt[..., None, None] * (outer(e, f) + outer(f, e))
    return rr[..., None, None] * outer(e, e) + tt[..., None, None] * outer(f, f) + shear


def hole_error(around):
    points, triangles, inner, outer = quadratic_ring(1.0, 4.0, around, around // 4)
    force = edge_load(points, outer, lambda p, n: np.einsum("...ij,...j->...i", kirsch(p), n) * sign(p, n))
    K = stiffness_matrix(points, triangles, LAW)
    # three components held to stop rigid motion; the load is in balance by itself
    first, opposite = np.argmin(np.linalg.norm(points - [4, 0], axis=1)), np.argmin(points[:, 0])
    stopped = np.array([2 * first, 2 * first + 1, 2 * opposite + 1])
    free = np.setdiff1d(np.arange(2 * len(points)), stopped)
    u = np.zeros(2 * len(points))
    u[free] = spsolve(csc_array(K[free][:, free]), force.ravel()[free])
    strain = edge_strain_matrix(points, inner) @ u
    step = 2 * np.pi / around
    angle = (np.arange(around)[:, None] * step + GAUSS * step).ravel()
    wanted = np.linspace(0.5, 3.0, 101)
    found = LAW.plane_modulus * local_cubic(angle, wanted) @ strain
    return np.max(np.abs(found - (1 - 2 * np.cos(2 * wanted)))), found.max()


def sign(place, normal):
    """The helper's normals point to the right of the edges; the outer rim's outward one is wanted."""
    return np.sign(np.einsum("...i,...i->...", place, normal))[..., None]


def test_hole_in_a_plate_has_three_times_the_stress_and_second_order():
    errors, greatest = zip(*(hole_error(n) for n in (16, 32, 64)), strict=True)
    assert errors[2] < 1.5e-3
    assert np.log2(np.array(errors[:-1]) / errors[1:]).min() > 1.9
    assert greatest[2] == pytest.approx(3.0, rel=3e-4)


def test_local_cubic_reproduces_cubics():
    places = np.sort(np.random.default_rng(1).uniform(0, 3, 11))
    wanted = np.linspace(-0.1, 3.1, 30)
    cubic = np.polynomial.Polynomial([2.0, -1.0, 0.5, 0.3])
    np.testing.assert_allclose(local_cubic(places, wanted) @ cubic(places), cubic(wanted), rtol=1e-9)
    two = np.array([1.0, 2.0])
    np.testing.assert_allclose(local_cubic(two, np.array([1.5])) @ (3 * two), [4.5])


def test_uniform_strain_is_found_along_the_whole_fillet(article_pair):
    profile = article_pair.teeth_profiles[0]
    mesh = mesh_sector(profile, refinements=1)
    line = fillet_line(profile)
    smooth = np.abs(line.arc - line.foot) > 0.03 * profile.module  # the tangent turns fast after the root arc
    slope = np.array([[3.0, -1.0], [2.0, 5.0]]) * 1e-4
    moved = (mesh.points @ slope.T).ravel()
    for side in ("left", "right"):
        _, tangents, _ = line.side(side == "left")
        exact = LAW.plane_modulus * np.einsum("pa,ab,pb->p", tangents, slope, tangents)
        found = fillet_stress_matrix(mesh, profile, line, LAW, side) @ moved
        # elements' edges are parabolas, not trochoids
        np.testing.assert_allclose(found[smooth], exact[smooth], atol=2e-3 * np.abs(exact).max())


def test_fillet_line_is_the_generated_outline(article_pair):
    profile = article_pair.teeth_profiles[0]
    line = fillet_line(profile)
    step = np.linalg.norm(np.diff(line.points, axis=0), axis=1)
    assert step.sum() == pytest.approx(line.arc[-1], rel=1e-4)
    np.testing.assert_allclose(step, line.arc[1], rtol=2e-3)
    np.testing.assert_allclose(line.points[-1], profile.fillet(np.array([1.0]))[0], rtol=1e-9)
    along = np.gradient(line.points, line.arc, axis=0)[5:-5]
    inner = np.einsum("pa,pa->p", along, line.tangents[5:-5])
    np.testing.assert_allclose(inner, 1.0, atol=2e-3)
    # at the root circle the fillet runs round, at the form circle as the involute does
    assert np.all(np.diff(line.tangent_angle[line.arc > line.foot]) < 0)
    section = closed_form.iso6336_3(article_pair, 1.0).sections[0]
    place = np.interp(-np.pi / 6, -line.tangent_angle, np.arange(len(line.arc)))
    chord = 2 * np.interp(place, np.arange(len(line.arc)), line.points[:, 0])
    assert chord / profile.module == pytest.approx(section.s_Fn, rel=1e-4)


def test_influence_is_that_of_a_plain_annulus_with_a_nodal_force():
    """No half-plane, no condensation, no series: all teeth assembled, a force on a node of one flank."""
    profile, z = SMALL.teeth_profiles[0], SMALL.pinion.teeth
    sizes = Sizes(fillet=0.12, root=0.12, flank=0.25, corner=0.1)
    sector = mesh_sector(profile, sizes)
    gear = gear_mesh(sector)
    K = stiffness_matrix(gear.points, gear.triangles, LAW)
    hub = np.unique(gear.facets["bore"])
    free = np.setdiff1d(np.arange(2 * len(gear.points)), np.concatenate([2 * hub, 2 * hub + 1]))
    edges, arcs = sector.facets["flank_left"], sector.parameters["flank_left"]
    pick = np.argmin(np.abs(arcs[:, 0] - 0.6 * arcs.max()))
    rho = np.sqrt(2 * profile.base_radius * arcs[pick, 0])
    at = flank_points(sector, np.array([rho]))
    force = np.zeros((len(gear.points), 2))
    force[gear.nodes[0][edges[pick, 0]]] = at.inward[0]
    u = np.zeros(2 * len(gear.points))
    u[free] = spsolve(csc_array(K[free][:, free]), force.ravel()[free])
    influence = fillet_influence(ring_of(sector, LAW), profile, 2)
    greatest = np.abs(influence.stress(0, np.array([rho]))).max()
    for tooth in (-2, -1, 0, 1, 2):
        c, s = np.cos(2 * np.pi * tooth / z), np.sin(2 * np.pi * tooth / z)
        own = (u.reshape(-1, 2)[gear.nodes[tooth % z]] @ np.array([[c, -s], [s, c]])).ravel()
        found = influence.stress(tooth, np.array([rho]))[0]
        for i, side in enumerate(("left", "right")):
            plain = fillet_stress_matrix(sector, profile, influence.line, LAW, side) @ own
            np.testing.assert_allclose(found[i], plain, atol=4e-3 * greatest)


def test_both_sides_of_a_gap_agree_at_its_middle(article_fillets):
    for gear in (article_fillets.pinion, article_fillets.wheel):
        rho = np.linspace(*gear.rho_range, 7)
        greatest = np.abs(gear.stress(0, rho)).max()
        for tooth in (-2, -1, 0, 1):
            left, right = gear.stress(tooth, rho)[:, 0, 0], gear.stress(tooth + 1, rho)[:, 1, 0]
            np.testing.assert_allclose(left, right, atol=0.01 * greatest)


def test_estimate_holds_against_a_far_finer_mesh(article_pair, article_fillets):
    finer = fillets(article_pair, fillet_edge=0.03)
    true = 0.0
    for gear in ("pinion", "wheel"):
        one, other = getattr(article_fillets, gear), getattr(finer, gear)
        rho = np.linspace(*one.rho_range, 15)
        a, b = (np.abs(each.stress(0, rho)).max(axis=2) for each in (one, other))
        true = max(true, float(np.max(np.abs(a / b - 1))))
    assert article_fillets.converged
    assert article_fillets.error < 0.005
    assert 0.5 < article_fillets.error / true < 5


@pytest.mark.slow
def test_estimates_of_many_gears_are_honest():
    rng = np.random.default_rng(11)
    ratios = []
    while len(ratios) < 12:
        rack = BasicRack(
            h_fP=rng.uniform(1.1, 1.5), rho_fP=rng.uniform(0.1, 0.42), alpha=np.radians(rng.choice([20, 25]))
        )
        try:
            pair = GearPair(
                Gear(int(rng.integers(10, 120)), rng.uniform(-0.4, 0.9)), Gear(45), 2e-3, 0.02, rack
            )
        except ValueError:
            continue
        usual, finer = fillets(pair), fillets(pair, fillet_edge=0.03)
        true = 0.0
        for one, other in ((usual.pinion, finer.pinion), (usual.wheel, finer.wheel)):
            rho = np.linspace(*one.rho_range, 15)
            a, b = (np.abs(each.stress(0, rho)).max(axis=2) for each in (one, other))
            true = max(true, float(np.max(np.abs(a / b - 1))))
        ratios.append(usual.error / true)
    assert np.mean(np.array(ratios) > 0.5) >= 0.95
    assert np.median(ratios) < 5


def test_stress_grows_with_the_forces_alone(article_pair, held, article_fillets):
    once = root_stress(article_pair, held, article_fillets)
    doubled = dataclasses.replace(held, forces=2 * held.forces)
    twice = root_stress(article_pair, doubled, article_fillets)
    np.testing.assert_allclose(twice.wheel.tangential_Pa, 2 * once.wheel.tangential_Pa, rtol=1e-12)
    assert np.max(twice.wheel.tension_Pa) == pytest.approx(2 * np.max(once.wheel.tension_Pa))


def test_a_root_feels_the_loads_on_the_teeth_beside_its_own(article_pair, held, article_fillets):
    """The pair ahead bears on the next tooth anticlockwise of the pinion, and clockwise of the wheel."""
    found = root_stress(article_pair, held, article_fillets)
    row = int(np.argmax(np.min(held.forces, axis=1)))  # two pairs bear
    parts: dict[tuple[int, int], list[np.ndarray]] = {(j, k): [] for j in range(2) for k in range(-2, 3)}
    for gear, influence in enumerate((article_fillets.pinion, article_fillets.wheel)):
        for pair in range(2):
            rho, load = held.flank_rho[gear][row, pair], held.forces[row, pair] / 0.04
            for k in (-2, -1, 0, 1, 2):
                parts[gear, k].append(load * influence.stress(k, np.array([rho]))[0])
    assert held.pair_offset.tolist() == [0, 1]
    assert found.pinion.tooth.tolist() == found.wheel.tooth.tolist() == [-1, 0, 1, 2]
    for place, tooth in enumerate((-1, 0, 1, 2)):
        pinion = parts[0, tooth][0] + parts[0, tooth - 1][1]
        wheel = parts[1, -tooth][0] + parts[1, 1 - tooth][1]
        np.testing.assert_allclose(found.pinion.tangential_Pa[row, place], pinion, rtol=1e-9, atol=1.0)
        np.testing.assert_allclose(found.wheel.tangential_Pa[row, place], wheel, rtol=1e-9, atol=1.0)
    beside = np.abs(parts[0, -1][1]).max() / np.abs(parts[0, 0][0]).max()
    assert beside > 0.02


def test_greatest_stress_is_at_the_outer_point_of_single_contact(article_pair, held, article_fillets):
    """Contact held to the path: tension on one side, compression on the other, both greatest near D and B."""
    found = root_stress(article_pair, held, article_fillets)
    points, pitch = article_pair.points, article_pair.base_pitch
    positions = (points.D - points.A) / pitch, (points.B - points.A) / pitch
    for gear, position in zip((found.pinion, found.wheel), positions, strict=True):
        peak = gear.greatest_tension
        assert peak.position == pytest.approx(position, abs=1e-8)
        assert gear.greatest_compression.position == pytest.approx(position, abs=1e-8)
        assert gear.greatest_compression.stress_Pa < -peak.stress_Pa < 0
        assert peak.von_mises_Pa == pytest.approx(np.sqrt(0.79) * peak.stress_Pa)
        # on the fillet under the loaded flank, between the root circle and the place of the standard
        assert peak.point[0] < 0 < gear.greatest_compression.point[0]
        assert np.radians(30) < peak.tangent_angle < np.radians(60)
        assert np.all(gear.tension_Pa <= peak.stress_Pa)
        amplitude, mean = gear.fatigue()
        assert np.max(amplitude + mean) == pytest.approx(peak.stress_Pa, rel=2e-3)
    # the standard's stress for the same load
    nominal = closed_form.iso6336_3(article_pair, held.force)
    assert found.pinion.greatest_tension.stress_Pa == pytest.approx(nominal.stresses[0], rel=0.05)
    assert found.wheel.greatest_tension.stress_Pa == pytest.approx(nominal.stresses[1], rel=0.05)


def test_greatest_stress_does_not_depend_on_the_positions(article_pair, article_bodies, article_fillets):
    """Of four positions or of very many, tip edges free; the samples alone miss what their distance allows."""
    few, many = (
        root_stress(article_pair, fem.mesh_cycle(article_pair, 600.0, n, article_bodies), article_fillets)
        for n in (4, 2000)
    )
    for name in ("pinion", "wheel"):
        found, brute = getattr(few, name), getattr(many, name)
        for peak, samples in (
            (found.greatest_tension, brute.tension_Pa),
            (found.greatest_compression, -brute.compression_Pa),
        ):
            size = abs(peak.stress_Pa)
            # an estimate, no bound: half of an error is the least that it may be; half an interval from a corner
            # samples are a little less
            assert -5e-4 < np.max(samples) / size - 1 < 2.0 * peak.sampling + 1e-9
            assert 0 <= peak.sampling < 1e-3
        np.testing.assert_allclose(np.max(found.tension_Pa), found.greatest_tension_Pa, rtol=0.2)
        assert np.max(found.tension_Pa) < 0.999 * found.greatest_tension_Pa
        high, low = brute.passage()[1].max(axis=0), brute.passage()[1].min(axis=0)
        np.testing.assert_allclose(found.passage_range_Pa[1], high, atol=2e-3 * high.max())
        np.testing.assert_allclose(found.passage_range_Pa[0], low, atol=2e-3 * high.max())
    assert few.error > article_fillets.error


def test_equal_gears_bear_alike():
    """A whole number of half base pitches of path: the wheel sees the pinion's passage run backwards."""
    low, high = -0.3, 0.0
    for _ in range(50):
        k = 0.5 * (low + high)
        gear = Gear(30, tip_alteration=k)
        pair = GearPair(gear, gear, 2e-3, 0.02)
        low, high = (k, high) if pair.contact_ratio < 1.5 else (low, k)
    cycle = fem.mesh_cycle(pair, 100.0, 20, beyond_path=False)
    found = root_stress(pair, cycle)
    for rows in range(20):
        position = found.pinion.tooth_position[rows]
        for column in np.flatnonzero((position > 0) & (position < 1.5)):
            other = np.argwhere(np.abs(found.wheel.tooth_position - (1.5 - position[column])) < 1e-6)[0]
            one = found.pinion.tangential_Pa[rows, column]
            np.testing.assert_allclose(
                one, found.wheel.tangential_Pa[tuple(other)], atol=2e-5 * np.abs(one).max()
            )


@pytest.mark.slow
def test_same_stress_in_every_module():
    found = []
    for scale in (1.0, 20.0):
        pair = GearPair(Gear(20), Gear(30), 1e-3 * scale, 10e-3 * scale)
        cycle = fem.mesh_cycle(pair, 10.0 * scale**3, 5)
        found.append(root_stress(pair, cycle).pinion.tangential_Pa)
    np.testing.assert_allclose(found[0], found[1], rtol=1e-6, atol=1e-6 * np.abs(found[0]).max())


@pytest.mark.filterwarnings("ignore:pinion. the rim:gears.GeometryWarning")
def test_thin_rim_on_its_hub_moves_the_stress_up_the_fillet_and_lowers_it():
    """The bore is held: a hub close below the root takes up what a solid gear's root land bears."""
    rims = [
        fillets(GearPair(Gear(36, bore_radius=bore), Gear(40), 2e-3, 0.04), 0.01) for bore in (0.015, 0.0325)
    ]
    at = []
    for rim in rims:
        stress = rim.pinion.stress(0, np.array([rim.pair.points.D]))[0, 0]
        at.append((stress.max(), rim.pinion.line.tangent_angle[np.argmax(stress)]))
    assert at[1][0] < 0.95 * at[0][0]
    assert at[1][1] < at[0][1] - np.radians(5)


def test_nonsense_is_refused(article_pair, held, article_fillets):
    with pytest.raises(InputError, match=r"(?s)tolerance.*plane.*fillet_edge"):
        fillets(article_pair, -1.0, "both", 3.0)
    other = dataclasses.replace(article_pair, face_width=0.05)
    with pytest.raises(InputError, match="another pair"):
        root_stress(other, held, article_fillets)
    with pytest.raises(InputError, match="plane"):
        root_stress(article_pair, dataclasses.replace(held, plane="stress"), article_fillets)
    lost = dataclasses.replace(held, forces=np.full_like(held.forces, np.nan))
    with pytest.raises(InputError, match="converged"):
        root_stress(article_pair, lost, article_fillets)
