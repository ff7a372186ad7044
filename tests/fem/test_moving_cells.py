"""Contacts that move on cells of the face: the plane's where loads are even, one energy, light loads, hard cases."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.contact.cell_matrix import cell_coupling
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.moved_side import moved_side
from fem.contact.moving_corners import moved_flanks
from fem.contact.moving_coupling import other_pairs, tooth_smoothing
from fem.elasticity.line_load import flank_points
from fem.elasticity.prism import prism
from fem.elasticity.section import Face
from fem.influence.gear_face import ENDS_SIZES, section_of
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from fem.pair.unequal_widths import cosines
from gears import Alignment, Bearing, Gear, GearPair, Lead, Material, Shaft, ShaftSegment

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
PLASTIC = GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66)).with_backlash(600e-6)
TORQUE, CELLS = 10.0, 8


@pytest.fixture(scope="module")
def bodies():
    return fem.compliance(PLASTIC, tolerance=0.02)


def cycle(bodies, torque=TORQUE, moving=True, cells=CELLS, pair=PLASTIC, model="walls", **more):
    own = bodies if pair == PLASTIC else replace(bodies, pair=pair)
    return fem.mesh_cycle(pair, torque, 8, own, cells=cells, face_model=model, moving_contact=moving, **more)


@pytest.mark.parametrize("beyond", [False, True])
def test_even_loads_between_walls_are_the_plane_s(bodies, beyond):
    plane = fem.mesh_cycle(PLASTIC, TORQUE, 8, bodies, moving_contact=True, beyond_path=beyond)
    found = cycle(bodies, beyond_path=beyond)
    assert found.moving_contact
    np.testing.assert_allclose(found.face_load_factor, 1.0, atol=1e-9)
    for name in ("transmission_error", "stiffness", "secant_stiffness", "forces", "load_share", "flank_rho"):
        np.testing.assert_allclose(getattr(found, name), getattr(plane, name), rtol=1e-9, atol=1e-9)
    for name in ("lever_loss", "further_lever_loss"):
        loaded = plane.forces > 0.0
        np.testing.assert_allclose(
            getattr(found, name)[:, loaded], getattr(plane, name)[:, loaded], rtol=1e-9, atol=1e-12
        )
    assert found.model_error == pytest.approx(plane.model_error, rel=1e-6)


def test_crowning_stays_symmetric_and_alignment_turned_round_is_the_mirror(bodies):
    crowned = replace(PLASTIC, wheel=replace(PLASTIC.wheel, lead=Lead(crowning=40e-6)))
    found = cycle(bodies, pair=crowned)
    np.testing.assert_allclose(found.line_load, found.line_load[..., ::-1], rtol=1e-8, atol=1e-3)
    one, other = (cycle(bodies, alignment=Alignment(turn * 40e-6)) for turn in (1, -1))
    np.testing.assert_allclose(one.line_load, other.line_load[..., ::-1], rtol=1e-8, atol=1e-3)
    np.testing.assert_allclose(one.transmission_error, other.transmission_error, rtol=1e-10)


def test_forces_add_up_to_the_torque(bodies):
    found = cycle(bodies, alignment=Alignment(40e-6))
    np.testing.assert_allclose(found.load_share.sum(axis=1), 1.0, rtol=1e-12)
    total = found.line_load.sum(axis=-1) * PLASTIC.face_width / CELLS
    np.testing.assert_allclose(total, found.forces, rtol=1e-12, atol=1e-9)


def test_light_loads_are_those_of_contacts_that_stay(bodies):
    """With gaps as small as the load the contacts are alike, and what the motion changes goes with the load."""
    changes = []
    for part in (1.0, 1 / 16, 1 / 256):
        tilted = Alignment(part * 40e-6)
        stays, moves = (
            cycle(bodies, part * TORQUE, moving, beyond_path=False, alignment=tilted)
            for moving in (False, True)
        )
        changes.append(np.abs(moves.stiffness / stays.stiffness - 1.0).max())
        off = np.abs(moves.line_load / stays.line_load.max() - stays.line_load / stays.line_load.max()).max()
        assert off < 10 * changes[-1]
    # in proportion to the load, what is next to the contact to its root
    assert changes[1] < changes[0] / 4
    assert changes[2] < changes[1] / 4
    assert changes[0] > 1e-3


@pytest.mark.parametrize(("beyond", "off"), [(False, 1e-6), (True, 1e-3)])
def test_the_tangent_is_the_derivative(bodies, beyond, off):
    """But for how far cells rise that bear in part, which the tangent holds (4.5e-4 of contacts that stay)."""
    step = 1e-4
    less, same, more = (
        cycle(bodies, TORQUE * (1 + s), beyond_path=beyond, alignment=Alignment(40e-6))
        for s in (-step, 0.0, step)
    )
    rise = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(same.stiffness, rise, rtol=off)
    assert not beyond or np.any(same.forces[same.edge] > 0.0)


def problem(bodies, beyond=True):
    """Cells that move, some forces on them and a deflection."""
    face = face_setting(PLASTIC, Alignment(40e-6), CELLS, "walls")
    given = MeshSetup(PLASTIC, 4, beyond, moving_contact=True, face=face)
    force, corner_laws = TORQUE / PLASTIC.base_radii[0], CornerLaws(given, bodies)
    flanks = loaded_flanks(given, bodies, None, 0.6, corner_laws)
    rise = np.full((1, 1, 4, flanks.candidates.touchable.shape[-1], CELLS), 2e-6)
    cells = moved_side(given, bodies, flanks, corner_laws).contacts(bodies, rise)
    draw = np.random.default_rng(1).uniform(
        0.2, 1.0, (1, 1, 4, flanks.candidates.touchable.shape[-1] * CELLS)
    )
    loads = np.where(cells.touchable, 0.5 * force / CELLS * draw, 0.0)
    return cells, loads, np.full((1, 1, 4), 100e-6)


def about(cells, loads, approach):
    return cells.linearised(loads, approach, cells.all_bent(loads))


def test_forces_and_torque_follow_from_one_energy(bodies):
    """d(overlap)/dF is symmetric, and d(overlap)/dD is what a further force takes from the torque: no work is lost."""
    cells, loads, approach = problem(bodies)
    at = about(cells, loads, approach)
    turn = 1e-9
    back, on = (about(cells, loads, approach + s) for s in (-turn, turn))
    touched = np.broadcast_to(cells.touchable, loads.shape)
    np.testing.assert_allclose(
        -(on.residual - back.residual)[touched] / (2 * turn), at.reach[touched], rtol=1e-6
    )
    np.testing.assert_allclose((on.carried - back.carried) / (2 * turn), -at.stiff, rtol=1e-4)
    along = [np.random.default_rng(n).normal(size=loads.shape) * loads for n in (2, 3)]
    slopes, arms = [], []
    for way in along:
        less, more = (about(cells, loads + s * 1e-5 * way, approach) for s in (-1, 1))
        slopes.append((more.residual - less.residual) / 2e-5)
        arms.append((more.carried - less.carried) / 2e-5)
    one, other = (
        np.sum(np.where(touched, a * b, 0.0), axis=-1) for a, b in zip(along, slopes[::-1], strict=True)
    )
    np.testing.assert_allclose(one, other, rtol=1e-6)
    for way, arm in zip(along, arms, strict=True):
        np.testing.assert_allclose(np.sum(way * at.further_lever_ratios, axis=-1), arm, rtol=1e-6)


def test_newton_s_matrix_is_the_derivative(bodies):
    cells, loads, approach = problem(bodies)
    at = about(cells, loads, approach)
    active = loads > 0.0
    way = np.where(active, np.random.default_rng(4).normal(size=loads.shape) * loads, 0.0)
    less, more = (about(cells, loads + s * 1e-5 * way, approach) for s in (-1, 1))
    risen, wanted = (more.residual - less.residual) / 2e-5, np.ones(approach.shape, dtype=bool)
    response = at.jacobian.solved(at.own, at.reach, risen, active, wanted)[1]
    np.testing.assert_allclose(response, way, rtol=1e-4, atol=1e-4 * loads.max())


def test_compliance_between_cells_is_that_of_the_moved_pairs(bodies):
    given = MeshSetup(PLASTIC, 4, face=face_setting(PLASTIC, None, CELLS, "walls"))
    flanks = loaded_flanks(given, bodies, None, 0.6, CornerLaws(given, bodies))
    own = moved_flanks(given, bodies, flanks, CornerLaws(given, bodies))
    stays, anew = (
        cell_coupling(given.face, bodies, flanks.candidates, matrix) for matrix in (flanks.matrix, own.matrix)
    )
    found = other_pairs(stays, flanks.candidates.touchable, own.matrix - flanks.matrix)
    assert np.abs(own.matrix - flanks.matrix).max() > 0.1 * np.abs(flanks.matrix).max()
    for one, other in zip(found.blocks, anew.blocks, strict=True):
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * np.abs(other).max())


def test_smoothing_holds_even_loads_and_takes_short_waves_away(bodies):
    where = loaded_flanks(
        MeshSetup(PLASTIC, 4), bodies, None, 0.6, CornerLaws(MeshSetup(PLASTIC, 4), bodies)
    ).candidates
    face = face_setting(PLASTIC, None, 32, "walls")
    smooth = tooth_smoothing(face, bodies, where)
    np.testing.assert_allclose(smooth.sum(axis=-1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(smooth, np.swapaxes(smooth, -1, -2), atol=1e-15)
    modes = cosines(32)
    parts = np.einsum("mc,xpcd,md->xpm", modes, smooth, modes)[where.touchable & ~where.edge]
    assert np.all(parts[:, 1] > 0.85)  # twenty modules long
    assert np.all(parts[:, -1] < 0.2)  # beside a tip corner most is left
    assert np.all(parts > -1e-12)


def test_slices_tilt_by_their_own_load(bodies):
    given = MeshSetup(PLASTIC, 4)
    where = loaded_flanks(given, bodies, None, 0.6, CornerLaws(given, bodies)).candidates
    smooth = tooth_smoothing(face_setting(PLASTIC, None, CELLS, "slices"), bodies, where)
    np.testing.assert_array_equal(smooth, np.broadcast_to(np.eye(CELLS), smooth.shape))


def test_a_pinion_rolls_on_by_what_its_shaft_gives_way(bodies):
    """Both bearings alike and the gear between them: loads and deflection stay, the pinion turns by F/(2 c) more."""
    stiff = 1e8
    shaft = Shaft((ShaftSegment(0.1, 0.1),), (Bearing(0.01, stiff), Bearing(0.09, stiff)), 0.05, 0.0)
    held, yielding = (
        cycle(bodies, beyond_path=False, shafts=(one, None))
        for one in (replace(shaft, bearings=tuple(replace(b, stiffness=1e13) for b in shaft.bearings)), shaft)
    )
    np.testing.assert_allclose(yielding.secant_stiffness, held.secant_stiffness, rtol=1e-3)
    turned = yielding.transmission_error - held.transmission_error
    np.testing.assert_allclose(turned, TORQUE / PLASTIC.base_radii[0] / (2 * stiff), rtol=0.05)
    bears = held.forces > 0.0
    more = (yielding.flank_rho - held.flank_rho)[:, bears]
    np.testing.assert_allclose(more[0], TORQUE / PLASTIC.base_radii[0] / (2 * stiff), rtol=0.05)
    assert np.abs(more[1]).max() < 0.05 * more[0].min()


def test_flanks_move_along_themselves_as_they_tilt(bodies):
    """t(k)/t(0) by the prism, beside s(k) of the tilt: within a tenth, of the wheel's body within two."""
    rho = np.array([3.0, 4.0])
    for gear, off in ((0, 0.1), (1, 0.2)):
        meshed, flexible, motion = (
            bodies.meshed[gear],
            (bodies.pinion, bodies.wheel)[gear],
            bodies.motions[gear],
        )
        place = rho if gear == 0 else PLASTIC.line_of_action / PLASTIC.module - rho
        over = section_of(meshed, ENDS_SIZES, 0)
        at = flank_points(over.mesh, place)
        tip, unit = at.towards_tip(), flexible.law.plane_modulus
        still, waved = (
            np.diagonal(tip.component(prism(over, Face.wave(k)).displacements(at, [0])[0][:, :2]))
            for k in (0.0, 0.5)
        )
        along = motion.tangential(place * PLASTIC.module) * unit
        follows = 1.0 + (waved - still) / along
        step = 1e-3
        waves = fem.pair.face_compliance.waves_of(meshed, fem.influence.gear_store.GearStore())
        slope = flexible.own_slope(place * PLASTIC.module) * unit * PLASTIC.module
        ahead, behind = (waves.own_at(place + by, np.array([0.5]))[:, 0] for by in (step, -step))
        np.testing.assert_allclose(follows, 1.0 + (ahead - behind) / (2 * step) / slope, atol=off)


@pytest.mark.parametrize("moving", [False, True])
def test_heavy_crowning_bears_on_one_piece_of_the_face(bodies, moving):
    """Cells of a tip edge by themselves bore 235 N/mm across gaps that nothing closed, told as converged."""
    crowned = replace(PLASTIC, pinion=replace(PLASTIC.pinion, lead=Lead(crowning=200e-6)))
    found = cycle(bodies, 20.0, moving, 16, crowned)
    assert found.converged, found.message
    bears = (found.line_load > 0.0).astype(int)
    pieces = np.sum(np.diff(bears, axis=-1, prepend=0) == 1, axis=-1)
    assert np.all(pieces[found.forces > 0.0] == 1)


def test_light_load_on_a_large_misalignment(bodies):
    stays, moves = (cycle(bodies, 0.5, moving, alignment=Alignment(60e-6)) for moving in (False, True))
    assert moves.converged, moves.message
    assert moves.face.contact_pattern < 1.0
    np.testing.assert_allclose(moves.stiffness, stays.stiffness, rtol=1e-2)


def test_far_too_large_deflections_are_refused(bodies):
    found = cycle(bodies, 2000.0, beyond_path=False, alignment=Alignment(40e-6))
    assert not found.converged
    assert "first order" in found.message


@pytest.mark.slow
def test_friction_relief_and_shafts_with_contacts_that_move(bodies):
    from gears import TipRelief

    relief = TipRelief(40e-6, 0.8e-3)
    eased = GearPair(
        Gear(24, tip_relief=relief), Gear(36, tip_relief=relief), 2e-3, 20e-3, material=(STEEL, PA66)
    ).with_backlash(600e-6)
    whole = fem.compliance(eased, tolerance=0.02)
    shaft = Shaft((ShaftSegment(0.2, 0.03),), (Bearing(0.005, 5e8), Bearing(0.195, 5e8)), 0.06, 0.0)
    for pair, own, more in (
        (eased, whole, {"friction": 0.1}),
        (PLASTIC, bodies, {"shafts": (shaft, None)}),
        (PLASTIC, bodies, {"tip_rounding": 50e-6}),
    ):
        stays, moves = (
            fem.mesh_cycle(
                pair, TORQUE, 8, own, cells=CELLS, face_model="walls", moving_contact=moving, **more
            )
            for moving in (False, True)
        )
        assert moves.converged, moves.message
        np.testing.assert_allclose(moves.load_share.sum(axis=1), 1.0, rtol=1e-12)
        np.testing.assert_allclose(moves.transmission_error, stays.transmission_error, rtol=0.06)
