"""Traces of each tooth and wear: files read, curves built, studies, results that run again, a revolution."""

from __future__ import annotations

import json

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import fem
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import gear_pair
from flankfilm.scene import parse_scene, read_scene
from flankfilm.studies.plan import read_plan
from tests.flankfilm.program import EXAMPLES, command, flankfilm

EXAMPLE = EXAMPLES / "worn_flanks.toml"
TRACES = EXAMPLES / "measured" / "pinion_traces.csv"
TEXT = EXAMPLE.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def table():
    return pd.read_csv(TRACES, comment="#")


def scene_with(folder, csv, text=TEXT):
    (folder / "measured").mkdir(exist_ok=True)
    (folder / "measured" / "pinion_traces.csv").write_text(csv, encoding="utf-8")
    return parse_scene(text, folder=folder)


def traces(scene):
    return [
        (one.measured_by, getattr(one, one.measured_by), one.material_um)
        for one in scene.pair.pinion.deviations.traces.teeth
    ]


def test_all_forms_of_a_file_are_one(table, tmp_path):
    own = traces(read_scene(EXAMPLE))
    assert len(own) == 36
    assert own[11][0] == "diameter_mm"
    np.testing.assert_array_equal(own[11][2], table["tooth_11"])
    head, numbers = ["diameter_mm", *range(1, 37)], table.to_numpy()
    wide = "\n".join(";".join(f"{cell:g}".replace(".", ",") for cell in row) for row in numbers)
    assert traces(scene_with(tmp_path, ";".join(map(str, head)) + "\n" + wide)) == own
    falling = "\n".join("\t".join(f"{cell:g}" for cell in row) for row in numbers[::-1])
    head = ["Diameter_mm", *(f"tooth {n}_um" for n in range(36))]
    assert traces(scene_with(tmp_path, "\ufeff# remark\n" + "\t".join(head) + "\n" + falling)) == own
    long = "".join(f"{row[0]:g},{row[k]:g},{k}\n" for k in range(1, 37) for row in numbers)
    assert traces(scene_with(tmp_path, "diameter_mm,material_um,tooth\n" + long)) == own


def test_positions_are_diameters_roll_angles_or_roll_lengths(table, tmp_path):
    scene = read_scene(EXAMPLE)
    pair = gear_pair(scene)
    base = pair.base_radii[0]
    rho = np.sqrt((0.5e-3 * table["diameter_mm"].to_numpy()) ** 2 - base**2)
    first = deviations(scene, pair, every_tooth=True)[0]
    np.testing.assert_allclose(first.profile[4].rho, rho, rtol=1e-12)
    np.testing.assert_allclose(first.profile[4].material, 1e-6 * table["tooth_4"], rtol=1e-12)
    for name, places in (("roll_deg", np.degrees(rho / base)), ("roll_length_mm", 1e3 * rho)):
        changed = table.drop(columns="diameter_mm")
        changed.insert(0, name, places)
        other = scene_with(tmp_path, changed.to_csv(index=False))
        found = deviations(other, pair, every_tooth=True)[0]
        np.testing.assert_allclose(found.profile[4].rho, rho, rtol=1e-9)
        assert found.pitch == first.pitch


def test_one_pitch_knows_the_mean_and_the_revolution_every_tooth(table):
    scene = read_scene(EXAMPLE)
    pair = gear_pair(scene)
    every, mean = (deviations(scene, pair, every_tooth=each) for each in (True, False))
    assert len(every[0].profile) == 36
    assert every[0].pitch is not None
    assert mean[0].pitch is None
    teeth = table.drop(columns="diameter_mm").to_numpy()
    np.testing.assert_allclose(mean[0].profile.material, 1e-6 * teeth.mean(axis=1), rtol=1e-9, atol=1e-18)
    assert mean[1] == every[1]  # worn alike
    np.testing.assert_allclose(mean[1].wear.depth[:2], [14e-6, 12e-6], rtol=1e-12)
    pitches = TEXT.replace('traces = { file = "measured/pinion_traces.csv" }', "").replace(
        "factor = 1.0", "factor = 0.0"
    )
    unworn = parse_scene(pitches)
    assert deviations(unworn, pair, every_tooth=False) is None  # pitches count in the revolution alone
    assert deviations(unworn, pair, every_tooth=True)[1] is None


def test_wear_in_files_of_all_teeth_or_of_each(tmp_path):
    start, end = TEXT.index("diameter_mm = [77.2"), TEXT.index("factor = 1.0")
    text = TEXT[:start] + 'file = "wear.csv"\n' + TEXT[end:]
    text = text.replace("measured/", f"{EXAMPLES.as_posix()}/measured/")
    (tmp_path / "wear.csv").write_text("diameter_mm,depth_um\n77.2,14\n80,1\n83.9,9\n")
    pair = gear_pair(parse_scene(text, folder=tmp_path))
    alike = deviations(parse_scene(text, folder=tmp_path), pair, every_tooth=True)[1]
    np.testing.assert_allclose(alike.wear.depth, [14e-6, 1e-6, 9e-6], rtol=1e-12)
    rows = [
        [place, *(depth * (k + 1) / 40 for k in range(40))]
        for place, depth in ((77.2, 14), (80, 1), (83.9, 9))
    ]
    head = ["diameter_mm", *range(40)]
    (tmp_path / "wear.csv").write_text("\n".join(",".join(map(str, row)) for row in [head, *rows]))
    each = deviations(parse_scene(text, folder=tmp_path), pair, every_tooth=True)[1]
    np.testing.assert_allclose(each.wear[9].depth, [3.5e-6, 0.25e-6, 2.25e-6], rtol=1e-12)
    mean = deviations(parse_scene(text, folder=tmp_path), pair, every_tooth=False)[1]
    np.testing.assert_allclose(mean.wear.depth, 41 / 80 * np.array([14e-6, 1e-6, 9e-6]), rtol=1e-12)


def test_a_study_over_wear(tmp_path):
    plan = read_plan(EXAMPLES / "studies" / "wear.toml")
    assert [row[0] for row in plan.rows] == [0.0, 0.5, 1.0, 1.5, 2.0]
    raw = plan.raw_scene(4)
    assert raw["pair"]["wheel"]["wear"]["factor"] == 2.0
    assert len(raw["pair"]["pinion"]["deviations"]["traces"]["teeth"]) == 36  # rows need no file
    # files that vary are read for each row, and a file that has changed makes another study
    for number in (1, 2):
        (tmp_path / f"state_{number}.csv").write_text(f"roll_deg,depth_um\n13,{number}\n28.5,{2 * number}\n")
    start, end = TEXT.index("diameter_mm = [77.2"), TEXT.index("factor = 1.0")
    scene = TEXT[:start] + 'file = "state_1.csv"\n' + TEXT[end:]
    (tmp_path / "scene.toml").write_text(scene.replace("measured/", f"{EXAMPLES.as_posix()}/measured/"))
    (tmp_path / "study.toml").write_text(
        'scene = "scene.toml"\noutputs = ["transmission_error_um"]\n'
        '[vary]\n"pair.wheel.wear.file" = ["state_1.csv", "state_2.csv"]\n'
    )
    plan = read_plan(tmp_path / "study.toml")
    assert [plan.raw_scene(row)["pair"]["wheel"]["wear"]["depth_um"] for row in (0, 1)] == [[1, 2], [2, 4]]
    before = plan.identity()
    (tmp_path / "state_2.csv").write_text("roll_deg,depth_um\n13,3\n28.5,4\n")
    assert plan.identity() != before


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("worn") / "out"
    command("run", EXAMPLE, "--out", folder, cwd=folder.parent)
    return folder


def test_the_example_meshes_every_tooth_with_its_own_trace(run):
    scene = read_scene(EXAMPLE)
    pair = gear_pair(scene)
    both = deviations(scene, pair, every_tooth=True)
    with xr.open_dataset(run / "results.nc", engine="h5netcdf") as results:
        unloaded = results.revolution_unloaded_transmission_error.values
        assert results.revolution_position.size == 36 * 40
        dent = results.flank_pinion_material.values - results.flank_pinion_mean_material.values
        assert int(np.argmin(dent.min(axis=1))) == 11
        assert results.flank_wheel_mean_wear.max() == pytest.approx(14e-6, rel=0.02)
        held = json.loads(results.attrs["scene_json"])
    own = fem.unloaded_transmission_error(pair, 40, deviations=both, pitches=36, tip_rounding=20e-6)
    np.testing.assert_allclose(unloaded, own, atol=1e-15)
    assert len(held["pair"]["pinion"]["deviations"]["traces"]["teeth"]) == 36
    listed = pd.read_csv(run / "csv" / "flank_pinion.csv")
    assert set(listed["tooth"]) == set(range(36))
    page = (run / "report.html").read_text(encoding="utf-8")
    assert 'id="flanks"' in page
    assert "measured/pinion_traces.csv" in page
    assert "tooth_1" not in page
    assert page.count("diameter_mm") == 1  # of the wheel's wear, which the scene itself holds


@pytest.mark.slow
def test_a_results_file_holds_the_traces(run, tmp_path):
    done = flankfilm("run", run / "results.nc", "--out", tmp_path / "again", cwd=tmp_path)
    assert "0 s" in done.stdout or done.returncode == 0
    with (
        xr.open_dataset(run / "results.nc", engine="h5netcdf") as first,
        xr.open_dataset(tmp_path / "again" / "results.nc", engine="h5netcdf") as again,
    ):
        name = "revolution_transmission_error"
        np.testing.assert_allclose(again[name].values, first[name].values, rtol=1e-12)
