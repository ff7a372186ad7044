"""The load that travels over the face drives trains: by statics, bodies in space, mirrors, and reduction."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import dynamics
from base import InputError
from fem import compliance
from flankfilm.coupling import (
    BearingForces,
    Flanks,
    LoadedTeeth,
    LoadTravel,
    PairDrive,
    bearing_stiffness,
    drive_sweep,
    given_series,
    mesh_series,
    pair_drive,
    spatial_pair,
    tilting_mesh,
)
from flankfilm.coupling.drive.mesh_in_space import SpatialMesh, cell_wrenches
from flankfilm.coupling.speeds.drive_peaks import linear_heights
from flankfilm.coupling.speeds.sidebands import mesh_spectrum, over_revolution
from flankfilm.coupling.vibration.excitation import ErrorSeries, error_series
from gears import Bearing, Gear, GearPair, Material, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=24), Gear(teeth=51), module=4e-3, face_width=40e-3).with_backlash(50e-6)
STIFF = Material(youngs_modulus=1e13, poisson_ratio=0.3, density=1.0)
STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
BEARINGS = (
    (Bearing(0.02, 4e8), Bearing(0.18, 3e8, axial_stiffness=1.2e8)),
    (Bearing(0.02, 2e8, axial_stiffness=2e8), Bearing(0.21, 3e8)),
)
AT = 0.08
STIFFNESS, TILT, CENTRE, TORQUE = 6e8, 9e4, 4e-3, 800.0
PLACES = np.array([1e-3, 3e-4 * np.exp(0.7j), 2e-4 * np.exp(-2.0j)])
FAR = 3e-3 * np.exp(0.7j)
SPEEDS = 150.0, 1000.0


def helical(degrees: float) -> GearPair:
    return replace(PAIR, helix_angle=math.radians(degrees))


def on_shafts(diameter: float = 0.2, material: Material = STIFF) -> tuple[Shaft, Shaft]:
    first, second = (
        Shaft((ShaftSegment(length, diameter),), bearings, AT, 0.0, material)
        for length, bearings in zip((0.2, 0.25), BEARINGS, strict=True)
    )
    return first, second


def train(pair: GearPair, shafts: tuple[Shaft, Shaft], amplitudes=(0.0,), **changes) -> PairDrive:
    given = {
        "speeds": SPEEDS, "tilt_stiffness": TILT, "load_centre": CENTRE, "travel": LoadTravel(PLACES),
        "tolerance": 1e-4,
    }  # fmt: skip
    series = given_series(STIFFNESS, amplitudes)
    return pair_drive(pair, series, TORQUE, 3e3, shafts=shafts, **(given | changes))


def balanced(drive: PairDrive, speed: float, order: int = 3) -> np.ndarray:
    """Harmonics 0 to 3 of what parts carry (4, parts), in contact, by harmonic balance of the train's matrices."""
    osc, size = drive.oscillator, drive.oscillator.dimension // 2
    g, omega, numbers = np.asarray(osc.direction), drive.scales.frequency(speed), np.arange(-order, order + 1)

    def halves(mean: float, series: np.ndarray) -> dict[int, complex]:
        found = {0: complex(mean)}
        for j, (amplitude, phase) in enumerate(series.T, start=1):
            found |= {j: 0.5 * amplitude * np.exp(1j * phase), -j: 0.5 * amplitude * np.exp(-1j * phase)}
        return found

    mesh = osc.mesh_stiffness
    stiff = halves(mesh.mean, np.array([mesh.amplitudes, mesh.phases]))
    error, push = halves(osc.half_backlash, osc.error_series), halves(0.0, osc.force_series)
    whole = np.zeros((len(numbers), size, len(numbers), size), dtype=complex)
    sides = np.zeros((len(numbers), size), dtype=complex)
    for i, n in enumerate(numbers):
        nu = 1j * n * omega
        for k, m in enumerate(numbers):
            whole[i, :, k] = stiff.get(n - m, 0.0) * np.outer(g, g)
            sides[i] += stiff.get(n - m, 0.0) * error.get(m, 0.0) * g
        whole[i, :, i] += (
            osc.stiffness + nu * (osc.damping + osc.mesh_damping * np.outer(g, g)) + nu**2 * osc.mass
        )
        sides[i] += nu * osc.mesh_damping * error.get(n, 0.0) * g
        sides[i] += 0.0 if osc.force_direction is None else push.get(n, 0.0) * np.asarray(osc.force_direction)
    sides[order] += osc.mean_force
    flat = whole.reshape(len(numbers) * size, -1)
    moved = np.linalg.lstsq(flat, sides.ravel(), rcond=1e-14)[0].reshape(-1, size)[order : order + 4]
    moved[1:] *= 2.0
    rates = 1j * omega * np.arange(4)[:, None] * moved
    return np.array([moved @ out.displacement + rates @ out.speed for out in drive.outputs]).T


def followed(drive: PairDrive, speed: float) -> np.ndarray:
    """The same of the periodic motion that the flow finds."""
    osc = drive.oscillator.with_parameter("frequency", drive.scales.frequency(speed))
    orbit = dynamics.find_orbit(osc, osc.rest_state())
    assert orbit.label == "1-0-0"
    states = dynamics.trajectory(osc, orbit.state, 1, 128).states[:-1]
    waves = 2.0 * np.fft.fft([out.of(states) for out in drive.outputs], axis=1) / 128
    waves[:, 0] *= 0.5
    return waves[:, :4].T


def column(drive: PairDrive, name: str) -> int:
    return [out.name for out in drive.outputs].index(name)


@pytest.mark.parametrize("angle", [0.0, 20.0, -20.0])
@pytest.mark.parametrize("thick", [True, False], ids=["stiff", "bent"])
def test_slow_bearings_carry_what_statics_gives(angle, thick):
    """A force F at z from mid-face loads the bearings by F z over their distance, whatever resists tilt."""
    shafts = on_shafts() if thick else on_shafts(0.03, STEEL)
    drive = train(helical(angle), shafts, damping_ratio=1e-6, shaft_damping_ratio=0.0)
    found, force = balanced(drive, 1e-2)[1:], drive.rigid.force
    for side, (left, right) in zip(("pinion", "wheel"), BEARINGS, strict=True):
        lever = force * PLACES / (right.position - left.position)
        assert found[:, column(drive, f"{side} bearing 1")] == pytest.approx(-lever, rel=1e-6)
        assert found[:, column(drive, f"{side} bearing 2")] == pytest.approx(lever, rel=1e-6)
    planes = [f"{side} bearing {i} across" for side in ("pinion", "wheel") for i in (1, 2) if angle]
    assert all(np.max(np.abs(found[:, column(drive, name)])) < 1e-6 * force * 1e-3 for name in planes)
    torques = [k for k, out in enumerate(drive.outputs) if out.unit == "N m"]
    assert np.max(np.abs(found[:, torques]), initial=0.0) < 1e-7 * TORQUE


@pytest.mark.parametrize("angle", [0.0, 20.0])
@pytest.mark.parametrize("tilt", [0.0, TILT])
@pytest.mark.parametrize("places", [PLACES, ()], ids=["travels", "stays"])
def test_mean_loads_of_bearings_are_those_of_the_mean_place(angle, tilt, places):
    """Whatever resists tilt, and wherever slopes place the force; also of a load that stays there."""
    at, pair, shafts = 7e-3, helical(angle), on_shafts(0.03, STEEL)
    given = {"tilt_stiffness": tilt, "travel": LoadTravel(places, mean=at), "damping_ratio": 1e-6}
    drive = train(pair, shafts, shaft_damping_ratio=0.0, **given)
    found, force = balanced(drive, 1e-2)[0].real, drive.rigid.force
    for i, (side, (left, right)) in enumerate(zip(("pinion", "wheel"), BEARINGS, strict=True)):
        lean = pair.helix.base_tangent if angle else 0.0
        lever = AT + at + lean * (pair.points.C - i * pair.line_of_action)
        loads = [(right.position - lever), (lever - left.position)] / np.array(right.position - left.position)
        names = [f"{side} bearing {k}" for k in (1, 2)]
        assert found[[column(drive, name) for name in names]] == pytest.approx(force * loads, rel=1e-6)


def in_space(pair: GearPair, speed: float, swing: float = 0.0, error: float = 0.0) -> BearingForces:
    """Two bodies of six freedoms with the same mesh, whose load travels as much."""
    pitch_point, cosine = np.array(pair.points.C), pair.helix.base_cosine
    there = cell_wrenches(pair, pitch_point, np.array(0.0)) / cosine
    tilted = cell_wrenches(pair, pitch_point, np.array(1.0)) / cosine - there
    pressed, theta = there + CENTRE * tilted, 2.0 * math.pi * (np.arange(64) + 0.5) / 64
    stiffness = STIFFNESS * (1.0 + swing * np.cos(theta))
    matrix = stiffness[:, None, None] * np.outer(pressed, pressed) + TILT * np.outer(tilted, tilted)
    force = TORQUE / pair.base_radii[0]
    place = np.real(FAR * np.exp(1j * theta))
    # about tilted bodies, as the drive's cycle has them
    yields = sum(
        (1.0 / a.stiffness + 1.0 / b.stiffness) / (b.position - a.position) ** 2 for a, b in BEARINGS
    )
    load = force * (pressed + (1.0 + TILT * yields) * place[:, None] * tilted)
    mesh = SpatialMesh(matrix, load, force / stiffness, pair, TORQUE)
    first, second = (
        bearing_stiffness([(one.position - AT, one.stiffness, one.axial_stiffness) for one in bearings])
        for bearings in BEARINGS
    )
    both = spatial_pair(mesh, (first, second), damping_ratio=0.003)
    return both.bearing_forces(speed, 12, error * np.cos(theta))


def springs_in_space(found: BearingForces, drive: PairDrive) -> np.ndarray:
    """Harmonics 0 to 3 of the forces of radial springs along the line of action and across, as the drive names them."""
    forces = []
    for out in drive.outputs:
        if out.unit != "N" or "axial" in out.name:
            continue
        side, _, number, *plane = out.name.split()
        i = ("pinion", "wheel").index(side)
        bearing, moved = BEARINGS[i][int(number) - 1], found.motion[:4, 6 * i : 6 * i + 6]
        place = bearing.position - AT
        at = moved[:, 1] - place * moved[:, 3] if plane else moved[:, 0] + place * moved[:, 4]
        forces.append(bearing.stiffness * at * (2.0 * i - 1.0))
    return np.array(forces).T


@pytest.mark.parametrize("angle", [0.0, 20.0, -20.0])
@pytest.mark.parametrize(
    ("swing", "error"), [(0.0, 0.0), (0.1, 0.0), (0.1, 1e-6)], ids=["travel", "k(t)", "error"]
)
def test_at_speed_the_train_on_rigid_shafts_is_two_bodies_in_space(angle, swing, error):
    """With and without a stiffness and an error that vary; bodies in space damp tilt, and the error's rate not."""
    pair = helical(angle)
    drive = train(
        pair,
        on_shafts(),
        (swing,),
        damping_ratio=0.003,
        shaft_damping_ratio=0.0,
        error_amplitude=error,
        travel=LoadTravel([FAR]),
    )
    radial = [k for k, out in enumerate(drive.outputs) if out.unit == "N" and "axial" not in out.name]
    for speed in (140.0, 450.0, 900.0):
        ours = balanced(drive, speed, 12)[:, radial]
        theirs = springs_in_space(in_space(pair, speed, swing, error), drive)
        size = np.max(np.abs(theirs[1:]))
        assert size > 0.02 * drive.rigid.force
        np.testing.assert_allclose(ours[1:3], theirs[1:3], rtol=0.0, atol=0.015 * size)
        np.testing.assert_allclose(ours[0], theirs[0], rtol=0.0, atol=0.01 * drive.rigid.force)


def test_a_constant_stiffness_without_error_leaves_bearings_still_but_for_the_load():
    """Of bent shafts, by the sweep of a scene: swings are there, and those of the harmonics."""
    shafts, given = on_shafts(0.05, STEEL), {"speeds": (300.0, 1000.0), "damping_ratio": 0.05}
    moved, still = (
        train(helical(20.0), shafts, travel=travel, **given) for travel in (LoadTravel(PLACES), None)
    )
    assert still.oscillator.force_direction is None
    assert still.load_travel == 0.0
    swing = drive_sweep(moved, np.array([700.0])).bearing_force_swing["up"][0]
    direct = np.sqrt(0.5 * np.sum(np.abs(balanced(moved, 700.0)[1:]) ** 2, axis=0))
    radial = [k for k, out in enumerate(moved.outputs) if out.unit == "N"]
    assert swing == pytest.approx(direct[radial], rel=1e-4, abs=1e-4 * swing.max())
    assert swing.max() > 0.01 * moved.rigid.force
    assert drive_sweep(still, np.array([700.0])).bearing_force_swing["up"].max() < 1e-6 * moved.rigid.force


def test_the_flow_has_the_harmonics_of_a_stiffness_that_varies_too():
    drive = train(
        helical(-20.0), on_shafts(0.05, STEEL), (0.15,), speeds=(300.0, 1000.0), error_amplitude=1e-6
    )
    ours, theirs = followed(drive, 620.0), balanced(drive, 620.0, 12)
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-7 * np.max(np.abs(theirs)))


def test_hands_and_sides_mirror_each_other():
    """z reversed: shafts from the other end, the other hand, the load on its way back."""
    shafts = on_shafts(0.05, STEEL)
    others = tuple(
        replace(
            one,
            segments=one.segments[::-1],
            bearings=tuple(replace(each, position=length - each.position) for each in one.bearings[::-1]),
            gear_position=length - one.gear_position,
            torque_position=length - one.torque_position,
        )
        for one, length in zip(shafts, (0.2, 0.25), strict=True)
    )
    given = {"speeds": (300.0, 1000.0)}
    here = train(helical(15.0), shafts, (0.1,), **given)
    there = train(
        helical(-15.0),
        (others[0], others[1]),
        (0.1,),
        load_centre=-CENTRE,
        travel=LoadTravel(-PLACES),
        **given,
    )
    ours, theirs = followed(here, 620.0), followed(there, 620.0)
    for name in ("pinion bearing 1", "wheel bearing 1", "pinion bearing 2 across"):
        mirrored = name.replace("1", "x").replace("2", "1").replace("x", "2")
        first, second = ours[:, column(here, name)], theirs[:, column(there, mirrored)]
        assert np.abs(second) == pytest.approx(np.abs(first), rel=1e-6, abs=1e-6 * np.abs(ours[1:]).max())
        if "across" not in name:
            assert second == pytest.approx(first, rel=1e-6, abs=1e-6 * np.abs(ours[1:]).max())


def test_the_reduced_train_keeps_what_the_moment_reaches():
    """Forces of parts by the moment alone, over the speeds, against the train with all its freedoms."""
    drive = train(helical(20.0), on_shafts(0.04, STEEL), speeds=(100.0, 1000.0), end_inertias=(0.02, 0.05))
    own, scales = drive.shaft_damping.train, drive.scales
    damping, g = drive.shaft_damping.of(np.eye(len(own.rotation))), own.direction
    c = 2.0 * drive.rigid.oscillator.damping_ratio * scales.equivalent_mass * scales.omega_n
    push, drag = (np.array([getattr(out, name) for out in own.outputs]) for name in ("displacement", "speed"))
    moments = drive.rigid.force * own.tilting_gain * PLACES
    ours, theirs = [], []
    for speed in np.geomspace(110.0, 950.0, 30).tolist():
        each = []
        for j, moment in enumerate(moments, start=1):
            nu = 24.0 * j * speed
            whole = own.stiffness.toarray() + 1j * nu * damping - nu**2 * own.mass.toarray()
            whole = whole + (scales.mean_stiffness + 1j * nu * c) * np.outer(g, g)
            moved = np.linalg.solve(whole, -moment * own.tilt)
            each.append((push + 1j * nu * drag) @ moved)
        theirs.append(each)
        ours.append(balanced(drive, speed)[1:])
    bearings = [k for k, out in enumerate(drive.outputs) if out.unit == "N"]
    ours, theirs = (np.linalg.norm(np.array(part)[:, :, bearings], axis=1) for part in (ours, theirs))
    off = np.abs(ours - theirs) / np.maximum(theirs, 0.1 * theirs.max(axis=0))
    assert np.max(off) < 0.05
    assert drive.reduction_error < 0.05
    found = linear_heights(drive, drive.scales.frequency(110.0), drive.scales.frequency(950.0))
    heights = np.array([np.interp(x, *(found[0], found[1][:, 1 + bearings[0]])) for x in found[0]])
    assert heights.max() > np.abs(balanced(drive, 110.0)[0, bearings[0]]) + theirs[:, 0].max() / math.sqrt(
        3.0
    )


def test_a_period_of_many_meshes_is_forced_in_each():
    drive = train(helical(20.0), on_shafts(0.05, STEEL), speeds=(300.0, 1000.0))
    drive = replace(
        drive, oscillator=drive.oscillator.with_parameter("frequency", drive.scales.frequency(700.0))
    )
    error = error_series(1e-9 * np.cos(2.0 * np.pi * (np.arange(12) + 0.5) / 12), meshes=3, order=1)
    assert isinstance(error, ErrorSeries)
    whole, start = over_revolution(drive, error), drive.oscillator.rest_state()
    there = dynamics.period_map(drive.oscillator, start, 3).state
    assert dynamics.period_map(whole, start).state == pytest.approx(there, abs=1e-5 * np.max(np.abs(there)))
    lines = mesh_spectrum(drive).bearing_force
    radial = [k for k, out in enumerate(drive.outputs) if out.unit == "N"]
    direct = np.abs(balanced(drive, 700.0))[1, radial]
    assert lines[0] == pytest.approx(direct, rel=1e-3, abs=1e-3 * direct.max())


def test_few_harmonics_are_kept_and_the_rest_is_an_error():
    values = 1e-3 / np.arange(1, 60) ** 2
    kept = LoadTravel(values, 2e-6).kept(0.04, 0.005, (0.1, 0.5), 0.05)
    order = len(kept.harmonics)
    rest = math.sqrt(0.5 * np.sum(values[order:] ** 2))
    assert 1 < order < 59
    assert rest <= 0.005 * 0.02 < math.sqrt(0.5 * np.sum(values[order - 1 :] ** 2)) or order > 2
    assert kept.error == pytest.approx(math.hypot(2e-6, rest), rel=1e-6)
    theta = np.linspace(0.0, 2.0 * np.pi, 4001)
    place = np.cos(np.outer(theta, np.arange(1, order + 1))) @ values[:order]
    assert kept.range == pytest.approx(np.ptp(place), rel=1e-4)
    assert kept.range_error == pytest.approx(2.0 * math.sqrt(2.0) * kept.error / kept.range, rel=1e-9)
    assert LoadTravel([0.0]).kept(0.04, 0.005, (0.1, 0.5), 0.05).range == 0.0
    assert len(LoadTravel(values).kept(0.04, 0.005, (0.1, 0.5), 0.0).harmonics) >= order


def test_harmonics_that_are_none_are_refused():
    with pytest.raises(InputError, match="harmonics"):
        LoadTravel([np.nan])


def test_gears_that_cannot_tilt_are_not_driven():
    drive = pair_drive(
        PAIR, given_series(STIFFNESS, [0.1]), TORQUE, 300.0, shafts=(None, None), travel=LoadTravel(PLACES)
    )
    assert drive.oscillator.force_direction is None


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.parametrize("angle", [0.0, 15.0, -15.0])
def test_of_a_mesh_cycle_on_its_shafts_slow_bearings_carry_its_loads(angle):
    """Means and harmonics of the radial forces that statics of every position gives, cell by cell."""
    pair = replace(
        GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3),
        helix_angle=math.radians(angle),
    ).with_backlash(100e-6)
    ends = Bearing(0.005, 5e8, axial_stiffness=1e13), Bearing(0.195, 5e8)
    first, second = (
        Shaft(
            tuple(ShaftSegment(*one) for one in ((at - 0.015, d), (0.03, 0.4), (0.185 - at, d))),
            ends,
            at,
            0.0,
        )
        for at, d in ((0.05, 0.02), (0.14, 0.03))
    )
    flanks = Flanks(False, cells=16, face_model="free-ends", shafts=(first, second))
    cycle = LoadedTeeth(pair, 50.0, compliance=compliance(pair, tolerance=0.02), flanks=flanks).cycle(12)
    given = tilting_mesh(cycle)
    drive = pair_drive(
        pair, mesh_series(cycle.against("body"), "secant", 2), 50.0, 300.0, shafts=(first, second),
        speeds=(100.0, 300.0), tolerance=1e-5, **given,
    )  # fmt: skip
    found = balanced(drive, 1e-2)
    turned = 2.0 * np.exp(-2j * np.pi * np.outer([0, 1, 2, 3], cycle.position)) / len(cycle.position)
    turned[0] *= 0.5
    loads = cycle.lines if angle else cycle.face
    assert drive.load_travel > 1e-6
    for i, (side, at) in enumerate((("pinion", 0.05), ("wheel", 0.14))):
        if angle:
            expected = turned @ loads.bearing_forces(i)[:, :, 0].T
        else:
            force = loads.line_load
            place = (force * loads.face_position).sum(axis=(1, 2)) / force.sum(axis=(1, 2))
            expected = (
                turned
                @ (drive.rigid.force * np.column_stack([0.195 - at - place, at + place - 0.005]))
                / 0.19
            )
        ours = found[:, [column(drive, f"{side} bearing {k}") for k in (1, 2)]]
        np.testing.assert_allclose(ours[0], expected[0], rtol=2e-3)
        np.testing.assert_allclose(ours[1:], expected[1:], rtol=0.0, atol=2e-3 * np.max(np.abs(expected[1:])))
