"""Branches of drive trains: special points against those of one freedom, and Neimark-Sacker points of two modes."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from dynamics import (
    DriveOscillator,
    FourierStiffness,
    GearOscillator,
    continue_branch,
    diagram,
    doubled_orbit,
    find_orbit,
    sweep,
    trajectory,
)
from tests.dynamics.test_drives import chain, same_as


def test_special_points_are_those_of_one_freedom():
    """Two folds, a grazing and a period doubling of the lubricated scan, by bracketing here and by Newton there."""
    gear = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.95, half_backlash=0.2)
    drive = same_as(gear)
    shift = np.array([0.2, 0.0])  # e = 0.2 cos: its value at the start
    orbit = find_orbit(gear, (0.2, -0.3), transient=300)
    theirs = continue_branch(orbit, "frequency", (0.86, 0.96))
    ours = continue_branch(find_orbit(drive, orbit.state + shift), "frequency", (0.86, 0.96))
    assert ours.converged
    assert len(theirs.points) >= 4
    assert [p.kind for p in ours.points] == [p.kind for p in theirs.points]
    for mine, other in zip(ours.points, theirs.points, strict=True):
        assert mine.parameter == pytest.approx(other.parameter, abs=1e-13)
        assert mine.label == other.label
        assert mine.multipliers == pytest.approx(other.multipliers, abs=1e-6)  # a root at a grazing
    (point,) = ours.special("period-doubling")
    doubled = doubled_orbit(drive, "frequency", point, (0.86, 0.96))
    assert doubled.label == "2-2-0"
    assert doubled.converged


def two_modes(frequency: float) -> DriveOscillator:
    """Two modes at 1.247 and 1.701, pressed together; the mesh couples them."""
    return DriveOscillator(
        np.diag([1.0, 0.6]), [[0.02, 0.0], [0.0, 0.03]], [[0.8, -0.3], [-0.3, 1.1]], [1.0, 0.7],
        FourierStiffness(1.0, (0.5,), (0.0,)), 0.02, [2.0, 1.4], 0.02, frequency, 0.1,
    )  # fmt: skip


def test_neimark_sacker_points_bound_the_combination_resonance():
    """Near the sum of two natural frequencies a pair of multipliers leaves the unit circle, as Hill's equation says."""
    branch = continue_branch(
        find_orbit(two_modes(2.8), two_modes(2.8).rest_state()), "frequency", (2.75, 3.1)
    )
    found = sorted(point.parameter for point in branch.special("neimark-sacker"))

    def excess(frequency):
        drive = two_modes(frequency)
        g, inverse = np.asarray(drive.direction), np.linalg.inv(drive.mass)

        def rhs(t, y):
            columns = y.reshape(4, 4)
            k = drive.stiffness + (1.0 + 0.5 * np.cos(frequency * t)) * np.outer(g, g)
            c = drive.damping + 0.02 * np.outer(g, g)
            return np.vstack([columns[2:], -inverse @ (k @ columns[:2] + c @ columns[2:])]).ravel()

        done = solve_ivp(rhs, (0.0, drive.period), np.eye(4).ravel(), "DOP853", rtol=1e-12, atol=1e-14)
        return np.max(np.abs(np.linalg.eigvals(done.y[:, -1].reshape(4, 4)))) - 1.0

    hill = [brentq(excess, *bracket, xtol=1e-13) for bracket in ((2.8, 2.9), (3.0, 3.1))]
    assert branch.converged
    assert found == pytest.approx(hill, abs=1e-9)
    for point in branch.special("neimark-sacker"):
        assert np.abs(point.multipliers[:2]) == pytest.approx([1.0, 1.0], abs=1e-11)
        assert point.multipliers[0].imag != 0.0
    inside = (branch.values > found[0]) & (branch.values < found[1])
    assert np.array_equal(branch.stable, ~inside)


def test_grazing_of_a_chain():
    """Where the least of y meets D: the extremum of the located orbit is there to rounding."""
    drive = chain(mean_force=[0.4, 0.0, 0.0, 0.5], error_amplitude=0.1, error_phase=0.0)
    branch = continue_branch(find_orbit(drive, drive.rest_state()), "error_amplitude", (0.05, 0.8))
    (touch, *_) = branch.special("grazing")
    here = drive.with_parameter("error_amplitude", touch.parameter)
    turns = trajectory(here, touch.state, 1, 1).extrema[:, 1]
    assert branch.converged
    assert np.min(np.abs(turns - here.half_backlash)) < 1e-13


@pytest.mark.parametrize(("free", "frequency", "swing"), [(0.5, 0.7, ()), (2.0, 0.9, (0.1,))])
def test_an_impact_that_passes_the_start_of_the_period_ends_no_branch(free, frequency, swing):
    """Damping that jumps at the impact: the map has a corner there, the branch one of up to 107 degrees."""
    gear = GearOscillator(
        FourierStiffness(1.0, swing, (0.3,) * len(swing)), 0.05, 0.1, 0.2, 1.0, 0.2, free_damping_ratio=free
    )
    states = sweep(gear, "frequency", np.linspace(1.0, frequency, 30), direction="down").states
    gear = gear.with_parameter("frequency", frequency)
    orbit = find_orbit(gear, states[-1, -1])
    assert orbit.label == "1-1-0"
    train = find_orbit(same_as(gear), orbit.state + np.array([0.2, 0.0]))
    ours, theirs = (continue_branch(start, "error_phase", (-3.2, 3.2)) for start in (train, orbit))
    assert ours.ended == theirs.ended == ("bound", "bound")
    assert ours.converged
    assert theirs.converged
    assert ours.multipliers[[0, -1]] == pytest.approx(theirs.multipliers[[0, -1]], abs=1e-8)
    assert np.all(np.diff(ours.values) > 0.0)  # never back at a corner


def test_two_freedoms_have_the_diagram_of_their_mesh():
    """A second freedom that touches nothing: special points are those of the pair, those of four multipliers too."""
    gear = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.64, half_backlash=0.2)
    drive = DriveOscillator(
        np.diag([1.0, 2.0]), np.diag([0.0, 0.2]), np.diag([0.0, 0.7]), [1.0, 0.0], gear.stiffness,
        2.0 * gear.damping_ratio, [gear.mean_force, 0.3], gear.error_amplitude, gear.frequency, gear.half_backlash,
    )  # fmt: skip
    asked = {"bounds": (0.63, 0.67), "periods": (1,), "searches": 1, "swept": 3, "max_period": 1}
    theirs, ours = (diagram(one, "frequency", **asked) for one in (gear, drive))
    assert ours.converged
    here, there = (
        sorted((kind, label, value, x, v) for _, kind, value, label, x, v in one.table())
        for one in (ours, theirs)
    )
    assert [row[:2] for row in here] == [row[:2] for row in there] != []
    assert np.array([row[2:] for row in here]) == pytest.approx(
        np.array([row[2:] for row in there]), abs=1e-8
    )
    assert all(branch.multipliers.shape[1] == 4 for branch in ours.branches)
