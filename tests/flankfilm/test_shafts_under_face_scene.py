"""Scenes of gears on shafts with cells of the face: no shaft makes the mesh stiffer; what shafts do in files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from base import InputError, SolverError
from flankfilm.building.preflight import refuse
from flankfilm.files.cache import Cache
from flankfilm.report import drive_parts, face_parts
from flankfilm.report.text import number
from flankfilm.runs.dataset import results_dataset, results_tables
from flankfilm.scene import parse_scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.drives import DRIVE
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE, PAIR
from flankfilm.studies.outputs import OUTPUTS

EXAMPLES = Path(__file__).parents[2] / "examples"
OVERHUNG = """
wants = ["stiffness", "fourier", "sweep"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 20.0
backlash_um = 50
pinion = { teeth = 24, bore_mm = 15.0 }
wheel = { teeth = 31, bore_mm = 20.0 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
density_kg_per_m3 = 7850
[operating]
pinion_torque_Nm = 80
[alignment]
cells = 8
face_model = "walls"
[dynamics]
fourier_order = 2
damping_ratio = 0.05
error_amplitude_um = 4
sweep = { speed_rpm = [3000, 12000], points = 6 }
"""
SHAFTS = """
[shafts]
damping_ratio = 0.02
[shafts.pinion]
segments = [{ length_mm = 60, diameter_mm = 15 }, { length_mm = 60, diameter_mm = 20 }]
bearings = [{ position_mm = 10, stiffness_N_per_m = 3e8 }, { position_mm = 110, stiffness_N_per_m = 3e8 }]
gear_position_mm = 60
inertia_kg_m2 = 0.01
coupling_stiffness_Nm_per_rad = 2e4
[shafts.wheel]
segments = [{ length_mm = 120, diameter_mm = 20 }]
bearings = [{ position_mm = 70, stiffness_N_per_m = 2e8 }, { position_mm = 110, stiffness_N_per_m = 2e8 }]
gear_position_mm = 40
torque_position_mm = 120
inertia_kg_m2 = 0.05
"""
ALIGNED = OVERHUNG.replace(', "sweep"', "").replace("sweep =", "# sweep =")


def _engine(text: str) -> Engine:
    return Engine(parse_scene(text), Cache(None))


def _is_no_stiffer(found, aligned) -> None:
    """Curves and means on shafts against those of gears on straight ones."""
    assert 0.0 < found.mean_secant_stiffness < found.mean_stiffness
    assert found.mean_stiffness < aligned.mean_stiffness * (1.0 + found.errors["mean_stiffness"])
    assert np.all(found.stiffness > 0.0)
    assert found.greatest_stiffness < aligned.greatest_stiffness * (1.0 + found.error)


@pytest.fixture(scope="module")
def overhung() -> Engine:
    return _engine(OVERHUNG + SHAFTS)


@pytest.fixture(scope="module")
def aligned():
    return _engine(ALIGNED)[DRY_CYCLE]


def test_twists_beside_shafts_that_give_way_are_refused_under_their_keys():
    kept = "deviations = { map = { z_mm = [-10, 10], roll_deg = [5, 40], material_um = [[0, 2], [2, 0]], twist = "
    text = OVERHUNG.replace("bore_mm = 15.0", f'bore_mm = 15.0, {kept}"kept" }} }}')
    text = text.replace("bore_mm = 20.0", "bore_mm = 20.0, lead_twist_um = 5")
    refuse(parse_scene(text))
    with pytest.raises(InputError) as told:
        refuse(parse_scene(text + SHAFTS))
    found = {fault.where: fault for fault in told.value.faults}
    assert set(found) == {"pair.pinion.deviations.map.twist", "pair.wheel.lead_twist_um"}
    assert all("shafts give way" in fault.allowed and fault.remedy for fault in found.values())


def test_a_wheel_that_overhangs_is_no_stiffer_than_an_aligned_one(overhung, aligned):
    """149.8 N/(mm um) where the deflection of the shafts was taken out at mid-face."""
    _is_no_stiffer(overhung[DRY_CYCLE], aligned)
    drive = overhung[DRIVE]
    assert np.all(drive.natural_frequencies > 0.0)
    assert drive.rigid.series.mean > 0.0


def test_the_drive_train_has_the_tilt_of_the_mesh_on_its_shafts(overhung):
    """Means of the mesh cycle's matrix, in train, report and studies; a train without cells gives way to tilt."""
    drive, matrix = overhung[DRIVE], overhung[DRY_CYCLE].contact.face.mesh_matrix.mean(axis=0)
    place = matrix[1, 0] / matrix[0, 0]
    assert drive.load_centre == pytest.approx(place, rel=1e-12)
    assert drive.tilt_stiffness == pytest.approx(matrix[1, 1] - place * matrix[1, 0], rel=1e-12)
    values = {stage.name: overhung[stage] for stage in (PAIR, DRY_CYCLE, DRIVE)}
    data = results_dataset(Computed(overhung.scene, values))
    for name, scale in (("tilt_stiffness_Nm_per_rad", 1.0), ("load_centre_mm", 1e3), ("tilt_change", 1.0)):
        figure = name.removesuffix("_Nm_per_rad").removesuffix("_mm")
        assert float(data[f"drive_{figure}"]) == getattr(drive, figure)
        told = OUTPUTS[f"drive_{name}"].value(overhung)
        assert told == pytest.approx(scale * getattr(drive, figure), rel=1e-12)
    osc = drive.oscillator
    assert (
        float(data["drive_load_travel"])
        == drive.load_travel
        == 1e-3 * OUTPUTS["drive_load_travel_mm"].value(overhung)
    )
    assert 1e-7 < drive.load_travel < 1e-3
    assert np.linalg.norm(osc.moving_loads) > 0.0
    (note, *_) = drive_parts.drive(drive, data).notes
    for words in (
        f"{number(drive.tilt_stiffness)} N m/rad",
        f"{number(1e3 * place)} mm from mid-face",
        f"{number(1e6 * drive.load_travel)} µm",
    ):
        assert words in note
    plain = (OVERHUNG + SHAFTS).replace('[alignment]\ncells = 8\nface_model = "walls"\n', "")
    without = _engine(plain)[DRIVE]
    assert without.tilt_stiffness == without.load_centre == without.load_travel == 0.0
    assert without.oscillator.force_direction is None
    assert 0.0 < drive.tilt_change < 0.5 * without.tilt_change
    assert "for a load that is even over the face" in drive_parts.drive(without, data).notes[0]


@pytest.mark.slow
def test_thicker_steps_move_the_stiffness_towards_that_of_aligned_gears(overhung, aligned):
    """-9633 N/(mm um) with steps of 30 mm, and a fault about a stiffness that nobody gave."""
    thicker = _engine(OVERHUNG + SHAFTS.replace("diameter_mm = 20 }]\nbearings = [{ position_mm = 70", THICK))
    found = thicker[DRY_CYCLE]
    _is_no_stiffer(found, aligned)
    assert found.mean_stiffness > overhung[DRY_CYCLE].mean_stiffness
    assert np.all(thicker[DRIVE].natural_frequencies > 0.0)


THICK = "diameter_mm = 30 }]\nbearings = [{ position_mm = 70"


@pytest.mark.slow
def test_the_example_of_a_drive_with_cells_is_no_stiffer_than_without():
    """29.56 N/(mm um) beside 19.41, both relative to the bores, where force and deflection were not conjugate."""
    text = (EXAMPLES / "drive.toml").read_text()
    cells = '[alignment]\ncells = 16\nface_model = "walls"\n\n[operating]'
    found = _engine(text.replace("[operating]", cells))[DRY_CYCLE]
    straight = _engine(text)[DRY_CYCLE]
    assert straight.mean_secant_stiffness / 40e6 == pytest.approx(21.77, rel=0.01)
    _is_no_stiffer(found, straight)
    assert found.mean_stiffness > 0.6 * straight.mean_stiffness


def test_shafts_that_are_far_too_soft_are_refused_by_what_they_do():
    soft = SHAFTS.replace("e8 }", "e6 }")
    with pytest.raises((InputError, SolverError), match="the shafts give way by") as told:
        _engine(OVERHUNG + soft)[DRY_CYCLE]
    assert "stiffer shafts or bearings" in str(told.value)
    assert "stiffness =" not in str(told.value)


def test_what_shafts_do_is_in_results_tables_report_and_studies(overhung):
    cycle = overhung[DRY_CYCLE]
    face = cycle.contact.face
    data = results_dataset(
        Computed(overhung.scene, {stage.name: overhung[stage] for stage in (PAIR, DRY_CYCLE)})
    )
    for name, error in (
        ("shaft_deflection", face.shaft_error),
        ("shaft_misalignment", face.tilt_error),
        ("shaft_transmission_error", face.shaft_error),
        ("tilt_transmission_error", face.tilt_error),
        ("tilt_stiffness", face.matrix_error),
    ):
        variable = data[f"dry_face_{name}"]
        np.testing.assert_array_equal(variable.values, getattr(face, name))
        assert variable.attrs["error"] == pytest.approx(error, rel=1e-12), name
    table = results_tables(data)["shafts_under_face"]
    np.testing.assert_allclose(
        table["shaft_transmission_error_um"], 1e6 * face.shaft_transmission_error, rtol=1e-12
    )
    assert table["shaft_deflection_um_wheel"].shape == cycle.position.shape
    rows = dict(face_parts.face(face, None, data).tables[0].rows)
    assert "µm ±" in rows["maximum deflection along the line of action by the shaft of the wheel"]
    assert rows["part of the transmission error by the shafts' tilt"].startswith("-")
    assert "shaft of the pinion and the wheel" in face_parts.face(face, None, data).paragraphs[0]
    expected = {
        "shaft_deflection_pinion_um": 1e6 * face.shaft_deflection[0].max(),
        "shaft_misalignment_wheel_um": 1e6 * np.abs(face.shaft_misalignment[1]).max(),
        "mean_tilt_stiffness_Nm_per_rad": face.tilt_stiffness.mean(),
        "shaft_error": face.shaft_error,
        "tilt_error": face.tilt_error,
        "tilt_stiffness_error": face.matrix_error,
    }
    assert {name: OUTPUTS[name].value(overhung) for name in expected} == pytest.approx(expected, rel=1e-12)


def test_rigid_shafts_have_none_of_it(aligned):
    engine = _engine(ALIGNED)
    data = results_dataset(Computed(engine.scene, {PAIR.name: engine[PAIR], DRY_CYCLE.name: aligned}))
    assert not [name for name in data.variables if "tilt" in str(name) or "shaft_deflection" in str(name)]
    assert "shafts_under_face" not in results_tables(data)
    rows = [row for row, _ in face_parts.face(aligned.contact.face, None, data).tables[0].rows]
    assert not any("shaft" in row for row in rows)
