"""Drive trains at their extremes: shafts far stiffer and softer than the mesh, many harmonics, modes in resonance."""

from __future__ import annotations

import numpy as np
import pytest

import dynamics
from dynamics import DriveOscillator, FourierStiffness, continue_branch, find_orbit, period_map
from tests.dynamics.test_drives import KICK, by_steps, chain

ORDERS = np.arange(1, 51)
# a stiffness of two values, .7 of the period the larger one: its first 50 harmonics
RECTANGLE = FourierStiffness(
    1.0, tuple(0.4 / np.pi * np.sin(0.7 * np.pi * ORDERS) / ORDERS), tuple(0.1 * ORDERS)
)


def with_shafts(factor: float, **changes) -> DriveOscillator:
    """Chain whose two shafts are `factor` times as stiff as the mesh; damped by modes."""
    stiff = np.diag([0.05, 0.0, 0.0, 0.1])
    for i, j in ((0, 1), (2, 3)):
        rows = np.zeros(4)
        rows[i], rows[j] = 1.0, -1.0
        stiff += factor * np.outer(rows, rows)
    mass = np.diag([2.0, 0.9, 1.3, 3.0])
    return chain(stiffness=stiff, damping=dynamics.modal_damping(mass, stiff, 0.02), **changes)


@pytest.mark.parametrize("factor", [1e-4, pytest.param(1e4, marks=pytest.mark.slow)])
def test_shafts_far_from_the_mesh(factor):
    """A period against scipy to 1e-9, with impacts, and the determinant; 100 times the frequency of the mesh."""
    drive = with_shafts(factor)
    start = drive.rest_state() + 0.3 * KICK
    state, jacobian, crossings = by_steps(drive, start, drive.period, max_step=0.1 / max(1.0, factor**0.5))
    image = period_map(drive, start)
    assert crossings > 0
    assert image.state == pytest.approx(state, abs=1e-9 * np.max(np.abs(state)))
    assert image.jacobian == pytest.approx(jacobian, abs=1e-8 * np.max(np.abs(jacobian)))
    assert image.error < 1e-10


@pytest.mark.parametrize("factor", [1e-4, 1e4])
def test_orbits_with_shafts_far_from_the_mesh(factor):
    drive = with_shafts(factor, mean_force=[0.5, 0.0, 0.0, 0.6], error_amplitude=0.1, error_phase=0.0)
    orbit = find_orbit(drive, drive.rest_state(), transient=50)
    assert orbit.converged, orbit.message
    assert orbit.error < 1e-9
    product = np.prod(orbit.multipliers)
    assert product.real == pytest.approx(orbit.determinant, rel=1e-6)


def test_fifty_harmonics_and_a_rectangle():
    """All of them in stiffness and error, against scipy with steps a tenth of the fastest."""
    drive = chain(
        mesh_stiffness=RECTANGLE, error_amplitude=tuple(0.2 / ORDERS**2), error_phase=tuple(0.3 * ORDERS)
    )
    start = drive.rest_state() + KICK
    state, jacobian, crossings = by_steps(drive, start, drive.period, max_step=0.02)
    image = period_map(drive, start)
    assert crossings > 0
    assert image.state == pytest.approx(state, abs=1e-9)
    assert image.jacobian == pytest.approx(jacobian, abs=1e-8 * np.max(np.abs(jacobian)))


@pytest.mark.parametrize("play", [0.0, 1e-13])
def test_hardly_any_play(play):
    """A dead zone of 1e-13 and none at all: the same motion."""
    drive, none = chain(half_backlash=play), chain(half_backlash=0.0)
    start = none.rest_state() + 0.2 * KICK
    assert period_map(drive, start, 2).state == pytest.approx(period_map(none, start, 2).state, abs=1e-10)


def two_equal(frequency: float, damping: float = 1e-4) -> DriveOscillator:
    """Two modes of one frequency in contact, hardly damped: 1:1, and 1:2 with the mesh at twice that."""
    return DriveOscillator(
        np.eye(2), damping * np.eye(2), np.diag([1.0, 2.0]), [1.0, 0.0], FourierStiffness(1.0, (0.1,), (0.0,)), damping,
        [3.0, 0.0], 0.05, frequency, 0.2,
    )  # fmt: skip


@pytest.mark.slow
def test_two_modes_of_one_frequency():
    """sqrt(2) twice: the multipliers coincide, the orbit and its branch past the resonance are found."""
    drive = two_equal(1.3, damping=0.02)
    orbit = find_orbit(drive, drive.rest_state())
    branch = continue_branch(orbit, "frequency", (1.2, 1.6))
    assert branch.converged, branch.message
    assert np.all(np.isfinite(branch.multipliers))


def test_damping_of_ten_thousandths():
    """Damping 1e-4: Newton's method needs no transient, and the determinant is kept."""
    drive = two_equal(0.9)
    orbit = find_orbit(drive, drive.rest_state())
    assert orbit.converged, orbit.message
    assert orbit.error < 1e-9
    assert abs(np.prod(orbit.multipliers)) == pytest.approx(orbit.determinant, rel=1e-10)
    assert orbit.determinant == pytest.approx(np.exp(-3e-4 * drive.period), rel=1e-12)


def test_beyond_a_neimark_sacker_point_motion_does_not_repeat():
    """Where a pair of multipliers has left the circle, a sweep meets no orbit up to period 16 that it holds to."""
    drive = DriveOscillator(
        np.diag([1.0, 0.6]), [[0.02, 0.0], [0.0, 0.03]], [[0.8, -0.3], [-0.3, 1.1]], [1.0, 0.7],
        FourierStiffness(1.0, (0.5,), (0.0,)), 0.02, [2.0, 1.4], 0.02, 2.93, 0.1,
    )  # fmt: skip
    found = dynamics.sweep(drive, "frequency", [2.93], transient=2000)
    orbit = find_orbit(drive, drive.rest_state())
    assert orbit.converged
    assert not orbit.stable
    assert orbit.multipliers[0].imag != 0.0
    assert found.labels == ("aperiodic",)
