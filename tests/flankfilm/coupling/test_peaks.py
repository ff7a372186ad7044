"""Maximum forces of a drive train over a range of speed: at jumps, of motions that do not repeat, between speeds."""

from __future__ import annotations

import numpy as np
import pytest

import dynamics
from flankfilm.coupling import PairDrive, drive_sweep, given_series, pair_drive
from flankfilm.coupling.speeds import drive_peaks
from flankfilm.coupling.vibration.resonance import vibration
from flankfilm.report.drive_parts import headlines
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04).with_backlash(50e-6)
SECANT = 19.41e9 * 0.04


def train(damping: float, error: float) -> PairDrive:
    """Two shafts that bend and twist, one natural frequency of the mesh in the range that is swept."""
    bearings = Bearing(0.02, 4e8), Bearing(0.18, 4e8)
    shafts = [Shaft((ShaftSegment(0.2, 0.035),), bearings, gear, 0.0) for gear in (0.06, 0.1)]
    given = {"shafts": tuple(shafts), "end_inertias": (0.02, 0.05)}
    series = given_series(SECANT, (0.15,))
    return pair_drive(PAIR, series, 300.0, 200.0, error_amplitude=error, damping_ratio=damping, **given)


def sampled(swept, name: str) -> np.ndarray:
    """Maximum of a figure over both sweeps."""
    return np.max([np.nanmax(values, axis=0) for values in getattr(swept, name).values()], axis=0)


def followed(drive: PairDrive, swept: list[float], high: float, count: int) -> list[tuple[float, float]]:
    """Mesh frequency and mesh force of the motion that a sweep ends with, from there on until it ends."""
    osc, found = drive.oscillator, []
    settled = dynamics.sweep(osc, "frequency", np.array(swept))
    state, periods = settled.states[-1, -1], int(settled.periods[-1])
    for frequency in np.linspace(swept[-1], high, count).tolist():
        here = osc.with_parameter("frequency", frequency)
        orbit = dynamics.find_orbit(here, state, periods=periods)
        if not (orbit.converged and orbit.stable):
            break
        state = orbit.state
        seen = vibration(here, state, orbit.periods, load=drive.mean_force, outputs=drive.outputs)
        found.append((frequency, float(seen.force)))
    return found


def test_a_force_that_rises_up_to_a_jump_is_followed_to_it():
    """Against small steps of the motion that sweeps leave at 1.02: it ends at 1.0247, where its force is maximum."""
    drive = train(0.05, 5e-6)
    swept = drive_sweep(drive, frequency=[0.98, 1.0, 1.02])
    beyond = drive_sweep(drive, frequency=[0.98, 1.0, 1.02, 1.06])
    assert beyond.force_peak > 1.1 * swept.force_peak
    small = followed(drive, [0.98, 1.0, 1.02], 1.03, 1001)
    assert len(small) < 1001
    assert small[-1][1] == max(force for _, force in small)
    assert beyond.force_peak == pytest.approx(small[-1][1], rel=drive_peaks.SETTLED)
    assert beyond.force_peak_speed == pytest.approx(small[-1][0] * drive.scales.speed(1.0), rel=1e-4)
    assert np.isfinite(beyond.force_peak_error)


def test_motions_that_do_not_repeat_count_and_how_far_their_maximum_is_off_is_unknown():
    drive = train(0.02, 10e-6)
    swept = drive_sweep(drive, frequency=[0.94, 1.06, 1.1])
    assert swept.force_peak == sampled(swept, "force_factor")
    for figure in ("bearing_force", "shaft_torque"):
        assert np.all(getattr(swept, f"{figure}_peak") >= sampled(swept, figure))
    assert np.isnan(swept.force_peak_band).all()
    assert swept.force_peak_error == np.inf
    said = {line.name: line.note for line in headlines(swept)}
    assert "does not repeat" in said["maximum mesh force over the mean force"]


def test_a_range_without_any_motion_that_repeats_has_what_the_sweeps_saw():
    swept = drive_sweep(train(0.02, 10e-6), frequency=[1.04, 1.06])
    assert swept.force_peak == sampled(swept, "force_factor")
    assert np.all(np.isinf(swept.bearing_force_peak_error))


def test_of_two_motions_at_a_speed_the_one_with_the_maximum_force_is_followed(monkeypatch):
    """A jump between sweeps up and down leaves two; the lower one leads away from the peak."""
    drive = train(0.05, 5e-6)
    settled = {"up": dynamics.sweep(drive.oscillator, "frequency", np.array([0.8, 0.82]))}
    search = drive_peaks._Search(drive, settled, {"up": np.ones((2, 1 + len(drive.outputs)))})
    high = search.known[0]
    search.known.insert(0, high._replace(state=2.0 * high.state, heights=0.5 * high.heights))
    starts, find = [], dynamics.find_orbit
    monkeypatch.setattr(
        dynamics,
        "find_orbit",
        lambda osc, state, **given: (starts.append(state), find(osc, state, **given))[1],
    )
    assert np.isfinite(search.at(0, 0.801).height)
    assert starts[0] is high.state
