"""Both sides of the teeth on shafts that give way: reciprocal, in balance, one energy, the same from either side."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.cell_contact import CellContact
from fem.contact.cell_laws import CellLaws
from fem.contact.contact_sides import both_sides
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.solver import solve_contact, solve_one_side
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from fem.pair.face_shafts import shafts_under_face
from gears import Alignment, Bearing, Gear, GearPair, Shaft, ShaftSegment
from gears.pair.shaft_face import shaft_over_face
from tests.stiff_shafts import ENDS, stiffest_shafts

CELLS = 8
SHAFTS = (
    Shaft((ShaftSegment(0.2, 0.035),), ENDS, 0.06, 0.0),
    Shaft((ShaftSegment(0.2, 0.04),), ENDS, 0.15, 0.2),
)
OVERHUNG = (
    Shaft((ShaftSegment(0.287, 0.049),), (Bearing(0.098, 7.8e7), Bearing(0.118, 3.7e8)), 0.2246, 0.287),
    Shaft((ShaftSegment(0.175, 0.023),), (Bearing(0.166, 7.5e8), Bearing(0.173, 1.3e9)), 0.0853, 0.0),
)
"""Cells over these come and go in circles if each is taken in or released by its own gap and force."""


@pytest.fixture(scope="module")
def tight():
    """Teeth that overlap by 20 um."""
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(-20e-6), tight=True)
    return fem.compliance(pair, tolerance=0.02)


def cycle(bodies, torque, shafts=SHAFTS, positions=4, **more):
    options = {"cells": CELLS, "face_model": "walls", "beyond_path": False} | more
    return fem.mesh_cycle(bodies.pair, torque, positions, bodies, shafts=shafts, **options)


def test_loads_move_flanks_by_the_vector_of_the_bend_and_the_turn_of_the_twist(tight):
    """In the plane of the gears: forces along both normals, displacements seen along both; symmetric and definite."""
    pair = tight.pair
    face = face_setting(pair, None, CELLS, "walls", SHAFTS)
    compliance = shafts_under_face(face, pair).compliance
    angle, rng = pair.working_pressure_angle, np.random.default_rng(3)
    normals = np.array([[np.sin(angle), np.cos(angle)], [np.sin(angle), -np.cos(angle)]])
    forces = rng.uniform(-100.0, 100.0, (2, CELLS))
    seen = np.zeros((2, CELLS))
    for gear, shaft in enumerate(SHAFTS):
        places = face.middles(pair.face_width), pair.base_radii[gear], 0.0, pair.face_width
        parts = shaft_over_face(shaft, *places)
        moved = parts.bent @ (forces.T @ normals)
        turned = parts.twisted @ (forces[0] - forces[1])
        seen += normals @ moved.T + np.array([[1.0], [-1.0]]) * turned
    np.testing.assert_allclose(np.einsum("stcd,td->sc", compliance, forces), seen, rtol=1e-9)
    whole = np.block([list(row) for row in compliance])
    np.testing.assert_allclose(whole, whole.T, rtol=1e-12)
    assert np.linalg.eigvalsh(whole).min() > -1e-12 * np.abs(whole).max()


@pytest.mark.parametrize("moving", [False, True])
def test_rigid_shafts_change_nothing(tight, moving):
    """By the stiffest shafts there may be, and half of what these still change; with and without a torque."""
    options = {"moving_contact": moving, "alignment": Alignment(10e-6)}
    torques = (0.0, 50.0, -600.0)
    plain = cycle(tight, torques, None, **options)
    nearly, other = (cycle(tight, torques, (shaft, shaft), **options) for shaft in stiffest_shafts())
    for rigid, first, second in zip(plain, nearly, other, strict=True):
        assert np.all(rigid.opposite_force > 0.0)
        for name in ("transmission_error", "stiffness", "forces", "opposite_force"):
            exact = getattr(rigid, name)
            led = 2.0 * getattr(first, name) - getattr(second, name)
            np.testing.assert_allclose(led, exact, rtol=1e-7, atol=1e-7 * np.abs(exact).max())
            assert np.any(getattr(first, name) != exact)


@pytest.mark.parametrize("moving", [False, True])
def test_pressed_gears_are_the_same_seen_from_either_side(tight, moving):
    """Without a torque no side is the loaded one: its forces are those of the other seen from there, cell by cell."""
    pair = tight.pair
    face = face_setting(pair, Alignment(15e-6, 10e-6), CELLS, "walls", SHAFTS)
    setup = MeshSetup(pair, face=face, two_sided=True, beyond_path=False, moving_contact=moving)
    setup = setup.at(np.linspace(0.02, 0.98, 5))
    here, there = (solve_contact(each, tight, np.zeros(1), None) for each in (setup, setup.opposite))
    first, second = (
        tuple(side.cell_forces(0)[None] for side in (state, state.opposite)) for state in (here, there)
    )
    size, off = (
        first[0].max(),
        1e-3 if moving else 1e-9,
    )  # pinions roll on from the first touch of the loaded side
    np.testing.assert_allclose(first[0], second[1], atol=off * size)
    np.testing.assert_allclose(first[1], second[0], atol=off * size)
    assert not np.allclose(first[0].sum(axis=-2)[..., 0], first[0].sum(axis=-2)[..., -1], rtol=0.1)
    for side, turned in ((here, there.opposite), (here.opposite, there)):
        np.testing.assert_allclose(side.turn(0), turned.turn(0), atol=max(off, 1e-7) * 20e-6)


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("torque", [0.0, 30.0, -30.0])
def test_forces_balance_the_torque_and_nothing_overlaps(tight, torque, moving):
    over = cycle(tight, torque, alignment=Alignment(20e-6), moving_contact=moving, beyond_path=True)
    assert over.converged, over.message
    assert np.any(over.opposite_force > 0.0)
    moments = over._moments()[0] * np.array(tight.pair.base_radii)[:, None]
    np.testing.assert_allclose(moments[0], abs(torque), atol=1e-9 * over.forces.max() * 0.04)
    matrix = over.face.mesh_matrix
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), rtol=1e-6 if moving else 1e-9)
    assert np.linalg.eigvalsh(matrix).min() > 0.0
    assert np.all(over.face.gap[over.face.line_load > 0.0] == 0.0)


@pytest.mark.filterwarnings("ignore::base.RangeWarning")
@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("torque", [0.0, 30.0])
def test_teeth_pressed_together_over_overhung_shafts_bear_where_nothing_else_overlaps(tight, torque, moving):
    options = {"alignment": Alignment(-15e-6, 5e-6), "moving_contact": moving}
    over = cycle(tight, torque, OVERHUNG, **options)
    assert over.converged, over.message
    carried = over._moments()[0][0] * tight.pair.base_radii[0]
    np.testing.assert_allclose(carried, torque, atol=1e-9 * over.forces.max() * 0.04)
    assert np.all(over.face.gap[over.face.line_load > 0.0] == 0.0)
    assert np.all(over.face.gap >= 0.0)
    matrix = over.face.mesh_matrix
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), rtol=1e-6, atol=1e-6 * matrix.max())
    assert np.all(over.stiffness > 0.0)


def test_gears_with_their_torque_reversed_are_their_mirror(tight):
    """Seen in the mirror back flanks are the loaded ones; the positions of symmetric gears are mirrored too."""
    setup = MeshSetup(
        tight.pair, face=face_setting(tight.pair, None, CELLS, "walls", SHAFTS), beyond_path=False
    )
    places = np.array([0.1, 0.45, 0.8])
    force = np.array([800.0])
    front = solve_contact(setup.at(places), tight, force, None)
    back = solve_contact(replace(setup, back=True).at((setup.mirror - places) % 1.0), tight, force, None)
    for one, other in ((front, back), (front.opposite, back.opposite)):
        loads, mirrored = (np.sort(state.share.forces[0, 0], axis=-1) for state in (one, other))
        np.testing.assert_allclose(loads, mirrored, rtol=1e-6, atol=1e-6 * loads.max())
        np.testing.assert_allclose(one.turn(0), other.turn(0), rtol=1e-6)


def test_the_torque_works_what_bodies_contacts_and_shafts_store(tight):
    """dU = T dtheta: the energies of teeth and bodies, of the contacts and of both beams, each by itself."""
    pair, change = tight.pair, 1e-3
    face = face_setting(pair, Alignment(5e-6), CELLS, "walls", SHAFTS)
    setup = MeshSetup(pair, 1, False, face=face).at(np.array([0.3]))
    force = pair.normal_force(20.0) * np.array([1.0 - change, 1.0 + change])
    state = solve_contact(setup, tight, force, None)
    corner_laws = CornerLaws(setup, tight)
    flanks, other = (loaded_flanks(each, tight, None, 0.6, corner_laws) for each in (setup, setup.opposite))
    sides = both_sides(setup, tight, flanks, other)
    loads = [side.contacts.forces[:, 0] for side in (state, state.opposite)]
    for load in loads:
        assert np.all(load.min(axis=-1)[load.max(axis=-1) > 0.0] > 0.0)
        assert np.any(load > 0.0)
    forces = np.concatenate(loads, axis=-2).reshape(2, 1, -1)
    coupling = CellContact(tight, force[:, None, None], sides).coupling(face)
    every, nothing = np.ones((2, 1), dtype=bool), np.zeros_like(forces)
    stored = 0.5 * np.sum(forces * coupling.applied(forces, every, nothing), axis=-1)[:, 0]
    first, second = (load[:, 0].sum(axis=-2) for load in loads)
    angle = pair.working_pressure_angle
    for gear, shaft in enumerate(SHAFTS):
        parts = shaft_over_face(
            shaft, face.middles(pair.face_width), pair.base_radii[gear], 0.0, pair.face_width
        )
        for between, load in (
            (parts.bent, np.sin(angle) * (first + second)),
            (parts.bent, np.cos(angle) * (first - second)),
            (parts.twisted, first - second),
        ):
            stored += 0.5 * np.einsum("tc,cd,td->t", load, between, load)
    laws, (low, high) = CellLaws(sides.laws, CELLS), forces
    squeezed = 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(8), strict=True):
        between = 0.5 * (low + high) + 0.5 * place * (high - low)
        bears = between > 0.0
        slope = np.where(bears, laws.slope(between), 0.0)
        squeezed += 0.5 * weight * float(np.sum(between * slope * (high - low)))
    turned = np.diff([state.turn(n)[0, 0] for n in (0, 1)])[0]
    assert stored[1] - stored[0] + squeezed == pytest.approx(force.mean() * turned, rel=1e-6)


@pytest.mark.parametrize("moving", [False, True])
def test_nothing_leaps_where_back_flanks_leave(tight, moving):
    """The torque takes the back flanks out of contact on the way: the tangent falls a little, the turn goes on."""
    cycles = cycle(tight, np.linspace(150.0, 300.0, 13), positions=2, moving_contact=moving)
    assert all(each.converged for each in cycles), [each.message for each in cycles]
    bears = np.array([each.opposite_force > 0.0 for each in cycles])
    assert np.all(bears[0])
    assert not np.any(bears[-1])
    steps = np.diff([each.transmission_error for each in cycles], axis=0)
    assert steps.min() > 0.0
    assert steps.max() < 1.2 * steps.min()


def test_flanks_that_stand_clear_do_so_by_less_than_is_said_without_their_laws():
    """Shafts tilt under the load and close gaps on the other side, where a small backlash is left."""
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(15e-6))
    bodies = fem.compliance(pair, tolerance=0.02)
    setup = MeshSetup(pair, 4, False, face=face_setting(pair, Alignment(8e-6), CELLS, "walls", SHAFTS))
    force, corner_laws = np.array([pair.normal_force(60.0)]), CornerLaws(setup, bodies)
    flanks = loaded_flanks(setup, bodies, None, 0.6, corner_laws)
    known = solve_contact(setup, bodies, force, None).opposite
    both = solve_contact(replace(setup, two_sided=True), bodies, force, None)
    alone = solve_one_side(setup, bodies, force, flanks, corner_laws)
    assert known is not None
    assert not both.opposite.bears
    np.testing.assert_allclose(both.share.forces, alone.share.forces, rtol=1e-9)
    touchable = both.opposite.candidates.touchable
    clear, exact = (state.contacts.open[0, 0][touchable] for state in (known, both.opposite))
    assert np.all(clear > 0.0)
    assert np.all(clear <= exact)
    np.testing.assert_allclose(clear, exact, atol=10e-6)
