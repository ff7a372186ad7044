"""Periodic forces on a drive train: exact harmonics in contact, an integrator beyond it, and what they leave alone."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

import dynamics
from base import InputError
from dynamics import DriveOscillator, FourierStiffness, find_orbit, period_map, trajectory
from dynamics.branches.continuation import problem_of
from dynamics.branches.grazing import contact_orbit
from dynamics.flow.drive_flow import drive_flow
from dynamics.motion.gridded_motion import GriddedContact, gridded_motions
from tests.dynamics.test_drives import KICK, by_steps, chain, pair

ALONG = np.array([0.5, -0.2, 0.7, 0.1])
SIZES, TURNS = (0.05, 0.0, 0.03), (0.8, 0.0, -2.1)
FORCED = {"force_direction": ALONG, "force_amplitude": SIZES, "force_phase": TURNS}
LINEAR = {
    "mesh_stiffness": FourierStiffness(1.0), "mean_force": [5.0, 0.0, 0.0, 6.0], "error_amplitude": 0.0,
    "error_phase": 0.0,
}  # fmt: skip


def harmonics(drive: DriveOscillator, order: int) -> np.ndarray:
    """Displacements of a train in contact, of constant stiffness, by its dynamic stiffness."""
    g, nu = np.asarray(drive.direction), order * drive.frequency
    mesh = np.outer(g, g) * (drive.mesh_stiffness.mean + 1j * nu * drive.mesh_damping)
    whole = drive.stiffness + mesh + 1j * nu * drive.damping - nu**2 * drive.mass
    size = drive.force_amplitude[order - 1] * np.exp(1j * drive.force_phase[order - 1])
    return np.linalg.solve(whole, size * np.asarray(drive.force_direction))


@pytest.mark.parametrize("frequency", [0.05, 0.4, 0.9, 2.3])
def test_in_contact_a_force_has_the_response_of_the_dynamic_stiffness(frequency):
    drive = chain(**LINEAR, **FORCED, frequency=frequency)
    g = np.asarray(drive.direction)
    rest = np.linalg.solve(
        drive.stiffness + np.outer(g, g), np.asarray(drive.mean_force) + g * drive.half_backlash
    )
    orbit = find_orbit(drive, drive.rest_state())
    assert orbit.label == "1-0-0"
    motion = trajectory(drive, orbit.state, 1, 64)
    angle = drive.frequency * motion.tau
    swings = [harmonics(drive, j) for j in (1, 2, 3)]
    q = rest + sum(np.real(np.outer(np.exp(1j * j * angle), a)) for j, a in enumerate(swings, start=1))
    v = sum(
        np.real(np.outer(1j * j * frequency * np.exp(1j * j * angle), a))
        for j, a in enumerate(swings, start=1)
    )
    np.testing.assert_allclose(motion.states, np.hstack([q, v]), rtol=0.0, atol=1e-11)


def test_a_force_along_the_mesh_that_the_error_makes_is_that_error():
    """The error's forces c e' + k e on y, as a force: the same displacements by another route."""
    uneven = chain(**{**LINEAR, "error_amplitude": (0.1, 0.02), "error_phase": (0.3, 1.1)})
    nu = uneven.frequency * np.arange(1, 3)
    forces = np.array([0.1, 0.02]) * np.exp(1j * np.array([0.3, 1.1])) * (1.0 + 1j * nu * uneven.mesh_damping)
    pushed = chain(
        **LINEAR, force_direction=uneven.direction, force_amplitude=tuple(np.abs(forces)),
        force_phase=tuple(np.angle(forces)),
    )  # fmt: skip
    first, second = (find_orbit(drive, drive.rest_state()) for drive in (uneven, pushed))
    assert first.state == pytest.approx(second.state, abs=1e-11)
    assert first.multipliers == pytest.approx(second.multipliers, abs=1e-12)


@pytest.mark.parametrize(
    "changes",
    [{}, {"free_mesh_damping": 0.4}, {"half_backlash": 0.0}, {"one_sided": True}],
    ids=["chain", "damping jumps", "no play", "one flank"],
)
def test_a_forced_train_with_impacts_against_an_integrator(changes):
    """States to 1e-9 after two periods with impacts, Jacobian to 1e-8: what the integrator's tolerance leaves."""
    drive = chain(**FORCED, **changes)
    start = drive.rest_state() + (0.3 if drive.one_sided else 1.0) * KICK
    state, jacobian, crossings = by_steps(drive, start, 2 * drive.period)
    ours, without = period_map(drive, start, 2), period_map(chain(**changes), start, 2)
    assert crossings > 1 or drive.half_backlash == 0.0
    assert ours.state == pytest.approx(state, abs=1e-9)
    assert ours.jacobian == pytest.approx(jacobian, abs=1e-8 * np.max(np.abs(jacobian)))
    assert np.max(np.abs(ours.state - without.state)) > 0.02


def test_strides_and_samples_are_forced_as_cells_are():
    drive = chain(**FORCED, frequency=0.23, half_backlash=0.05)
    start = drive.rest_state() + KICK
    cells = drive_flow(drive)
    short = [cells.follow(start)]
    for _ in range(3):
        short.append(cells.follow(short[-1].state))
    strides = drive_flow(drive)
    assert len(strides.in_strides[-1]) == strides.cells // 8 > 4
    found = strides.follow(start, 4)
    np.testing.assert_allclose(found.states, [one.state for one in short], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(
        trajectory(drive, start, 4, 10).states[10::10], found.states, rtol=0.0, atol=1e-12
    )


def test_a_later_start_turns_all_phases():
    drive, shift = chain(**FORCED), 2.0 * np.pi * 5 / 16
    path = trajectory(drive, drive.rest_state() + KICK, 2, 16)
    j = np.arange(1, 4)
    turned = dataclasses.replace(
        drive,
        mesh_stiffness=FourierStiffness(1.0, (0.18, 0.05), (0.3 + shift, 1.0 + 2.0 * shift)),
        error_phase=(0.4 + shift, 1.0 + 2.0 * shift),
        force_phase=tuple(np.array(TURNS) + j * shift),
    )
    assert period_map(turned, path.states[5]).state == pytest.approx(path.states[21], abs=1e-11)


def test_in_contact_a_force_changes_no_multiplier():
    """Additive forcing: the monodromy of a motion that stays in contact is that of the unforced one."""
    steady = {"mean_force": [5.0, 0.0, 0.0, 6.0]}
    forced, free = (
        find_orbit(drive, drive.rest_state()) for drive in (chain(**steady, **FORCED), chain(**steady))
    )
    assert forced.multipliers == pytest.approx(free.multipliers, abs=1e-13)
    assert np.max(np.abs(forced.state - free.state)) > 0.01


@pytest.mark.parametrize("name", ["frequency", "force_amplitude[2]", "force_phase[0]"])
def test_the_map_changes_with_a_parameter_as_the_integrator_says(name):
    drive = chain(**FORCED)
    start, value = drive.rest_state() + KICK, drive.get(name)
    low, high = np.array([value - 0.1]), np.array([value + 0.1])
    problem = problem_of(drive, (name,), 1, low, high, 1.0)
    point = problem.evaluate(problem.unknowns(start, value))
    step = 1e-4
    ends = []
    for way in (1, -1):
        there = drive.with_parameter(name, value + way * step)
        ends.append(by_steps(there, start, there.period)[0])
    slope = (ends[0] - ends[1]) / (2.0 * step)
    np.testing.assert_allclose(point.derivative[:, -1] * problem.scale / 0.2, slope, rtol=0.0, atol=2e-5)


def test_a_branch_over_the_frequency_passes_the_orbits_found_by_themselves():
    drive = chain(**FORCED, mean_force=[0.4, 0.0, 0.0, 0.5])
    branch = dynamics.continue_branch(
        find_orbit(drive, drive.rest_state(), transient=100), "frequency", (0.8, 1.0)
    )
    for value in (0.85, 0.97):
        at = int(np.argmin(np.abs(branch.values - value)))
        there = drive.with_parameter("frequency", float(branch.values[at]))
        state = branch.states[at]
        assert period_map(there, state).state == pytest.approx(state, abs=1e-9)


def test_without_a_swing_nothing_changes_in_any_digit():
    plain, still = chain(), chain(**{**FORCED, "force_amplitude": (0.0, 0.0, 0.0)})
    assert (plain.cells, plain.natural_size, plain.driven_size) == (
        still.cells,
        still.natural_size,
        still.driven_size,
    )
    start = plain.rest_state() + KICK
    first, second = (period_map(drive, start, 40) for drive in (plain, still))
    assert np.array_equal(first.states, second.states)
    assert np.array_equal(first.jacobian, second.jacobian)


def test_the_linear_orbit_and_the_turning_points_know_the_force():
    drive = chain(**{**LINEAR, **FORCED, "mean_force": [0.4, 0.0, 0.0, 0.5]})
    linear, orbit = contact_orbit(drive), find_orbit(drive, drive.rest_state())
    assert linear.clearance > 0.0
    assert linear.state == pytest.approx(orbit.state, abs=1e-10)
    state = orbit.state.copy()
    g = np.asarray(drive.direction)
    state[4:] -= g * (g @ state[4:]) / (g @ g)  # y at rest
    samples = round(drive.period / 1e-4)
    y = trajectory(drive, state, 1, samples).x[:4]
    found = (2.0 * y[0] - 5.0 * y[1] + 4.0 * y[2] - y[3]) * (samples / drive.period) ** 2
    assert drive.turning_acceleration(state) == pytest.approx(found, abs=1e-4)


def test_the_gridded_motion_is_forced_alike():
    drive = chain(
        **{**FORCED, "mean_force": [0.4, 0.0, 0.0, 0.5], "error_amplitude": 0.01, "error_phase": 0.0}
    )
    drive = dataclasses.replace(drive, mesh_stiffness=FourierStiffness(1.0))
    spring = GriddedContact(np.tile([0.0, 1.0], (12, 1)), 0.0, 1.0, np.zeros(12), 0.0)
    found = gridded_motions(drive, spring, [0.9]).force[0]
    motion = trajectory(drive, find_orbit(drive, drive.rest_state()).state, 1, 2000)
    still = dataclasses.replace(drive, force_amplitude=0.0, force_phase=0.0)
    alone = trajectory(still, find_orbit(still, still.rest_state()).state, 1, 2000)
    force, without = (np.max(each.x) - drive.half_backlash for each in (motion, alone))
    assert found == pytest.approx(force, rel=1e-4)
    assert abs(force / without - 1.0) > 0.02


def test_the_size_of_what_drives_is_that_of_the_force_at_rest():
    drive = chain(**{**LINEAR, **FORCED, "mean_force": [1e-6, 0.0, 0.0, 1e-6], "half_backlash": 0.0})
    g = np.asarray(drive.direction)
    moved = np.linalg.solve(drive.stiffness + np.outer(g, g), 0.08 * ALONG)
    assert drive.natural_size == drive.driven_size == pytest.approx(np.max(np.abs(moved)), rel=1e-12)


def test_cells_resolve_the_highest_harmonic_that_moves():
    fine = chain(**{**FORCED, "force_amplitude": (*(0.0,) * 29, 0.01), "force_phase": 0.0})
    assert fine.cells == pytest.approx(4.0 * np.pi * 30)


@pytest.mark.parametrize(
    ("changes", "where", "words"),
    [
        ({"force_direction": [1.0, 0.0], "force_amplitude": 0.1}, "force_direction", "balance over a rotation"),
        ({"force_direction": [1.0]}, "force_direction", "finite numbers of shape"),
        ({"force_amplitude": 0.1}, "force_direction", "must be given beside force_amplitude"),
        ({"force_direction": [1.0, -1.0], "force_amplitude": (0.1, np.nan)}, "force_amplitude[1]", "finite"),
        ({"force_direction": [1.0, -1.0], "force_amplitude": (0.1, 0.1), "force_phase": (0.0,)}, "force_phase", "2 p"),
    ],
)  # fmt: skip
def test_forces_that_cannot_be_are_refused_by_name(changes, where, words):
    with pytest.raises(InputError, match=words) as raised:
        pair(**changes)
    assert raised.value.faults[0].where == where


def test_parameters_of_a_force_by_name():
    drive = chain(**FORCED)
    assert drive.get("force_amplitude[2]") == 0.03
    for name in drive.parameters:
        assert drive.with_parameter(name, drive.get(name)).get(name) == drive.get(name)
    assert not any("force_amp" in name for name in chain().parameters)
