"""Scenes of the motion of helical pairs: what they report is along the transverse line of action, trains that twist."""

from __future__ import annotations

import math

import pytest

from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.test_helical_scene import BETA_B, R_B1, SCENE

GIVEN = """
[stiffness]
model = "given"
mean_N_per_m = 7.4e8
amplitudes = [0.013]
[dynamics]
error_amplitude_um = 2
sweep = { speed_rpm = [5000, 9000], points = 5 }
"""
SHAFTS = """
[shafts.pinion]
inertia_kg_m2 = 0.02
coupling_stiffness_Nm_per_rad = 2e4
"""


def text(more: str = "") -> str:
    scene = SCENE.replace("WANTS", '"sweep"').replace("face_width_mm", "backlash_um = 50\nface_width_mm", 1)
    return scene + GIVEN + more


def test_force_and_backlash_are_those_of_the_section(tmp_path):
    found = run_scene(parse_scene(text()), tmp_path, use_cache=False)
    assert not found.failures
    data = found.dataset
    assert float(data["oscillator_force"]) == pytest.approx(600 / R_B1, rel=1e-12)
    assert float(data["oscillator_backlash"]) == pytest.approx(50e-6 / math.cos(BETA_B), rel=1e-9)
    assert float(data["pair_backlash"]) == pytest.approx(50e-6, rel=1e-9)


def test_motor_and_load_twist_with_the_pair(tmp_path):
    found = run_scene(parse_scene(text(SHAFTS)), tmp_path, use_cache=False)
    assert not found.failures
    torque = found.dataset["drive_sweep_shaft_torque_up"]
    assert float(torque.min()) > 600.0


def test_shafts_that_bend_carry_the_mesh_in_all_directions(tmp_path):
    shaft = """
[shafts.pinion]
segments = [{ length_mm = 200, diameter_mm = 33.5 }]
bearings = [
  { position_mm = 20, stiffness_N_per_m = 3e8 },
  { position_mm = 180, stiffness_N_per_m = 3e8, axial_stiffness_N_per_m = 1.5e8 },
]
gear_position_mm = 90
"""
    found = run_scene(parse_scene(text(shaft)), tmp_path, use_cache=False)
    assert not found.failures
    data = found.dataset
    mean = dict(
        zip(
            data["drive_sweep_bearings"].values,
            data["drive_sweep_bearing_force_mean_up"].values[0],
            strict=True,
        )
    )
    force, lean = 600 / R_B1, math.tan(BETA_B)
    assert mean["pinion bearing 1"] + mean["pinion bearing 2"] == pytest.approx(force, rel=1e-6)
    assert mean["pinion bearing 2 axial"] == pytest.approx(force * lean, rel=1e-6)
    across = [mean[f"pinion bearing {k} across"] for k in (1, 2)]
    assert [abs(one) for one in across] == pytest.approx(2 * [force * lean * R_B1 / 0.16], rel=1e-6)
    assert sum(across) == pytest.approx(0.0, abs=1e-6 * force)
    assert [f"pinion {name}" in data["drive_freedoms"].values for name in ("deflection across", "axial")] == [
        True
    ] * 2


SMALL = """
wants = ["sweep", "spectrum", "run-up"]
tolerance = 0.05
[pair]
module_mm = 1.0
face_width_mm = 5.0
helix_angle_deg = 18.0
backlash_um = 50
pinion = { teeth = 18, bore_mm = 8.0 }
wheel = { teeth = 23, bore_mm = 8.0 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[operating]
pinion_torque_Nm = 8
pinion_speed_rpm = 4000
[dynamics]
damping_ratio = 0.05
sweep = { speed_rpm = [20000, 40000], points = 2 }
run_up = { speed_rpm = [20000, 22000], periods = 64 }
"""
SHORT = """
segments = [{ length_mm = 60, diameter_mm = 8 }]
bearings = [
  { position_mm = 5, stiffness_N_per_m = 1e8 },
  { position_mm = 55, stiffness_N_per_m = 1e8, axial_stiffness_N_per_m = 5e7 },
]
gear_position_mm = 25
"""


@pytest.mark.slow
def test_the_load_that_travels_over_the_face_drives_the_train_of_a_scene(tmp_path):
    scene = parse_scene(f"{SMALL}[shafts.pinion]{SHORT}[shafts.wheel]{SHORT}")
    found = run_scene(scene, tmp_path, use_cache=False)
    assert not found.failures
    data = found.dataset
    travel = float(data["drive_load_travel"])
    assert 0.02 * 5e-3 < travel < 0.5 * 5e-3
    assert 0.0 < float(data["drive_load_travel_error"]) < 0.5
    assert float(data["drive_sweep_bearing_force_swing_up"].min()) > 0.0
    assert {"spectrum_bearing_force", "run_up_bearing_force_up"} <= {*data.variables}
