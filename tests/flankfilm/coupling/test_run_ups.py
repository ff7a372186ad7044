"""Run-ups of a pair and the map over speed and torque, against the sweeps and sizes that they are made of."""

from __future__ import annotations

import math

import numpy as np
import pytest

import flankfilm as ff
from base import InputError
from flankfilm.coupling import drive_sweep, given_series, mesh_cycle, mesh_series, pair_drive, speed_sweep
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(50e-6)
SERIES = given_series(4e8, [0.2])
RPM = math.pi / 30.0


def motion_at(torque: float):
    return ff.pair_oscillator(PAIR, SERIES, torque, 500.0, error_amplitude=(4e-6, 1e-6))


def test_seconds_are_mesh_periods():
    motion = motion_at(100.0)
    found = ff.speed_run_up(motion, (300.0, 420.0), seconds=0.4)
    # revolutions of 0.4 s at the mean speed, 20 meshes each, in whole blocks of 16
    assert found.periods == pytest.approx(0.4 * 360.0 / (2 * math.pi) * 20, abs=16)
    assert found.seconds == pytest.approx(0.4, rel=0.05)
    assert found.speed["up"][0] < found.speed["up"][-1]
    assert found.speed["down"] == pytest.approx(found.speed["up"][::-1], rel=1e-12)


def test_a_slow_run_up_holds_the_forces_of_the_sweep():
    motion = motion_at(100.0)
    low, high = (motion.scales.speed(w) for w in (0.3, 0.4))  # no jump on the way
    found = ff.speed_run_up(motion, (low, high), periods=3200)
    at = found.frequency["up"][[40, 100, 160]]
    steady = speed_sweep(motion, frequency=at)
    assert found.force_factor["up"][[40, 100, 160]] == pytest.approx(steady.force_factor["up"], rel=1e-2)
    assert found.spread["up"][[40, 100, 160]] == pytest.approx(steady.spread["up"], rel=2e-2)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ({}, "one of both"),
        ({"speed": (500.0, 400.0)}, "rise"),
        ({"speed": (300.0, 400.0), "seconds": 1e-4}, "mesh periods"),
    ],
)
def test_ranges_that_are_none(keys, said):
    with pytest.raises(InputError, match=said):
        ff.speed_run_up(motion_at(100.0), **keys)


def test_each_cell_of_the_map_is_the_greatest_force_of_the_sweeps_there():
    speeds = np.linspace(1500.0, 2500.0, 5)
    found = ff.dynamic_map(motion_at, [50.0, 200.0], speeds)
    assert found.factor.shape == found.iso.shape == (2, 5)
    for k, torque in enumerate((50.0, 200.0)):
        swept = speed_sweep(motion_at(torque), speeds)
        greatest = np.fmax(*swept.force_factor.values())
        assert found.factor[k] == pytest.approx(greatest, rel=1e-12)
    assert found.truncation is None
    assert (found.converged, found.message) == (True, "")
    # a given stiffness does not know the load
    assert found.resonance[0] == pytest.approx(found.resonance[1], rel=1e-12)
    assert found.greatest == found.factor.max()


def test_a_map_names_what_is_no_speed_and_no_torque():
    with pytest.raises(InputError) as told:
        ff.dynamic_map(motion_at, [], [500.0, math.nan])
    assert {one.where.partition("[")[0] for one in told.value.faults} == {"speeds", "torques"}


@pytest.mark.filterwarnings("ignore:Sainsot")
def test_what_a_longer_series_changes_of_a_map_is_what_it_changes_of_the_sweeps():
    """Of a drive train's force factors, bearing forces and torques, where the motion is the same."""
    cycle = mesh_cycle(PAIR, 100.0, model="potential-energy")
    shaft = Shaft((ShaftSegment(0.2, 0.04),), (Bearing(0.02, 4e8), Bearing(0.18, 4e8)), 0.1, 0.0)
    drive = pair_drive(PAIR, mesh_series(cycle, order=1), 100.0, 500.0, shafts=(shaft, shaft))
    speeds = np.array([500.0, 600.0])
    found, swept = ff.dynamic_map(lambda torque: drive, [100.0], speeds), drive_sweep(drive, speeds)
    changes = [float(one[np.isfinite(one)].max()) for one in swept.force_change.values()]
    assert found.truncation == pytest.approx(max(*changes, swept.truncation), rel=1e-9)
    assert found.truncation > 10.0 * found.sampling_error


def test_run_ups_and_maps_report_what_is_done():
    """Blocks of run-up and coast-down, each twice; speeds of all torques up and down: once each, to the end."""
    shown: list[tuple[str, int, int]] = []
    ff.speed_run_up(motion_at(100.0), (500.0, 700.0), periods=64, progress=lambda *one: shown.append(one))
    many = 2 * 2 * 4  # ways, lengths of steps, blocks
    assert [one[1:] for one in shown] == [(done, many) for done in range(1, many + 1)]
    shown.clear()
    ff.dynamic_map(motion_at, [50.0, 100.0], [500.0, 600.0, 700.0], progress=lambda *one: shown.append(one))
    many = 2 * 2 * 3  # torques, ways, speeds
    assert shown == [("speeds", done, many) for done in range(1, many + 1)]
