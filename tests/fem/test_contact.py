"""Load sharing over a base pitch: balance, symmetry, tangent against finite difference, gaps and film."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import fem
from base import InputError
from fem.laws.cut_off import FAR, cut_off
from fem.laws.relieved_flanks import plain_touch
from fem.laws.tip_geometry import unloaded_gap
from gears import Gear, GearPair, TipRelief


@pytest.fixture(scope="module")
def path_only(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False)


@pytest.fixture(scope="module")
def free(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)


@pytest.mark.parametrize("beyond", [False, True])
def test_shares_add_up_and_deflections_are_equal(article_pair, article_bodies, beyond):
    cycle = fem.mesh_cycle(article_pair, 600.0, 23, article_bodies, beyond_path=beyond, reference="bore")
    np.testing.assert_allclose(cycle.load_share.sum(axis=1), 1.0, atol=1e-12)
    assert np.all(cycle.load_share >= 0)
    for row in range(23):
        on = np.flatnonzero((cycle.forces[row] > 0) & ~cycle.edge[row])
        if np.any(cycle.edge[row] & (cycle.forces[row] > 0)):
            continue
        rho1, force = cycle.rho1[row, on], cycle.forces[row, on]
        deflection = article_bodies.bulk(rho1) @ force + article_bodies.hertz(rho1).approach(force)
        if beyond:
            deflection += by_corners(article_bodies, rho1, force)
        law = 1e-5 if beyond else 1e-9  # that of corners is a surface through those of strips
        np.testing.assert_allclose(deflection, cycle.transmission_error[row], rtol=law)


def by_corners(bodies, rho1, force):
    """What near corners add to the deflections, by strips about these very places."""
    added, line = np.zeros(len(rho1)), bodies.pair.line_of_action
    for corner, gear, rho in ((0, bodies.pinion, rho1), (1, bodies.wheel, line - rho1)):
        near = (gear.rho_end**2 - rho**2) / (2 * gear.base_radius) < FAR[1] * bodies.pair.module
        touched = plain_touch(bodies.pair, rho1[near])
        more = cut_off(bodies, corner, touched, rho1[near], np.maximum(force[near], 1.0))
        added[near] += np.diagonal(more) * force[near]
    return added


def test_one_pair_alone_is_the_single_pair(article_pair, article_bodies, path_only):
    alone = np.flatnonzero((path_only.forces > 0).sum(axis=1) == 1)
    assert len(alone) == 12  # 0.297 of a base pitch
    for row in alone:
        rho1 = path_only.rho1[row, path_only.forces[row] > 0]
        k = fem.single_pair_stiffness(article_pair, path_only.force, rho1, article_bodies, reference="body")
        assert path_only.secant_stiffness[row] == pytest.approx(float(k[0]), rel=1e-9)


@pytest.mark.parametrize("beyond", [False, True])
def test_tangent_is_the_derivative_of_the_force(article_pair, article_bodies, beyond):
    step = 0.01
    less, here, more = (
        fem.mesh_cycle(article_pair, torque, 40, article_bodies, beyond_path=beyond)
        for torque in (600.0 - step, 600.0, 600.0 + step)
    )
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    same = np.all((less.forces > 0) == (more.forces > 0), axis=1)
    assert same.sum() >= 38
    np.testing.assert_allclose(here.stiffness[same], slope[same], rtol=2e-4 if beyond else 1e-6)
    assert np.all(here.stiffness > here.secant_stiffness)  # Hertz and taking in more contact both stiffen


def test_equal_gears_give_a_cycle_that_reads_the_same_backwards():
    pair = GearPair(Gear(28), Gear(28), 2e-3, 0.04)
    bodies = fem.compliance(pair)
    for beyond in (False, True):
        cycle = fem.mesh_cycle(pair, 400.0, 400, bodies, beyond_path=beyond)
        # the mirror about the pitch point takes a pair at A + s to E - s
        s = (pair.points.E - pair.points.A) / pair.base_pitch - cycle.position
        mirrored = np.interp(np.mod(s, 1.0), cycle.position, cycle.transmission_error, period=1.0)
        # Where a pair enters or leaves, the approach steps or bends within an interval. A tip edge of the
        # pinion presses with a shorter lever about the pinion's axis, one of the wheel about the wheel's:
        # with the pinion's torque given the two differ by their share times the change of the lever.
        away = np.abs(cycle.position[:, None] - [0.0, pair.contact_ratio - 1.0, 1.0]).min(axis=1) > 0.01
        np.testing.assert_allclose(
            cycle.transmission_error[away], mirrored[away], rtol=3e-2 if beyond else 1e-4
        )


def test_positions_are_midpoints_of_equal_intervals(article_pair, path_only):
    np.testing.assert_allclose(path_only.position, (np.arange(40) + 0.5) / 40)
    np.testing.assert_allclose(
        path_only.rho1[:, 0], article_pair.points.A + path_only.position * article_pair.base_pitch
    )


def test_tip_edges_only_add_stiffness_and_leave_the_double_zone_alone(path_only, free):
    assert np.all(free.forces >= 0)
    # nor is a contact so near to a corner that this cuts off its pressure
    ends = [(one.flank_rho[1], one.base_radius) for one in free.pair.teeth_profiles]
    away = [(end**2 - rho**2) / (2 * base) for rho, (end, base) in zip(free.flank_rho, ends, strict=True)]
    near = np.min(away, axis=0) < FAR[1] * free.pair.module
    idle = ~np.any((free.forces > 0) & (free.edge | near), axis=1)
    assert idle.sum() >= 5
    np.testing.assert_allclose(free.transmission_error[idle], path_only.transmission_error[idle], rtol=1e-10)
    assert np.all(free.transmission_error <= path_only.transmission_error * (1 + 1e-12))
    assert np.any(free.transmission_error < 0.8 * path_only.transmission_error)


def test_no_step_where_pairs_enter_and_leave(article_pair, article_bodies):
    """With tip edges the approach does not step where a pair passes A or E, without them by more than a fifth."""
    cycle = fem.mesh_cycle(article_pair, 600.0, 4000, article_bodies)
    around = np.append(cycle.transmission_error, cycle.transmission_error[0])
    typical = np.abs(np.diff(around))
    jump = typical[[3999, int((article_pair.contact_ratio - 1) * 4000)]]
    assert np.all(jump < 5e-4 * cycle.transmission_error.mean())
    held = fem.mesh_cycle(article_pair, 600.0, 4000, article_bodies, beyond_path=False).transmission_error
    assert np.abs(np.diff(np.append(held, held[0]))).max() > 0.2 * held.mean()


def test_light_load_forgets_the_tip_edges(article_pair, article_bodies):
    one, two = (fem.mesh_cycle(article_pair, 0.01, 40, article_bodies, beyond_path=b) for b in (False, True))
    assert np.mean(two.secant_stiffness) == pytest.approx(np.mean(one.secant_stiffness), rel=3e-3)


def test_load_dependence_of_one_pair(article_pair, article_bodies):
    k = [
        float(fem.single_pair_stiffness(article_pair, f, [article_pair.points.C], article_bodies)[0])
        for f in (17736.3, 8868.0, 1773.6)
    ]
    assert k[0] > k[1] > k[2] > 0.9 * k[0]


def test_tip_relief_is_a_gap():
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    relief = TipRelief(amount=15e-6, length=2e-3)
    eased = GearPair(Gear(36, tip_relief=relief), Gear(40, tip_relief=relief), 2e-3, 0.04)
    a, b = (fem.mesh_cycle(pair, 300.0, 40, beyond_path=False) for pair in (plain, eased))
    # single contact near the pitch point: no relief there, the same stiffness
    single = np.flatnonzero((a.forces > 0).sum(axis=1) == 1)
    np.testing.assert_allclose(b.transmission_error[single], a.transmission_error[single], rtol=1e-3)
    # a pair entering at A carries little, and the gaps add to the transmission error
    assert b.load_share[0, 0] < 0.5 * a.load_share[0, 0]
    assert np.all(b.transmission_error >= a.transmission_error * (1 - 1e-3))
    # the gap is the least along the flanks, where they are turned towards each other
    first, second = eased.teeth_profiles
    rho1, line = b.rho1[3, :1], eased.line_of_action
    touched = np.linspace(line - rho1[0] - 0.8e-3, second.flank_rho[1], 20_001)
    gaps, where = unloaded_gap(eased.base_radii, line, rho1, touched)
    wanted = float(np.min(gaps + first.relief(where) + second.relief(touched)))
    assert b.gaps[3, 0] == pytest.approx(wanted, rel=1e-3)
    nominal = float(first.relief(rho1[0]) + second.relief(line - rho1[0]))
    assert wanted < 0.97 * nominal


def test_film_is_in_series_with_each_pair_before_sharing(article_pair):
    """A film as a linear spring of k_f: each pair's compliance grows by 1/k_f, its separation cancels out."""
    k_film = 2e9

    class Spring:
        def __call__(self, rho1, forces):
            return 30e-6 - forces / k_film, np.full_like(forces, -1 / k_film)

    loose = article_pair.with_backlash(200e-6)  # with none such films would press the back flanks as well
    bodies = fem.compliance(loose)
    path_only, cycle = (
        fem.mesh_cycle(loose, 600.0, 40, bodies, beyond_path=False, film=film) for film in (None, Spring())
    )
    row = int(np.flatnonzero((path_only.forces > 0).sum(axis=1) == 1)[3])
    assert 1 / cycle.stiffness[row] == pytest.approx(1 / path_only.stiffness[row] + 1 / k_film, rel=1e-9)
    more = cycle.transmission_error[row] - path_only.transmission_error[row]
    assert more == pytest.approx(cycle.force / k_film - 30e-6, rel=1e-9)
    double = np.flatnonzero((path_only.forces > 0).sum(axis=1) == 2)
    spread = np.abs(cycle.load_share[double, 0] - 0.5) / np.abs(path_only.load_share[double, 0] - 0.5)
    assert np.all(spread < 1.0)  # springs in series level the shares


def test_a_given_compliance_is_not_computed_again(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 500.0, 40, article_bodies, reference="bore")
    assert set(cycle.cost.parts) == {"contact"}
    assert cycle.error == article_bodies.error


def test_result_travels_and_message_names_the_model(free, path_only):
    assert pickle.loads(pickle.dumps(free)).force == free.force
    assert "sharp corners" in free.message
    assert "sharp corners" not in path_only.message


def test_all_faults_at_once(article_pair, article_bodies):
    other = GearPair(Gear(20), Gear(40), 2e-3, 0.04)
    with pytest.raises(InputError) as caught:
        fem.mesh_cycle(other, float("inf"), 0, article_bodies)
    assert {fault.where for fault in caught.value.faults} == {"torque", "positions", "compliance"}
    for torque in (0.0, float("nan")):  # back flanks bear under a negative one
        with pytest.raises(InputError, match="torque"):
            fem.mesh_cycle(article_pair, torque, 40, article_bodies)


def test_a_load_beyond_the_strips_is_refused_not_guessed(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 2e6, 8, article_bodies)
    assert not cycle.converged
    assert np.all(np.isnan(cycle.transmission_error))
    assert np.all(np.isnan(cycle.stiffness))
    assert np.all(np.isnan(cycle.forces))
    assert "reduce the torque" in cycle.message
