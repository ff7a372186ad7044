"""Scenes of bearing forces in space: keys in SI, refusals with remedies, a run with results, report and outputs."""

from __future__ import annotations

import re

import numpy as np
import pytest

from base import InputError
from flankfilm.coupling import SpatialBearing
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from flankfilm.studies.outputs import OUTPUTS
from tests.flankfilm.pictured import HELICAL

SCENE = HELICAL.replace('"geometry", "stiffness", "film", "bearing-forces"', '"bearing-forces", "report"')


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    return {fault.where: str(fault) for fault in caught.value.faults}


def test_bearings_are_read_in_si() -> None:
    section = parse_scene(SCENE).bearings
    assert section is not None
    assert section.each == (
        (SpatialBearing(-9 * 1e-3, 1e8, 5e7, 0.0, 5e-6), SpatialBearing(12 * 1e-3, 1e8, 0.0, 0.0, 5e-6)),
        (SpatialBearing(0.0, 2e8, 5e7, 1e4, 5e-6),),
    )
    assert section.masses == (0.0, 0.0)


@pytest.mark.parametrize(
    ("old", "new", "where", "said"),
    [
        ("helix_angle_deg = 20\n", "", "pair.helix_angle_deg", "take [shafts]"),
        ("pinion_torque_Nm = 8", "pinion_torque_Nm = -8", "operating.pinion_torque_Nm", "the other hand"),
        ("[bearings]", "[shafts.pinion]\ninertia_kg_m2 = 0.02\n[bearings]", "[shafts]", "rigid there"),
        ("bearing_forces = { speed_rpm = [2000, 20000], points = 40 }", "", "dynamics.bearing_forces", "Add"),
        ("axial_N_per_m = 5e7 }, {", "axial_N_per_m = 0 }, {", "bearings.pinion", "along its axis"),
        ("tilting_Nm_per_rad = 1e4", "tilting_Nm_per_rad = 0", "bearings.wheel", "against tilt"),
        ("position_mm = 12", "position_mm = -9", "bearings.pinion", "at two places"),
        ("radial_N_per_m = 2e8", "radial_N_per_m = -2e8", "bearings.wheel.0.radial_N_per_m", "must be"),
        (
            "[dynamics]",
            "[dynamics]\nmean_force = 0.1\nhalf_backlash = 0.1\nerror_amplitude = 0.1",
            "dynamics.mean_force",
            "no dimensionless form",
        ),
    ],
)
def test_what_is_not_held_or_not_known_is_refused(old: str, new: str, where: str, said: str) -> None:
    assert old in SCENE
    found = faults(SCENE.replace(old, new))
    assert said in found[where]


def test_the_section_is_asked_for() -> None:
    assert "[bearings]" in faults(SCENE[: SCENE.index("[bearings]")])


@pytest.mark.slow
@pytest.mark.long
def test_results_report_and_outputs(tmp_path) -> None:
    done = run_scene(parse_scene(SCENE), tmp_path, use_cache=False)
    assert not done.failures
    data, swept = done.dataset, done.values["bearing forces"]
    assert data["in_space_bearing_force"].shape == (40, 3)
    assert [str(name) for name in data["in_space_bearings"].values] == ["pinion 1", "pinion 2", "wheel 1"]
    assert 0.0 < float(data["in_space_bearing_force"].attrs["error"]) < 0.5
    assert 0.0 < swept.frequency_error < 0.05
    # the loaded contact has next to no transmission error, and yet bearings swing and gears move along their axes
    assert np.nanmin(swept.bearing_swing) > 0.0
    assert np.nanmin(swept.axial_motion) > 0.0
    text = re.sub(r"\s+", " ", (tmp_path / "report.html").read_text(encoding="utf-8"))
    assert "Bearing forces in space" in text
    table = (tmp_path / "csv" / "bearing_forces.csv").read_text(encoding="utf-8")
    assert table.count("\n") == 41

    class Row:
        scene = parse_scene(SCENE)

        def __getitem__(self, stage):
            return done.values[stage.name]

    for name, value in (
        ("greatest_force_in_space_N", swept.greatest_force),
        ("greatest_axial_motion_um", 1e6 * swept.greatest_axial_motion),
        ("lowest_frequency_in_space_Hz", swept.natural_frequencies[0]),
        ("bearing_forces_error", swept.error),
    ):
        assert OUTPUTS[name].value(Row()) == pytest.approx(value, rel=1e-12)
