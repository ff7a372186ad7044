"""Both sides of the teeth on cells of the face: the plane's where loads are even, the same seen from either side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.solver import solve_contact
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Alignment, Gear, GearPair, Lead, Material

CELLS = 8
STEEL, POM = Material(206e9, 0.3, 7850.0), Material(2.8e9, 0.36, 1410.0)


def pressed(overlap, first=36, second=40, module=2e-3, width=0.04, **more):
    """Pair whose teeth overlap [m]."""
    plain = GearPair(Gear(first), Gear(second), module, width, **more)
    return replace(plain, centre_distance=plain.centre_distance_of_backlash(-overlap), tight=True)


@pytest.fixture(scope="module")
def tight():
    pair = pressed(5e-6)
    return pair, fem.compliance(pair, tolerance=0.02)


def cycle(tight, torque, model="walls", cells=CELLS, positions=6, **more):
    return fem.mesh_cycle(tight[0], torque, positions, tight[1], cells=cells, face_model=model, **more)


@pytest.mark.parametrize("model", ["walls", "slices"])
def test_even_loads_are_the_plane_s(tight, model):
    torques = (0.0, 100.0, -100.0, 600.0)
    plane = fem.mesh_cycle(tight[0], torques, 6, tight[1])
    for even, over in zip(plane, cycle(tight, torques, model), strict=True):
        assert over.converged, over.message
        assert np.any(over.opposite_force > 0.0)
        for name in ("transmission_error", "stiffness", "secant_stiffness", "forces", "opposite_force"):
            exact = getattr(even, name)
            np.testing.assert_allclose(getattr(over, name), exact, rtol=1e-9, atol=1e-9 * np.abs(exact).max())
        np.testing.assert_allclose(over.face_load_factor, 1.0, atol=1e-9)


def test_pressed_gears_are_the_same_seen_from_either_side(tight):
    """Without a torque no side is the loaded one: its forces are those of the other seen from there, cell by cell."""
    pair, bodies = tight
    face = face_setting(pair, Alignment(15e-6, 10e-6), CELLS, "walls")
    setup = MeshSetup(pair, face=face, two_sided=True).at(np.linspace(0.02, 0.98, 5))
    here, there = (solve_contact(each, bodies, np.zeros(1), None) for each in (setup, setup.opposite))
    first, second = (
        tuple(side.cell_forces(0)[None] for side in (state, state.opposite)) for state in (here, there)
    )
    size = first[0].max()
    np.testing.assert_allclose(first[0], second[1], rtol=1e-7, atol=1e-9 * size)
    np.testing.assert_allclose(first[1], second[0], rtol=1e-7, atol=1e-9 * size)
    assert not np.allclose(first[0].sum(axis=-2)[..., 0], first[0].sum(axis=-2)[..., -1], rtol=0.1)


@pytest.mark.parametrize(
    ("torque", "model"),
    [
        (0.0, "walls"),
        (50.0, "walls"),
        (-50.0, "walls"),
        pytest.param(50.0, "free-ends", marks=pytest.mark.slow),
    ],
)
def test_forces_balance_the_torque_and_nothing_overlaps(tight, torque, model):
    pair = tight[0]
    over = cycle(tight, torque, model, alignment=Alignment(20e-6))
    assert over.converged, over.message
    moments = over._moments()[0] * np.array(pair.base_radii)[:, None]
    np.testing.assert_allclose(moments[0], abs(torque), atol=1e-9 * over.forces.max() * pair.base_radii[0])
    face = over.face
    assert np.all(face.line_load >= 0.0)
    assert np.all(face.gap[face.line_load > 0.0] == 0.0)
    np.testing.assert_allclose(
        face.line_load.sum(axis=-1) * pair.face_width / CELLS, over.forces, rtol=1e-12, atol=1e-9
    )


def test_the_tangent_is_the_derivative(tight):
    step, torque = 1e-3, 60.0
    torques = [torque * (1 + s) for s in (-step, 0.0, step)]
    less, same, more = cycle(tight, torques, alignment=Alignment(20e-6))
    rise = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(same.stiffness, rise, rtol=1e-3)  # how far cells rise that bear in part


def test_axes_out_of_parallel_press_the_other_flanks_at_the_other_end(tight):
    """The loaded flanks are nearer at z < 0, those behind the teeth at z > 0, where bending teeth leave them apart."""
    pair, bodies = tight
    face = face_setting(pair, Alignment(20e-6), CELLS, "walls")
    state = solve_contact(MeshSetup(pair, 4, face=face), bodies, np.zeros(1), None)
    front, back = (side.contacts.forces[0, 0].sum(axis=1) for side in (state, state.opposite))
    half = CELLS // 2
    assert np.all(front[:, :half].sum(axis=-1) > 1.2 * front[:, half:].sum(axis=-1))
    assert np.all(back[:, half:].sum(axis=-1) > 1.02 * back[:, :half].sum(axis=-1))


def test_crowned_teeth_stay_symmetric(tight):
    pair, bodies = tight
    crowned = replace(pair, wheel=replace(pair.wheel, lead=Lead(crowning=10e-6)))
    over = fem.mesh_cycle(crowned, 20.0, 4, replace(bodies, pair=crowned), cells=CELLS, face_model="walls")
    assert over.converged, over.message
    assert np.any(over.opposite_force > 0.0)
    np.testing.assert_allclose(over.line_load, over.line_load[..., ::-1], rtol=1e-7, atol=1e-3)


def test_backlash_that_an_alignment_takes_up_at_one_end_is_seen():
    """Alike over the face 20 um are left behind the teeth; axes 80 um out of parallel press both ends."""
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(20e-6)
    bodies = fem.compliance(replace(pair, tight=True), tolerance=0.02)
    even = fem.mesh_cycle(bodies.pair, 30.0, 4, bodies)
    askew = {"cells": CELLS, "face_model": "walls", "alignment": Alignment(80e-6)}
    over = fem.mesh_cycle(bodies.pair, 30.0, 4, bodies, **askew)
    assert even.opposite is None
    assert over.converged, over.message
    assert np.any(over.opposite_force > 0.0)
    left_out = fem.mesh_cycle(pair, 30.0, 4, replace(bodies, pair=pair), **askew)
    assert left_out.opposite is None
    assert (
        "the teeth jam: without load their back flanks overlap by up to 50.6 um, which is left out"
        in left_out.message
    )


@pytest.fixture(scope="module")
def plastic():
    pair = pressed(20e-6, 19, 45, 1.5e-3, 12e-3, material=(STEEL, POM))
    return pair, fem.compliance(pair, tolerance=0.02)


@pytest.mark.parametrize("beyond", [False, True])
@pytest.mark.parametrize("torque", [0.0, 2.0, -2.0])
def test_even_loads_of_contacts_that_move_are_the_plane_s(plastic, beyond, torque):
    plane = fem.mesh_cycle(plastic[0], torque, 5, plastic[1], beyond_path=beyond)
    over = cycle(plastic, torque, positions=5, beyond_path=beyond)
    assert over.converged, over.message
    assert over.moving_contact
    assert np.any(over.opposite_force > 0.0)
    for name in ("transmission_error", "stiffness", "secant_stiffness", "forces", "opposite_force"):
        exact = getattr(plane, name)
        np.testing.assert_allclose(getattr(over, name), exact, rtol=1e-8, atol=1e-8 * np.abs(exact).max())
    loaded = plane.forces > 0.0
    for name in ("flank_rho", "lever_loss", "further_lever_loss"):
        exact = getattr(plane, name)[:, loaded]
        np.testing.assert_allclose(getattr(over, name)[:, loaded], exact, rtol=1e-7, atol=1e-10)


def test_contacts_that_move_have_the_tangent_of_their_turn_and_carry_the_torque(plastic):
    step, torque = 1e-3, 1.5
    torques = [torque * (1 + s) for s in (-step, 0.0, step)]
    less, same, more = cycle(plastic, torques, positions=5, alignment=Alignment(10e-6), beyond_path=False)
    assert same.converged, same.message
    assert np.any(same.opposite_force > 0.0)
    rise = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(same.stiffness, rise, rtol=1e-3)
    np.testing.assert_allclose(same._moments()[0][0] * plastic[0].base_radii[0], torque, rtol=1e-9)


def test_the_alignment_of_the_other_flanks():
    alpha = np.radians(22.0)
    given = Alignment(13e-6, -7e-6)
    twice = given.opposite(alpha).opposite(alpha)
    np.testing.assert_allclose([twice.in_plane, twice.out_of_plane], [13e-6, -7e-6], rtol=1e-12)
    other = given.opposite(alpha)
    assert np.hypot(other.in_plane, other.out_of_plane) == pytest.approx(np.hypot(13e-6, 7e-6))
