"""The mesh between gears that tilt, in a drive train: its place and resistance, by statics and by mirrors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fem import PairCompliance, compliance
from flankfilm.coupling import (
    Flanks,
    LoadedTeeth,
    MeshCycle,
    PairDrive,
    mesh_series,
    pair_drive,
    tilting_mesh,
)
from flankfilm.coupling.drive.bent_shaft import GearBody
from flankfilm.coupling.drive.drive_side import drive_side
from flankfilm.coupling.drive.tilting_mesh import resistance_and_place
from flankfilm.coupling.drive.train import joined
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 50.0
ENDS = Bearing(0.005, 5e8), Bearing(0.195, 5e8)


def shaft(at: float, diameter: float, torque_at: float = 0.0) -> Shaft:
    """Bends beside its gear but not under it, where a drive train has a rigid body too."""
    parts = (at - 0.015, diameter), (0.03, 0.4), (0.185 - at, diameter)
    return Shaft(tuple(ShaftSegment(*one) for one in parts), ENDS, at, torque_at)


BOTH = shaft(0.05, 0.02), shaft(0.14, 0.03)
BEAMS = tuple(replace(one, segments=(ShaftSegment(0.2, 0.03),)) for one in BOTH)
OTHERS = tuple(replace(one, gear_position=0.2 - one.gear_position, torque_position=0.2) for one in BEAMS)
"""Mirrored."""

MIRRORED = shaft(0.15, 0.02, 0.2), shaft(0.06, 0.03, 0.2)


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


def cycle(bodies: PairCompliance, shafts, torque: float = TORQUE) -> MeshCycle:
    flanks = Flanks(False, cells=16, face_model="walls", shafts=shafts)
    return LoadedTeeth(PAIR, torque, compliance=bodies, flanks=flanks).cycle(8)


@pytest.fixture(scope="module")
def found(bodies) -> MeshCycle:
    return cycle(bodies, BOTH)


def turned_by_the_train(shafts, matrix: np.ndarray) -> float:
    """Turn of the pinion's gear along the line of action by a mesh force of one, the wheel's gear held: statics."""
    resists, place = resistance_and_place(matrix)
    sides = [
        drive_side(one, GearBody(radius, 1.0, 1e-3, 1e-4, 0.01), 0.0, None, 1.0 - 2.0 * i)
        for i, (one, radius) in enumerate(zip(shafts, PAIR.base_radii, strict=True))
    ]
    train = joined((sides[0], sides[1]), float(matrix[0, 0]), float(resists), float(place))
    stiffness, n = train.in_contact.toarray(), len(sides[0].free)
    pinion, wheel = (
        np.pad(sides[0].points["gear"], (0, len(sides[1].free))),
        np.pad(sides[1].points["gear"], (n, 0)),
    )
    stiffness += 1e15 * np.outer(wheel, wheel)
    return float(pinion @ np.linalg.solve(stiffness, pinion))


def test_the_train_gives_way_as_the_mesh_cycle_does(bodies, found):
    """The slope of the transmission error over the force, shafts and all, is that of beams with the mesh's matrix."""
    less, more = (cycle(bodies, BOTH, factor * TORQUE) for factor in (0.999, 1.001))
    slope = (more.transmission_error - less.transmission_error) / (more.contact.force - less.contact.force)
    matrix = found.contact.face.mesh_matrix
    for row in range(len(matrix)):
        assert turned_by_the_train(BOTH, matrix[row]) == pytest.approx(slope[row], rel=1e-3)
    other = matrix * np.array([[1.0, -1.0], [-1.0, 1.0]])  # z from the right
    assert abs(turned_by_the_train(BOTH, other[0]) / slope[0] - 1.0) > 0.01


def test_both_are_means_over_the_cycle(found):
    matrix = found.contact.face.mesh_matrix
    given = tilting_mesh(found)
    mean = matrix.mean(axis=0)
    assert given["load_centre"] == mean[1, 0] / mean[0, 0]
    assert given["tilt_stiffness"] == mean[1, 1] - mean[1, 0] ** 2 / mean[0, 0]
    assert given["mesh_matrix"] is matrix
    load = found.face.line_load
    place = (load * found.face.face_position).sum(axis=(1, 2)) / load.sum(axis=(1, 2))
    angle = 2.0 * np.pi * np.outer(found.position, np.arange(1, 4))
    rest = place - place.mean() - np.real(np.exp(1j * angle) @ given["travel"].harmonics)
    assert rest[1:] == pytest.approx(-rest[:-1], abs=1e-9 * np.ptp(place))  # the fourth of eight positions
    assert np.max(np.abs(rest)) < 0.2 * np.ptp(place)  # jumps as pairs come and go
    assert tilting_mesh(None) == {}
    assert 1e-3 < abs(given["load_centre"]) < 0.5 * PAIR.face_width


def test_a_mirrored_pair_has_its_force_on_the_other_side(bodies, found):
    here, there = tilting_mesh(found), tilting_mesh(cycle(bodies, MIRRORED))
    assert there["load_centre"] == pytest.approx(-here["load_centre"], rel=1e-6)
    assert there["tilt_stiffness"] == pytest.approx(here["tilt_stiffness"], rel=1e-6)
    one, other = (
        train(found_of, shafts, **given)
        for found_of, shafts, given in ((found, BEAMS, here), (found, OTHERS, there))
    )
    np.testing.assert_allclose(one.natural_frequencies, other.natural_frequencies, rtol=1e-5)


def train(of: MeshCycle, shafts, **given) -> PairDrive:
    series = mesh_series(of.against("body"), "tangent", 2)
    ends = {"end_inertias": (0.01, 0.05), "couplings": (2e4, 2e4), "speeds": (50.0, 800.0)}
    return pair_drive(PAIR, series, TORQUE, 200.0, shafts=shafts, error_amplitude=2e-6, **ends, **given)


def test_what_is_left_out_is_the_variation_over_the_cycle(found):
    """By trains with the mesh of each position; much less than the doubt of a mesh that gives way to tilt."""
    given = tilting_mesh(found)
    mean, gives_way = train(found, BEAMS, **given), train(found, BEAMS)
    assert mean.tilt_stiffness == given["tilt_stiffness"]
    assert mean.load_centre == given["load_centre"]
    assert gives_way.tilt_stiffness == gives_way.load_centre == 0.0
    worst = 0.0
    for resists, place in zip(*resistance_and_place(given["mesh_matrix"]), strict=True):
        one = train(found, BEAMS, tilt_stiffness=float(resists), load_centre=float(place))
        assert one.tilt_change == 0.0  # it is given
        n = min(len(one.natural_frequencies), len(mean.natural_frequencies))
        off = one.natural_frequencies[:n] / mean.natural_frequencies[:n] - 1.0
        worst = max(worst, float(np.abs(off).max()))
    assert mean.tilt_change == pytest.approx(worst, rel=0.1)
    assert 0.0 < mean.tilt_change < 0.5 * gives_way.tilt_change
    still = replace_matrix(given)
    assert train(found, BEAMS, **still).tilt_change == pytest.approx(0.0, abs=1e-9)


def replace_matrix(given: dict) -> dict:
    """The same mean, which does not vary."""
    return given | {"mesh_matrix": np.tile(given["mesh_matrix"].mean(axis=0), (3, 1, 1))}
