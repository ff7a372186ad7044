"""Shafts under helical pairs: three-dimensional forces on beams, spur limit, rigid limit, energy, bearings."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import numpy as np
import pytest

from fem import PairCompliance, compliance, mesh_cycle
from fem.contact.contact_sides import one_side
from fem.contact.line_contact import LineContact
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.solver import solve_contact
from fem.laws.corner_laws import CornerLaws
from fem.laws.line_candidates import contact_lines
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from fem.pair.line_shafts import PlacesOnLines, ShaftsUnderLines, shafts_under_lines
from gears import Bearing, Gear, GearPair, Lead, Material, Shaft, ShaftSegment
from gears.pair.shaft_face import shaft_over_face
from gears.pair.tilting_shaft import tilting_shaft

SMALL = GearPair(Gear(18), Gear(23), module=1e-3, face_width=5e-3, helix_angle=radians(18.0))
TORQUE = 8.0


def _shaft(at: float, diameter: float = 0.012, stiffness: float = 5e7, modulus: float = 206e9) -> Shaft:
    ends = Bearing(0.0, stiffness), Bearing(0.06, stiffness)
    return Shaft((ShaftSegment(0.06, diameter),), ends, at, 0.0, Material(modulus, 0.3, 7850.0))


BOTH = _shaft(0.02), _shaft(0.035, 0.014)
LEVEL = _shaft(0.0301, 0.03, 1e9), _shaft(0.0302, 0.03, 1e9)
"""Under which all lines stay in contact."""


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(SMALL, tolerance=0.02)


def _under(pair: GearPair, shafts: tuple[Shaft | None, Shaft | None], cells: int = 8) -> ShaftsUnderLines:
    """At two positions, without any gear solved."""
    pitches = np.array([[0.3], [0.8]]) + np.array([-1.0, 0.0, 1.0])
    middle = pair.points.A + pitches * pair.base_pitch
    ends = pair.points.A, pair.points.E
    divided = contact_lines(pair, pair.helix.base_tangent, ends, middle).divided(cells)
    flat = (2, -1)
    length = np.where(divided.used, divided.length[..., None], 0.0).reshape(flat)
    places = PlacesOnLines(
        divided.z.reshape(flat), divided.rho.reshape(2, *flat), divided.used.reshape(flat), length,
        np.zeros((1, *length.shape)),
    )  # fmt: skip
    face = face_setting(pair, None, cells, "free-ends", shafts)
    assert face is not None
    found = shafts_under_lines(face, pair, pair.helix.base_tangent, places, places)
    assert found is not None
    return found


@pytest.mark.parametrize("angle", [18.0, -18.0])
@pytest.mark.parametrize("gear", [0, 1])
def test_flanks_move_as_bodies_under_forces_in_space(angle: float, gear: int) -> None:
    """Forces and moments as vectors, sections as rigid discs that shift and turn, without any of the formulas.

    Pinion: line of action along e = z x n, its foot along n; the axial force is above 0 for a right hand.
    """
    pair = replace(SMALL, helix_angle=radians(angle))
    shaft = BOTH[gear]
    under = _under(pair, (shaft, None) if gear == 0 else (None, shaft))
    n, axis = np.eye(3)[1:]
    e = np.cross(axis, n)
    push = -e * pair.helix.base_cosine + axis * pair.helix.base_sine
    # of the wheel: the foot is on the other side, contact rho2 back from it along e
    normal, reach = (push, e) if gear == 0 else (-push, -e)
    radius = pair.base_radii[gear]
    for position, block in enumerate(under.compliances()):
        used = under.cells.used[position]
        z, rho = under.cells.z[position, used], under.cells.rho[gear, position, used]
        arm = radius * n + rho[:, None] * reach
        order = np.unique(z)
        beam = tilting_shaft(shaft, order, 0.0, pair.face_width)
        at = np.searchsorted(order, z)
        moved = np.zeros_like(block)
        for load in range(len(z)):
            moment = np.cross(arm[load], normal)
            bent = beam.bent[:, at][..., at[load]]
            # a couple that grows the slope of a deflection along d turns about z x d
            shift, turn = np.zeros((len(z), 3)), np.zeros((len(z), 3))
            for d in (e, n):
                about = np.cross(axis, d)
                v, slope = bent @ np.array([normal @ d, moment @ about])
                shift += np.outer(v, d)
                turn += np.outer(slope, about)
            turn += np.outer(beam.twisted[at, at[load]] * (moment @ axis), axis)
            moved[:, load] = (shift + np.cross(turn, arm)) @ normal
        # straight lines between nodes cut the corner that shear has under a load
        np.testing.assert_allclose(block, moved, atol=5e-4 * np.abs(moved).max())
        np.testing.assert_allclose(moved, moved.T, atol=1e-9 * np.abs(moved).max())


def test_what_they_give_is_their_compliance() -> None:
    """Along the line of action; deflections of cells by an independent route."""
    under, rng = _under(SMALL, BOTH), np.random.default_rng(11)
    forces = np.where(under.cells.used, rng.random(under.cells.z.shape), 0.0)
    bent = under.give(forces, under.cells).sum(axis=-2)
    for position, block in enumerate(under.compliances()):
        used = under.cells.used[position]
        np.testing.assert_allclose(
            under.cosine * bent[position, used], block @ forces[position, used], rtol=1e-12
        )
        assert np.linalg.eigvalsh(block).min() > -1e-12 * np.abs(block).max()


def test_without_a_helix_they_are_the_shafts_of_spur_gears() -> None:
    pair = replace(SMALL, helix_angle=1e-9)
    under = _under(pair, (BOTH[0], None), 8)
    block = next(iter(under.compliances()))
    z = under.cells.z[0, under.cells.used[0]]
    order = np.unique(np.round(z, 12))
    plane = shaft_over_face(BOTH[0], order, pair.base_radii[0], 0.0, pair.face_width).between
    at = np.searchsorted(order, z - 1e-9)
    np.testing.assert_allclose(block, plane[np.ix_(at, at)], rtol=2e-4)


@pytest.mark.slow
def test_rigid_shafts_change_nothing(bodies: PairCompliance) -> None:
    """By the stiffest shafts there may be, and half of what these still change."""
    stiff, half = (_shaft(0.03, 5.0, size, size) for size in (1e13, 5e12))
    plain = mesh_cycle(SMALL, TORQUE, 6, bodies, cells=16)
    found, other = (
        mesh_cycle(SMALL, TORQUE, 6, bodies, cells=16, shafts=(one, one)) for one in (stiff, half)
    )
    for name in ("stiffness", "secant_stiffness", "transmission_error"):
        rigid = 2.0 * getattr(found, name) - getattr(other, name)
        np.testing.assert_allclose(rigid, getattr(plain, name), rtol=1e-8)
        np.testing.assert_allclose(getattr(found, name), getattr(plain, name), rtol=1e-4)
    assert plain.lines is not None
    assert plain.lines.shaft_deflection is None


@pytest.mark.slow
@pytest.mark.parametrize("position", [0.2, 0.7])
def test_the_torque_works_what_bodies_contacts_and_shafts_store(
    bodies: PairCompliance, position: float
) -> None:
    """dU = T dtheta between torques: teeth and bodies, contacts, beams."""
    cells, change = 8, 1e-3
    face = face_setting(SMALL, None, cells, "free-ends", LEVEL)
    assert face is not None
    setup = MeshSetup(SMALL, 1, False, face=face).at(np.array([position]))
    force = TORQUE / SMALL.base_radii[0] * np.array([1.0 - change, 1.0 + change])
    found = solve_contact(setup, bodies, force, None)
    flanks = loaded_flanks(setup, bodies, None, 0.6, CornerLaws(setup, bodies))
    over = LineContact(bodies, force[:, None, None], one_side(setup, flanks))
    shafts = over.shafts(face)
    assert shafts is not None
    coupling, used = over.coupling(face), shafts.cells.used[0]
    forces = found.contacts.forces[:, 0, 0].reshape(2, -1)
    assert np.all(forces[:, used] > 0.0)
    between = coupling.blocks[0] + next(iter(shafts.compliances()))
    stored = np.diff([0.5 * one[used] @ between @ one[used] for one in forces])[0]
    laws, (low, high), pressed = over.laws(face), forces, 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(8), strict=True):
        mid = 0.5 * (low + high) + 0.5 * place * (high - low)
        slope = laws.value_and_slope(mid[None])[1][0]
        pressed += 0.5 * weight * float(np.sum((mid * slope * (high - low))[used]))
    turned = np.diff([found.turn(n)[0, 0] for n in (0, 1)])[0]
    assert stored + pressed == pytest.approx(force.mean() * turned, rel=1e-6)


@pytest.mark.slow
def test_bearings_hold_the_mesh_forces(bodies: PairCompliance) -> None:
    """F_t, F_t times the lever of the load, and F_a r_b, about mid-face, on both shafts."""
    lines = mesh_cycle(SMALL, TORQUE, 6, bodies, cells=16, shafts=BOTH).lines
    assert lines is not None
    for gear, shaft in enumerate(BOTH):
        forces = lines.bearing_forces(gear)
        place = np.array([bearing.position for bearing in shaft.bearings]) - shaft.gear_position
        total, moments = forces.sum(axis=0), np.einsum("b,bnp->np", place, forces)
        across = TORQUE / SMALL.base_radii[0]
        np.testing.assert_allclose(total, np.broadcast_to([across, 0.0], total.shape), atol=1e-6 * across)
        np.testing.assert_allclose(moments[:, 0], lines.tilting_moment[gear], rtol=1e-7, atol=1e-9)
        np.testing.assert_allclose(
            moments[:, 1], SMALL.axial_force(TORQUE) * SMALL.base_radii[gear], rtol=1e-7
        )


@pytest.mark.slow
def test_the_other_hand_on_shafts_in_the_mirror(bodies: PairCompliance) -> None:
    left = replace(SMALL, helix_angle=-SMALL.helix_angle)
    first, second = (
        replace(shaft, gear_position=0.06 - shaft.gear_position, torque_position=0.06) for shaft in BOTH
    )
    right = mesh_cycle(SMALL, TORQUE, 6, bodies, cells=16, shafts=BOTH)
    other = mesh_cycle(left, TORQUE, 6, compliance(left, tolerance=0.02), cells=16, shafts=(first, second))
    np.testing.assert_allclose(other.transmission_error, right.transmission_error, rtol=2e-3)
    np.testing.assert_allclose(other.stiffness, right.stiffness, rtol=4e-3)
    # the couple of the axial force counts: the same shafts under the other hand give way otherwise
    same = mesh_cycle(left, TORQUE, 6, compliance(left, tolerance=0.02), cells=16, shafts=BOTH)
    assert np.abs(same.transmission_error / right.transmission_error - 1.0).max() > 0.02


@pytest.mark.slow
def test_parts_of_the_transmission_error_add_up(bodies: PairCompliance) -> None:
    crowned = replace(SMALL, pinion=replace(SMALL.pinion, lead=Lead(crowning=5e-6, twist=4e-6)))
    found = mesh_cycle(crowned, TORQUE, 6, replace(bodies, pair=crowned), cells=16, shafts=BOTH)
    lines = found.lines
    assert lines is not None
    assert lines.shaft_transmission_error is not None
    assert lines.tilt_transmission_error is not None
    assert lines.shaft_deflection is not None
    added = lines.shaft_transmission_error + lines.tilt_transmission_error
    deflection = abs(found.force) / found.secant_stiffness
    moved = found.unloaded_transmission_error + added + deflection
    np.testing.assert_allclose(found.transmission_error, moved, rtol=1e-12)
    np.testing.assert_allclose(lines.shaft_transmission_error, lines.shaft_deflection.sum(axis=0), rtol=1e-12)


@pytest.mark.slow
def test_cells_settle_within_the_errors_of_what_shafts_do(bodies: PairCompliance) -> None:
    few, many = (mesh_cycle(SMALL, TORQUE, 6, bodies, cells=cells, shafts=BOTH).lines for cells in (16, 64))
    assert few is not None
    assert many is not None
    for name, error in (("shaft_deflection", few.shaft_error), ("shaft_misalignment", few.tilt_error)):
        found, better = getattr(few, name), getattr(many, name)
        assert np.abs(found - better).max() < error * np.abs(better).max(), name


@pytest.mark.slow
def test_force_over_the_turn_on_held_shafts_has_the_slope_of_the_stiffness(bodies):
    """Under the load that has brought them there nothing changes, at every position with the lines that are there."""
    given = {"cells": 8, "beyond_path": False, "shafts": BOTH}
    bent = mesh_cycle(SMALL, TORQUE, 6, bodies, **given)
    for share in (0.5, 1.0):
        torques = [step * share * TORQUE for step in (0.999, 1.0, 1.001)]
        less, held, more = mesh_cycle(SMALL, torques, 6, bodies, shafts_held_under=TORQUE, **given)
        slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
        np.testing.assert_allclose(slope, held.stiffness, rtol=1e-3 if share < 1.0 else 1e-6)
    for name in ("transmission_error", "stiffness", "secant_stiffness", "forces"):
        np.testing.assert_allclose(getattr(held, name), getattr(bent, name), rtol=1e-9)
    np.testing.assert_allclose(held.lines.shaft_deflection, bent.lines.shaft_deflection, rtol=1e-9)
