"""A scene that `check` refuses is refused by a run before its first stage, with the same faults, and no other is."""

from __future__ import annotations

import json
import warnings
from typing import Any

import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from pydantic import ValidationError

from base import InputError
from flankfilm.building.face import varies_by
from flankfilm.building.pair import gear_pair
from flankfilm.runs.check import check_scene
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import Scene
from flankfilm.scene.reader import reread, validated
from flankfilm.scene.wants import WANTS
from tests.flankfilm.test_traits import WHOLE, put

STEPS = {"segments": [{"length_mm": 200, "diameter_mm": 40}], "gear_position_mm": 100.0,
         "bearings": [{"position_mm": p, "stiffness_N_per_m": 4e8} for p in (20, 180)]}  # fmt: skip
FORM = {"mean_force": 0.0, "error_amplitude": 0.0, "half_backlash": 0.2, "diagram": {"frequency": [0.4, 0.5]}}
CHANGES: list[tuple[str, Any]] = [
    *((section, None) for section in ("pair", "material", "operating", "lubricant", "dynamics")),
    *(("stiffness.model", model) for model in ("ishikawa", "auto")),
    ("stiffness", {"model": "given", "amplitudes": [0.2]}),
    ("stiffness.pairs", "independent"),
    ("stiffness.plane", "stress"),
    ("stiffness.reference", "bore"),
    ("dynamics.stiffness_reference", "teeth"),
    ("dynamics.damping_ratio", "film"),
    ("dynamics.sweep", {"speed_rpm": [0.01, 3000]}),
    ("dynamics.portraits_rpm", [9000.0]),
    ("dynamics", FORM),
    ("operating.friction", 0.05),
    ("operating.torques_Nm", []),
    ("operating.pinion_speed_rpm", None),
    ("alignment", {}),
    ("alignment", {"in_plane_um": 20.0, "cells": 2}),
    ("shafts", {"pinion": STEPS}),
    ("shafts", {"pinion": STEPS, "rayleigh": {"of_mass_per_s": 20.0}}),
    *(("film", {"model": model}) for model in ("none", "dowson", "ehl", "auto")),
    ("film", {"supply": "meniscus", "meniscus_mm": 0.01}),
    ("film", {"supply": "meniscus", "meniscus_half_widths": 1.5}),
    ("roughness", {"sigma_um": 0.3, "density_per_mm2": 25000.0, "tip_radius_um": 10.0}),
    ("lubricant", {"iso_vg": 100.0, "temperature_C": 60.0}),
    ("heat", {"pinion_temperature_C": 400.0}),
    ("pair.helix_angle_deg", 15.0),
    ("pair.tight", True),
    ("pair.centre_distance_mm", 75.95),
    ("pair.tool", {"h_aP0": 1.25, "rho_aP0": 0.9}),
    ("pair.pinion.teeth", 5),
    ("pair.pinion.tip_diameter_mm", 90.0),
    ("pair.pinion.tip_rounding_um", 5000.0),
    ("pair.pinion.crowning_um", 10.0),
    ("pair.wheel.end_relief_um", 8.0),
    ("pair.wheel.end_relief_length_mm", 5.0),
    ("pair.wheel.face_width_mm", 45.0),
    ("pair.wheel.hub", {"hub_mm": 100.0}),
    ("pair.wheel.hub", {"torsional_stiffness_Nm_per_rad": 1e6}),
    ("pair.wheel.wear", {"roll_deg": [10.0, 20.0], "depth_um": [3.0, 1.0]}),
]


@st.composite
def scenes(draw: st.DrawFn) -> dict[str, Any]:
    """Scenes with some changes that do not always go together."""
    raw = {"wants": draw(st.lists(st.sampled_from(sorted(WANTS)), min_size=1, max_size=3)), **WHOLE}
    for path, value in draw(st.lists(st.sampled_from(CHANGES), max_size=4)):
        table = raw.get(path.partition(".")[0], {})
        if isinstance(table, dict):
            raw = put(raw, path, value)
    return raw


class BegunError(Exception):
    """A run has begun its first stage."""


def begun(*_: object) -> None:
    raise BegunError


def refused(call: Any) -> list[str]:
    """Faults by which a scene is refused; none where it is computed, or would be."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            call()
        except InputError as error:
            return sorted(map(str, error.faults))
        except BegunError:
            pass
    return []


def judged(raw: dict[str, Any]) -> bool:
    """Whether a scene is accepted, by its file, by check and by a run alike."""
    try:
        scene = Scene.model_validate(raw)
    except ValidationError:
        return False
    by_check = refused(lambda: check_scene(scene))
    assert refused(lambda: run_scene(scene, None, use_cache=False, progress=begun)) == by_check
    by_file = refused(lambda: validated(raw))
    assert by_file in ([], by_check)
    if not by_file:
        assert reread(json.loads(scene.model_dump_json())) == scene
    return not by_check


@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
@example({"wants": ["sweep"], **put(put(WHOLE, "pair.helix_angle_deg", 15.0), "shafts", {"pinion": STEPS})})
def test_check_and_run_refuse_the_same_scenes_with_the_same_faults(raw: dict[str, Any]):
    judged(raw)


@pytest.mark.slow
@settings(max_examples=1500, deadline=None, suppress_health_check=list(HealthCheck))
@given(scenes())
def test_check_and_run_refuse_the_same_of_many_scenes(raw: dict[str, Any]):
    judged(raw)


def test_a_scene_that_python_made_is_asked_the_rules_between_sections():
    scene = Scene.model_validate({"wants": ["geometry", "film"], "pair": WHOLE["pair"]})
    faults = refused(lambda: run_scene(scene, None, progress=begun))
    assert [fault.partition(":")[0] for fault in faults] == ["[lubricant]", "[material]", "[operating]"]


@pytest.mark.parametrize(
    "change",
    [
        ("film", None),  # the film is wanted of a scene without [film], whose default leaves it out
        ("shafts", {"pinion": STEPS, "rayleigh": {"of_mass_per_s": 20.0}}),
        ("pair.wheel.hub", {}),
        ("alignment", {}),
    ],
)
def test_a_scene_written_with_all_its_defaults_is_the_same_scene(change: tuple[str, Any]):
    scene = validated(put({"wants": ["film"], **WHOLE}, *change))
    assert reread(json.loads(scene.model_dump_json())) == scene


def test_a_length_of_end_relief_without_any_leaves_the_load_even():
    raw = put({"wants": ["stiffness"], **WHOLE}, "pair.pinion.end_relief_length_mm", 25.0)
    scene = validated(put(raw, "stiffness.plane", "stress"))
    assert varies_by(scene) == []
    assert gear_pair(scene) == gear_pair(validated({"wants": ["stiffness"], **WHOLE}))
