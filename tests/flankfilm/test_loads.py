"""Torques, a revolution and root stress from a scene with real flanks."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import fem
from base import InputError
from flankfilm.coupling.mesh.loaded_teeth import LoadedTeeth
from flankfilm.coupling.mesh.torque_curves import torque_curves
from flankfilm.scene import parse_scene
from gears import Gear, GearPair
from tests.flankfilm.program import EXAMPLES, command

EXAMPLE = EXAMPLES / "real_flanks.toml"
TORQUES, FEWER = (
    "torques_Nm = [50, 100, 200, 300, 400, 500, 700, 800]",
    "torques_Nm = [50, 100, 200, 400, 800]",
)


def ran(folder: Path, tolerance: str) -> Path:
    """Folder of a run of the example with another tolerance."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for old, new in (("tolerance = 0.005\n", f"tolerance = {tolerance}\n"), (TORQUES, FEWER)):
        assert old in text
        text = text.replace(old, new, 1)
    (folder / "scene.toml").write_text(text, encoding="utf-8")
    assert "maximum root stress" in command("run", "scene.toml", "--out", "out", cwd=folder).stdout
    return folder / "out"


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    return ran(tmp_path_factory.mktemp("real"), "0.05")


@pytest.mark.slow
def test_the_example_at_its_own_tolerance_has_the_same_figures(results, tmp_path):
    with xr.open_dataset(ran(tmp_path, "0.005") / "results.nc", engine="h5netcdf") as own:
        for name in ("dry_mean_secant_stiffness", "root_pinion_tension", "root_wheel_tension"):
            assert float(own[name].max()) == pytest.approx(float(results[name].max()), rel=0.05)


@pytest.fixture(scope="module")
def results(run):
    with xr.open_dataset(run / "results.nc", engine="h5netcdf") as found:
        yield found.load()


def test_the_scene_s_own_torque_is_one_of_the_sweep(results):
    at = int(np.flatnonzero(results.torque.values == 600.0)[0])
    assert results.torque.size == 6
    own = float(results.dry_mean_secant_stiffness)
    assert float(results.torque_secant_stiffness[at]) == pytest.approx(
        own, rel=1e-4 * 0.05
    )  # events searched twice
    assert np.all(np.diff(results.torque_secant_stiffness.values) > 0)  # contacts stiffen


def test_a_revolution_shows_every_tooth_and_the_runout(results):
    travel = results.revolution_position.values
    assert travel.size == 36 * 40
    assert "revolution_mean_stiffness" not in results  # curves alone, no figures without arcs
    unloaded = results.revolution_unloaded_transmission_error.values
    # once around the pinion: a sine of 6 um in cumulative pitch turns it by 6 cos 20 degrees along the line of action
    first = 2 * np.abs(np.mean(unloaded * np.exp(-2j * np.pi * travel / 36)))
    assert first == pytest.approx(6e-6 * np.cos(np.radians(20)), rel=0.1)
    assert np.all(results.revolution_transmission_error.values > unloaded)


def test_one_pitch_knows_the_profile_but_not_the_pitches(results):
    whole = results.revolution_transmission_error.values.reshape(36, 40)
    spread = np.ptp(whole.mean(axis=1))
    assert spread > 8e-6
    assert np.ptp(results.dry_transmission_error.values) < np.ptp(whole)


def test_root_stress_stands_beside_the_standard(results):
    for gear in ("pinion", "wheel"):
        tension = float(results[f"root_{gear}_tension"].max())
        nominal = float(results.iso6336_3_stresses.sel(gear=gear))
        assert 0.7 < tension / nominal < 1.1
        at = int(np.argmax(results[f"root_{gear}_tension"].values))
        lean = np.degrees(results[f"root_{gear}_tension_tangent"].values[at])
        assert 25 < lean < 50


def test_hertz_contacts_carry_units_and_only_flanks(results):
    pressure = results.dry_hertz_pressure
    assert pressure.attrs["units"] == "Pa"
    load, width = results.dry_forces.values / 0.040, results.dry_half_width.values
    on_flank = np.isfinite(pressure.values)
    # w = pi/2 p a for an ellipse of pressure
    assert np.allclose(0.5 * np.pi * pressure.values[on_flank] * width[on_flank], load[on_flank], rtol=1e-9)
    sliding = results.dry_sliding.values[on_flank]
    assert sliding.min() < 0 < sliding.max()


def test_tables_read_back(run):
    for name in ("torques", "revolution", "contacts_dry", "root_stress_pinion", "fillet_stress_wheel"):
        assert len(pd.read_csv(run / "csv" / f"{name}.csv")) > 5
    page = (run / "report.html").read_text(encoding="utf-8")
    for anchor in ("torques", "revolution", "roots"):
        assert f'id="{anchor}"' in page


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("[operating]", '[stiffness]\nmodel = "ishikawa"\n[operating]', "stiffness.model"),
        ("[operating]", '[stiffness]\npairs = "independent"\n[operating]', "stiffness.pairs"),
        (TORQUES, "", "operating.torques_Nm"),
        (
            "teeth = 36",
            "teeth = 35",
            "cumulative_pitch_um = 36 values: must have one value for each of 35 teeth",
        ),
        (
            "roll_deg = [11.0, 16.0",
            "roll_deg = [16.0, 11.0",
            r"roll_deg = 16, 11 .points 1 and 2.: must rise",
        ),
        ("friction = 0.05", "friction = 0.9", "operating.friction"),
    ],
)
def test_what_cannot_be_is_refused_under_its_key(old, new, where):
    text = EXAMPLE.read_text(encoding="utf-8")
    assert old in text
    with pytest.raises(InputError, match=where):
        parse_scene(text.replace(old, new, 1))


def test_a_torque_without_a_solution_between_the_positions_is_left_out_and_named():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    teeth = LoadedTeeth(pair, 600.0, compliance=fem.compliance(pair, tolerance=0.05))
    assert fem.mesh_cycle(pair, 24e3, 4, teeth.compliance).converged
    found = torque_curves(teeth, [24e3], positions=4)
    assert found.torque.tolist() == [600.0]
    assert not found.converged
    assert found.message.startswith("24000 N m: between the positions of the mesh cycle a tip edge presses")
