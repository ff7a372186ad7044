"""Diagrams of drive trains: rigid shafts give the pair's, jump by jump with their errors; scenes, report, tables."""

from __future__ import annotations

import numpy as np
import pytest

import dynamics
from dynamics import FourierStiffness, GearOscillator
from dynamics.orbits.starting import reach
from flankfilm import coupling, figures
from flankfilm.coupling import mesh_cycle, pair_drive, pair_oscillator
from flankfilm.coupling.speeds import jump_errors, jumps
from flankfilm.coupling.vibration.series import mesh_series
from flankfilm.products.diagram import headlines
from flankfilm.runs.dataset import results_tables
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from gears import Bearing, Shaft, ShaftSegment
from tests.dynamics.test_drives import same_as
from tests.flankfilm.shown import part_of
from tests.flankfilm.test_drive import PAIR
from tests.flankfilm.test_drive_scene import TRAIN


@pytest.mark.slow
def test_one_freedom_has_the_diagram_of_the_pair():
    """No search finds the unstable branch of a train: sweeps meet stable motions, and folds lead on from these."""
    gear = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    asked = {"bounds": (0.55, 0.7), "periods": (1,), "searches": 1, "swept": 12, "max_period": 2}
    theirs, ours = (dynamics.diagram(one, "frequency", **asked) for one in (gear, same_as(gear)))
    assert ours.converged
    assert ours.unsure == ()
    here, there = (
        sorted((kind, value, label, x, v) for _, kind, value, label, x, v in one.table())
        for one in (ours, theirs)
    )
    assert [(kind, label) for kind, _, label, *_ in here] == [(kind, label) for kind, _, label, *_ in there]
    # X and V of both are counted from the error
    assert np.array([row[1:2] + row[3:] for row in here]) == pytest.approx(
        np.array([row[1:2] + row[3:] for row in there]), abs=1e-8
    )
    assert [one.label for one in ours.stretches(stable=True)] == [
        one.label for one in theirs.stretches(stable=True)
    ]
    assert ours.columns().shape[1] == theirs.columns().shape[1] == 5
    assert ours.special("neimark-sacker") == []


@pytest.mark.long
@pytest.mark.slow
def test_rigid_shafts_give_the_jumps_of_the_pair_and_their_errors(monkeypatch):
    """Frequencies by the same folds; slopes by branches with another stiffness, within what their step leaves."""
    cycle = mesh_cycle(PAIR, 300.0, model="potential-energy")
    series = mesh_series(cycle, order=3)
    for room in (jumps, jump_errors):
        monkeypatch.setattr(room, "stiffness_errors", lambda series: (1e-3, np.array([1e-3, 0.0, 2e-3])))
    given = {"error_amplitude": 8e-6}
    pair = pair_oscillator(PAIR, series, 300.0, 209.44, **given)
    train = pair_drive(PAIR, series, 300.0, 209.44, shafts=(None, None), **given)
    asked = {"frequency": (0.6, 0.72), "searches": 1, "max_period": 1}
    theirs, ours = (coupling.jump_speeds(one, **asked) for one in (pair, train))
    assert len(ours.jumps) == len(theirs.jumps) > 1
    assert ours.jump_frequency == pytest.approx(theirs.jump_frequency, rel=1e-10)
    assert ours.jump_speed == pytest.approx(theirs.jump_speed, rel=1e-10)
    for mine, other in zip(ours.jumps, theirs.jumps, strict=True):
        assert (mine.label, mine.rising) == (other.label, other.rising)
        assert mine.budget["stiffness"] == pytest.approx(other.budget["stiffness"], rel=0.02)
    # the pair's jumps are carried, those of trains are matched to branches, where many are near each other
    alike = [
        abs(mine.longer / other.longer - 1.0) < 1e-8
        for mine, other in zip(ours.jumps, theirs.jumps, strict=True)
    ]
    assert sum(alike) >= 2
    assert ours.greatest_force == pytest.approx(theirs.greatest_force, rel=1e-2)  # of the points of branches
    assert ours.force_factor_iso6336[0] == pytest.approx(theirs.force_factor_iso6336[0], rel=0.1)


@pytest.mark.long
@pytest.mark.slow
def test_a_scene_with_shafts_has_a_diagram():
    ranged = "diagram = { speed_rpm = [9600, 10800], max_period = 1, searches = 1 }"
    text = (
        TRAIN.replace('"sweep"', '"diagram"')
        .replace("[shafts.pinion]", "[shafts]\nreduction_tolerance = 0.5\n[shafts.pinion]")
        .replace("error_amplitude_um = 4", f"error_amplitude_um = 10\n{ranged}")
        .replace("pinion_torque_Nm = 600", "pinion_torque_Nm = 300")
        .replace("backlash_um = 50", "backlash_um = 40")
    )
    results = run_scene(parse_scene(text), None)
    assert results.failures == ()
    found, data = results.values["diagram"], results.dataset
    assert found.diagram.oscillator.dimension == results.values["drive"].oscillator.dimension
    assert found.diagram.converged
    assert data.diagram_displacement.size == sum(len(branch.values) for branch in found.diagram.branches)
    assert {"diagram", "special_points"} <= {*results_tables(data)}
    assert part_of(results, "diagram").figures
    assert headlines(found)
    assert figures.diagram(data).axes


@pytest.mark.slow
def test_both_motions_of_a_train_are_met_though_a_slow_mode_outlives_the_limit():
    """Starts that come to 1-1-0 were left unsettled once, and no diagram had its branch of them."""
    shaft = Shaft((ShaftSegment(0.2, 0.04),), (Bearing(0.02, 4e8), Bearing(0.18, 4e8)), 0.1, 0.0)
    pair = PAIR.with_backlash(40e-6)
    series = mesh_series(mesh_cycle(pair, 300.0, model="potential-energy"), order=3)
    ends = {
        "shafts": (shaft, shaft),
        "end_inertias": (0.02, 0.05),
        "error_amplitude": 10e-6,
        "speeds": (900.0, 1000.0),
    }
    train = pair_drive(pair, series, 300.0, 209.44, **ends).oscillator.with_parameter("frequency", 0.7833)
    (x0, x1), (v0, v1) = reach(train)
    found = dynamics.basins(train, (x0, x1, 6), (v0, v1, 6), limit=1000, max_period=8)
    assert found.converged, found.message
    assert {one.label for one in found.attractors if one.share > 0.0} == {"1-0-0", "1-1-0"}
    for one in found.attractors:
        assert one.orbit is not None
        assert one.orbit.stable
        assert one.orbit.error < 1e-9
