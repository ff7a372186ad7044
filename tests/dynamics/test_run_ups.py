"""Slow run-ups against an independent integrator with a varying frequency, and against the folds of steady motions."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import dynamics.motion.run_ups
from base import InputError
from dynamics import FourierStiffness, GearOscillator, find_orbit, run_up
from tests.dynamics.test_drives import chain, same_as
from tests.validation.article_motion import lubricated


@pytest.mark.slow
def test_a_ramp_is_that_of_the_equation_with_a_varying_frequency():
    """Without backlash and with a phase, so that the impulses between periods count; scipy knows no steps."""
    osc = GearOscillator(
        FourierStiffness(1.0, (0.1,), (0.3,)), 0.05, 0.2, (0.05, 0.02), 0.5, 0.0, (0.8, -1.1)
    )
    first, last, periods = 0.5, 0.55, 320
    found = run_up(osc, (first, last), periods, state=(0.2, 0.0))
    growth = (last**2 - first**2) / (2.0 * math.pi * periods)  # of w^2 by angle

    def motion(tau, y):
        theta = y[2]
        w = math.sqrt(first**2 + growth * theta)
        force = 0.2
        for j, (e, phi) in enumerate(zip((0.05, 0.02), (0.8, -1.1), strict=True), start=1):
            force += e * (
                j * j * w * w * math.cos(j * theta + phi) + j * 0.5 * growth * math.sin(j * theta + phi)
            )
        k = 1.0 + 0.1 * math.cos(theta + 0.3)
        return [y[1], force - 2 * 0.05 * y[1] - k * y[0], w]

    end = 2.0 * math.pi * periods
    done = solve_ivp(
        motion, (0.0, 1e6), [0.2, 0.0, 0.0], events=_reached(end), rtol=1e-9, atol=1e-11, max_step=0.5
    )
    theta, x = done.y[2], done.y[0]
    blocks = (theta // (32.0 * math.pi)).astype(int)
    for block in (2, 10, 18):
        mine = blocks == block
        spread = _rms(done.t[mine], x[mine])
        assert found.rms[block] == pytest.approx(spread, rel=2e-3)
        assert found.peak[block] == pytest.approx(x[mine].max(), rel=2e-3)
    assert found.rms_error.max() < 2e-3
    assert found.error < 3e-3  # of peaks between samples, too


def test_a_train_of_one_freedom_runs_up_as_the_pair(monkeypatch):
    """Frequency by frequency the same motion: impulses of the error's rate are the train's own; q is X and e."""
    monkeypatch.setattr(dynamics.motion.run_ups, "HELD", 1)
    gear = GearOscillator(
        FourierStiffness(1.0, (0.18,), (0.3,)), 0.05, 0.1, (0.2, 0.03), 0.6, 0.2, (0.4, 1.0)
    )
    bounds = (0.66, 0.7)  # contact is lost, which is seldom to the last block
    ours = run_up(same_as(gear), bounds, 128, outputs=[[1.0, 0.0], [0.0, 3.0]])
    theirs = run_up(gear, bounds, 128)
    assert theirs.separated.max() > 0.1
    for name in ("rms", "peak", "force_rms", "force_peak", "separated", "force_order", "displacement_order"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), rel=1e-8, abs=1e-10), name
    assert ours.rate == pytest.approx(theirs.rate, rel=1e-12)
    assert ours.output_rms.shape == ours.output_peak.shape == (8, 2)
    assert np.all(np.abs(ours.output_peak[:, 0] - ours.peak) < 0.23)
    assert theirs.output_peak.shape == (8, 0)


@pytest.mark.slow
def test_a_train_on_a_ramp_is_that_of_its_equations_with_a_varying_frequency():
    """Four freedoms in contact; scipy knows no steps. What a shaft carries is an output."""
    drive = chain(mean_force=[0.4, 0.0, 0.0, 0.5], error_amplitude=(0.1, 0.02), error_phase=(0.4, 1.0))
    first, last, periods = 0.85, 0.9, 160
    shaft = np.array([0.8, -0.8, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    start = drive.rest_state()
    found = run_up(drive, (first, last), periods, state=start, outputs=[shaft])
    assert np.all(found.separated == 0.0)
    growth = (last**2 - first**2) / (2.0 * math.pi * periods)
    mass, damping, stiffness, g, force = (
        np.asarray(getattr(drive, name))
        for name in ("mass", "damping", "stiffness", "direction", "mean_force")
    )
    inverse = np.linalg.inv(mass)

    def motion(tau, y):
        q, speed, theta = y[:4], y[4:8], y[8]
        w = math.sqrt(first**2 + growth * theta)
        e = sum(a * math.cos(j * theta + p) for j, a, p in ((1, 0.1, 0.4), (2, 0.02, 1.0)))
        rate = -w * sum(j * a * math.sin(j * theta + p) for j, a, p in ((1, 0.1, 0.4), (2, 0.02, 1.0)))
        gap = g @ q - e
        push = drive.mesh_stiffness(theta) * (gap - 0.15) + drive.mesh_damping * (g @ speed - rate)
        bent = inverse @ (force - damping @ speed - stiffness @ q - g * push)
        return [*speed, *bent, w]

    def reached(tau, y):
        return y[8] - 2.0 * math.pi * periods

    reached.terminal = True
    done = solve_ivp(motion, (0.0, 1e6), [*start, 0.0], events=reached, rtol=1e-8, atol=1e-10, max_step=0.3)
    y, carried = g @ done.y[:4], shaft[:4] @ done.y[:4]
    y = y - sum(a * np.cos(j * done.y[8] + p) for j, a, p in ((1, 0.1, 0.4), (2, 0.02, 1.0)))
    blocks = (done.y[8] // (32.0 * math.pi)).astype(int)
    for block in (1, 4, 8):
        mine = blocks == block
        assert found.rms[block] == pytest.approx(_rms(done.t[mine], y[mine]), rel=3e-3)
        assert found.output_rms[block, 0] == pytest.approx(_rms(done.t[mine], carried[mine]), rel=3e-3)
        assert found.output_peak[block, 0] == pytest.approx(np.abs(carried[mine]).max(), rel=3e-3)
    assert found.error < 3e-3


@pytest.mark.parametrize("outputs", [[[1.0, 0.0, 0.0]], [1.0, 0.0], [[np.nan, 0.0]]])
def test_outputs_are_rows_as_long_as_a_state(outputs):
    with pytest.raises(InputError, match="outputs"):
        run_up(lubricated(0.6), (0.6, 0.61), 64, outputs=outputs)


def _reached(end):
    def event(tau, y):
        return y[2] - end

    event.terminal = True
    return event


def _rms(t, x):
    mean = np.trapezoid(x, t) / (t[-1] - t[0])
    return math.sqrt(np.trapezoid((x - mean) ** 2, t) / (t[-1] - t[0]))


@pytest.mark.slow
@pytest.mark.parametrize(("bounds", "fold"), [((0.6, 0.7), 0.65556), ((0.7, 0.55), 0.56940)])
def test_jumps_come_behind_the_folds_of_the_steady_motions(bounds, fold):
    start = find_orbit(lubricated(bounds[0]), (0.35, 0.0) if bounds[0] < 0.65 else (1.0, 0.5)).state
    found = run_up(lubricated(0.6), bounds, 8_000, state=start)
    at = found.frequency[1 + int(np.argmax(np.abs(np.diff(found.rms))))]
    late = (at - fold) * np.sign(bounds[1] - bounds[0])
    assert -1e-3 < late < 1e-2


def test_orders_hold_the_motion():
    """Lines of a block at whole orders add up to its root mean square while the motion has the period."""
    found = run_up(lubricated(0.6), (0.3, 0.45), 3200)
    whole = found.displacement_order[:, 15::16]
    settled = slice(5, None)  # at the start the ramp itself sets in
    by_lines = np.sqrt(0.5 * np.sum(whole**2, axis=1))
    assert by_lines[settled] == pytest.approx(found.rms[settled], rel=2e-2)
    assert found.order[15] == 1.0
    assert np.all(found.separated == 0.0)


def test_too_fast_is_said():
    found = run_up(lubricated(0.6), (0.3, 1.2), 64)
    assert found.rate > 0.1
    assert "faster" in found.message
    with pytest.raises(InputError, match="bounds"):
        run_up(lubricated(0.6), (-0.1, 1.0))


def test_errors_are_told_block_by_block():
    """A jump that the run of longer steps makes a block later; a peak between samples."""
    fine = np.full((6, 7), 2.0)
    fine[3:] = 6.0
    coarse = fine * (1.0 + 1e-7)
    coarse[3] = 2.0
    above = np.zeros((6, 3))
    above[5] = 0.3
    by_rms, by_peak, greatest = dynamics.motion.run_ups._errors(fine, coarse, above)
    assert by_rms == pytest.approx([1e-7, 1e-7, 1e-7, 2 / 3, 1e-7, 1e-7], rel=1e-6)
    assert by_peak == pytest.approx([1e-7, 1e-7, 1e-7, 2 / 3, 1e-7, 0.05], rel=1e-6)
    assert greatest == pytest.approx(1e-7, rel=1e-6)
    coarse[2] = np.nan
    assert dynamics.motion.run_ups._errors(fine, coarse, above)[0][2] == np.inf


def test_errors_cover_blocks_and_peaks(monkeypatch):
    """Peaks against sixteen times the samples; a median of the root mean squares alone was 1e-8 here."""
    start = find_orbit(lubricated(0.68), (1.0, 0.5)).state
    found = run_up(lubricated(0.6), (0.68, 0.5), 400, state=start)
    monkeypatch.setattr(dynamics.motion.run_ups, "SAMPLES", 1024)
    true = run_up(lubricated(0.6), (0.68, 0.5), 400, state=start)
    for name in ("peak", "force_peak"):
        off = np.abs(getattr(found, name) / getattr(true, name) - 1.0)
        assert off.max() > 1e-4
        assert np.all(off <= found.error)
        assert np.mean(off <= found.peak_error) > 0.98
        top = np.max(getattr(found, name)) / np.max(getattr(true, name)) - 1.0
        assert abs(top) <= found.greatest_error
    assert found.error == max(found.rms_error.max(), found.peak_error.max())
