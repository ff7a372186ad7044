"""Gridded contact against the exact flow: springs over position, backlash, drive trains, and orders of the steps."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import dynamics
from dynamics.flow.motions import trajectory
from dynamics.flow.samples import mesh_force
from dynamics.motion import free_motion, gridded_motion
from dynamics.motion.gridded_motion import GriddedContact, gridded_motions, unsettled
from dynamics.motion.sweeps import sweep

SERIES = dynamics.FourierStiffness(1.0, (0.18, 0.05), (0.0, 0.4))
PAIR = dynamics.GearOscillator(
    SERIES, 0.05, 0.1, (0.08, 0.004), 0.6, half_backlash=0.2, error_phase=(0.3, 1.0)
)
DRIVE = dynamics.DriveOscillator(
    [[1.0, 0.0], [0.0, 2.0]], [[0.1, 0.0], [0.0, 0.1]], [[0.5, -0.2], [-0.2, 0.4]], [1.0, -1.0], SERIES, 0.05,
    [0.1, -0.1], 0.02, 0.62, 0.2,
)  # fmt: skip


def springs(angles: int, mirror: float = 0.0, series: dynamics.FourierStiffness = SERIES) -> GriddedContact:
    """Force k(t) times the depth, on a grid."""
    stiffness = series(2.0 * np.pi * (np.arange(angles) + 0.5) / angles)
    return GriddedContact(np.outer(stiffness, np.linspace(0.0, 2.0, 9)), 0.0, 0.25, np.zeros(angles), mirror)


def exact(oscillator, frequency: float) -> float:
    """Maximum force by the exact flow."""
    found = sweep(oscillator, "frequency", [frequency])
    at = oscillator.with_parameter("frequency", frequency)
    motion = trajectory(at, found.states[0, -1], periods=int(found.periods[0]), points_per_period=2000)
    return float(mesh_force(at, motion).max())


@pytest.mark.parametrize("oscillator", [PAIR, DRIVE], ids=["pair", "drive"])
@pytest.mark.parametrize("frequency", [0.15, 0.5, 0.93])
def test_springs_on_a_grid_move_as_the_exact_flow(oscillator, frequency):
    """Separation and impacts at 0.93 included."""
    found = gridded_motions(oscillator, springs(480), [frequency])
    assert found.followed
    assert found.force[0] == pytest.approx(exact(oscillator, frequency), rel=2e-3)


@pytest.mark.parametrize("frequency", [0.15, 0.93])
def test_coordinates_of_modes_change_rounding_alone(monkeypatch, frequency):
    found = gridded_motions(DRIVE, springs(480), [frequency])
    monkeypatch.setattr(gridded_motion, "modes_of", lambda _: None)
    plain = gridded_motions(DRIVE, springs(480), [frequency])
    assert found.force[0] == pytest.approx(plain.force[0], rel=1e-10)


def test_modes_that_coincide_are_left_alone():
    """A mass without spring or damper moves on evenly: a matrix without a whole set of modes."""
    matrix = np.zeros((4, 4))
    matrix[0, 2] = matrix[1, 3] = 1.0
    assert free_motion.modes_of(matrix) is None
    matrix[2, 0], matrix[3, 1] = -1.0, -4.0
    modes = free_motion.modes_of(matrix)
    over, columns = modes.step(0.3)
    dense = np.zeros((4, 4))
    np.put_along_axis(dense, columns, over, axis=1)
    whole = modes.raises @ dense @ modes.lowers
    assert whole[0, [0, 2]] == pytest.approx([np.cos(0.3), np.sin(0.3)], abs=1e-14)
    assert whole[1, [1, 3]] == pytest.approx([np.cos(0.6), 0.5 * np.sin(0.6)], abs=1e-14)


def test_what_a_free_damping_changes_is_that_of_the_exact_flow():
    loose = replace(PAIR, free_damping_ratio=0.4)
    change = exact(loose, 0.93) - exact(PAIR, 0.93)
    found = [gridded_motions(each, springs(480), [0.93]).force[0] for each in (PAIR, loose)]
    assert abs(change) > 0.01
    assert found[1] - found[0] == pytest.approx(change, rel=0.05)


def test_the_error_falls_with_the_square_of_the_step():
    """A quarter of the step leaves a sixteenth; the maximum is that of samples, for which a half more is allowed."""
    linear = replace(PAIR, stiffness=dynamics.FourierStiffness(1.0), error_amplitude=0.02, error_phase=0.0)
    swing = 0.02 * 0.25 / np.hypot(0.75, 2.0 * 0.05 * 0.5)
    spring = springs(6, series=linear.stiffness)
    errors = [abs(gridded_motions(linear, spring, [0.5], steps).force[0] - 0.1 - swing) for steps in (24, 96)]
    assert errors[1] < errors[0] / 10.0


def test_back_flanks_bear_at_the_mirrored_position():
    """Rattling teeth: a stiffness that is its own mirror image is that of the exact flow, which has none."""
    even = dynamics.FourierStiffness(1.0, (0.18,), (0.0,))
    rattling = replace(
        PAIR, stiffness=even, mean_force=0.01, error_amplitude=0.3, error_phase=0.5, half_backlash=0.05
    )
    both = [gridded_motions(rattling, springs(480, mirror, even), [0.5]).force[0] for mirror in (0.0, 0.5)]
    assert both[0] == pytest.approx(exact(rattling, 0.5), rel=5e-3)
    assert abs(both[1] / both[0] - 1.0) > 0.02


def test_the_damper_does_not_feel_what_is_moved():
    """Without stiffness over position, a displacement that moves law and damper alike is an error of the pair."""
    size, amplitude = 480, 0.012
    curve = amplitude * np.cos(2.0 * np.pi * (np.arange(size) + 0.5) / size)
    lowest, spacing = -0.25, 0.005
    depths = lowest + spacing * np.arange(400)
    moved = GriddedContact(np.maximum(depths - curve[:, None], 0.0), lowest, spacing, curve, 0.0)
    linear = replace(PAIR, stiffness=dynamics.FourierStiffness(1.0), error_amplitude=0.0, error_phase=0.0)
    shaken = replace(linear, error_amplitude=amplitude)
    for frequency in (0.4, 0.8):
        found = gridded_motions(linear, moved, [frequency]).force[0]
        assert found == pytest.approx(exact(shaken, frequency), rel=2e-3)


def test_a_motion_goes_on_from_the_last_state():
    """Up and down a resonance of teeth that separate two motions are met."""
    values = np.linspace(0.7, 1.05, 15)
    up = gridded_motions(PAIR, springs(48), values).force
    down = gridded_motions(PAIR, springs(48), values[::-1]).force[::-1]
    assert np.any(np.abs(up / down - 1.0) > 0.05)
    assert up[0] == pytest.approx(down[0], rel=1e-3)


def test_what_grows_without_bound_has_no_force():
    wild = replace(PAIR, stiffness=dynamics.FourierStiffness(1.0), damping_ratio=0.0)
    pushed = GriddedContact(np.tile([0.0, -1.0], (12, 1)), 0.0, 1.0, np.zeros(12), 0.0)
    found = gridded_motions(wild, pushed, [0.02])
    assert not found.followed
    assert np.isnan(found.force).all()


def slowly_settling(frequency: float, amplitude: float) -> dynamics.GearOscillator:
    """Teeth that stay in contact, of a stiffness that swings."""
    series = dynamics.FourierStiffness(1.0, (amplitude,), (0.0,))
    return dynamics.GearOscillator(series, 0.05, 0.1, 0.003, frequency, half_backlash=0.0, error_phase=0.7)


@pytest.mark.parametrize("amplitude", [0.17, 0.19, 0.197])
def test_a_motion_that_has_not_settled_says_by_how_much(monkeypatch, amplitude):
    """Near parametric resonance a disturbance shrinks far more slowly than by damping: truth by 300 times as long."""
    slow = slowly_settling(2.0, amplitude)
    grid = springs(48, series=slow.stiffness)
    monkeypatch.setattr(gridded_motion, "LEAST_SETTLING", 6000)
    true = gridded_motions(slow, grid, [2.0])
    assert true.unsettled[0] < 1e-6
    monkeypatch.setattr(gridded_motion, "LEAST_SETTLING", 10)
    monkeypatch.setattr(gridded_motion, "settling_periods", lambda *_: 20)
    found = gridded_motions(slow, grid, [2.0])
    error = abs(found.force[0] / true.force[0] - 1.0)
    assert error > 1e-3
    assert 0.5 * error < found.unsettled[0] < 50.0 * error


@pytest.mark.parametrize(("frequency", "damping"), [(1.0, 0.005), (0.98, 0.003), (0.5, 0.004)])
def test_ten_periods_near_resonance_are_not_enough(monkeypatch, frequency, damping):
    linear = replace(
        PAIR, stiffness=dynamics.FourierStiffness(1.0), error_amplitude=3e-4, error_phase=0.0, damping_ratio=damping
    )  # fmt: skip
    spring = springs(24, series=linear.stiffness)
    true = gridded_motions(linear, spring, [frequency])
    assert true.unsettled[0] < 1e-5
    monkeypatch.setattr(gridded_motion, "settling_periods", lambda *_: 10)
    found = gridded_motions(linear, spring, [frequency])
    error = abs(found.force[0] / true.force[0] - 1.0)
    assert error > 1e-4
    assert found.unsettled[0] > 0.5 * error


def test_periodic_motions_have_settled_and_chaos_has_a_spread(monkeypatch):
    """At 1.6 the largest exponent is 0.07: what fifty times as many periods change is less than the error."""
    wild = replace(
        PAIR, stiffness=dynamics.FourierStiffness(1.0, (0.18,), (0.0,)), error_amplitude=0.2, error_phase=0.0
    )
    grid = springs(96, series=wild.stiffness)
    for frequency in (0.5, 0.6, 1.4):
        assert gridded_motions(wild, grid, [frequency]).unsettled[0] < 1e-5
    found = gridded_motions(wild, grid, [1.6])
    monkeypatch.setattr(gridded_motion, "KEPT", 400)
    change = abs(gridded_motions(wild, grid, [1.6]).force[0] / found.force[0] - 1.0)
    assert 1e-3 < change < found.unsettled[0]


def test_a_geometric_approach_has_what_is_left_of_it():
    for ratio in (0.2, 0.8, 0.99):
        for start in (0.3, -0.3):
            peaks = 2.0 + start * ratio ** np.arange(5.0)
            error = abs(peaks.max() / 2.0 - 1.0)
            assert error * (1.0 - 1e-9) <= unsettled(peaks, 0.1) * peaks.max() / 2.0 <= 0.151
    assert unsettled(np.full(4, 1.5), 1.0) == 0.0
    assert unsettled(np.array([1.0, 1.1, 1.2, 1.3]), 0.5) == pytest.approx(0.4 / 1.3)
    assert unsettled(np.array([1.0, 1.1, 1.0, 1.1]), 0.5) == pytest.approx(0.1 / 1.1)
