"""Scenes with shafts: a rigid train is the pair, balance of forces, files, report, outputs, damping, modes."""

from __future__ import annotations

import dataclasses
import math
import tomllib
from pathlib import Path

import numpy as np
import pytest

import dynamics
import dynamics.motion.run_ups
import fem
from base import InputError
from flankfilm import figures
from flankfilm.building.preflight import refuse
from flankfilm.coupling import drive_sweep, mesh_cycle, mesh_series, pair_drive
from flankfilm.coupling.speeds.truncation import with_order
from flankfilm.files.cache import Cache
from flankfilm.report import drive_parts
from flankfilm.runs.dataset import results_tables
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import Scene, parse_scene
from flankfilm.stages.drives import DRIVE, DRIVE_SWEEP
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE, DRY_CYCLE, FILM
from flankfilm.stages.mesh import PAIR as PAIR_STAGE
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.plan import plan_of
from flankfilm.studies.study_file import StudyFile
from gears import Gear, GearPair
from tests.flankfilm.scenes import ISHIKAWA
from tests.flankfilm.shown import part_of

MOVING = (
    ISHIKAWA.replace("WANTS", '"sweep"').replace(
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 600\npinion_speed_rpm = 7200\ntorques_Nm = [300, 600]"
    )
    + """
[dynamics]
fourier_order = 1
error_amplitude_um = 4
run_up = { speed_rpm = [7000, 7100], periods = 128 }
sweep = { speed_rpm = [7000, 7400], points = 2 }
"""
)
SHAFT = """
segments = [{ length_mm = 200, diameter_mm = 40 }]
bearings = [{ position_mm = 20, stiffness_N_per_m = 4e8 }, { position_mm = 180, stiffness_N_per_m = 4e8 }]
gear_position_mm = 60
inertia_kg_m2 = 0.02
"""
TRAIN = f"{MOVING}[shafts.pinion]{SHAFT}[shafts.wheel]\ninertia_kg_m2 = 0.05\ncoupling_stiffness_Nm_per_rad = 2e4\n"
PAIR = GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04)


EVERY = ("sweep", "spectrum", "run-up", "dynamic-map")
ALL = TRAIN.replace('"sweep"', ", ".join(f'"{want}"' for want in EVERY))


@pytest.fixture(scope="module")
def train():
    return run_scene(parse_scene(ALL), None)


def test_a_rigid_train_moves_as_the_pair_does(monkeypatch):
    """Rigid shafts with nothing on them: both equations are the same, and forces agree to what sweeps leave over.

    The run-up too, where the train changes its frequency as often as the pair does; sweeps leave 1e-6 of a motion,
    and of its swing more.
    """
    monkeypatch.setattr(dynamics.motion.run_ups, "HELD", 1)
    extra = MOVING.replace('"sweep"', ", ".join(f'"{want}"' for want in EVERY)).replace(
        "[dynamics]", "[dynamics]\nextra_inertia_kg_m2 = { pinion = 0.002, wheel = 0.003 }"
    )
    rigid = extra + "[shafts]\npinion = {}\nwheel = {}\n"
    theirs, ours = (run_scene(parse_scene(text), None).dataset for text in (extra, rigid))
    for way in ("up", "down"):
        expected = theirs[f"sweep_force_factor_{way}"].values
        assert ours[f"drive_sweep_force_factor_{way}"].values == pytest.approx(expected, rel=2e-6)
    assert "drive_sweep_bearing_force_up" not in ours
    for name in ("run_up_force_factor_up", "run_up_peak_down", "run_up_force_rms_up", "run_up_separated_up"):
        assert ours[name].values == pytest.approx(theirs[name].values, rel=1e-5, abs=1e-9), name
    for name in ("spectrum_force", "spectrum_displacement", "dynamic_map_factor", "dynamic_map_factor_down"):
        expected = theirs[name].values
        assert ours[name].values == pytest.approx(expected, abs=1e-5 * expected.max()), name
    assert ours.spectrum_mode_order.values == pytest.approx(theirs.spectrum_mode_order.values, rel=1e-12)
    assert not any("bearing" in name or "shaft" in name for name in map(str, ours.data_vars))
    assert float(ours.drive_lowest_frequency) == pytest.approx(
        float(theirs.oscillator_natural_frequency), rel=1e-12
    )


def test_bearings_and_shafts_of_a_scene_carry_the_load(train):
    """A sweep leaves 1e-6 of the largest displacement, the coupling's twist of 1.1 mm: 34 times a bearing's 33 um."""
    data, torque = train.dataset, 600.0
    force = torque / PAIR.base_radii[0]
    assert train.failures == ()
    assert data.drive_sweep_bearings.values.tolist() == ["pinion bearing 1", "pinion bearing 2"]
    assert data.drive_sweep_shafts.values.tolist() == ["pinion shaft", "wheel coupling"]
    for way in ("up", "down"):
        forces = data[f"drive_sweep_bearing_force_mean_{way}"]
        torques = data[f"drive_sweep_shaft_torque_mean_{way}"]
        assert (forces.attrs["units"], torques.attrs["units"]) == ("N", "N m")
        assert forces.values == pytest.approx(np.tile([0.75 * force, 0.25 * force], (2, 1)), rel=34e-6)
        assert torques.values == pytest.approx(np.tile([torque, torque * 40 / 36], (2, 1)), rel=34e-6)


def test_a_train_is_in_tables_report_and_outputs(train):
    data = train.dataset
    tables = results_tables(data)
    assert {"drive_sweep", "drive_modes"} <= {*tables}
    assert "sweep_up" not in tables
    assert {"bearing_force_up_N_pinion_bearing_1", "shaft_torque_down_Nm_wheel_coupling"} <= {
        *tables["drive_sweep"]
    }
    assert {len(column) for column in tables["drive_sweep"].values()} == {2}
    for name in ("drive", "drive sweep"):
        part = part_of(train, name)
        assert part.figures
        modes = len(train.values["drive"].natural_frequencies)
        assert len(part.tables[0].rows) == {"drive": modes, "drive sweep": 4}[name]
    assert [one.unit for one in drive_parts.headlines(train.values["drive sweep"])] == ["", "N", "N m"]
    for draw in (figures.drive_sweep, figures.drive_modes):
        assert draw(data).axes
    engine = Engine(parse_scene(TRAIN), Cache(None))
    engine._values.update(train.values)
    for name, figure in (
        ("greatest_bearing_force_N", "drive_sweep_greatest_bearing_force"),
        ("greatest_shaft_torque_Nm", "drive_sweep_greatest_shaft_torque"),
        ("lowest_drive_frequency_Hz", "drive_lowest_frequency"),
        ("drive_mesh_frequency_Hz", "drive_mesh_frequency"),
        ("drive_sweep_error", "drive_sweep_carried_error"),
        ("drive_valid_to_Hz", "drive_valid_to"),
        ("drive_valid_to_Hz", "drive_sweep_valid_to"),
        ("greatest_run_up_bearing_force_N", "run_up_greatest_bearing_force"),
        ("greatest_map_shaft_torque_Nm", "dynamic_map_greatest_shaft_torque"),
    ):
        assert OUTPUTS[name].value(engine) == float(data[figure])
    swept = train.values["drive sweep"]
    worst = float(swept.bearing_force_peak_error[int(np.argmax(swept.bearing_force_peak))])
    assert OUTPUTS["greatest_bearing_force_error"].value(engine) == worst
    assert {"drive_peaks_bearings", "drive_peaks_shafts"} <= {*tables}
    most = max(float(data[f"drive_sweep_force_factor_{way}"].max()) for way in ("up", "down"))
    assert OUTPUTS["greatest_force_factor"].value(engine) == most
    assert OUTPUTS["greatest_force_factor_error"].value(engine) == math.inf  # another motion at 7400 rpm
    with pytest.raises(InputError, match="rigid shafts"):
        OUTPUTS["contact_loss_speed_rpm"].value(engine)


def test_the_error_of_a_trains_mesh_force_is_of_samples_and_of_motions_that_repeat(train):
    swept = train.values["drive sweep"]
    known = {"up": np.array([0.02, np.nan]), "down": np.array([np.nan, 0.03])}
    error = dataclasses.replace(swept, force_change=known).greatest_factor_error
    assert error == swept.sampling_error + 0.03
    none = dict.fromkeys(known, np.full(2, np.nan))
    assert dataclasses.replace(swept, force_change=none).greatest_factor_error is None
    assert dataclasses.replace(swept, force_change=None).greatest_factor_error is None


def test_a_sweep_shows_what_it_has_done(train, monkeypatch):
    """Speeds up and down, then parts whose peaks are sought, then motions with the longer series, each to its end."""
    monkeypatch.setattr("flankfilm.processes.progress.PATIENCE", 0.0)
    shown: list[tuple[str, int, int]] = []
    engine = Engine(parse_scene(TRAIN), Cache(None), progress=lambda *one: shown.append(one))
    engine._values.update({name: one for name, one in train.values.items() if name != "drive sweep"})
    swept = engine[DRIVE_SWEEP]
    title = DRIVE_SWEEP.title
    assert [one[1:] for one in shown if " speeds, " in one[0]] == [(done, 4) for done in range(1, 5)]
    parts = 1 + len(swept.bearings) + len(swept.shafts)
    assert [one[1:] for one in shown if " peaks, " in one[0]] == [(n, parts) for n in range(1, parts + 1)]
    many = 2 * len(swept.checked)
    rest = [one for one in shown if " motions with more harmonics, " in one[0]]
    assert [one[1:] for one in rest] == [(done, many) for done in range(1, many + 1)]
    assert rest[-1][0] == f"{title}: {many} of {many} motions with more harmonics, 0 s left"
    assert len(shown) == 4 + parts + many


def test_a_run_up_a_map_and_orders_carry_what_settled_motions_do(train):
    """A slow run-up by the sweep's forces at its ends, a map's row by the sweep, orders by the root mean square."""
    data = train.dataset
    swept = data.drive_sweep_bearing_force_up.values
    assert data.dynamic_map_bearing_force.values[1] == pytest.approx(
        np.fmax(swept, data.drive_sweep_bearing_force_down.values), rel=1e-6
    )
    torque = data.dynamic_map_shaft_torque.values
    assert torque[0] == pytest.approx(0.5 * torque[1], rel=0.1)  # half the load, the same error
    assert data.run_up_bearing_force_up.values[-1] == pytest.approx(swept[0], rel=0.02)
    assert data.run_up_shaft_torque_up.values[-1] == pytest.approx(
        data.drive_sweep_shaft_torque_up.values[0], rel=0.02
    )
    lines = data.spectrum_bearing_force.values
    swing = 0.5 * data.drive_sweep_bearing_force_swing_up.values.sum(
        axis=0
    )  # of 7000 and 7400 rpm; orders of 7200
    assert np.sqrt(0.5 * np.sum(lines**2, axis=0)) == pytest.approx(swing, rel=0.1)
    modes = data.drive_natural_frequencies.values / (7200.0 / 60.0 * 36.0)
    assert data.spectrum_mode_order.values == pytest.approx(modes, rel=1e-12)


def test_harmonics_beyond_the_series_are_estimated(train):
    """What is told is the difference of sweeps with the series and with a longer one, part by part."""
    found = train.values["drive sweep"]
    drive = train.values["drive"]
    assert found.longer_order >= 32
    assert found.truncation > 1e-3
    longer = drive.oscillator.with_contact_stiffness(with_order(drive, found.longer_order).contact_stiffness)
    again = drive_sweep(dataclasses.replace(drive, oscillator=longer), frequency=found.checked)
    same = np.array([one == other for one, other in zip(found.labels["up"], again.labels["up"], strict=True)])
    assert same.tolist() == [True, False]  # 7400 rpm: contact is lost once more with more harmonics
    assert np.isinf(found.force_change["up"][~same]).all()
    for figure in ("bearing_force", "shaft_torque"):
        ours, theirs = (getattr(one, figure)["up"][same] for one in (found, again))
        told = getattr(found, f"{figure}_change")["up"]
        assert np.isinf(told[~same]).all()
        assert told[same] == pytest.approx(np.abs(ours - theirs) / theirs, rel=1e-4)


def test_reports_of_run_ups_maps_and_orders(train):
    for name, tables in (("spectrum", 1), ("run-up", 2), ("dynamic-map", 2)):
        part = part_of(train, name)
        assert part.figures
        assert len(part.tables) == tables
    for draw in (figures.drive_run_up, figures.drive_map, figures.spectrum):
        assert draw(train.dataset).axes


@pytest.fixture(scope="module")
def cycle():
    return mesh_series(mesh_cycle(PAIR, 600.0, model="ishikawa", pairs="independent"), order=1)


def test_frequencies_of_couplings_are_those_of_four_inertias(cycle):
    """Motor, pinion, wheel and load, in angles, assembled by hand."""
    ends, couplings = (0.01, 0.05), (2e4, 3e4)
    drive = pair_drive(PAIR, cycle, 600.0, 200.0, shafts=(None, None), end_inertias=ends, couplings=couplings)
    r1, r2 = PAIR.base_radii
    lever = np.array([0.0, r1, -r2, 0.0])
    stiffness = drive.rigid.mean_stiffness * np.outer(lever, lever)
    for firm, i, j in ((couplings[0], 0, 1), (couplings[1], 2, 3)):
        stiffness[np.ix_([i, j], [i, j])] += firm * np.array([[1.0, -1.0], [-1.0, 1.0]])
    inertias = np.array([ends[0], *PAIR.moments_of_inertia, ends[1]])
    squares = np.sort(np.linalg.eigvals(stiffness / inertias[:, None]).real)[1:]
    assert drive.natural_frequencies == pytest.approx(np.sqrt(squares) / (2.0 * math.pi), rel=1e-9)
    assert drive.mesh_share.max() > 0.9
    assert np.all((drive.mesh_share >= 0.0) & (drive.mesh_share <= 1.0))
    assert np.abs(drive.mode_shapes).max(axis=1) == pytest.approx(1.0)


def test_rayleigh_damping_leaves_free_rotation_and_damps_a_mode_by_its_frequency(cycle):
    """Motor and pinion on a coupling: zeta = alpha/(2 w) + beta w/2 of their mode, none of their rotation."""
    alpha, beta = 30.0, 2e-6
    drive = pair_drive(
        PAIR, cycle, 600.0, 200.0, shafts=(None, None), end_inertias=(0.01, 0.0), couplings=(2e4, None),
        rayleigh=(alpha, beta),
    )  # fmt: skip
    scales = drive.rigid.scales
    inertias = np.array([PAIR.moments_of_inertia[0], 0.01])
    omega = math.sqrt(2e4 * np.sum(1.0 / inertias))
    damping = np.asarray(drive.oscillator.damping)[:2, :2] * scales.equivalent_mass * scales.omega_n
    damping *= PAIR.base_radii[0] ** 2  # N m s per radian
    shape = np.array([1.0, -inertias[0] / inertias[1]])
    ratio = shape @ damping @ shape / (2.0 * omega * np.sum(inertias * shape**2))
    assert ratio == pytest.approx(alpha / (2.0 * omega) + 0.5 * beta * omega, rel=1e-9)
    assert damping @ np.ones(2) == pytest.approx(np.zeros(2), abs=1e-12 * np.abs(damping).max())


def test_a_coupling_needs_something_behind_it(cycle):
    with pytest.raises(InputError, match="behind a coupling"):
        pair_drive(PAIR, cycle, 600.0, 200.0, shafts=(None, None), couplings=(2e4, None))


def test_pictures_of_trains_do_not_call_their_first_freedom_x(cycle):
    drive = pair_drive(
        PAIR, cycle, 600.0, 700.0, shafts=(None, None), end_inertias=(0.01, 0.0), couplings=(2e4, None)
    )
    orbit = dynamics.find_orbit(drive.oscillator, drive.oscillator.rest_state(), transient=200)
    swept = dynamics.sweep(drive.oscillator, "frequency", [drive.oscillator.frequency])
    for record in (orbit, swept):
        labels = [axes.get_ylabel() for axes in record.plot().axes] + [
            axes.get_xlabel() for axes in record.plot().axes
        ]
        assert not any("X" in label for label in labels), labels
    assert drive.plot().axes


def test_the_face_bears_on_the_shafts_of_the_scene():
    """What the scene's mesh cycle finds is what finite elements find with these shafts; straight shafts bear evenly."""
    text = TRAIN.replace('model = "ishikawa"\npairs = "independent"', 'model = "fem"').replace(
        "pinion_speed_rpm = 7200", "pinion_speed_rpm = 2000"
    )
    oil = "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\ntemperature_C = 80\n"
    face = '[alignment]\ncells = 4\nface_model = "walls"\n[film]\nmodel = "dowson"\n'
    whole = f"tolerance = 0.05\n{text}{oil}{face}"
    on_shafts = parse_scene(whole.replace('"sweep"', '"film"'))
    engine = Engine(on_shafts, Cache(None))
    found = engine[DRY_CYCLE]
    straight = fem.mesh_cycle(
        engine[PAIR_STAGE], 600.0, found.position.size, engine[COMPLIANCE], cells=4, face_model="walls"
    )
    shafts = on_shafts.shafts.pinion.shaft(), None
    bent = fem.mesh_cycle(
        engine[PAIR_STAGE],
        600.0,
        found.position.size,
        engine[COMPLIANCE],
        cells=4,
        face_model="walls",
        shafts=shafts,
    )
    assert found.contact.face_load_factor == pytest.approx(bent.face_load_factor, rel=1e-9)
    assert straight.face_load_factor.max() == pytest.approx(1.0, abs=1e-6)
    assert bent.face_load_factor.max() > 1.05
    # films are thinnest where the slope of the shafts puts most of the load; losses go with them
    over, wet = engine[FILM].over_face, engine[FILM].contact.face
    assert np.abs(wet.shaft_misalignment[0]).min() > 1e-6
    assert over.least_film_place == wet.face_position[np.argmax(wet.line_load.sum(axis=(0, 1)))]
    refuse(parse_scene(whole.replace('"sweep"', '"losses"')))


def test_a_study_varies_a_diameter_by_its_place_in_the_list():
    """A thicker shaft is stiffer in bending and torsion; a place that is none is refused."""
    raw = {
        "scene": tomllib.loads(TRAIN),
        "vary": {
            "shafts.pinion.segments.0.diameter_mm": [30.0, 50.0],
            "dynamics.free_damping_ratio": [0.01, 0.02],
        },
        "design": "list",
        "outputs": ["lowest_drive_frequency_Hz", "greatest_run_up_shaft_torque_Nm", "run_up_error"],
    }
    plan = plan_of(StudyFile.model_validate(raw), Path())
    found = []
    for row in range(2):
        engine = Engine(Scene.model_validate(plan.raw_scene(row)), Cache(None))
        assert engine[DRIVE].oscillator.dampings == (0.1, (0.02, 0.04)[row])
        found.append([OUTPUTS[name].value(engine) for name in plan.outputs])
    thin, thick = found
    assert thick[0] > 1.05 * thin[0]  # the coupling yields too
    assert thick[1] > 600.0
    assert max(thin[2], thick[2]) < 0.05
    with pytest.raises(InputError, match=r"1 is no place in a list of 1"):
        plan_of(
            StudyFile.model_validate({**raw, "vary": {"shafts.pinion.segments.1.diameter_mm": [30.0]}}),
            Path(),
        )
