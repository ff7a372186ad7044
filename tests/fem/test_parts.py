"""Named parts of a pair's compliance, supports of the hub, materials and planes: exact sums and limits."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import fem
from base import InputError
from fem.elasticity.support import Support
from gears import BasicRack, Gear, GearPair, Material

STEEL, BRONZE = Material(206e9, 0.3, 7850.0), Material(110e9, 0.34, 8800.0)


def places(pair, n=7):
    start = np.linspace(pair.points.A, pair.points.E - pair.base_pitch, n)
    return np.stack([start, start + pair.base_pitch], axis=1)


def test_parts_add_up(article_pair, article_bodies):
    rho1 = np.linspace(article_pair.points.A, article_pair.points.E, 9)
    parts = article_bodies.parts(rho1)
    assert set(parts) == {"pinion", "wheel", "hub_windup", "support", "coupling"}
    total = sum(parts[name] for name in ("pinion", "wheel", "hub_windup", "support"))
    np.testing.assert_allclose(total, article_bodies.own(rho1), rtol=1e-12)
    inside = rho1 + article_pair.base_pitch <= article_pair.points.E
    np.testing.assert_array_equal(np.isfinite(parts["coupling"]), inside)
    assert np.all(parts["coupling"][inside] > parts["hub_windup"][inside])


def test_coupling_is_what_either_pair_does_to_the_other(article_pair, article_bodies):
    """By Betti's theorem the pair ahead is deflected by as much; far less than by a force of its own."""
    rho1 = places(article_pair)
    coupling = article_bodies.parts(rho1[:, 0])["coupling"]
    np.testing.assert_allclose(coupling, article_bodies.bulk(rho1)[:, 1, 0], rtol=1e-3)
    assert np.all(coupling < 0.5 * article_bodies.own(rho1[:, 1]))


def test_leaving_out_the_hub_takes_it_from_own_and_from_every_cross_term(article_pair, article_bodies):
    rho1, turn = places(article_pair), sum(article_bodies.hub_windup)
    stiff = article_bodies.without("hub_windup")
    np.testing.assert_allclose(stiff.bulk(rho1), article_bodies.bulk(rho1) - turn, rtol=1e-12)
    np.testing.assert_allclose(stiff.own(rho1[:, 0]), article_bodies.own(rho1[:, 0]) - turn, rtol=1e-12)
    assert stiff.left_out == {"hub_windup"}
    assert pickle.loads(pickle.dumps(stiff)).left_out == {"hub_windup"}


def test_leaving_out_the_coupling_keeps_the_diagonal(article_pair, article_bodies):
    rho1 = places(article_pair)
    alone = article_bodies.without("coupling").bulk(rho1)
    full = article_bodies.bulk(rho1)
    np.testing.assert_array_equal(alone, full * np.eye(2))
    both = article_bodies.without("coupling").without("hub_windup").bulk(rho1)
    np.testing.assert_allclose(both, alone - sum(article_bodies.hub_windup) * np.eye(2), rtol=1e-12)
    with pytest.raises(InputError, match="windup"):
        article_bodies.without("windup")


def test_uncoupled_pairs_are_as_stiff_as_their_sum(article_pair, article_bodies):
    """Independent pairs overstate the zone of two pairs by a fifth (a known fault of adding stiffnesses)."""
    middle = 0.5 * (article_pair.points.A + article_pair.points.E)
    rho1 = np.array([middle - 0.5 * article_pair.base_pitch, middle + 0.5 * article_pair.base_pitch])
    share = [np.linalg.inv(b.bulk(rho1)).sum() for b in (article_bodies, article_bodies.without("coupling"))]
    assert share[1] == pytest.approx(np.sum(1 / article_bodies.own(rho1)), rel=1e-9)
    assert 1.2 < share[1] / share[0] < 1.6


def test_a_hub_on_springs_gives_every_pair_the_same(article_pair, article_bodies):
    supports = (Support(radial_stiffness=5e8, torsional_stiffness=2e5), Support(torsional_stiffness=3e5))
    held = fem.compliance(article_pair, supports=supports)
    r1, r2 = article_pair.base_radii
    extra = 1 / 5e8 + r1**2 / 2e5 + r2**2 / 3e5
    assert sum(held.support) == pytest.approx(extra, rel=1e-12)
    rho1 = places(article_pair)
    np.testing.assert_allclose(held.bulk(rho1), article_bodies.bulk(rho1) + extra, rtol=1e-12)
    np.testing.assert_allclose(held.without("support").bulk(rho1), article_bodies.bulk(rho1), rtol=1e-12)
    k = fem.single_pair_stiffness(article_pair, 1e4, rho1[:, 0], held)
    rigid = fem.single_pair_stiffness(article_pair, 1e4, rho1[:, 0], article_bodies)
    np.testing.assert_allclose(1 / k, 1 / rigid + extra, rtol=1e-12)


def test_a_rigid_hub_is_a_larger_bore(article_pair):
    hub = Support(hub_radius=0.027)
    held = fem.compliance(article_pair, 0.002, supports=(hub, Support()))
    bored = GearPair(Gear(36, bore_radius=0.027), Gear(40, bore_radius=0.01875), 2e-3, 0.04)
    other = fem.compliance(bored, 0.002)
    rho1 = places(article_pair)
    np.testing.assert_allclose(held.bulk(rho1), other.bulk(rho1), rtol=1e-12)
    assert held.rim_thickness[0] == pytest.approx(article_pair.root_radii[0] - 0.027)
    back = pickle.loads(pickle.dumps(held))
    np.testing.assert_array_equal(back.rings()[0].mesh.points, held.rings()[0].mesh.points)


def test_supports_that_make_no_sense_are_all_named(article_pair):
    with pytest.raises(InputError) as caught:
        Support(radial_stiffness=0.0, torsional_stiffness=float("nan"), hub_radius=-1.0)
    assert len(caught.value.faults) == 3
    with pytest.raises(InputError) as caught:
        fem.compliance(article_pair, supports=(Support(hub_radius=0.01), Support(hub_radius=0.0375)))
    wheres = [fault.where for fault in caught.value.faults]
    assert wheres == ["pinion.support.hub_radius", "wheel.support.hub_radius"]


def test_a_thinner_rim_is_stiffer_down_to_a_fifth_of_a_module(article_pair):
    """The hub is rigid: less rim, less to deform; the wind-up goes with it."""
    rho1, own, turns = [article_pair.points.C], [], []
    for rim in (4.0, 1.0, 0.2):
        hubs = tuple(Support(hub_radius=r - rim * 2e-3) for r in article_pair.root_radii)
        bodies = fem.compliance(article_pair, 0.002, supports=hubs)
        assert bodies.converged
        own.append(float(bodies.own(rho1)[0]))
        turns.append(sum(bodies.hub_windup))
    assert own[0] > own[1] > own[2] > 0
    assert turns[0] > turns[1] > turns[2] > 0


def test_each_gear_answers_with_its_own_material(article_pair, article_bodies):
    mixed = GearPair(article_pair.pinion, article_pair.wheel, 2e-3, 0.04, material=(STEEL, BRONZE))
    bodies = fem.compliance(mixed)
    rho = np.linspace(*article_bodies.pinion.rho_range, 5)
    np.testing.assert_allclose(bodies.pinion.own(rho), article_bodies.pinion.own(rho), rtol=1e-12)
    assert np.all(
        bodies.wheel.own(article_bodies.wheel.rho_range)
        > 1.7 * article_bodies.wheel.own(article_bodies.wheel.rho_range)
    )


@pytest.mark.parametrize("plane", ["strain", "stress"])
def test_compliance_scales_with_youngs_modulus(article_pair, plane):
    soft = GearPair(
        article_pair.pinion, article_pair.wheel, 2e-3, 0.04, material=Material(103e9, 0.3, 7850.0)
    )
    one, two = (fem.compliance(pair, 0.002, plane=plane) for pair in (article_pair, soft))
    rho1 = places(article_pair)
    np.testing.assert_allclose(two.bulk(rho1), 2 * one.bulk(rho1), rtol=1e-9)


def test_plane_strain_is_plane_stress_of_other_constants(article_pair):
    """E/(1 - nu^2) and nu/(1 - nu) in plane stress give the displacements of plane strain."""
    nu = 0.3
    other = Material(206e9 / (1 - nu**2), nu / (1 - nu), 7850.0)
    pair = GearPair(article_pair.pinion, article_pair.wheel, 2e-3, 0.04, material=other)
    stress, strain = fem.compliance(pair, 0.002, plane="stress"), fem.compliance(article_pair, 0.002)
    rho1 = places(article_pair)
    np.testing.assert_allclose(stress.bulk(rho1), strain.bulk(rho1), rtol=1e-9)


def test_teeth_two_apart_are_coupled_where_the_contact_ratio_is_above_two():
    pair = GearPair(Gear(60), Gear(80), 2e-3, 0.04, BasicRack(1.35, 1.6, 0.25))
    assert pair.contact_ratio > 2
    bodies = fem.compliance(pair)
    assert bodies.reach >= 3
    # three pairs fit between A and E
    rho1 = pair.points.A + 0.02 * pair.base_pitch + np.arange(3) * pair.base_pitch * 0.98
    bulk = bodies.bulk(rho1)
    assert np.all(np.linalg.eigvalsh(bulk) > 0)
    assert 0 < sum(bodies.hub_windup) < bulk[0, 2] < bulk[0, 1]
