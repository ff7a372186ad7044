"""Drive trains of helical pairs: shafts that bend in both planes and are pulled, against other routes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from base import InputError
from fem import compliance
from flankfilm.coupling import (
    Flanks,
    LoadedTeeth,
    SpatialPair,
    bearing_stiffness,
    mesh_cycle,
    pair_drive,
    spatial_pair,
)
from flankfilm.coupling.drive.drive_reduced import gear_bodies
from flankfilm.coupling.drive.drive_side import drive_side
from flankfilm.coupling.drive.gyroscopic import gyroscopic_change
from flankfilm.coupling.drive.mesh_in_space import SpatialMesh, cell_wrenches
from flankfilm.coupling.drive.tilting_mesh import resistance_and_place
from flankfilm.coupling.drive.train import Train, joined, lowest_modes, shaft_damping
from gears import Bearing, Gear, GearPair, Material, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=24), Gear(teeth=51), module=2e-3, face_width=40e-3)
STIFF = Material(youngs_modulus=1e13, poisson_ratio=0.3, density=1.0)
BEARINGS = (
    (Bearing(0.02, 4e8), Bearing(0.18, 3e8, axial_stiffness=1.2e8)),
    (Bearing(0.02, 2e8, axial_stiffness=2e8), Bearing(0.21, 3e8)),
)
STIFFNESS, TILT, CENTRE = 6e8, 9e4, 4e-3


def helical(degrees: float) -> GearPair:
    return replace(PAIR, helix_angle=math.radians(degrees))


def shafts(diameter: float = 0.03, **options: Material) -> tuple[Shaft, Shaft]:
    first, second = (
        Shaft((ShaftSegment(length, diameter),), bearings, 0.08, 0.0, **options)
        for length, bearings in zip((0.2, 0.25), BEARINGS, strict=True)
    )
    return first, second


def train(pair: GearPair, on: tuple[Shaft, Shaft], tilt: float = TILT, centre: float = CENTRE) -> Train:
    bodies = gear_bodies(pair, pair.moments_of_inertia)
    first, second = (drive_side(on[i], bodies[i], 0.0, None, 1.0 - 2.0 * i) for i in range(2))
    return joined((first, second), STIFFNESS, tilt, centre)


def frequencies(of: Train, count: int) -> np.ndarray:
    squares = lowest_modes(of.in_contact, of.mass, count, 1e8)[0]
    return np.sqrt(np.maximum(squares, 0.0)) / (2.0 * math.pi)


def loads(of: Train) -> dict[str, float]:
    """What parts carry under a mesh force of one."""
    moved = np.linalg.lstsq(of.in_contact.toarray(), of.load, rcond=1e-14)[0]
    assert STIFFNESS * of.direction @ moved == pytest.approx(1.0, rel=1e-6)
    return {output.name: float(output.displacement @ moved) for output in of.outputs}


def bodies_in_space(pair: GearPair, on: tuple[Shaft, Shaft], tilt: float = TILT) -> SpatialPair:
    """The same mesh and bearings on rigid shafts; levers are those of forces on cells in space."""
    pitch_point, cosine = np.array(pair.points.C), pair.helix.base_cosine
    there = cell_wrenches(pair, pitch_point, np.array(0.0)) / cosine
    tilted = cell_wrenches(pair, pitch_point, np.array(1.0)) / cosine - there
    pressed = there + CENTRE * tilted
    matrix = STIFFNESS * np.outer(pressed, pressed) + tilt * np.outer(tilted, tilted)
    mesh = SpatialMesh(np.repeat(matrix[None], 8, 0), np.zeros((8, 12)), np.zeros(8), pair, 100.0)
    first, second = (
        bearing_stiffness(
            [(one.position - 0.08, one.stiffness, one.axial_stiffness) for one in shaft.bearings]
        )
        for shaft in on
    )
    return spatial_pair(mesh, (first, second))


@pytest.mark.parametrize("angle", [20.0, -20.0, 8.0])
def test_on_rigid_shafts_the_train_is_two_bodies_of_six_freedoms(angle):
    pair, on = replace(helical(angle), module=6e-3), shafts(0.16, material=STIFF)
    expected = bodies_in_space(pair, on).natural_frequencies
    assert frequencies(train(pair, on), 10)[1:] == pytest.approx(expected[1:10], rel=1e-3)  # shafts weigh 4 g
    other = frequencies(train(replace(pair, helix_angle=-pair.helix_angle), on), 10)[1:]
    assert np.max(np.abs(other / expected[1:10] - 1.0)) > 5e-3


def turning(space: SpatialPair, speeds: tuple[float, float]) -> np.ndarray:
    """Frequencies with moments J Omega on rates of tilt, from the angular momentum of a disc whose axis tilts."""
    gyro = np.zeros((12, 12))
    for first, polar, speed in zip((0, 6), space.mesh.pair.moments_of_inertia, speeds, strict=True):
        gyro[first + 3, first + 4], gyro[first + 4, first + 3] = polar * speed, -polar * speed
    inverse = np.linalg.inv(space.mass)
    state = np.block([[np.zeros((12, 12)), np.eye(12)], [-inverse @ space.in_contact, -inverse @ gyro]])
    return np.sort(np.abs(np.linalg.eigvals(state).imag))[::2] / (2.0 * math.pi)


@pytest.mark.parametrize("angle", [20.0, -20.0])
def test_gyroscopic_moments_are_those_of_two_bodies_that_turn_against_each_other(angle):
    pair, on = replace(helical(angle), module=6e-3), shafts(0.16, material=STIFF)
    space = bodies_in_space(pair, on)
    change = turning(space, (500.0, -235.0))[1:10] / space.natural_frequencies[1:10] - 1.0
    of = train(pair, on)
    squares, modes = lowest_modes(of.in_contact, of.mass, 10, 1e8)
    found = gyroscopic_change(of, modes[:, 1:], squares[1:], (500.0, 235.0), 40, 1e8)
    assert found == pytest.approx(np.max(np.abs(change)), rel=0.02)


@pytest.mark.parametrize("angle", [35.0, -35.0])
def test_gyroscopic_moments_of_both_gears_have_opposite_signs(angle):
    """Equal gears at 2000 rad/s on soft bearings, joined against tilt; with one sign both change a quarter less."""
    pair = replace(PAIR, pinion=Gear(40), wheel=Gear(40), module=6e-3, helix_angle=math.radians(angle))
    held = (Bearing(0.02, 1e8), Bearing(0.18, 1e8, axial_stiffness=1e8))
    on = (Shaft((ShaftSegment(0.2, 0.16),), held, 0.08, 0.0, material=STIFF),) * 2
    space, of = bodies_in_space(pair, on, 2e6), train(pair, on, tilt=2e6)
    against, alike = (
        np.max(np.abs(turning(space, (2000.0, speed))[1:12] / space.natural_frequencies[1:12] - 1.0))
        for speed in (-2000.0, 2000.0)
    )
    squares, modes = lowest_modes(of.in_contact, of.mass, 12, 1e8)
    found = gyroscopic_change(of, modes[:, 1:], squares[1:], (2000.0, 2000.0), 40, 1e8)
    assert found == pytest.approx(against, rel=1e-3)
    assert alike < 0.8 * against


@pytest.mark.parametrize("angle", [20.0, -20.0])
def test_bearings_carry_what_statics_gives(angle):
    pair, found = helical(angle), loads(train(helical(angle), shafts(), tilt=0.0))
    lean = pair.helix.base_tangent
    for i, side in enumerate(("pinion", "wheel")):
        left, right = (bearing.position - 0.08 for bearing in BEARINGS[i])
        lever = CENTRE + lean * (pair.points.C - i * pair.line_of_action)
        assert found[f"{side} bearing 1"] == pytest.approx((right - lever) / (right - left), rel=1e-6)
        assert found[f"{side} bearing 2"] == pytest.approx((lever - left) / (right - left), rel=1e-6)
        axial = [value for name, value in found.items() if name.startswith(side) and "axial" in name]
        assert axial == pytest.approx([abs(lean)], rel=1e-6)
        across = pair.base_radii[i] * abs(lean) / (right - left)
        forces = [found[f"{side} bearing {k} across"] for k in (1, 2)]
        assert np.abs(forces) == pytest.approx([across, across], rel=1e-6)
        assert sum(forces) == pytest.approx(0.0, abs=1e-6 * across)


def test_a_vanishing_helix_leaves_the_spur_train():
    """Its modes are there, beside those of planes and axes that no mesh reaches."""
    spur, nearly = (frequencies(train(helical(angle), shafts()), 24)[1:] for angle in (0.0, 1e-5))
    apart = np.min(np.abs(nearly[:, None] / spur[:6] - 1.0), axis=0)
    assert np.max(apart) < 1e-7
    assert loads(train(helical(1e-5), shafts()))["wheel bearing 2"] == pytest.approx(
        loads(train(helical(0.0), shafts()))["wheel bearing 2"], rel=1e-6
    )


@pytest.mark.parametrize("tilt", [0.0, TILT])
def test_modes_that_both_planes_have_in_common_are_all_found(tilt):
    """Bearings and shafts alike in both planes: every frequency of bending twice, which damps both planes alike."""
    of = train(helical(20.0), shafts(), tilt)
    assert len(of.rotation) > 450
    squares, modes = lowest_modes(of.out_of_mesh, of.mass, 150, 1e8)
    every = eigh(of.out_of_mesh.toarray(), of.mass.toarray(), eigvals_only=True)
    np.testing.assert_allclose(squares, every[:150], rtol=1e-7, atol=1e-9 * every[20])
    np.testing.assert_allclose(modes.T @ (of.mass @ modes), np.eye(150), atol=1e-9)
    stretched = of.out_of_mesh @ modes - of.mass @ (modes * squares)
    assert np.max(np.abs(stretched)) < 1e-9 * np.max(np.abs(of.out_of_mesh @ modes))
    found = shaft_damping(of, [0.01], None, 150, 1e8).of(np.eye(len(of.rotation)))
    for side in ("pinion", "wheel"):
        plane, across = (
            np.flatnonzero(of.points[f"{side} {name}"])[0] for name in ("deflection", "deflection across")
        )
        assert found[across, across] == pytest.approx(found[plane, plane], rel=1e-6)


def test_shafts_that_slide_are_refused_both_at_once():
    cycle = mesh_cycle(PAIR.with_backlash(50e-6), 100.0, model="potential-energy")
    loose = tuple(
        replace(shaft, bearings=tuple(replace(one, axial_stiffness=0.0) for one in shaft.bearings))
        for shaft in shafts()
    )
    with pytest.raises(InputError) as caught:
        pair_drive(helical(20.0).with_backlash(50e-6), cycle, 100.0, 100.0, shafts=(loose[0], loose[1]))
    assert [fault.where for fault in caught.value.faults] == [
        "shafts.pinion.bearings",
        "shafts.wheel.bearings",
    ]
    assert all("axial_stiffness" in str(fault) for fault in caught.value.faults)


@pytest.mark.slow
@pytest.mark.parametrize("angle", [15.0, -10.0])
def test_the_train_gives_way_as_the_mesh_cycle_on_its_shafts_does(angle):
    """The slope of the transmission error over the force is that of the train but for shafts in tension."""
    pair = replace(
        GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3),
        helix_angle=math.radians(angle),
    ).with_backlash(100e-6)
    ends = Bearing(0.005, 5e8, axial_stiffness=1e13), Bearing(0.195, 5e8)
    on = tuple(
        Shaft(
            tuple(ShaftSegment(*one) for one in ((at - 0.015, d), (0.03, 0.4), (0.185 - at, d))),
            ends,
            at,
            0.0,
        )
        for at, d in ((0.05, 0.02), (0.14, 0.03))
    )
    both, torque = (on[0], on[1]), 50.0
    bodies = compliance(pair, tolerance=0.02)

    def cycle(factor: float):
        flanks = Flanks(False, cells=16, face_model="free-ends", shafts=both)
        return LoadedTeeth(pair, factor * torque, compliance=bodies, flanks=flanks).cycle(4)

    less, found, more = map(cycle, (0.999, 1.0, 1.001))
    slope = (more.transmission_error - less.transmission_error) / (more.contact.force - less.contact.force)
    axial = sum((shaft.gear_position - 0.02) / (206e9 * shaft.segments[0].area) for shaft in both)
    for row, matrix in enumerate(found.lines.tilting[0]):
        resists, place = resistance_and_place(matrix)
        bodies_of = gear_bodies(pair, pair.moments_of_inertia)
        first, second = (drive_side(both[i], bodies_of[i], 0.0, None, 1.0 - 2.0 * i) for i in range(2))
        of = joined((first, second), float(matrix[0, 0]), float(resists), float(place))
        pinion, wheel = (of.points[f"{side} gear"] for side in ("pinion", "wheel"))
        held = of.in_contact.toarray() + 1e15 * np.outer(wheel, wheel)
        turned = float(pinion @ np.linalg.solve(held, pinion))
        assert turned - pair.helix.base_tangent**2 * axial == pytest.approx(slope[row], rel=2e-4)
