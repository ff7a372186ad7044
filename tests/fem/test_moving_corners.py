"""Tip corners under contacts that move: no steps, exact tangents, and stiff teeth as if contacts stayed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.solver import solve_contact
from fem.laws.corner_laws import CornerLaws
from fem.laws.corner_surface import up_to
from fem.laws.cut_off import cut_off
from fem.laws.local_law import Table
from fem.laws.mesh_setup import MeshSetup
from fem.laws.relieved_flanks import plain_touch
from fem.laws.tip_contact import edge_laws
from fem.laws.tip_geometry import lever_ratio
from gears import Gear, GearPair, Material

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)


def pair_of(factor=1.0):
    materials = tuple(Material(m.youngs_modulus * factor, m.poisson_ratio, m.density) for m in (STEEL, PA66))
    return GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=materials).with_backlash(600e-6)


@pytest.fixture(scope="module")
def plastic():
    pair = pair_of()
    bodies = fem.compliance(pair, tolerance=0.01)
    return pair, bodies, CornerLaws(MeshSetup(pair, moving_contact=True), bodies)


def ends(pair):
    """Positions of A and E [base pitches from A]."""
    return 0.0, (pair.points.E - pair.points.A) / pair.base_pitch


def solved(pair, bodies, corner_laws, position, torque, moving=True):
    given = MeshSetup(pair, 1, moving_contact=moving).at(np.atleast_1d(position))
    found = solve_contact(
        given, bodies, np.array([torque / pair.base_radii[0]]), None, corner_laws if moving else None
    )
    assert not found.refusal(0)
    return found


@pytest.mark.parametrize("torque", [1.0, 20.0, 50.0])
def test_nothing_steps_at_A_and_E(plastic, torque):
    for end in ends(plastic[0]):
        share = solved(*plastic, [end - 1e-6, end + 1e-6], torque).share
        before, after = share.transmission_error[0, 0]
        assert after == pytest.approx(before, rel=5e-5)
        assert share.stiffness[0, 0, 1] == pytest.approx(share.stiffness[0, 0, 0], rel=5e-4)


def test_nothing_steps_at_A_where_the_flank_goes_on_below_it():
    """A wheel of few teeth leaves much of the pinion's flank untouched; what that yields changes along it."""
    pair = GearPair(Gear(60), Gear(18), 2e-3, 20e-3, material=PA66).with_backlash(600e-6)
    bodies = fem.compliance(pair, tolerance=0.01)
    assert bodies.pinion.rho_range[0] < pair.points.A - 0.5 * pair.module
    corner_laws = CornerLaws(MeshSetup(pair, moving_contact=True), bodies)
    before, after = solved(pair, bodies, corner_laws, [-1e-6, 1e-6], 20.0).share.transmission_error[0, 0]
    assert after == pytest.approx(before, rel=5e-5)


def test_what_the_flank_yields_changes_with_the_roll_on_the_flank_alone(plastic):
    """Derivatives by D of what the pinion's flank yields, on the flank, beyond its tip and below its end."""
    pair, bodies, corner_laws = plastic
    own = solved(pair, bodies, corner_laws, 0.4, 20.0).side.own
    low, high = bodies.pinion.rho_range
    step, force = 1e-8, np.full(own.base.shape, 30.0)
    for rho in (low - 0.2e-3, 0.5 * (low + high), high + 0.05e-3):
        some = replace(own, base=np.full_like(own.base, rho), share=np.ones_like(own.share))
        less, here, more = (some.rolled(force, np.full(own.base.shape, by)) for by in (-step, 0.0, step))
        scale = force[0, 0, 0] * bodies.pinion.own_slope(np.array([0.5 * (low + high)]))[0]
        np.testing.assert_allclose(
            (more.approach - less.approach) / (2 * step), here.less, atol=1e-4 * abs(scale)
        )
        np.testing.assert_allclose(
            (more.push - less.push) / (2 * step), here.stiff, atol=1e-2 * abs(scale) / high
        )


@pytest.mark.parametrize("away", [-0.03, -0.01, 0.02])
def test_the_tangent_is_the_derivative(plastic, away):
    torque, step = 20.0, 1e-4
    for end in ends(plastic[0]):
        less, same, more = (solved(*plastic, end + away, torque * (1 + s)).share for s in (-step, 0.0, step))
        rise = (more.transmission_error - less.transmission_error) / (
            2 * step * torque / plastic[0].base_radii[0]
        )
        np.testing.assert_allclose(1 / same.stiffness, rise, rtol=1e-6)


def test_stiff_teeth_have_the_law_of_contacts_that_stay():
    """What the motion changes goes with D/m: by forty times the modulus to a fortieth, and by their root."""
    changes = []
    for factor in (1.0, 40.0):
        pair = pair_of(factor)
        bodies = fem.compliance(pair, tolerance=0.01)
        corner_laws = CornerLaws(MeshSetup(pair, moving_contact=True), bodies)
        positions = [end + away for end in ends(pair) for away in (-0.02, -0.004, 0.004, 0.03)]
        moves, stays = (
            solved(pair, bodies, corner_laws, positions, 10.0, moving).share.transmission_error[0, 0]
            for moving in (True, False)
        )
        changes.append(np.abs(moves / stays - 1).max())
    assert changes[0] > 0.01
    assert changes[1] < changes[0] / 10


@pytest.mark.parametrize("corner", [0, 1])
def test_the_surface_is_the_law_by_strips(plastic, corner):
    pair, bodies, corner_laws = plastic
    surface, slid = corner_laws.surfaces[corner], corner_laws.slid[corner]
    gear, other = (bodies.pinion, bodies.wheel)[corner], (bodies.wheel, bodies.pinion)[corner]
    for away in (-0.09, -0.02, 0.0, 0.003, 0.04, 0.3):
        z = np.array([away * pair.module])
        rho = gear.rho_end + z
        place = rho if corner == 0 else pair.line_of_action - rho
        own, rounded = (
            float(gear.own(at)[0] - gear.hub_windup) / pair.face_width
            for at in (rho, up_to(rho, gear.rho_range[1], pair.module)[0])
        )
        for size in (20.0, 200.0, 1000.0):
            force = np.array([size])
            flank = bodies.hertz(np.clip(place, pair.points.A, pair.points.E)).approach(force) + own * force
            if away <= 0.0:
                near = plain_touch(pair, place)
                more = cut_off(bodies, corner, near, place, force, slid=slid, turned=1 - corner)
                wanted = flank + more[0] * force
            else:
                law = edge_laws(pair, bodies.tips[corner], corner, place, other.law, turned=1 - corner)
                wanted = (
                    Table.through(law.force, law.approach, law.smooth).value_and_slope(force)[0]
                    + 3 * slid * force**2
                )
            at = surface.at(z - surface.sliding * force, force)
            got = flank + at.approach - surface.sliding * at.push + (rounded - own) * force
            np.testing.assert_allclose(got, wanted, rtol=1e-4)


def test_derivatives_of_the_surface(plastic):
    surface, step = plastic[2].surfaces[0], 1e-4
    z, force = np.array([-0.05e-3, 0.02e-3, 0.3e-3]), np.array([150.0, 700.0, 40.0])
    here = surface.at(z, force)
    less, more = (surface.at(z, force * (1 + s)) for s in (-step, step))
    np.testing.assert_allclose((more.approach - less.approach) / (2 * step * force), here.slope, rtol=1e-5)
    np.testing.assert_allclose((more.push - less.push) / (2 * step * force), here.less, rtol=1e-5)
    less, more = (surface.at(z + s, force) for s in (-1e-8, 1e-8))
    np.testing.assert_allclose((more.approach - less.approach) / 2e-8, here.less, rtol=1e-5)
    np.testing.assert_allclose((more.push - less.push) / 2e-8, here.stiff, rtol=1e-4)


def test_the_lever_of_an_edge_is_in_its_gap(plastic):
    """Turned by D, the pinion's corner closes by kappa D: kappa = 1 - d gap/dx."""
    pair, _, corner_laws = plastic
    z = np.linspace(0.05, 0.3, 5) * pair.module
    gap = [corner_laws.surfaces[0].gap(z + s) for s in (-1e-7, 1e-7)]
    place = pair.points.E + z
    _, where = fem.laws.tip_geometry.unloaded_gap(
        pair.base_radii[::-1], pair.line_of_action, pair.line_of_action - place, np.array([pair.points.E])
    )
    np.testing.assert_allclose(
        1 - (gap[1] - gap[0]) / 2e-7, lever_ratio(pair, where[:, 0], place, 0), atol=1e-3
    )


def touched(radii, line, tip, place, rested):
    """Where a tip edge is pressed into the other flank: tangent length of that flank on the tangent through the edge.

    Of two gears with these base radii and contacts on the line of action, x from the first one's base circle: the
    first, with its tip at the curvature radius ``tip``, stands as if it touched at ``place``, the second at ``rested``.
    """
    turn = (tip - place) / radii[0]
    edge = np.array(
        [tip * np.cos(turn) - radii[0] * np.sin(turn), tip * np.sin(turn) + radii[0] * np.cos(turn)]
    )
    edge -= np.array([line, sum(radii)])  # from the second gear's axis
    along = np.sqrt(edge @ edge - radii[1] ** 2)
    angle = np.arctan2(edge[1], edge[0]) - np.arctan2(-radii[1], -along)
    return line - rested + radii[1] * ((angle + np.pi) % (2.0 * np.pi) - np.pi)


def test_edges_touch_where_gears_that_are_turned_by_the_deflection_do(plastic):
    """The pinion is turned by D, rigidly: its tip goes on with it, and the wheel's presses into what has come on."""
    pair, bodies, corner_laws = plastic
    radii, line = pair.base_radii, pair.line_of_action
    found = solved(
        pair, bodies, corner_laws, [end + away for end in ends(pair) for away in (-0.03, 0.03)], 20.0
    )
    rho, D = found.flank_rho(0)[:, 0], found.share.transmission_error[0, 0]
    known, seen = found.share.forces[0, 0] > 0.0, [0, 0]
    for i, k in zip(*np.nonzero(found.candidates.edge & known), strict=True):
        place, before = (
            float(found.candidates.place[i, k]),
            bool(found.candidates.place[i, k] < pair.points.C),
        )
        tip = (bodies.wheel if before else bodies.pinion).rho_end
        if before:
            wanted = touched(radii[::-1], line, tip, line - place, line - place - D[i])
        else:
            wanted = touched(radii, line, tip, place + D[i], place)
        assert rho[0 if before else 1, i, k] == pytest.approx(wanted, abs=0.02 * D[i])
        seen[before] += 1
    assert min(seen) > 0


def test_torques_add_up_with_corners_that_move(plastic):
    found = solved(*plastic, np.linspace(0.5, 1.8, 27), 20.0)
    np.testing.assert_allclose(found.torques(0).sum(axis=-1), 20.0 / plastic[0].base_radii[0], rtol=1e-9)


@pytest.mark.parametrize("torque", [5.0, 20.0])
def test_the_model_error_of_contacts_that_stay_holds_the_corners(plastic, torque):
    pair, bodies, _ = plastic
    stays, moves = (
        fem.mesh_cycle(pair, torque, 40, bodies, moving_contact=moving) for moving in (False, True)
    )
    change = np.abs(moves.secant_stiffness / stays.secant_stiffness - 1).max()
    assert change < stays.model_error < 3 * change
    assert moves.model_error < 0.4 * stays.model_error
