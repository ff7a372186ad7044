"""Measured leads and maps in scenes: files read, what is built, studies, faults, results that run again."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest
import xarray as xr

from base import InputError
from flankfilm.building.face import varies_by
from flankfilm.building.flanks import deviations
from flankfilm.building.pair import gear_pair
from flankfilm.scene import parse_scene
from gears import GeometryWarning
from tests.flankfilm.program import flankfilm

TEXT = """
wants = ["stiffness", "report"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36, deviations = { GIVEN } }
wheel = { teeth = 40 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[operating]
pinion_torque_Nm = 300
pinion_speed_rpm = 2000
[alignment]
in_plane_um = 5
cells = 8
face_model = "walls"
[film]
model = "none"
"""
POINTS = "lead = { z_mm = [-20, 0, 20], material_um = [-6, 0, -10] }"
ROLL = np.array([6.5, 9.0, 12.0, 17.5])
PROFILE, LEAD = np.array([0.0, 1.0, 0.0, -8.0]), np.array([-6.0, 0.0, -10.0])


def scene_of(given, folder=None):
    return parse_scene(TEXT.replace("GIVEN", given), folder=folder)


def lead_of(scene):
    return gear_pair(scene).pinion.lead.trace


def map_file(folder, heights, name="map.csv"):
    rows = [
        f"{z:g},{at:g},{height:.9g}"
        for at, row in zip(ROLL, heights, strict=True)
        for z, height in zip((-20, 0, 20), row, strict=True)
    ]
    (folder / name).write_text("z_mm,roll_length_mm,material_um\n" + "\n".join(rows[::-1]), encoding="utf-8")


def test_points_and_files_are_one(tmp_path):
    own = lead_of(scene_of(POINTS))
    np.testing.assert_allclose(own.z, [-0.02, 0.0, 0.02], rtol=1e-12)
    np.testing.assert_allclose(own.material, [-6e-6, 0.0, -10e-6], rtol=1e-12, atol=1e-20)
    (tmp_path / "one.csv").write_text("z_mm;material_um\n20;-10\n0;0\n-20;-6\n", encoding="utf-8")
    assert lead_of(scene_of('lead = { file = "one.csv" }', tmp_path)) == own
    (tmp_path / "teeth.csv").write_text("z_mm,1,10,19,28\n-20,-5,-7,-6,-6\n0,1,-1,0,0\n20,-9,-11,-8,-12\n")
    with pytest.raises(
        InputError, match="no tooth 2"
    ):  # some teeth of many: columns are told by their numbers
        scene_of('lead = { file = "teeth.csv" }', tmp_path)
    (tmp_path / "teeth.csv").write_text("z_mm,1,2,3,4\n-20,-5,-7,-6,-6\n0,1,-1,0,0\n20,-9,-11,-8,-12\n")
    np.testing.assert_allclose(
        lead_of(scene_of('lead = { file = "teeth.csv" }', tmp_path)).material, own.material, atol=1e-18
    )


def test_a_lead_makes_the_load_vary_and_counts_in_one_base_pitch():
    scene = scene_of(POINTS)
    assert "pair.pinion.deviations.lead" in varies_by(scene)
    assert deviations(scene, gear_pair(scene), every_tooth=True) is None  # no curve over the profile


def test_a_map_is_its_profile_and_its_lead(tmp_path):
    map_file(tmp_path, PROFILE[:, None] + LEAD)
    scene = scene_of('map = { file = "map.csv" }', tmp_path)
    pair = gear_pair(scene)
    trace, (first, second) = pair.pinion.lead.trace, deviations(scene, pair, every_tooth=False)
    assert second is None
    mean = np.trapezoid(LEAD, [-20, 0, 20]) / 40
    np.testing.assert_allclose(trace.material, 1e-6 * (LEAD - mean), rtol=1e-9)
    np.testing.assert_allclose(first.profile.material, 1e-6 * (PROFILE + mean), rtol=1e-9)
    np.testing.assert_allclose(first.profile.rho, 1e-3 * ROLL, rtol=1e-9)


def test_twist_is_named(tmp_path):
    map_file(tmp_path, PROFILE[:, None] + LEAD + np.outer([-3.0, -1.0, 1.0, 3.0], [-1.0, 0.0, 1.0]))
    with pytest.warns(GeometryWarning, match="twist, up to 3"):
        gear_pair(scene_of('map = { file = "map.csv" }', tmp_path))


def test_twist_is_kept_where_that_is_asked_for(tmp_path):
    """Profile, lead and topography together are the map, at its points."""
    whole = PROFILE[:, None] + LEAD + np.outer([-3.0, -1.0, 1.0, 3.0], [-1.0, 0.0, 1.0])
    map_file(tmp_path, whole)
    scene = scene_of('map = { file = "map.csv", twist = "kept" }', tmp_path)
    pair = gear_pair(scene)
    lead, (first, _) = pair.pinion.lead, deviations(scene, pair, every_tooth=False)
    rho, z = 1e-3 * ROLL[:, None], np.array([-0.02, 0.0, 0.02])
    lacking = lead.removed_at(z, rho, 0.04, pair.active_profiles[0])
    np.testing.assert_allclose(first.profile.at(rho) - lacking, 1e-6 * whole, atol=1e-18)
    assert lead.topographic
    given = 'map = { file = "map.csv", twist = "half" }'
    with pytest.raises(InputError, match="left-out"):
        scene_of(given, tmp_path)


@pytest.mark.parametrize(
    ("given", "where", "allowed"),
    [
        ("lead = { z_mm = [-20, 20], material_um = [1, 2, 3] }", "lead", "as many z_mm as material_um"),
        ("lead = { z_mm = [20, -20], material_um = [1, 2] }", "lead.z_mm", "must rise"),
        ("lead = { z_mm = [-20, 20], material_um = [1, 4000] }", "lead.material_um", "1000 um"),
        ("lead = { material_um = [1, 2] }", "lead", "must have z_mm"),
        ("lead = { z_mm = [-10, 10], material_um = [1, 2] }", "lead", "must cover the face, -20 to 20 mm"),
        ("lead = { z_mm = [30, 40], material_um = [1, 2] }", "lead", "must lie on the face"),
        (
            "lead = { z_mm = [-20, 20], material_um = [1, 2] }, map = { z_mm = [-20, 20], roll_deg = [9, 30], "
            "material_um = [[0, 0], [0, 0]] }",
            "",
            "must have map, or lead, not both",
        ),
        (
            "map = { z_mm = [-20, 20], roll_deg = [9, 30], material_um = [[0, 0], [0, 0], [0, 0]] }",
            "map.material_um",
            "a row for each of 2 roll_deg",
        ),
        ("map = { z_mm = [-20, 20], roll_deg = [9, 30] }", "map", "z_mm, and material_um"),
    ],
)
def test_faults_have_their_keys(given, where, allowed):
    with pytest.raises(InputError, match=allowed) as raised:
        gear_pair(scene_of(given))
    key = f"pair.pinion.deviations.{where}".rstrip(".")
    assert any(fault.where.startswith(key) for fault in raised.value.faults)
    assert all(fault.remedy for fault in raised.value.faults if fault.where == key)


@pytest.mark.parametrize(
    ("text", "allowed"),
    [
        ("z_mm,roll_deg,material_um\n-20,9,0\n20,9,0\n-20,30,1\n", "every z_mm with every roll_deg"),
        ("z_mm,roll_deg,material_um\n-20,9,0\n-20,9,1\n20,9,0\n-20,30,1\n20,30,1\n", "each place once"),
        ("z_mm,roll_deg,material_um\n-20,9,0\n20,9,\n-20,30,1\n20,30,1\n", "three numbers in each row"),
        ("z_mm,material_um\n-20,0\n", "must have the columns z_mm"),
    ],
)
def test_faults_of_a_map_s_file(tmp_path, text, allowed):
    (tmp_path / "map.csv").write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=allowed) as raised:
        scene_of('map = { file = "map.csv" }', tmp_path)
    assert raised.value.faults[0].where == "pair.pinion.deviations.map.file"


def test_scattered_points_are_refused_in_little_memory(tmp_path):
    """2000 places and 2000 positions: what lacks is counted, not listed (1 kB a row at most)."""
    rows = "".join(f"{-10 + 0.01 * i},{5 + 0.017 * (i * 7919 % 2000)},1\n" for i in range(2000))
    (tmp_path / "map.csv").write_text("z_mm,roll_deg,material_um\n" + rows, encoding="utf-8")
    tracemalloc.start()
    with pytest.raises(InputError) as raised:
        scene_of('map = { file = "map.csv" }', tmp_path)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert "and 3997999 more" in str(raised.value.faults[0])
    assert most < 2000 * 1024


def test_ends_are_held_where_that_is_asked_for():
    trace = lead_of(scene_of('lead = { z_mm = [-10, 10], material_um = [1, 2], beyond = "hold" }'))
    assert trace.at(np.array([-0.02, 0.02])) == pytest.approx([1e-6, 2e-6])


@pytest.mark.slow
def test_a_run_has_the_lead_and_runs_again(tmp_path):
    map_file(tmp_path, PROFILE[:, None] + LEAD)
    scene = tmp_path / "scene.toml"
    scene.write_text(TEXT.replace("GIVEN", 'map = { file = "map.csv" }'), encoding="utf-8")
    flankfilm("run", scene, "--out", tmp_path / "out")
    (tmp_path / "map.csv").unlink()
    flankfilm("run", tmp_path / "out" / "results.nc", "--out", tmp_path / "again")
    one, other = (xr.load_dataset(tmp_path / folder / "results.nc") for folder in ("out", "again"))
    for name in ("flank_pinion_lead", "flank_pinion_mean_material", "dry_face_line_load"):
        np.testing.assert_array_equal(one[name], other[name])
    assert (tmp_path / "out" / "csv" / "lead_pinion.csv").exists()
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "measured lead of the pinion" in page
