"""Contacts that move under load: the energies behind the law, its derivatives, its limits, and the cycle."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.moving_contact import contact_moves, contacts_move, model_error
from fem.contact.moving_contacts import MovingContacts
from fem.elasticity import flamant, nonlinear_energy
from fem.elasticity.nonlinear_energy import densities, half_plane, hertz_rotation
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.ring import ring_of
from fem.influence.flank_motion import flank_motion
from fem.laws.contact_candidates import contact_candidates
from fem.laws.local_law import PairLaws
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearPair, Material, share_load
from gears.sharing.active_set import share_forces
from gears.sharing.load_coupling import DenseCoupling
from meshes import Sizes, mesh_sector

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
PLASTIC = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66))


@pytest.fixture(scope="module")
def plastic():
    return fem.compliance(PLASTIC, tolerance=0.01)


def alone(bodies, position, torque, staying=False):
    """One pair at a position: without and with its contact moving, and the moves."""
    pair = bodies.pair
    rho1 = pair.points.A + position * pair.base_pitch
    rho = np.array([[[rho1]], [[pair.line_of_action - rho1]]])
    yes, no = np.ones((1, 1), dtype=bool), np.zeros((1, 1), dtype=bool)
    where = replace(contact_candidates(MeshSetup(pair, 1, False)), rho=rho, touchable=yes, edge=no)
    moves, laws = contact_moves(bodies, where), PairLaws(bodies.hertz(rho[0]))
    force, bulk, gaps = np.array([torque / pair.base_radii[0]]), bodies.bulk(rho[0]), np.zeros((1, 1))
    stays = share_load(force, bulk, laws, gaps)
    if staying:
        return stays
    contacts = MovingContacts(
        1,
        DenseCoupling(bulk),
        DenseCoupling(moves.roll),
        laws,
        None,
        gaps,
        gaps,
        0.0,
        yes,
        np.ones((1, 1)),
        np.ones((1, 1)),
        moves,
        np.ones((1, 1, 1, 1)),
        None,
    )
    moved = share_forces(contacts, force, stays.forces, stays.transmission_error)
    assert moved is not None
    return stays, moved, moves


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.45])
def test_energy_of_the_half_plane_by_quadrature(plane, nu):
    law = PlaneElasticity(plane, 2.5e9, nu)
    a, inward = 0.7e-3, np.array([0.6, -0.8])
    # elliptic coordinates about the edges of the pressure, on which the stress is smooth
    mu, mu_weight = np.polynomial.legendre.leggauss(100)
    mu, mu_weight = 9.0 * (1 + mu), 9.0 * mu_weight
    theta, theta_weight = np.polynomial.legendre.leggauss(60)
    theta, theta_weight = 0.5 * np.pi * (1 + theta), 0.5 * np.pi * theta_weight
    m, t = np.meshgrid(mu, theta, indexing="ij")
    x, z = a * np.cosh(m) * np.cos(t), a * np.sinh(m) * np.sin(t)
    area = a**2 * (np.sinh(m) ** 2 + np.sin(t) ** 2) * mu_weight[:, None] * theta_weight
    points = (x[..., None] * np.array([0.8, 0.6]) + z[..., None] * inward).reshape(-1, 2)
    peak = 2 / (np.pi * a)
    stress = flamant.hertz_stress(points, np.zeros(2), inward, a, peak)
    turn = hertz_rotation(points, np.zeros(2), inward, a, peak, law)
    mean = law.plane_poisson * np.trace(stress, axis1=1, axis2=2)
    parts = [
        ((1 + law.plane_poisson) * stress[:, i, j] - (mean if i == j else 0.0)) / law.plane_modulus
        for i, j in ((0, 0), (1, 1), (0, 1))
    ]
    found = densities(tuple(parts), turn, law) @ area.ravel()
    np.testing.assert_allclose(half_plane(law) / a, found, rtol=1e-5)


def test_rotation_under_the_pressure_is_that_of_the_line_load_far_away():
    law = PlaneElasticity("strain", 2.5e9, 0.4)
    a, inward, h = 1e-3, np.array([0.6, -0.8]), 1e-6
    points = np.array([[0.03, 0.01], [0.05, -0.02], [-0.01, -0.04]])
    points = points[points @ inward > 0]
    steps = [
        (flamant.displacement(points + h * e, np.zeros(2), inward, law, 1e-3)
         - flamant.displacement(points - h * e, np.zeros(2), inward, law, 1e-3)) / (2 * h)
        for e in np.eye(2)
    ]  # fmt: skip
    expected = 0.5 * (steps[0][:, 1] - steps[1][:, 0])
    found = hertz_rotation(points, np.zeros(2), inward, a, 2 / (np.pi * a), law)
    np.testing.assert_allclose(found, expected, rtol=2e-3)


@pytest.mark.slow
def test_energy_of_a_gear_that_is_turned_as_a_whole(monkeypatch):
    """The load, held in its direction, then works along the flank: the energy changes by psi t.

    Not at the flank's foot, whose radius is not large beside the pressure's half-width.
    """
    profile, law = PLASTIC.teeth_profiles[0], PlaneElasticity.of(PA66, "strain")
    ring = ring_of(mesh_sector(profile, Sizes(), 3), law)
    monkeypatch.setattr(nonlinear_energy, "NEIGHBOURS", 8)  # all teeth of the ring
    straight, psi, found = nonlinear_energy._strained, 1.0 / law.E, []
    for sign in (1, -1):

        def turned(slopes, by=sign * psi):
            strain, turn = straight(slopes)
            return strain, turn + by

        monkeypatch.setattr(nonlinear_energy, "_strained", turned)
        motion = flank_motion(ring)
        found.append(motion.energy(np.linspace(*motion.rho_range, 5)[1:])[0])
    along = motion.tangential(np.linspace(*motion.rho_range, 5)[1:])
    np.testing.assert_allclose(np.abs(found[0] - found[1]) / (2 * psi), along, rtol=0.01)


def test_a_contact_that_rolls_on_yields_by_the_slope_of_its_compliance(plastic):
    """B' of one pair: the pinion's flank rolls on and the wheel's stays, which changes Hertz's part by ln(R) alone."""
    moves = alone(plastic, 0.8, 20.0)[2]
    rho1 = PLASTIC.points.A + 0.8 * PLASTIC.base_pitch
    rho2, gears = PLASTIC.line_of_action - rho1, (plastic.pinion, plastic.wheel)
    reduced = 2.0 / sum(1.0 / gear.law.plane_modulus for gear in gears)

    def yielded(rho):
        a = flamant.hertz_half_width(1e5, rho * rho2 / (rho + rho2), reduced)
        local = sum(flamant.hertz_indentation(a, gear.law, PLASTIC.module) for gear in gears)
        return local + float(plastic.pinion.own(np.array([rho]))[0])

    slope = (yielded(rho1 + 1e-7) - yielded(rho1 - 1e-7)) / 2e-7
    assert moves.roll[0, 0, 0] * PLASTIC.face_width == pytest.approx(slope, rel=1e-4)


def test_tangent_is_the_derivative(plastic):
    torque, step = 20.0, 1e-3
    less, same, more = (alone(plastic, 0.8, torque * (1 + s))[1] for s in (-step, 0.0, step))
    rise = (more.transmission_error - less.transmission_error) / (2 * step * torque / PLASTIC.base_radii[0])
    np.testing.assert_allclose(1 / same.stiffness, rise, rtol=1e-6)


def test_first_order_in_the_load(plastic):
    """What moves and strains adds in proportion to the load, its part next to the contact to the root of it."""
    torques, changes = np.array([0.02, 0.08, 0.32]), []
    for torque in torques:
        stays, moved, _ = alone(plastic, 0.8, torque)
        changes.append(float(stays.transmission_error[0] - moved.transmission_error[0]))
        assert abs(changes[-1]) < 1e-3 * moved.transmission_error[0]
    powers = np.stack([torques**2, torques**1.5], axis=1)
    np.testing.assert_allclose(powers[2] @ np.linalg.solve(powers[:2], changes[:2]), changes[2], rtol=0.03)


def test_both_conventions_differ_by_the_slope_of_the_stiffness(plastic):
    """The wheel turned back at x is the pinion turned at x - D."""
    torque = 2.0
    pinion = alone(plastic, 0.8, torque)[1]
    away = float(pinion.transmission_error[0]) / PLASTIC.base_pitch
    wheel = alone(plastic, 0.8 - away, torque)[1]
    ends = [alone(plastic, 0.8 + s, torque, staying=True) for s in (-0.5 * away, 0.5 * away)]
    slope = np.log(ends[0].transmission_error / ends[1].transmission_error) / away
    between = np.log(wheel.transmission_error / pinion.transmission_error)
    np.testing.assert_allclose(between, slope * away, rtol=0.03)


@pytest.mark.parametrize("materials", [(STEEL, PA66), (PA66, STEEL), (PA66, PA66), (STEEL, STEEL)])
def test_the_default_is_by_the_softer_material(materials):
    pair = replace(PLASTIC, material=materials)
    assert contacts_move(pair, None) is (materials != (STEEL, STEEL))
    for asked in (False, True):
        assert contacts_move(pair, asked) is asked


def test_plastics_move_and_metals_stay_for_one_torque_and_for_several(plastic):
    asked = fem.mesh_cycle(PLASTIC, 10.0, 4, plastic, beyond_path=False, moving_contact=True)
    plain = fem.mesh_cycle(PLASTIC, 10.0, 4, plastic, beyond_path=False)
    _, among = fem.mesh_cycle(PLASTIC, (5.0, 10.0), 4, plastic, beyond_path=False)
    assert plain.moving_contact
    for cycle in (plain, among):
        np.testing.assert_allclose(cycle.stiffness, asked.stiffness, rtol=1e-9)
    steel = replace(PLASTIC, material=STEEL)
    assert not fem.mesh_cycle(steel, 10.0, 4, fem.compliance(steel, tolerance=0.05)).moving_contact


class TestCycle:
    @pytest.fixture(scope="class")
    def cycles(self, plastic):
        return {
            moving: fem.mesh_cycle(PLASTIC, 10.0, 8, plastic, moving_contact=moving)
            for moving in (False, True)
        }

    def test_shares_and_places(self, cycles):
        stays, moves = cycles[False], cycles[True]
        assert moves.converged, moves.message
        np.testing.assert_allclose(moves.load_share.sum(axis=1), 1.0, rtol=1e-10)
        loaded = np.isfinite(moves.rho1) & (moves.forces > 0)
        rolled = (moves.flank_rho - stays.flank_rho)[:, loaded]
        assert np.all(rolled[0] > 0)  # the stiff pinion, turned by D
        assert np.all(np.abs(rolled) < 3 * moves.transmission_error.max())
        np.testing.assert_array_equal(moves.rho1, stays.rho1)

    def test_the_model_error_of_contacts_that_stay_holds_what_their_motion_changes(self, cycles):
        stays, moves = cycles[False], cycles[True]
        change = np.max(np.abs(moves.secant_stiffness / stays.secant_stiffness - 1))
        assert 0.5 * change < stays.model_error < 4 * change
        assert moves.model_error < stays.model_error

    def test_large_deflections_are_told(self, plastic):
        cycle = fem.mesh_cycle(PLASTIC, 40.0, 4, plastic, moving_contact=True)
        assert "modules" in cycle.message
        assert "half-width" in cycle.message

    def test_far_too_large_deflections_are_refused(self, plastic):
        cycle = fem.mesh_cycle(PLASTIC, 2000.0, 4, plastic, beyond_path=False, moving_contact=True)
        assert not cycle.converged
        assert "first order" in cycle.message
        assert np.all(np.isnan(cycle.stiffness))

    def test_steel_hardly_changes(self, article_pair):
        bodies = fem.compliance(article_pair, tolerance=0.01)
        stays, moves = (
            fem.mesh_cycle(article_pair, 600.0, 8, bodies, moving_contact=moving, reference="bore")
            for moving in (False, True)
        )
        np.testing.assert_allclose(moves.secant_stiffness, stays.secant_stiffness, rtol=4e-3)
        assert moves.model_error < 4e-3


def test_model_error_holds_the_large_strain_law(plastic):
    _, moved, moves = alone(plastic, 0.8, 20.0)
    found = model_error(moves, moved.forces, moved.transmission_error, True)
    law = moves.thrust(moved.forces, 1)[0] / moved.transmission_error
    assert found >= abs(float(law.ravel()[0]))


def test_the_hubs_of_moving_contacts_carry_the_whole_torque(plastic):
    """The tilted flank's shorter lever and the law agree on it, whatever the deflection is measured against."""
    options = {"beyond_path": False, "moving_contact": True, "reference": "bore"}
    held = fem.mesh_cycle(PLASTIC, 10.0, 8, plastic, **options)
    teeth = held.against("teeth")
    np.testing.assert_allclose(
        held.transmission_error - teeth.transmission_error,
        sum(plastic.hub_windup) * held.force,
        rtol=1e-10,
    )
    part = 1e-4
    less, more = (
        fem.mesh_cycle(
            PLASTIC, 10.0 * (1 + s), 8, plastic, beyond_path=False, moving_contact=True, reference="teeth"
        )
        for s in (-part, part)
    )
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(teeth.stiffness, slope, rtol=1e-6)
