"""Shafts under the cells of the face: the alignment that they lead to, conjugate force and deflection, their faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem import MeshCycle, PairCompliance, compliance, mesh_cycle
from fem.contact.cell_laws import CellLaws
from fem.contact.cell_matrix import cell_coupling
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.solver import solve_contact
from fem.laws.corner_laws import CornerLaws
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import face_setting
from gears import Alignment, Bearing, Gear, GearPair, Shaft, ShaftSegment
from gears.pair.shaft_face import shaft_over_face
from tests.stiff_shafts import ENDS, stiffest_shafts, tilting_shaft

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 100.0


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


BOTH = tilting_shaft(0.05), tilting_shaft(0.14, 0.03)
BENDING = (
    Shaft((ShaftSegment(0.2, 0.02),), ENDS, 0.06, 0.0),
    Shaft((ShaftSegment(0.2, 0.025),), ENDS, 0.15, 0.2),
)
"""Bend and twist under their gears too."""

LEVEL = (
    Shaft((ShaftSegment(0.2, 0.04),), ENDS, 0.09, 0.0),
    Shaft((ShaftSegment(0.2, 0.05),), ENDS, 0.12, 0.2),
)
"""The same, with all of the face in contact."""


def _cycle(bodies, torque=TORQUE, positions=8, cells=16, **more):
    return mesh_cycle(PAIR, torque, positions, bodies, cells=cells, face_model="walls", **more)


def _between_bodies(cycle: MeshCycle) -> np.ndarray:
    """Approach of the bodies at mid-face: the turn without what the shafts give way there."""
    return cycle.transmission_error - cycle.face.shaft_transmission_error


def _moment(cycle: MeshCycle) -> np.ndarray:
    """Of the loads about mid-face (positions,) [N m]."""
    place, width = cycle.face_position, PAIR.face_width / cycle.face_position.size
    return width * (cycle.line_load.sum(axis=1) @ place)


@pytest.mark.parametrize("moving", [False, True])
def test_rigid_shafts_change_nothing(bodies, moving):
    """By the stiffest shafts there may be, and half of what these still change."""
    options = {"moving_contact": moving, "beyond_path": False}
    plain = _cycle(bodies, **options)
    found, other = (_cycle(bodies, shafts=(one, one), **options) for one in stiffest_shafts())
    for name in ("stiffness", "secant_stiffness", "transmission_error"):
        rigid = 2.0 * getattr(found, name) - getattr(other, name)
        np.testing.assert_allclose(rigid, getattr(plain, name), rtol=1e-9)
        np.testing.assert_allclose(getattr(found, name), getattr(plain, name), rtol=1e-4)
    np.testing.assert_allclose(found.line_load, plain.line_load, rtol=1e-6)
    assert np.abs(found.face.shaft_misalignment).max() < 1e-10
    assert not np.any(plain.face.shaft_misalignment)
    assert plain.face.mesh_matrix is None
    assert plain.face.shaft_deflection is None


@pytest.mark.parametrize(
    ("shafts", "moving", "off"),
    [
        ((tilting_shaft(0.08, 0.035), None), False, 1e-6),
        ((tilting_shaft(0.05), None), False, 5e-5),
        (BOTH, False, 1e-6),
        (BOTH, True, 1.5e-2),
    ],
)
def test_figures_are_those_of_the_alignment_that_the_shafts_lead_to(bodies, shafts, moving, off):
    """Each position by itself, with the moment of its own loads about mid-face: what an iteration would end at.

    Where a contact ends within a cell (second case), the gap's slope there is that of half as many cells. Contacts that
    move do so by the pinion's turn, which the shafts make larger.
    """
    options = {"moving_contact": moving, "beyond_path": False}
    found = _cycle(bodies, shafts=shafts, **options)
    bent = found.face.shaft_misalignment.sum(axis=0)
    assert np.ptp(bent) > 0.001 * np.abs(bent).max() > 1e-9
    for row in (0, 3, 6):
        given = _cycle(bodies, alignment=Alignment(float(bent[row])), **options)
        load = given.line_load[row]
        np.testing.assert_allclose(found.line_load[row], load, atol=max(1e-4, off) * load.max())
        for name in ("stiffness", "secant_stiffness"):
            assert getattr(found, name)[row] == pytest.approx(getattr(given, name)[row], rel=off)
        assert _between_bodies(found)[row] == pytest.approx(given.transmission_error[row], rel=off)


def test_the_mesh_is_a_symmetric_matrix_between_approach_and_tilt_and_force_and_moment(bodies):
    """Between neighbouring torques shafts that do not bend under their gears move as the matrix says."""
    less, mid, more = _cycle(bodies, [99.9, 100.0, 100.1], shafts=BOTH, beyond_path=False)
    matrix = mid.face.mesh_matrix
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), rtol=1e-10)
    np.testing.assert_allclose(np.linalg.inv(matrix)[:, 0, 1], np.linalg.inv(matrix)[:, 1, 0], rtol=1e-10)
    assert np.linalg.eigvalsh(matrix).min() > 0.0
    np.testing.assert_array_equal(mid.stiffness, matrix[:, 0, 0])
    approach = [_between_bodies(one) for one in (less, more)]
    tilt = [-one.face.shaft_misalignment.sum(axis=0) / PAIR.face_width for one in (less, more)]
    motion = np.stack([approach[1] - approach[0], tilt[1] - tilt[0]], axis=-1)[..., None]
    force = np.full(8, more.force - less.force)
    load = np.stack([force, _moment(more) - _moment(less)], axis=-1)
    np.testing.assert_allclose((matrix @ motion)[..., 0], load, rtol=1e-5)


def test_the_matrix_is_that_of_aligned_gears_by_differences(bodies):
    """Without any shaft: gears that are tilted a little more, and pressed a little more."""
    found = _cycle(bodies, shafts=BOTH, beyond_path=False)
    bent = float(found.face.shaft_misalignment.sum(axis=0)[0])

    def at(torque: float, slope: float) -> np.ndarray:
        one = _cycle(bodies, torque, alignment=Alignment(slope), beyond_path=False)
        return np.array([one.force, _moment(one)[0], one.transmission_error[0]])

    by_torque = at(1.001 * TORQUE, bent) - at(0.999 * TORQUE, bent)
    by_tilt = (at(TORQUE, bent - 1e-8) - at(TORQUE, bent + 1e-8)) / (2e-8 / PAIR.face_width)
    stiffness = by_torque[0] / by_torque[2]
    coupling = by_torque[1] / by_torque[2]
    expected = [
        [stiffness, -stiffness * by_tilt[2]],
        [coupling, by_tilt[1] - coupling * by_tilt[2]],
    ]
    np.testing.assert_allclose(found.face.mesh_matrix[0], expected, rtol=1e-5)


@pytest.mark.parametrize("shafts", [(tilting_shaft(0.08, 0.04), tilting_shaft(0.09, 0.04)), LEVEL])
@pytest.mark.parametrize("position", [0.1, 0.9])
def test_the_torque_works_what_bodies_contacts_and_shafts_store(bodies, shafts, position):
    """dU = T dtheta: the energies of teeth and bodies, of the contacts and of both beams, each by itself."""
    cells, change = 16, 1e-3
    face = face_setting(PAIR, None, cells, "walls", shafts)
    given = MeshSetup(PAIR, 1, False, face=face).at(np.array([position]))
    force = PAIR.normal_force(TORQUE) * np.array([1.0 - change, 1.0 + change])
    found = solve_contact(given, bodies, force, None)
    forces = found.contacts.forces[:, 0].reshape(2, 1, -1)
    assert np.all((forces > 0.0).sum(axis=-1) == cells * found.candidates.touchable.sum())
    assert np.abs(found.contacts.shafts.tilt_touch).min() > 1e-7
    flanks = loaded_flanks(given, bodies, None, 0.6, CornerLaws(given, bodies))
    coupling = cell_coupling(face, bodies, flanks.candidates, flanks.matrix)
    every, nothing = np.ones((2, 1), dtype=bool), np.zeros_like(forces)
    stored = 0.5 * np.sum(forces * coupling.applied(forces, every, nothing), axis=-1)[:, 0]
    loads = found.contacts.forces[:, 0, 0].sum(axis=1)
    for gear, shaft in enumerate(shafts):
        on_face = face.middles(PAIR.face_width), PAIR.base_radii[gear], 0.0, PAIR.face_width
        between = shaft_over_face(shaft, *on_face).between
        stored += 0.5 * np.einsum("tc,cd,td->t", loads, between, loads)
    laws, (low, high) = CellLaws(flanks.laws, cells), forces
    pressed = 0.0
    for place, weight in zip(*np.polynomial.legendre.leggauss(8), strict=True):
        between = 0.5 * (low + high) + 0.5 * place * (high - low)
        pressed += 0.5 * weight * float(np.sum(between * laws.slope(between) * (high - low)))
    turned = np.diff([found.turn(n)[0, 0] for n in (0, 1)])[0]
    assert stored[1] - stored[0] + pressed == pytest.approx(force.mean() * turned, rel=1e-6)


def test_no_shaft_makes_a_mesh_stiffer(bodies):
    """Flanks without leads, held to the path: tangents of aligned gears are the greatest."""
    aligned = _cycle(bodies, cells=32, beyond_path=False)
    for shafts in (BOTH, BENDING, (None, BENDING[1])):
        found = _cycle(bodies, cells=32, beyond_path=False, shafts=shafts)
        assert np.all(found.stiffness < aligned.stiffness * (1.0 + found.error))
        assert np.all(found.stiffness > 0.2 * aligned.stiffness)
        assert np.all(found.secant_stiffness < found.stiffness)
        assert 0.0 < found.mean_stiffness < aligned.mean_stiffness * (1.0 + found.error)


def test_parts_of_the_transmission_error_add_up(bodies):
    """With the bodies' deflection, on the cycle and on its arcs; the other flanks' parts have the other sign."""
    found, back = _cycle(bodies, [TORQUE, -TORQUE], shafts=BENDING, beyond_path=False)
    for one, sign in ((found, 1.0), (back, -1.0)):
        added = one.face.shaft_transmission_error + one.face.tilt_transmission_error
        deflection = abs(one.force) / one.secant_stiffness
        moved = one.unloaded_transmission_error + added + sign * deflection
        np.testing.assert_allclose(one.transmission_error, moved, rtol=1e-12)
        np.testing.assert_allclose(
            one.face.shaft_transmission_error, sign * one.face.shaft_deflection.sum(axis=0), rtol=1e-12
        )
        assert np.all(sign * one.face.shaft_transmission_error > 0.0)
    (least, _), (most, _) = found.arcs.arcs.extremes("transmission_error")
    assert least <= found.transmission_error.min()
    assert most >= found.transmission_error.max()
    assert most - least < 1.5 * np.ptp(found.transmission_error)


def test_cells_settle_within_the_errors_of_what_shafts_do(bodies):
    few, many = (_cycle(bodies, cells=cells, shafts=BENDING).face for cells in (16, 64))
    for name, error in (
        ("shaft_deflection", few.shaft_error),
        ("shaft_misalignment", few.shaft_error),
        ("shaft_transmission_error", few.shaft_error),
        ("tilt_transmission_error", few.tilt_error),
        ("tilt_stiffness", few.matrix_error),
    ):
        found, better = getattr(few, name), getattr(many, name)
        assert np.abs(found - better).max() < error * np.abs(better).max(), name
    off = few.matrix_error * np.sqrt(many.mesh_matrix[:, 0, 0].max() * many.tilt_stiffness.max())
    assert np.abs(few.moment_stiffness - many.moment_stiffness).max() < off
    assert few.shaft_error < 0.05
    assert many.shaft_error < 0.4 * few.shaft_error


def test_the_moment_of_the_loads_turns_shafts_back(bodies):
    """Loads that leave mid-face tilt a shaft less than the same force at mid-face does."""
    light, heavy = _cycle(bodies, [1.0, 100.0], shafts=(tilting_shaft(0.05, 0.02), None))
    factor = light.face_load_factor, heavy.face_load_factor
    # shafts, unlike an alignment, bend by the load
    np.testing.assert_allclose(factor[0], factor[1], rtol=0.25)
    assert factor[1].min() > 1.02
    # the gear sits left of the shaft's middle: its right end gives way more
    assert (heavy.face.shaft_misalignment[0] > 0.0).all()
    assert not np.any(heavy.face.shaft_misalignment[1])


def test_a_wide_pinion_winds_up_towards_its_coupling(bodies):
    """Torque comes in at the right: the right end of the face bears more."""
    thin = Shaft((ShaftSegment(0.2, 0.012),), (Bearing(0.08, 1e12), Bearing(0.12, 1e12)), 0.1, 0.2)
    found = _cycle(bodies, shafts=(thin, None))
    assert (found.line_load[..., -1].sum(axis=1) > found.line_load[..., 0].sum(axis=1)).all()


def test_shafts_under_narrower_gears_and_crowned_flanks_keep_the_matrix_symmetric(bodies):
    from gears import Lead

    pair = replace(PAIR, pinion=replace(PAIR.pinion, lead=Lead(crowning=10e-6)))
    own = compliance(pair, tolerance=0.05)
    found = mesh_cycle(pair, TORQUE, 8, own, cells=16, face_model="walls", shafts=BENDING)
    matrix = found.face.mesh_matrix
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), rtol=1e-10)
    assert np.linalg.eigvalsh(matrix).min() > 0.0


def test_faults_name_the_shaft(bodies):
    short = Shaft((ShaftSegment(0.2, 0.03),), ENDS, 0.195, 0.0)
    with pytest.raises(InputError, match=r"shafts\[1\]\.gear_position") as told:
        _cycle(bodies, shafts=(None, short))
    assert "0.01" in str(told.value)
