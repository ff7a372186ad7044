from __future__ import annotations

import pickle

import numpy as np
import pytest

import fem
from base import InputError
from gears import BasicRack, Gear, GearPair, Material
from meshes import Sizes
from tests.fem.conftest import true_error
from tests.validation.article import PAIR

PAIRS = {
    "article": PAIR,
    "form circle": GearPair(Gear(17), Gear(43), 2e-3, 0.04),
    "high contact ratio": GearPair(Gear(60), Gear(80), 2e-3, 0.04, BasicRack(1.3, 1.55, 0.3, np.radians(18))),
    "chamfer": GearPair(Gear(30, tip_chamfer=2e-4), Gear(40, tip_chamfer=2e-4), 2e-3, 0.04),
}


@pytest.mark.parametrize("name", list(PAIRS))
def test_error_estimate_is_the_true_error(name):
    pair = PAIRS[name]
    bodies = fem.compliance(pair)
    reference = fem.compliance(pair, 1e-4, sizes=bodies.sizes, refinements=2)
    assert reference.error < 0.2 * bodies.error
    assert 0.5 < bodies.error / true_error(bodies, reference) < 3.0


@pytest.mark.parametrize("name", ["article", "form circle"])
def test_flanks_at_the_default_tolerance_are_those_of_a_converged_mesh(name):
    """Mid-flank within 0.05 %, the ends of the path within 0.3 %."""
    pair = PAIRS[name]
    rho1 = np.linspace(pair.points.A, pair.points.E, 41)
    force = pair.normal_force(600.0)
    bodies = fem.compliance(pair)
    converged = fem.compliance(pair, 1e-4, refinements=2)
    assert converged.error < 5e-5
    k, reference = (fem.single_pair_stiffness(pair, force, rho1, one) for one in (bodies, converged))
    off = np.abs(k / reference - 1)
    assert np.all(off < 3e-3)
    assert np.all(off[5:-5] < 5e-4)


def test_tolerance_chooses_the_mesh(article_pair):
    loose, tight = fem.compliance(article_pair, 0.01), fem.compliance(article_pair, 5e-5)
    assert loose.cost.unknowns < 0.7 * tight.cost.unknowns
    assert loose.error <= 0.01
    assert 5e-6 < tight.error <= 5e-5
    assert loose.converged
    assert tight.converged


def test_a_tolerance_that_cannot_be_met_is_said_so(article_pair):
    with pytest.raises(InputError, match="at least 2e-06"):
        fem.compliance(article_pair, 1e-6)
    bodies = fem.compliance(article_pair, 2e-6, options=fem.Options(finest=1))
    assert bodies.converged
    assert bodies.error > 2e-6
    assert "above the tolerance" in bodies.message


@pytest.mark.slow
def test_the_least_tolerance_is_reached(article_pair):
    bodies = fem.compliance(article_pair, 4e-6)
    assert bodies.converged
    assert bodies.error < 4e-6


def test_coarser_elements_are_within_their_own_estimate(article_pair, article_bodies):
    crude = fem.compliance(article_pair, sizes=Sizes(flank=0.6, fillet=0.5, root=0.6, rim=1.2, corner=0.05))
    rho1 = np.linspace(article_pair.points.A, article_pair.points.E, 30)
    change = crude.own(rho1) / article_bodies.own(rho1) - 1
    assert np.max(np.abs(change)) < 3 * (crude.error + article_bodies.error)


def test_bulk_matrix_is_symmetric_positive_and_coupled(article_pair, article_bodies):
    start = np.linspace(article_pair.points.A, article_pair.points.E - article_pair.base_pitch, 7)
    rho1 = np.stack([start, start + article_pair.base_pitch], axis=1)
    bulk = article_bodies.bulk(rho1)
    np.testing.assert_array_equal(bulk, bulk.swapaxes(1, 2))
    assert np.all(np.linalg.eigvalsh(bulk) > 0)
    # the neighbour moves by more than the hubs' turn, and less than the loaded tooth
    turn = sum(article_bodies.hub_windup)
    assert np.all(bulk[:, 0, 1] > turn)
    assert np.all(bulk[:, 0, 1] < 0.6 * bulk[:, 0, 0])


def test_equal_gears_are_the_same_seen_from_either_side():
    pair = GearPair(Gear(28), Gear(28), 2e-3, 0.04)
    bodies = fem.compliance(pair)
    rho1 = np.linspace(pair.points.A, pair.points.E, 11)
    np.testing.assert_allclose(bodies.own(rho1), bodies.own(rho1)[::-1], rtol=1e-12)
    k = fem.single_pair_stiffness(pair, 1e4, rho1, bodies)
    np.testing.assert_allclose(k, k[::-1], rtol=1e-12)


def test_stiffness_per_face_width_is_free_of_size(article_pair):
    small = GearPair(Gear(36), Gear(40), 1e-3, 0.02)
    large = GearPair(Gear(36), Gear(40), 5e-3, 0.1)
    k = []
    for pair, force in ((small, 1e4), (large, 25e4)):  # the same pressure on similar shapes
        rho1 = np.linspace(pair.points.A, pair.points.E, 5)
        k.append(fem.single_pair_stiffness(pair, force, rho1) / pair.face_width)
    np.testing.assert_allclose(k[0], k[1], rtol=2e-5)


def test_two_materials_lie_between_one(article_pair):
    steel, bronze = Material(206e9, 0.3, 7850.0), Material(110e9, 0.34, 8800.0)
    rho1 = [article_pair.points.C]
    k = [
        float(fem.single_pair_stiffness(GearPair(Gear(36), Gear(40), 2e-3, 0.04, material=m), 1e4, rho1)[0])
        for m in (bronze, (steel, bronze), steel)
    ]
    assert k[0] < k[1] < k[2]
    assert 1 / k[1] == pytest.approx(0.5 * (1 / k[0] + 1 / k[2]), rel=0.02)


def test_plane_stress_is_softer_by_nearly_the_plane_modulus(article_pair):
    rho1 = [article_pair.points.C]
    strain = fem.single_pair_stiffness(article_pair, 1e4, rho1)[0]
    stress = fem.single_pair_stiffness(article_pair, 1e4, rho1, plane="stress")[0]
    assert 0.91 < stress / strain < 0.96  # shear and the hub's turn do not know E*


def test_hub_windup_is_named(article_pair, article_bodies):
    first, second = article_bodies.hub_windup
    G = 206e9 / 2.6
    r_b, r_f, r_h = article_pair.base_radii[0], article_pair.root_radii[0], article_pair.bore_radii[0]
    assert first == pytest.approx(r_b**2 / (4 * np.pi * G * 0.04) * (1 / r_h**2 - 1 / r_f**2), rel=1e-12)
    assert second > 0


def test_both_ends_of_the_path_are_finite(article_pair, article_bodies):
    points = article_pair.points
    k = fem.single_pair_stiffness(article_pair, 1e4, [points.A, points.E], article_bodies)
    assert np.all(np.isfinite(k))
    assert np.all(k > 0.5 * fem.single_pair_stiffness(article_pair, 1e4, [points.C], article_bodies))


def test_results_travel_between_processes(article_pair, article_bodies):
    back = pickle.loads(pickle.dumps(article_bodies))
    rho1 = np.array([article_pair.points.C])
    np.testing.assert_array_equal(back.own(rho1), article_bodies.own(rho1))


def test_factorised_gears_are_kept_in_the_process_and_come_back_after_travel(article_bodies, no_gear_solved):
    assert article_bodies.rings() is article_bodies.rings()
    fem.forget_gears()
    back = pickle.loads(pickle.dumps(article_bodies))
    assert len(pickle.dumps(article_bodies)) < 1e6
    for kept, again in zip(article_bodies.rings(), back.rings(), strict=True):
        np.testing.assert_array_equal(again.mesh.points, kept.mesh.points)
        np.testing.assert_array_equal(again.schur, kept.schur)


def test_all_faults_at_once(article_pair):
    with pytest.raises(InputError) as caught:
        fem.compliance(article_pair, tolerance=0.0, plane="shell", refinements=9)
    assert [fault.where for fault in caught.value.faults] == ["tolerance", "plane", "refinements"]
    with pytest.raises(InputError) as caught:
        fem.single_pair_stiffness(article_pair, float("nan"), [1.0], fem.compliance(article_pair))
    assert [fault.where for fault in caught.value.faults] == ["force", "rho1"]


def test_cost_says_what_was_solved(article_pair, no_gear_solved):
    cost = fem.compliance(article_pair, tip_edges=True).cost
    assert {"mesh", "assemble", "factor", "condense", "solve", "tips"} <= set(cost.parts)
    assert sum(cost.parts.values()) <= cost.seconds
    assert cost.counts["annulus_unknowns"] > 30 * cost.unknowns


@pytest.mark.parametrize(
    "sizes", [{"corner": 0.05}, {"corner": 0.1}, {"corner": 0.4, "growth": 1.5}, {"fillet": 0.6}]
)
def test_the_error_of_ones_own_sizes_is_the_true_one(article_pair, sizes):
    """Elements at the corner up to thirty times as long as usual: a refinement gains less of their error."""
    mine = fem.compliance(article_pair, sizes=Sizes(**sizes), refinements=1)
    assert 0.5 < mine.error / true_error(mine, fem.compliance(article_pair, refinements=3)) < 2
