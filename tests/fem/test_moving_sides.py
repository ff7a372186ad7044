"""Contacts that move where flanks on both sides of the teeth bear: one energy, its limits, and no leap at its onset."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.clear_flanks import ROLLED
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.moved_side import moved_side
from fem.contact.moving_sides import MovedSides
from fem.contact.solver import solve_contact
from fem.laws.contact_candidates import REACHES
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearPair, Material

STEEL, POM = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.36, 1410.0)
LOOSE = GearPair(Gear(19, 0.2), Gear(45, -0.1), 1.5e-3, 12e-3, material=(STEEL, POM))


def pressed(overlap, materials=(STEEL, POM), teeth=(19, 45)):
    """Pair whose teeth overlap [m]."""
    plain = GearPair(Gear(teeth[0]), Gear(teeth[1]), 1.5e-3, 12e-3, material=materials)
    return replace(plain, centre_distance=plain.centre_distance_of_backlash(-overlap), tight=True)


@pytest.fixture(scope="module")
def loose():
    return fem.compliance(LOOSE, tolerance=1e-3)


@pytest.fixture(
    scope="module", params=[(STEEL, POM), (POM, STEEL), (POM, POM)], ids=["wheel", "pinion", "both"]
)
def tight(request):
    pair = pressed(20e-6, request.param)
    return fem.compliance(pair, tolerance=0.02)


def problem(bodies, beyond, positions=5):
    given = MeshSetup(bodies.pair, positions, beyond, moving_contact=True)
    corner_laws = CornerLaws(given, bodies)
    sides = []
    for setting in (given, given.opposite):
        flanks = loaded_flanks(setting, bodies, None, REACHES[0], corner_laws)
        sides.append(moved_side(setting, bodies, flanks, corner_laws))
    pairs = sum(len(side.flanks.candidates.offset) for side in sides)
    return MovedSides(*sides).contacts(bodies, np.zeros((1, 1, positions, pairs, 1)))


@pytest.mark.parametrize("beyond", [False, True])
def test_forces_and_torque_follow_from_one_energy(tight, beyond):
    """Levers of further forces are what they close by a turn; slopes are derivatives; one matrix is symmetric."""
    both, rng, step = problem(tight, beyond), np.random.default_rng(1), 1e-5
    turn = np.full((1, 1, 5), 30e-6)

    def about(loads, turn):
        return both.linearised(loads, turn, both.all_bent(loads))

    loads = np.where(both.touchable, rng.uniform(50.0, 300.0, both.touchable.shape), 0.0)[None]
    at = about(loads, turn)
    ends = [about(loads, turn + s * step * 30e-6) for s in (-1, 1)]
    some = loads > 0
    reach = -(ends[1].residual - ends[0].residual) / (2 * step * 30e-6)
    np.testing.assert_allclose(at.reach[some], reach[some], atol=3e-6)
    stiff = -(ends[1].carried - ends[0].carried) / (2 * step * 30e-6)
    np.testing.assert_allclose(at.stiff, stiff, rtol=1e-5, atol=1e-5 * 500.0 / 30e-6)
    further = np.where(some, rng.normal(size=loads.shape), 0.0) * 100.0
    less, more = (about(loads + s * step * further, turn) for s in (-1, 1))
    carried = (more.carried - less.carried) / (2 * step)
    np.testing.assert_allclose(
        np.sum(at.further_lever_ratios * further, axis=-1), carried, rtol=1e-6, atol=1e-5
    )
    # what ``solved`` inverts is the derivative of the overlap
    risen = (more.residual - less.residual) / (2 * step)
    unit, response = at.jacobian.solved(at.own, at.reach, risen, some, np.ones(turn.shape, bool))
    np.testing.assert_allclose(response[some], further[some], rtol=1e-5, atol=1e-4)
    assert np.all(np.isfinite(unit))


def test_what_the_roll_changes_of_the_coupling_is_within_the_doubt(tight):
    """Flanks that surely stay clear are known without their laws by X where nothing has rolled."""
    both = problem(tight, False, 20)
    part = (
        np.abs(both.cross.matrices[1:])
        * tight.pair.module
        / np.maximum(np.abs(both.cross.matrices[0]), 1e-2 * np.abs(both.cross.matrices[0]).max())
    )
    assert np.max(part) < ROLLED


@pytest.mark.parametrize("beyond", [False, True])
def test_pressed_gears_carry_their_torque_and_have_the_tangent_of_their_turn(tight, beyond):
    pair, torque, step = tight.pair, 1.0, 1e-3
    less, cycle, more = fem.mesh_cycle(
        pair, [torque * (1 + s) for s in (-step, 0.0, step)], 5, tight, beyond_path=beyond
    )
    assert cycle.converged, cycle.message
    assert cycle.moving_contact
    assert np.any(cycle.opposite_force > 0.0)
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(cycle.stiffness, slope, rtol=1e-4)
    np.testing.assert_allclose(cycle._moments()[0][0] * pair.base_radii[0], torque, rtol=1e-9)
    np.testing.assert_allclose(cycle._moments()[1][0], cycle.stiffness, rtol=1e-6)


def test_little_overlap_and_load_are_those_of_contacts_that_stay():
    """What moves is of the first order in the deflection over the module."""
    changes = []
    for part in (1.0, 0.1):
        pair = pressed(10e-6 * part)
        bodies = fem.compliance(pair, tolerance=0.02)
        stays, moves = (
            fem.mesh_cycle(pair, part, 5, bodies, beyond_path=False, moving_contact=moving)
            for moving in (False, True)
        )
        assert np.any(stays.opposite_force > 0.0)
        changes.append(np.max(np.abs(moves.transmission_error / stays.transmission_error - 1)))
    assert changes[1] < 0.3 * changes[0] < 0.01


def test_pressed_gears_rest_in_the_middle_where_they_are_their_own_mirror(tight):
    """Both sides roll on by as much, and bear alike; the transmission error is half the overlap."""
    mirror = MeshSetup(tight.pair).mirror
    places = np.array([0.5 * mirror, 0.5 * mirror + 0.5]) % 1.0
    given = MeshSetup(tight.pair, moving_contact=True, two_sided=True, beyond_path=False).at(places)
    found = solve_contact(given, tight, np.zeros(1), None)
    assert found.settled
    np.testing.assert_allclose(found.share.transmission_error[0, 0], 10e-6, rtol=2e-3)
    front, back = (np.sort(one[0, 0], axis=-1) for one in (found.share.forces, found.opposite.share.forces))
    np.testing.assert_allclose(front[:, -2:], back[:, -2:], rtol=0.02)


@pytest.mark.parametrize(
    ("beyond", "torques"), [(False, (5.75, 6.0, 6.25, 6.5)), (True, (12.75, 13.0, 13.25, 13.5))]
)
def test_nothing_leaps_where_back_flanks_begin_to_bear(loose, beyond, torques):
    """One position of fifty let all contacts stay: the mean transmission error grew by 8 % at once."""
    cycles = fem.mesh_cycle(LOOSE, torques, 50, loose, beyond_path=beyond)
    assert [np.any(cycle.opposite_force > 0.0) for cycle in (cycles[0], cycles[-1])] == [False, True]
    assert all(cycle.moving_contact for cycle in cycles)
    assert "flanks on both sides of the teeth bear at" in cycles[-1].message
    for less, more in itertools.pairwise(cycles):
        rise = more.transmission_error - less.transmission_error
        by_tangents = (more.force - less.force) * 0.5 * (1 / less.stiffness + 1 / more.stiffness)
        same = np.all(
            (less.forces > 0) == (more.forces > 0), axis=1
        )  # a pair that enters turns the tangent at once
        np.testing.assert_allclose(rise[same], by_tangents[same], rtol=5e-3)
        assert same.mean() > 0.8
        assert abs(rise.sum() / by_tangents.sum() - 1) < 0.01


def test_deflections_beyond_the_first_order_are_refused_and_others_of_the_same_call_are_not(loose):
    light, heavy = fem.mesh_cycle(LOOSE, [8.0, 25.0], 10, loose, beyond_path=False)
    single = fem.mesh_cycle(LOOSE, 8.0, 10, loose, beyond_path=False)
    assert light.converged
    np.testing.assert_array_equal(light.forces, single.forces)
    assert not heavy.converged
    assert "reduce the torque, or let contacts stay" in heavy.message


def test_teeth_that_stiffen_without_bound_are_refused_and_have_no_negative_stiffness(loose):
    """The compliance of one position falls to that of the hubs: against the bodies the tangent would leap below 0."""
    cycles = fem.mesh_cycle(LOOSE, (18.5, 18.7, 18.74, 18.76), 20, loose, beyond_path=False)
    assert [cycle.converged for cycle in cycles] == [True, True, False, False]
    assert all(np.all(cycle.stiffness > 0.0) for cycle in cycles if cycle.converged)
    assert "strained teeth stiffen without bound" in cycles[-1].message


@pytest.mark.parametrize("moving", [False, True])
def test_slices_are_the_plane_where_back_flanks_bear(loose, moving):
    """Under 9 N m those of contacts that move do, of contacts that stay none."""
    arguments = {"beyond_path": False, "moving_contact": moving}
    plane = fem.mesh_cycle(LOOSE, 9.0, 12, loose, **arguments)
    over = fem.mesh_cycle(LOOSE, 9.0, 12, loose, cells=4, face_model="slices", **arguments)
    assert np.any(plane.opposite_force > 0.0) == moving
    assert over.converged, over.message
    for name in ("transmission_error", "stiffness", "forces", "opposite_force"):
        exact = getattr(plane, name)
        np.testing.assert_allclose(getattr(over, name), exact, rtol=1e-9, atol=1e-9 * np.abs(exact).max())


def test_corners_that_move_are_refused_beyond_their_laws():
    """A soft wheel of many teeth deflects by more than a quarter of the module before strained teeth stiffen."""
    pair = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, Material(3e9, 0.4, 1140.0)))
    bodies = fem.compliance(pair, tolerance=0.02)
    found = fem.mesh_cycle(pair, 120.0, 10, bodies)
    assert not found.converged
    assert "more than a quarter of the module" in found.message
    assert "reduce the torque, or let contacts stay" in found.message


def test_the_model_error_grows_towards_the_end_of_the_first_order_and_holds_contacts_that_stay(loose):
    """Where strained teeth stiffen without bound the tangent goes first."""
    cycles = fem.mesh_cycle(LOOSE, (14.0, 17.0, 18.5), 20, loose, beyond_path=False)
    errors = [cycle.model_error for cycle in cycles]
    assert errors[0] < errors[1] < errors[2]
    assert errors[2] > 1.9 * errors[0]
    for torque, cycle in zip((14.0, 18.5), cycles[::2], strict=True):
        stays = fem.mesh_cycle(LOOSE, torque, 20, loose, beyond_path=False, moving_contact=False)
        assert stays.model_error > np.max(np.abs(cycle.secant_stiffness / stays.secant_stiffness - 1))
    heavy = fem.mesh_cycle(LOOSE, 25.0, 20, loose, beyond_path=False, moving_contact=False)
    assert heavy.converged
    assert heavy.model_error > 1.0  # there is none with motion to be compared with
