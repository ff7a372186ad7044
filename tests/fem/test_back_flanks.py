"""Back flanks: reversal as the mirrored problem, both sides of the teeth at zero and negative backlash."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.sparse import csc_array
from scipy.sparse.linalg import spsolve

import fem
from base import InputError
from fem.contact.clear_flanks import stays_clear
from fem.contact.contact_sides import both_sides
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.opposite_flanks import share_with_opposite
from fem.contact.solver import solve_contact, solve_one_side
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.elasticity.ring import ring_of
from fem.influence.back_compliance import back_compliance
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Gear, GearDeviations, GearPair, PitchDeviations, TipRelief
from gears.tooth.rotation import turned
from meshes import gear_mesh, mesh_sector


def pressed(overlap, first=36, second=40):
    """Pair whose teeth overlap [m]."""
    plain = GearPair(Gear(first), Gear(second), 2e-3, 0.04)
    distance = plain.centre_distance_of_backlash(-overlap)
    return replace(plain, centre_distance=distance, tight=True)


@pytest.fixture(scope="module")
def tight():
    pair = pressed(5e-6)
    return pair, fem.compliance(pair, tolerance=0.005)


@pytest.fixture(scope="module")
def loose():
    relief = TipRelief(8e-6, 1.5e-3)
    pair = GearPair(Gear(36, tip_relief=relief), Gear(40), 2e-3, 0.04).with_backlash(50e-6)
    return pair, fem.compliance(pair, tolerance=0.005)


@pytest.mark.parametrize("beyond", [True, False])
def test_reversal_is_the_mirrored_problem(loose, beyond):
    pair, bodies = loose
    position = np.linspace(0.01, 0.99, 23)
    force = np.array([600.0 / pair.base_radii[0]])
    given = MeshSetup(pair, beyond_path=beyond)
    back = solve_contact(replace(given, back=True).at(position), bodies, force, None)
    front = solve_contact(given.at((given.mirror - position) % 1.0), bodies, force, None)
    for name in ("forces", "transmission_error", "stiffness"):
        np.testing.assert_allclose(getattr(back.share, name), getattr(front.share, name), rtol=1e-12)


def test_a_braking_pinion(loose):
    pair, bodies = loose
    drives, brakes = fem.mesh_cycle(pair, (600.0, -600.0), 40, bodies)
    assert (drives.flank, brakes.flank) == ("front", "back")
    assert brakes.force == -drives.force
    assert np.all(brakes.forces >= 0.0)
    np.testing.assert_allclose(brakes.load_share.sum(axis=1), 1.0, atol=1e-12)
    # the wheel leads by the backlash and the deflection
    assert np.all(brakes.transmission_error < -pair.backlash)
    for name in ("mean_stiffness", "mean_secant_stiffness", "transmission_error_range", "least_stiffness"):
        assert getattr(brakes, name) == pytest.approx(getattr(drives, name), rel=3e-6)
    np.testing.assert_allclose(brakes.wheel_torque.mean(), -drives.wheel_torque.mean(), rtol=1e-2)
    # the phases of the harmonics are those of the mirror
    c = MeshSetup(pair).mirror
    first, mirrored = (one.arcs.harmonics("stiffness", np.array([1]))[0][0] for one in (drives, brakes))
    assert mirrored == pytest.approx(np.conj(first) * np.exp(-2j * np.pi * c), rel=1e-5)
    measured = brakes.against("body")
    np.testing.assert_allclose(
        measured.transmission_error - brakes.transmission_error,
        np.interp(
            np.mod(c - brakes.position, 1.0),
            drives.position,
            drives.transmission_error - drives.against("body").transmission_error,
            period=1.0,
        ),
        rtol=1e-3,
    )


def test_the_mirror_is_where_the_back_flanks_touch():
    # the wheel stands, the pinion turns back by its backlash: its back flank is at rho1' = L - rho2'
    pair = GearPair(Gear(23, 0.2), Gear(40, -0.1), 2e-3, 0.04).with_backlash(70e-6)
    given = MeshSetup(pair)
    first, _ = pair.teeth_profiles
    placed = pair.placement(pair.points.A)
    turned = placed.pinion_angle - pair.backlash / first.base_radius
    alpha = pair.working_pressure_angle
    # the tooth's right flank is the left one of the mirror, which turns the other way
    rho1 = first.base_radius * (-turned + first.base_half_angle + alpha)
    assert (rho1 - pair.points.A) / pair.base_pitch == pytest.approx(given.mirror, abs=1e-12)


def test_pitch_deviations_open_one_side_and_close_the_other():
    pair = GearPair(Gear(12, 0.3), Gear(17), 2e-3, 0.02).with_backlash(80e-6)
    late = np.zeros(12)
    late[3] = 10e-6
    deviations = (GearDeviations(None, PitchDeviations(tuple(late))), None)
    front = MeshSetup(pair, 1, deviations=deviations)
    teeth = np.array([[3, 4], [3, 4]])
    np.testing.assert_allclose(front.pitch_gap(teeth), [10e-6 * np.cos(pair.rack.alpha), 0.0])
    np.testing.assert_allclose(front.opposite.pitch_gap(teeth), -front.pitch_gap(teeth))


def test_back_flanks_by_loads_on_them(tight):
    _, bodies = tight
    ring = bodies.rings()[0]
    profile = bodies.pair.teeth_profiles[0]
    rho = sample_places(profile, 20)
    across = back_compliance(ring, rho, 2)
    assert across.error < 2e-4 * np.abs(bodies.pinion.own(rho)).max()
    right = line_loads(ring, flank_points(ring.mesh, rho[[4, 15]], "right"))
    left = flank_points(ring.mesh, rho[[4, 15]], "left")
    for tooth in (-2, -1, 1, 2):
        moved = right.on_tooth(-tooth, left)
        found = across.across(np.array(tooth), rho[[4, 15]][:, None], rho[[4, 15]])
        np.testing.assert_allclose(moved, found, rtol=2e-3)


def test_large_backlash_costs_nothing_and_changes_nothing(loose):
    pair, bodies = loose
    bodies = replace(bodies)
    cycle = fem.mesh_cycle(pair, 600.0, 10, bodies)
    assert "back_flanks" not in vars(bodies)
    assert cycle.opposite is None
    assert "back flanks" not in cycle.message
    close = GearPair(Gear(36, tip_relief=pair.pinion.tip_relief), Gear(40), 2e-3, 0.04)
    bodies = fem.compliance(close, tolerance=0.005)
    given = MeshSetup(close, 10)
    force = np.array([600.0 / close.base_radii[0]])
    flanks = loaded_flanks(given, bodies, None, 0.6, CornerLaws(given, bodies))
    alone = solve_one_side(given, bodies, force, flanks, CornerLaws(given, bodies))
    cycle = fem.mesh_cycle(close, 600.0, 10, bodies)
    assert np.array_equal(cycle.forces, alone.share.forces.reshape(cycle.forces.shape))
    assert "back flanks stand clear by at least" in cycle.message


@pytest.mark.parametrize("teeth", [(36, 40), (18, 61)])
def test_flanks_that_stay_clear_are_known_without_their_laws(teeth):
    """The bound lies below the gaps of the finer mesh, and is none where less play is left than it doubts."""
    pair = GearPair(Gear(teeth[0]), Gear(teeth[1]), 2e-3, 0.04)
    bodies = fem.compliance(pair, tolerance=0.005)
    given, force = MeshSetup(pair, 12), np.array([50.0, 600.0]) / pair.base_radii[0]
    corner_laws = CornerLaws(given, bodies)
    flanks = loaded_flanks(given, bodies, None, 0.6, corner_laws)
    alone = solve_one_side(given, bodies, force, flanks, corner_laws)
    apart = np.zeros(2, dtype=bool)
    clear = stays_clear(given, bodies, force, None, flanks, alone, apart, 0.6)
    assert "back_flanks" not in vars(bodies)
    true = share_with_opposite(given, bodies, force, None, flanks, alone, apart, 0.6, corner_laws).opposite
    least_gap, gap = clear.contacts.open, true.contacts.open
    assert np.all(least_gap <= gap)
    deflection = alone.share.transmission_error[..., None]
    near = gap < deflection  # no more is in doubt than a few per cent of what bends
    bent = np.broadcast_to(deflection, near.shape)[near]
    assert np.all(gap[near] - least_gap[near] < 0.03 * bent)
    np.testing.assert_allclose(clear.closing, true.closing, rtol=1e-12)
    least = np.min(gap[1])
    for short, free in ((0.5, True), (1.0, False), (1.5, False)):
        turn = alone.share.transmission_error - short * least
        share = replace(alone.share, transmission_error=turn)
        closer = replace(alone, contacts=replace(alone.contacts, share=share))
        known = stays_clear(given, bodies, force, None, flanks, closer, np.array([True, False]), 0.6)
        assert (known is not None) is free


@pytest.mark.slow
def test_gaps_of_flanks_that_stay_clear_hold_what_free_ends_add():
    """Free ends yield more than even loads, by which the bound is known: without their doubt it was too large."""
    pair = GearPair(Gear(36), Gear(40), 2e-3, 4e-3)
    bodies, force = fem.compliance(pair, tolerance=0.02), np.array([60.0 / pair.base_radii[0]])
    setup, apart = MeshSetup(pair, 6, face=face_setting(pair, None, 8, "free-ends")), np.zeros(1, dtype=bool)
    corner_laws = CornerLaws(setup, bodies)
    flanks = loaded_flanks(setup, bodies, None, 0.6, corner_laws)
    alone = solve_one_side(setup, bodies, force, flanks, corner_laws)
    clear = stays_clear(setup, bodies, force, None, flanks, alone, apart, 0.6)
    true = share_with_opposite(setup, bodies, force, None, flanks, alone, apart, 0.6, corner_laws).opposite
    gap, deflection = true.contacts.open, alone.share.transmission_error[..., None]
    near = gap < deflection
    doubted = (gap[near] - clear.contacts.open[near]) / np.broadcast_to(deflection, gap.shape)[near]
    assert np.all(doubted >= 0.0)
    assert np.all(doubted < 0.05)


def testboth_sides_balance_the_torque(tight):
    pair, bodies = tight
    torques = (-600.0, -50.0, -1.0, 0.0, 1.0, 50.0, 600.0)
    cycles = fem.mesh_cycle(pair, torques, 10, bodies)
    moved = np.array([cycle.transmission_error for cycle in cycles])
    assert np.all(np.diff(moved, axis=0) > 0.0)
    for cycle, torque in zip(cycles, torques, strict=True):
        first, second = cycle._moments()
        np.testing.assert_allclose(first[0] * pair.base_radii[0], abs(torque), atol=1e-8)
        np.testing.assert_allclose(cycle.stiffness, second[0], rtol=1e-9)
        assert np.all(cycle.secant_stiffness > 0.0)
    rest = cycles[3]
    assert rest.flank == "front"
    assert "flanks on both sides of the teeth bear at 10 of 10 positions" in rest.message
    assert np.all(rest.opposite_force > 100.0)
    # secants start at the tangent, from where the pressed gears rest
    for cycle in (cycles[2], cycles[4]):
        np.testing.assert_allclose(cycle.secant_stiffness, rest.stiffness, rtol=2e-3)
    sine = np.sin(pair.working_pressure_angle)
    np.testing.assert_allclose(rest.separating_force, (rest.forces.sum(axis=1) + rest.opposite_force) * sine)
    np.testing.assert_allclose(rest.bearing_force, rest.separating_force, rtol=0.05)


def test_pressed_gears_rest_in_the_middle_where_they_are_their_own_mirror(tight):
    pair, bodies = tight
    given = MeshSetup(pair)
    middle = np.array([0.5 * given.mirror % 1.0, (0.5 * given.mirror + 0.5) % 1.0])
    found = solve_contact(given.at(middle), bodies, np.array([0.0]), None)
    # the mean approach of both sides is zero, and both bear alike
    np.testing.assert_allclose(found.share.transmission_error[0, 0], -0.5 * pair.backlash, rtol=2e-4)
    both = found.share.forces[0, 0].sum(axis=-1), found.opposite.share.forces[0, 0].sum(axis=-1)
    np.testing.assert_allclose(*both, rtol=1e-9)
    np.testing.assert_allclose(
        np.sort(found.share.forces[0, 0], axis=-1),
        np.sort(found.opposite.share.forces[0, 0], axis=-1),
        rtol=2e-3,
    )


def test_reversal_of_pressed_gears(tight):
    pair, bodies = tight
    position = np.linspace(0.02, 0.98, 9)
    given, force = MeshSetup(pair), np.array([100.0 / pair.base_radii[0]])
    back = solve_contact(replace(given, back=True).at(position), bodies, force, None)
    front = solve_contact(given.at((given.mirror - position) % 1.0), bodies, force, None)
    np.testing.assert_allclose(back.share.forces, front.share.forces, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(back.opposite.share.forces, front.opposite.share.forces, rtol=1e-9, atol=1e-6)


def test_forces_are_those_of_a_convex_program(tight):
    pair, bodies = tight
    given, force = MeshSetup(pair, 3), 100.0 / pair.base_radii[0]
    corner_laws = CornerLaws(given, bodies)
    flanks, other = (loaded_flanks(one, bodies, None, 0.6, corner_laws) for one in (given, given.opposite))
    both = both_sides(given, bodies, flanks, other)
    found = solve_contact(given, bodies, np.array([force]), None)
    forces = np.concatenate([found.share.forces, found.opposite.share.forces], axis=-1)[0, 0]
    length = 1e-6
    for row in range(3):
        on = np.isfinite(both.gaps[0, row])
        reach = (both.sign * both.lever_ratios[row])[on]
        # with Hertz's slope, which belongs to the energy of a flank, the compliance is definite
        whole = both.matrix[row] + np.diag(both.laws.slope(np.maximum(forces, 1.0))[row])
        assert np.linalg.eigvalsh(whole[np.ix_(on, on)]).min() > 0.0
        size = forces[row].max()

        def gaps(x, row=row, on=on, size=size):
            loads = np.zeros((3, len(on)))
            loads[row, on] = size * np.maximum(x, 0.0)
            local = both.laws.approach(loads)[row, on]
            return both.matrix[row][np.ix_(on, on)] @ loads[row, on] + local + both.gaps[0, row, on]

        def energy(x):
            # integral of the gaps' closing along a straight path from no force, whose Hertz part is smooth
            t, weight = np.polynomial.legendre.leggauss(12)
            t, weight = 0.5 * (t + 1), 0.5 * weight
            return sum(w * (gaps(s * x) @ x) for s, w in zip(t, weight, strict=True)) / length

        by_scipy = minimize(
            energy,
            np.full(on.sum(), 0.5),
            jac=lambda x: gaps(x) / length,
            bounds=[(0.0, None)] * int(on.sum()),
            constraints={
                "type": "eq",
                "fun": lambda x, reach=reach, size=size: reach @ x - force / size,
                "jac": lambda x, reach=reach: reach,
            },
            method="SLSQP",
            options={"ftol": 1e-14, "maxiter": 300},
        )
        np.testing.assert_allclose(by_scipy.x, forces[row, on] / size, atol=1e-3)


def test_tangent_ofboth_sides_is_the_derivative(tight):
    pair, bodies = tight
    less, here, more = fem.mesh_cycle(pair, (99.9, 100.0, 100.1), 10, bodies)
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(here.stiffness, slope, rtol=1e-4)


def test_figures_of_pressed_gears(tight):
    pair, bodies = tight
    found = [fem.mesh_cycle(pair, torque, 10, bodies) for torque in (0.0, 30.0)]
    for cycle in found:
        assert cycle.mean_stiffness == pytest.approx(cycle.stiffness.mean(), rel=0.02)
        assert cycle.errors["mean_stiffness"] < 1e-3
        against = cycle.against("teeth")
        assert against.mean_stiffness > cycle.mean_stiffness


def test_a_film_pressesboth_sides(tight):
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    bodies = fem.compliance(pair, tolerance=0.005)

    def film(rho1, force):
        return np.full_like(force, 3e-6), np.zeros_like(force)

    cycle = fem.mesh_cycle(pair, 50.0, 10, bodies, beyond_path=False, film=film)  # tip edges are dry
    assert np.all(cycle.opposite_force > 0.0)
    # as teeth that are thicker by the two films
    thick = pressed(6e-6)
    thick = fem.mesh_cycle(thick, 50.0, 10, fem.compliance(thick, tolerance=0.005), beyond_path=False)
    np.testing.assert_allclose(cycle.opposite_force, thick.opposite_force, rtol=2e-3)


def test_a_film_that_floats_gears_in_their_backlash_is_no_deflection(loose):
    """Films thicken without bound as pairs let go; the secant was counted from where they float, 50 um away."""
    pair, bodies = loose

    def film(rho1, force):
        ratio = np.maximum(force / 20.0, 1e-2)
        thick = 2e-6 / ratio
        return np.where(np.isfinite(rho1), thick, 0.0), np.where(
            force > 0.2, -thick / np.maximum(force, 0.2), 0.0
        )

    dry, oily = (fem.mesh_cycle(pair, 20.0, 10, bodies, film=one) for one in (None, film))
    play = pair.backlash
    assert film(np.zeros(1), np.zeros(1))[0] > play
    # what the film yields is not in this secant: it is above the dry one, by no more than the film itself
    np.testing.assert_array_less(dry.secant_stiffness, oily.secant_stiffness)
    np.testing.assert_allclose(oily.force / oily.secant_stiffness, oily.transmission_error, rtol=1e-12)


def test_weak_bearings_let_pressed_gears_part():
    pair = pressed(5e-6)
    rigid, weak = (
        fem.mesh_cycle(pair, 0.0, 4, fem.compliance(pair, tolerance=0.02, supports=support))
        for support in (None, fem.Support(radial_stiffness=2e8))
    )
    assert np.all(weak.bearing_force < 0.8 * rigid.bearing_force)


def test_whatboth_sides_refuse(tight, loose):
    pair, bodies = tight
    with pytest.raises(InputError, match="must not be 0 where no flank bears: there is backlash of 50 um"):
        fem.mesh_cycle(loose[0], 0.0, 4, loose[1])
    cycle = fem.mesh_cycle(pair, 10.0, 4, bodies)
    with pytest.raises(InputError, match="flanks that bear on both sides"):
        fem.root_stress(pair, cycle, tolerance=0.1)


def test_back_flanks_on_the_whole_annulus_factorised_at_once():
    profile = GearPair(Gear(18, 0.2, bore_radius=0.008), Gear(24), 2e-3, 0.04).teeth_profiles[0]
    law = PlaneElasticity("strain", 206e9, 0.3)
    sector = mesh_sector(profile, refinements=1)
    gear = gear_mesh(sector)
    stiffness = stiffness_matrix(gear.points, gear.triangles, law, gear.thickness)
    hub = np.unique(gear.facets["bore"])
    free = np.setdiff1d(np.arange(2 * len(gear.points)), np.concatenate([2 * hub, 2 * hub + 1]))
    rho = sample_places(profile, 20)
    load = flank_points(sector, rho[[12]], "left")
    force = np.zeros((len(gear.points), 2))
    force[gear.nodes[0][load.nodes[0]]] += load.weights[0][:, None] * load.inward[0]
    moved = np.zeros(2 * len(gear.points))
    moved[free] = spsolve(
        csc_array(stiffness[free][:, free]), force.ravel()[free], permc_spec="MMD_AT_PLUS_A"
    )
    across = back_compliance(ring_of(sector, law), rho, 2)
    seen = flank_points(sector, rho[[3, 9, 16]], "right")
    for tooth in range(-2, 3):
        whole = moved.reshape(-1, 2)[gear.nodes[tooth % 18]]
        found = seen.component(turned(whole, -tooth * profile.pitch_angle))
        mine = across.across(np.array(tooth), rho[[12]], rho[[3, 9, 16]])
        np.testing.assert_allclose(mine, found, rtol=2e-3)
