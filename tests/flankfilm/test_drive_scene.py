"""Scenes with shafts: a rigid train is the pair, balance of forces, files, report, outputs, damping, modes."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dynamics
import fem
from base import InputError
from flankfilm import figures
from flankfilm.beforehand import refuse
from flankfilm.cache import Cache
from flankfilm.coupling import mesh_cycle, pair_drive
from flankfilm.output.run import results_tables
from flankfilm.report.contents import HEADLINES, PARTS
from flankfilm.running import run_scene
from flankfilm.scene import parse_scene
from flankfilm.stages.catalogue import COMPLIANCE, DRY_CYCLE, FILM
from flankfilm.stages.catalogue import PAIR as PAIR_STAGE
from flankfilm.stages.engine import Engine
from flankfilm.studies.outputs import OUTPUTS
from gears import Gear, GearPair
from tests.flankfilm.scenes import ISHIKAWA

MOVING = (
    ISHIKAWA.replace("WANTS", '"sweep"')
    + """
[dynamics]
error_amplitude_um = 4
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


@pytest.fixture(scope="module")
def train():
    return run_scene(parse_scene(TRAIN), None)


def test_a_rigid_train_moves_as_the_pair_does():
    """Rigid shafts with nothing on them: both equations are the same, and forces agree to what sweeps leave over."""
    extra = MOVING.replace(
        "[dynamics]", "[dynamics]\nextra_inertia_kg_m2 = { pinion = 0.002, wheel = 0.003 }"
    )
    rigid = extra + "[shafts]\npinion = {}\nwheel = {}\n"
    theirs, ours = (run_scene(parse_scene(text), None).dataset for text in (extra, rigid))
    for way in ("up", "down"):
        expected = theirs[f"sweep_force_factor_{way}"].values
        assert ours[f"drive_sweep_force_factor_{way}"].values == pytest.approx(expected, rel=2e-6)
    assert "drive_sweep_bearing_force_up" not in ours
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
    for name in ("drive", "drive sweep"):
        part = PARTS[name](train.values[name], data)
        assert part.figures
        assert len(part.tables[0].rows) == {"drive": 4, "drive sweep": 4}[name]
    assert [one.unit for one in HEADLINES["drive sweep"](train.values["drive sweep"])] == ["N", "N m"]
    for draw in (figures.drive_sweep, figures.drive_modes):
        assert draw(data).axes
    engine = Engine(parse_scene(TRAIN), Cache(None))
    engine._values.update(train.values)
    for name, figure in (
        ("greatest_bearing_force_N", "drive_sweep_greatest_bearing_force"),
        ("greatest_shaft_torque_Nm", "drive_sweep_greatest_shaft_torque"),
        ("lowest_drive_frequency_Hz", "drive_lowest_frequency"),
        ("drive_mesh_frequency_Hz", "drive_mesh_frequency"),
        ("drive_sweep_error", "drive_sweep_sampling_error"),
    ):
        assert OUTPUTS[name].value(engine) == float(data[figure])
    most = max(float(data[f"drive_sweep_force_factor_{way}"].max()) for way in ("up", "down"))
    assert OUTPUTS["greatest_force_factor"].value(engine) == most
    with pytest.raises(InputError, match="rigid shafts"):
        OUTPUTS["contact_loss_speed_rpm"].value(engine)


@pytest.fixture(scope="module")
def cycle():
    return mesh_cycle(PAIR, 600.0, model="ishikawa", pairs="independent")


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
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 600\npinion_speed_rpm = 2000"
    )
    oil = "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\ntemperature_C = 80\n"
    face = '[alignment]\ncells = 4\nface_model = "slices"\n[film]\nmodel = "dowson"\n'
    whole = f"tolerance = 0.05\n{text}{oil}{face}"
    on_shafts = parse_scene(whole.replace('"sweep"', '"film"'))
    engine = Engine(on_shafts, Cache(None))
    found = engine[DRY_CYCLE]
    straight = fem.mesh_cycle(
        engine[PAIR_STAGE], 600.0, found.position.size, engine[COMPLIANCE], cells=4, face_model="slices"
    )
    shafts = on_shafts.shafts.pinion.shaft(), None
    bent = fem.mesh_cycle(
        engine[PAIR_STAGE],
        600.0,
        found.position.size,
        engine[COMPLIANCE],
        cells=4,
        face_model="slices",
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
