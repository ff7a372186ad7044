"""Films over a face that bears on shafts: against the alignment that the shafts lead to, and their own stiffness."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import ehl
import fem
import flankfilm as ff
from flankfilm.coupling import FilmModel, Flanks, LoadedTeeth, LubricatedCycle, MeshLosses, lubricate
from flankfilm.coupling.mesh.resolution import resolution_of
from gears import Alignment, Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(300e-6)
OIL = ehl.Lubricant(0.05, 19e-9, 870.0, temperature=353.15, eyring_stress=5e6)
SPEED, TORQUE = 200.0, 100.0
SHAFT = Shaft(
    (ShaftSegment(0.035, 0.028), ShaftSegment(0.03, 0.4), ShaftSegment(0.135, 0.028)),
    (Bearing(0.005, 5e8), Bearing(0.195, 5e8)),
    0.05,
    0.0,
)
"""Bends beside its gear but not under it, so that an alignment does to the face what it does."""

FLANKS = Flanks(cells=8, face_model="walls")
ON_SHAFTS = replace(FLANKS, shafts=(SHAFT, None))
Cycles = Callable[[Flanks], LubricatedCycle]


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.05)


@pytest.fixture(scope="module")
def cycles(bodies) -> Cycles:
    def lubricated(flanks: Flanks) -> LubricatedCycle:
        teeth = LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=flanks)
        model = FilmModel("dowson")
        return lubricate(teeth, teeth.cycle(8), SPEED, OIL, resolution_of(0.01), model, profiles=False)

    return lubricated


@pytest.fixture(scope="module")
def found(cycles) -> LubricatedCycle:
    return cycles(ON_SHAFTS)


def test_films_and_loads_are_those_of_the_alignment_that_the_shafts_come_to(cycles, found):
    """Each position by itself, where no tip edge bears: to that a shaft that gives way is no turn of the gear."""
    over, face = found.over_face, found.contact.face
    bent = face.shaft_misalignment.sum(axis=0)
    dry = found.dry.contact.face.shaft_misalignment.sum(axis=0)
    # films spread the load and turn the shaft a little
    assert 0.0 < np.abs(bent - dry).max() < 0.1 * bent.min()
    even = cycles(FLANKS)
    for row in (0, 3):
        assert not np.any(found.contact.edge[row] & (found.forces[row] > 0.0))
        given = cycles(replace(FLANKS, alignment=Alignment(float(bent[row]))))
        load = given.over_face.line_load[row]
        np.testing.assert_allclose(over.line_load[row], load, atol=2e-3 * load.max())
        thin, other = (np.nanmin(one.over_face.minimum_thickness[row]) for one in (found, given))
        assert thin == pytest.approx(other, rel=2e-3)
        assert thin < 0.98 * np.nanmin(even.over_face.minimum_thickness[row])
        between_bodies = found.transmission_error[row] - face.shaft_transmission_error[row]
        assert between_bodies == pytest.approx(given.transmission_error[row], rel=2e-3)
        for name in ("stiffness", "secant_stiffness"):
            assert getattr(found, name)[row] == pytest.approx(getattr(given, name)[row], rel=2e-3)


def test_force_and_moment_with_films_follow_approach_and_tilt(bodies, found):
    """By the mesh between bodies that tilt, with the same films under a little less and more torque."""
    table = found.over_face.table
    less, more = (
        LoadedTeeth(PAIR, torque, compliance=bodies, flanks=ON_SHAFTS).cycle(8, table).contact
        for torque in (0.999 * TORQUE, 1.001 * TORQUE)
    )
    on_path = ~np.any(found.contact.edge & (found.forces > 0.0), axis=1)
    assert np.sum(on_path) > 4
    matrix, width = found.contact.face.mesh_matrix, PAIR.face_width
    np.testing.assert_allclose(matrix, np.swapaxes(matrix, 1, 2), rtol=1e-10)
    np.testing.assert_array_equal(found.stiffness, matrix[:, 0, 0])
    moved, loads = [], []
    for one in (less, more):
        face = one.face
        approach = one.transmission_error - face.shaft_transmission_error
        moved.append(np.stack([approach, -face.shaft_misalignment.sum(axis=0) / width], axis=-1))
        per_cell = face.line_load.sum(axis=1) * width / face.face_position.size
        loads.append(np.stack([per_cell.sum(axis=-1), per_cell @ face.face_position], axis=-1))
    expected = (matrix @ (moved[1] - moved[0])[..., None])[..., 0]
    np.testing.assert_allclose(expected[on_path], (loads[1] - loads[0])[on_path], rtol=2e-3)
    assert np.all(found.stiffness < found.dry.stiffness)


@pytest.mark.slow
def test_losses_on_shafts_are_those_of_the_alignment_that_they_come_to(bodies):
    """The shaft's slope changes along the path by some per cent, and losses with it by less than their error."""

    def lost(flanks: Flanks) -> MeshLosses:
        held = replace(
            flanks, beyond_path=False
        )  # to tip edges a shaft that gives way is no turn of the gear
        given = {"tolerance": 0.02, "positions": 8, "compliance": bodies}
        return ff.mesh_losses(PAIR, TORQUE, SPEED, OIL, flanks=held, **given)

    found = lost(ON_SHAFTS)
    bent = found.cycle.contact.face.shaft_misalignment.sum(axis=0)
    aligned, even = (lost(replace(FLANKS, alignment=Alignment(slope))) for slope in (float(bent.mean()), 0.0))
    assert found.mesh_loss == pytest.approx(aligned.mesh_loss, rel=found.error)
    assert abs(found.mesh_loss / even.mesh_loss - 1.0) > found.error
    assert found.heat.sum() == pytest.approx(found.mesh_loss, rel=1e-9)
    hottest, level = (one.over_face.greatest_cell_temperature for one in (found, even))
    assert hottest > level + 10.0
