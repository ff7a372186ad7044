"""Drive trains reduced to modes: independent frequencies, the unreduced train solved directly, static answers."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigh

from flankfilm.building.shafts import drive_arguments
from flankfilm.coupling import PairDrive, drive_sweep, given_series, pair_drive
from flankfilm.coupling.drive.drive_reduced import drive_squares
from flankfilm.scene import read_scene
from gears import Gear, GearPair

SCENE = read_scene(Path(__file__).parents[3] / "examples" / "drive.toml")
PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04).with_backlash(50e-6)
SECANT = 19.41e9 * 0.04
SPEEDS = (1000.0 * math.pi / 30.0, 16000.0 * math.pi / 30.0)


def train(amplitudes=(0.12, 0.08, 0.05), **changes) -> PairDrive:
    given = drive_arguments(SCENE) | {"speeds": SPEEDS, "error_amplitude": (4e-6, 1e-6)}
    return pair_drive(PAIR, given_series(SECANT, amplitudes), 300.0, 200.0, **(given | changes))


@pytest.fixture(scope="module")
def example() -> PairDrive:
    return train()


def forces(drive: PairDrive, frequencies: np.ndarray, reduced: bool, factor: float = 1.0) -> np.ndarray:
    """Forces of parts by a unit mesh excitation, linear in contact, solved directly; `factor` is of damping."""
    rigid, scales = drive.rigid, drive.scales
    c = 2.0 * rigid.oscillator.damping_ratio * scales.equivalent_mass * scales.omega_n
    if reduced:
        osc, m, w = drive.oscillator, scales.equivalent_mass, scales.omega_n
        mass, damping = np.asarray(osc.mass) * m, np.asarray(osc.damping) * m * w
        stiffness, g = np.asarray(osc.stiffness) * scales.mean_stiffness, np.asarray(osc.direction)
        push = np.array([one.displacement for one in drive.outputs]) / scales.length
        drag = np.array([one.speed for one in drive.outputs]) / scales.length / w
    else:
        own = drive.shaft_damping.train
        mass, stiffness, g = own.mass.toarray(), own.stiffness.toarray(), own.direction
        damping = drive.shaft_damping.of(np.eye(len(g)))
        push = np.array([one.displacement for one in own.outputs])
        drag = np.array([one.speed for one in own.outputs])
    found = []
    for nu in 2.0 * math.pi * frequencies:
        mesh = (scales.mean_stiffness + 1j * nu * c) * np.outer(g, g)
        x = np.linalg.solve(stiffness + 1j * nu * factor * damping - nu**2 * mass + mesh, g.astype(complex))
        found.append((push + 1j * nu * drag) @ x)
    return np.array(found)


def test_frequencies_of_the_example_are_those_of_another_beam_model(example):
    """Full beams with rotary inertia and tilting gears, on the secant stiffness; two modes share the mesh."""
    found = example.natural_frequencies
    assert found[:4] == pytest.approx([180.0, 552.0, 1184.0, 1733.0], rel=1.5e-3)
    assert np.sum((found > 1800.0) & (found < 6300.0)) == 6
    mesh = np.sort(found[np.argsort(example.mesh_share)[-2:]])
    assert mesh == pytest.approx([7378.0, 9083.0], rel=6e-3)
    assert np.all(example.reduction_change < 1e-8)
    assert np.all(example.element_error[found < 1e4] < 3e-4)
    assert example.retained[found < 6300.0].tolist() == [1.0] * 10
    assert np.isnan(example.frequency_error).all()  # of a stiffness that is given


def test_forces_of_parts_are_those_of_the_unreduced_train(example):
    """Bearings and shafts over the mesh frequencies that are swept: within the tolerance, most far within."""
    at = np.geomspace(600.0, 9600.0, 60)
    ours, theirs = (np.abs(forces(example, at, reduced)) for reduced in (True, False))
    off = np.abs(ours - theirs) / np.maximum(theirs, 0.1 * theirs.max(axis=0))
    assert off.max() < 0.05
    assert np.median(off) < 3e-3
    assert example.reduction_error < 0.05
    assert example.valid_to >= 9600.0 * (1.0 - 1e-9)
    beyond = np.linspace(25e3, 40e3, 40)
    ours, theirs = (np.abs(forces(example, beyond, reduced)) for reduced in (True, False))
    assert np.max(np.abs(ours / theirs - 1.0)) > 0.5  # and the measure can tell


def test_the_sweep_has_the_forces_of_the_unreduced_train(example):
    """A stiffness that stays and an error too small for impacts: swings of forces by the exact flow, and directly."""
    drive = train((0.0,), error_amplitude=1e-7)
    bearings = [k for k, one in enumerate(drive.outputs) if one.unit == "N"]
    shafts = [k for k, one in enumerate(drive.outputs) if one.unit == "N m"]
    for rpm in (3000.0, 12000.0):
        swept = drive_sweep(drive, speed=[rpm * math.pi / 30.0])
        direct = linear(drive, np.array([rpm * 36.0 / 60.0]), 1e-7)[0] / math.sqrt(2.0)
        # a sweep leaves 1e-6 of the largest displacement; the coupling's is 3000 times the swing
        assert swept.bearing_force_swing["up"][0] == pytest.approx(direct[bearings], rel=0.03, abs=0.02)
        assert swept.shaft_torque_swing["up"][0] == pytest.approx(direct[shafts], rel=0.03, abs=2e-3)
        assert swept.valid_to == drive.valid_to


def linear(drive: PairDrive, frequencies: np.ndarray, error: float, factor: float = 1.0) -> np.ndarray:
    """Amplitudes of the forces of parts by an error's amplitude [m], of the unreduced train solved directly."""
    nu, scales = 2.0 * math.pi * frequencies, drive.scales
    c = 2.0 * drive.rigid.oscillator.damping_ratio * scales.equivalent_mass * scales.omega_n
    push = np.abs(scales.mean_stiffness + 1j * nu * c) * error
    return np.abs(forces(drive, frequencies, False, factor)) * push[:, None]


def test_a_peak_between_two_speeds_is_found():
    """The mode at 1184 Hz between 1080 and 1320 Hz: place, height and damping's band of the linear response."""
    drive = train((0.0,), error_amplitude=2e-7, speeds=(100.0, 300.0))
    swept = drive_sweep(drive, speed=np.array([1800.0, 2200.0]) * math.pi / 30.0)
    at = np.linspace(1080.0, 1320.0, 241)
    names, curves = [one.name for one in drive.outputs], linear(drive, at, 2e-7)
    for figure, parts in (("bearing_force", swept.bearings), ("shaft_torque", swept.shafts)):
        for column, name in enumerate(parts):
            part = names.index(name)
            mean = abs(float(getattr(swept, f"{figure}_mean")["up"][0, column]))
            curve = curves[:, part]
            peak, speed = (float(getattr(swept, f"{figure}_peak{end}")[column]) for end in ("", "_speed"))
            sampled = getattr(swept, figure)["up"][:, column].max()
            assert peak - mean == pytest.approx(curve.max(), rel=5e-3, abs=1e-6 * mean)
            if curve.max() > 2.0 * curve[[0, -1]].max():
                assert speed * 36.0 / (2.0 * math.pi) == pytest.approx(at[np.argmax(curve)], rel=3e-3)
                assert peak > sampled
                band = getattr(swept, f"{figure}_peak_band")[:, column] - mean
                for factor, height in zip((0.5, 2.0), band.tolist(), strict=True):
                    direct = linear(drive, np.array([speed * 36.0 / (2.0 * math.pi)]), 2e-7, factor)[0, part]
                    assert height == pytest.approx(direct, rel=5e-3, abs=1e-6 * mean)
                error = getattr(swept, f"{figure}_peak_error")[column]
                assert error >= np.max(np.abs(band - (peak - mean))) / peak
    assert np.isfinite(swept.bearing_force_peak_error).all()
    assert "valid to" not in swept.message
    assert "forces are valid to" in drive_sweep(drive, speed=[3000.0]).message


def test_frequencies_err_upwards_and_settle():
    """Ritz: the reduced train is never lower than the unreduced one, and with more modes it comes nearer."""
    whole = train().shaft_damping.train
    exact = np.sqrt(eigh(whole.in_contact.toarray(), whole.mass.toarray(), eigvals_only=True)[1:])
    worst = []
    for tolerance in (1.0, 0.3, 0.05, 0.005):
        drive = train(reduction_tolerance=tolerance)
        found = np.sqrt(drive_squares(drive.oscillator)) * drive.scales.omega_n
        assert np.all(found >= exact[: len(found)] * (1.0 - 1e-9))
        worst.append(np.max(found[:10] / exact[:10] - 1.0))
        assert drive.reduction_error <= tolerance
    assert worst[-1] < 1e-6
    assert len(found) > 20


def test_out_of_contact_both_sides_turn_freely_and_vibrate_as_they_do(example):
    """Modes are those in contact; without the mesh two rotations are free, and the lowest frequencies are kept."""
    whole = example.shaft_damping.train
    exact = np.sqrt(
        np.maximum(eigh(whole.out_of_mesh.toarray(), whole.mass.toarray(), eigvals_only=True), 0.0)
    )
    osc = example.oscillator
    found = (
        np.sqrt(np.maximum(eigh(osc.stiffness, osc.mass, eigvals_only=True), 0.0)) * example.scales.omega_n
    )
    assert np.all(found[:2] < 1e-4 * exact[2])
    assert found[2:14] == pytest.approx(exact[2:14], rel=2e-3)


def test_static_answers_are_exact():
    """At rest under the mean load every bearing and shaft carries what the levers say."""
    example = train(error_amplitude=0.0)
    states = example.oscillator.rest_state()[None]
    force = 300.0 / PAIR.base_radii[0]
    expected = [force * 70 / 120, force * 50 / 120, 300.0, 300.0]
    expected += [force * 100 / 60, -force * 40 / 60, 300.0 * 40 / 36]
    assert [float(one.of(states)[0]) for one in example.outputs] == pytest.approx(expected, rel=1e-7)


def test_gyroscopic_moments_split_by_the_speed(example):
    """What is left out grows with the speed; next to nothing at a hundredth of it."""
    slow = train(speeds=(SPEEDS[0] / 100.0, SPEEDS[1] / 100.0))
    assert 5e-3 < example.gyroscopic_change < 0.05
    assert slow.gyroscopic_change < 0.02 * example.gyroscopic_change


def test_a_mesh_that_resists_tilt_raises_frequencies_by_as_much_as_told(example):
    """Stiffness spread evenly over the face, k b^2 / 12; a force beside the middle of the face lowers them."""
    evenly = train(tilt_stiffness=SECANT * 0.04**2 / 12.0)
    n = min(len(evenly.natural_frequencies), len(example.natural_frequencies))
    change = evenly.natural_frequencies[:n] / example.natural_frequencies[:n] - 1.0
    assert np.all(change > -1e-9)
    assert change.max() == pytest.approx(example.tilt_change, rel=1e-6)
    aside = train(load_centre=0.01)
    assert aside.natural_frequencies[1] != pytest.approx(example.natural_frequencies[1], rel=1e-3)
