"""Figures of a mesh cycle beside its stiffness: pressures, sliding, friction and losses, torque sweeps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.elasticity.line_load import flank_points, line_loads
from fem.elasticity.ring import mesh_and_factor
from gears import Gear, GearPair, Material
from meshes import Sizes


@pytest.fixture(scope="module")
def held(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False)


@pytest.fixture(scope="module")
def free(article_pair, article_bodies):
    return fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)


@pytest.mark.parametrize("name", ["stiffness", "secant_stiffness", "transmission_error"])
def test_harmonics_are_those_of_the_arcs_and_whoever_changes_them_changes_his_own(held, name):
    found, errors = (getattr(held, f"{name}_harmonics{end}") for end in ("", "_error"))
    size, error = held.arcs.amplitudes(name, np.arange(1, found.size + 1), name != "transmission_error")
    np.testing.assert_array_equal(found, size)
    np.testing.assert_array_equal(errors, error)
    found[:] = errors[:] = -1.0
    np.testing.assert_array_equal(getattr(held, f"{name}_harmonics"), size)
    np.testing.assert_array_equal(getattr(held, f"{name}_harmonics_error"), error)


def test_hertz_pressure_at_the_pitch_point(article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 41, article_bodies, beyond_path=False)
    row, column = np.unravel_index(np.nanargmin(np.abs(cycle.rho1 - article_pair.points.C)), cycle.rho1.shape)
    load = cycle.forces[row, column] / 0.04
    path = article_pair.path_at(cycle.rho1[row, column])
    modulus = article_pair.reduced_modulus
    a = np.sqrt(8 * load * path.radius[0] / (np.pi * modulus))
    assert cycle.half_width[row, column] == pytest.approx(a, rel=1e-12)
    # the pressure's ellipse carries the load
    assert 0.5 * np.pi * a * cycle.hertz_pressure[row, column] == pytest.approx(load, rel=1e-12)
    np.testing.assert_array_equal(np.isfinite(cycle.half_width), cycle.forces > 0)


def test_tip_edges_have_no_hertz_pressure(free):
    pressed = free.edge & (free.forces > 0)
    assert pressed.any()
    assert np.all(np.isnan(free.hertz_pressure[free.edge]))
    assert np.all(np.isfinite(free.hertz_pressure[~free.edge & (free.forces > 0)]))


def test_plane_stress_presses_with_its_own_modulus():
    steel, iron = Material(206e9, 0.3, 7850.0), Material(120e9, 0.25, 7200.0)
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.004, material=(steel, iron))
    cycle = fem.mesh_cycle(pair, 40.0, 5, beyond_path=False, plane="stress", tolerance=0.01)
    on = cycle.forces > 0
    radius = cycle.flank_rho[0] * cycle.flank_rho[1] / pair.line_of_action
    modulus = 2 / (1 / 206e9 + 1 / 120e9)
    wanted = np.sqrt(cycle.forces / 0.004 * modulus / (2 * np.pi * radius))
    np.testing.assert_allclose(cycle.hertz_pressure[on], wanted[on], rtol=1e-12)


def test_sliding_on_the_path_is_that_of_the_path_of_contact(article_pair, held):
    on = np.isfinite(held.rho1)
    path = article_pair.path_at(held.rho1[on])
    np.testing.assert_allclose(held.sliding(210.0)[on], path.sliding(210.0), atol=1e-12)
    first, second = path.surface_speeds(1.0)
    np.testing.assert_allclose(held.specific_sliding[0][on], 1 - second / first, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(held.specific_sliding[1][on], 1 - first / second, rtol=1e-9, atol=1e-12)


def test_sliding_at_tip_edges_is_that_of_two_turning_bodies(article_pair, free):
    """Velocities of the tip and of the touched flank at one point, by their own distances from the axes."""
    radii = article_pair.base_radii
    distance = article_pair.working_centre_distance
    for row, column in np.argwhere(free.edge):
        rho = free.flank_rho[:, row, column]
        r1, r2 = (np.hypot(base, one) for base, one in zip(radii, rho, strict=True))
        # the touched flank's tangent: its normal passes the axis at the base radius
        y = (r1**2 - r2**2 + distance**2) / (2 * distance)
        point = np.array([np.sqrt(r1**2 - y**2), y])
        omega = 1.0, -radii[0] / radii[1]
        first = omega[0] * np.array([-point[1], point[0]])
        second = omega[1] * np.array([-(point[1] - distance), point[0]])
        ahead = free.pair_offset[column] > 0
        axis, base, mine = (
            (np.array([0.0, distance]), radii[1], rho[1]) if ahead else (np.zeros(2), radii[0], rho[0])
        )
        arm = point - axis
        # two normals pass at that distance; the sliding along the wrong one is quite different
        found = []
        for side in (1.0, -1.0):
            angle = side * np.arctan2(base, mine)
            normal = np.array(
                [
                    arm[0] * np.cos(angle) - arm[1] * np.sin(angle),
                    arm[0] * np.sin(angle) + arm[1] * np.cos(angle),
                ]
            ) / np.linalg.norm(arm)
            tangent = np.array([-normal[1], normal[0]])
            found.append(abs((first - second) @ tangent))
        wanted = abs(free.sliding(1.0)[row, column])
        # the corner stands where the pair would be without the gap: 1e-2 of the way at the most
        assert min(abs(np.array(found) - wanted)) < 0.03 * wanted


def test_torque_on_the_wheel_without_friction(article_pair, held, free):
    """Held to the path it is the ratio. Tip edges press beside the line of action: only the mean is exact.

    Nothing is lost, so over a cycle the work of both torques is the same (principle of virtual work); that
    ties the levers, the gaps and the laws of the edges together, which are computed apart.
    """
    np.testing.assert_allclose(held.wheel_torque, 600.0 * 40 / 36, rtol=1e-12)
    off = free.wheel_torque / (600.0 * 40 / 36) - 1
    assert np.abs(off).max() > 5e-3
    assert abs(off.mean()) < 1e-4


def test_losses_are_what_the_wheel_does_not_get(article_pair, article_bodies):
    for mu in (0.03, 0.1):
        cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False, friction=mu)
        put_in, got = 600.0 * 200.0, cycle.wheel_torque * 200.0 * 36 / 40
        np.testing.assert_allclose(put_in - got, cycle.friction_loss(200.0), rtol=1e-9)
        assert cycle.efficiency == pytest.approx(np.mean(got) / put_in, rel=1e-12)
        # every pair's friction turns with its sliding: moments about the pinion's axis
        slip = np.sign(np.where(np.isfinite(cycle.rho1), cycle.rho1, 1.0) - article_pair.points.C)
        arm = article_pair.base_radii[0] + mu * slip * np.nan_to_num(cycle.rho1)
        np.testing.assert_allclose(np.sum(cycle.forces * arm, axis=1), 600.0, rtol=1e-10)
        np.testing.assert_allclose(cycle.load_share.sum(axis=1), 1.0, rtol=1e-10)
    free = fem.mesh_cycle(article_pair, 600.0, 400, article_bodies, friction=0.1)
    lost = 1 - np.mean(free.wheel_torque) / (600.0 * 40 / 36)
    assert lost == pytest.approx(1 - free.efficiency, abs=1e-4)
    assert "lever arms only" in free.message


def test_loss_against_the_formula_of_even_shares(article_pair, article_bodies):
    """mu pi (1/z1 + 1/z2)(1 - eps + eps1^2 + eps2^2) takes half of the load for each of two pairs (Niemann).

    Ours carries less far from C, where it slides most, but the difference is small.
    """
    points, pitch = article_pair.points, article_pair.base_pitch
    first, second = (points.E - points.C) / pitch, (points.C - points.A) / pitch
    even = 0.05 * np.pi * (1 / 36 + 1 / 40) * (1 - first - second + first**2 + second**2)
    cycle = fem.mesh_cycle(article_pair, 600.0, 200, article_bodies, beyond_path=False, friction=0.05)
    assert 0.9 < (1 - cycle.efficiency) / even < 1.0


def test_friction_eases_before_C_and_loads_after_it(article_pair, article_bodies, held):
    """The pinion drives: in approach friction takes from the lever, so a pair alone presses more."""
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False, friction=0.1)
    alone = np.flatnonzero((held.forces > 0).sum(axis=1) == 1)
    force = cycle.forces[alone].max(axis=1) / held.force
    rho1 = np.nansum(np.where(cycle.forces[alone] > 0, cycle.rho1[alone], 0.0), axis=1)
    lever = 0.1 * rho1 / article_pair.base_radii[0]
    np.testing.assert_allclose(force, 1 / (1 + np.sign(rho1 - article_pair.points.C) * lever), rtol=1e-10)
    assert force.max() > 1.02
    assert force.min() < 0.98


def test_friction_opposes_the_sliding_of_the_placed_gears(article_pair, article_bodies):
    """Direction and moment from velocities and points in the common frame, no formula of ours."""
    mu = 0.1
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies, beyond_path=False, friction=mu)
    for row in (12, 18, 22, 27):
        moment = 0.0
        for k in np.flatnonzero(cycle.forces[row] > 0):
            place = article_pair.placement(float(cycle.rho1[row, k]))
            p, q = place.contact_point, place.contact_point - place.wheel_centre
            slip = np.array([-p[1], p[0]]) + 36 / 40 * np.array([-q[1], q[0]])  # of the pinion's surface
            assert np.linalg.norm(slip) == pytest.approx(abs(cycle.sliding(1.0)[row, k]), rel=1e-9)
            assert abs(slip @ place.normal) < 1e-12
            drag = -slip / np.linalg.norm(slip)
            force = cycle.forces[row, k] * (-place.normal + mu * drag)
            moment += p[0] * force[1] - p[1] * force[0]
            towards_tip = drag @ p > 0
            assert towards_tip == (cycle.rho1[row, k] > article_pair.points.C)
        assert moment == pytest.approx(-600.0, rel=1e-9)


def test_what_teeth_yield_to_tangential_forces_is_small(article_pair, article_bodies):
    """The part that friction leaves out: 0.35 mu of a pair's deflection at the ends, nothing at C.

    By Maxwell and Betti it is the tangential displacement, towards the tip, under a normal load. In approach
    friction points to the pinion's root and to the wheel's tip.
    """
    rings = mesh_and_factor(article_pair, "strain", Sizes(), 1)
    rho1 = np.array([article_pair.points.A + 1e-4, article_pair.points.C, article_pair.points.E - 1e-4])
    towards_tip = []
    for ring, rho in zip(rings, (rho1, article_pair.line_of_action - rho1), strict=True):
        at = flank_points(ring.mesh, rho)
        along = np.stack([-at.inward[:, 1], at.inward[:, 0]], axis=1)
        along *= np.sign(np.einsum("na,na->n", along, at.points))[:, None]
        loads = line_loads(ring, at)
        towards_tip.append(np.diagonal(loads.on_tooth(0, replace(at, inward=along))))
    force = 17736.3
    deflection = force / fem.single_pair_stiffness(article_pair, force, rho1, article_bodies)
    part = (towards_tip[1] - towards_tip[0]) * force / 0.04 / deflection
    np.testing.assert_allclose(part, [0.35, 0.0, -0.35], atol=0.01)  # times mu, in recess times -mu


def test_tangent_with_friction_is_the_derivative(article_pair, article_bodies):
    low, mid, high = fem.mesh_cycle(
        article_pair, [599.99, 600.0, 600.01], 40, article_bodies, False, friction=0.2
    )
    slope = (high.force - low.force) / (high.transmission_error - low.transmission_error)
    np.testing.assert_allclose(mid.stiffness, slope, rtol=1e-6)


@pytest.mark.parametrize("beyond", [False, True])
def test_a_sweep_is_its_torques_one_by_one(article_pair, article_bodies, beyond):
    torques = [1e-6, 600.0, 1.0, 3000.0]
    sweep = fem.mesh_cycle(article_pair, torques, 20, article_bodies, beyond)
    for torque, cycle in zip(torques, sweep, strict=True):
        alone = fem.mesh_cycle(article_pair, torque, 20, article_bodies, beyond)
        assert cycle.torque == torque
        for name in ("transmission_error", "stiffness", "secant_stiffness"):
            np.testing.assert_allclose(getattr(cycle, name), getattr(alone, name), rtol=1e-8)
        np.testing.assert_allclose(cycle.forces, alone.forces, rtol=1e-7, atol=1e-9 * cycle.force)
        assert cycle.message == alone.message


def test_a_sweep_refuses_only_the_torques_that_are_too_large(article_pair, article_bodies):
    fine, wild = fem.mesh_cycle(article_pair, [600.0, 2e6], 8, article_bodies)
    assert fine.converged
    assert not wild.converged
    assert np.all(np.isnan(wild.transmission_error))
    np.testing.assert_allclose(
        fine.transmission_error,
        fem.mesh_cycle(article_pair, 600.0, 8, article_bodies).transmission_error,
        rtol=1e-9,
    )


def test_a_film_is_swept_too(article_pair, article_bodies):
    def film(rho1, forces):
        assert rho1.shape == forces.shape
        assert rho1.ndim == 2
        return 2e-6 * (1 + forces / 10.0) ** -0.13, -0.26e-7 * (1 + forces / 10.0) ** -1.13

    sweep = fem.mesh_cycle(article_pair, [10.0, 600.0], 10, article_bodies, film=film)
    for cycle in sweep:
        alone = fem.mesh_cycle(article_pair, cycle.torque, 10, article_bodies, film=film)
        np.testing.assert_allclose(cycle.transmission_error, alone.transmission_error, rtol=1e-9)
