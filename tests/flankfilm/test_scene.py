"""A faulty scene yields every fault at once, each with key, value, what is allowed and a remedy."""

from __future__ import annotations

import math
import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import BaseModel
from pydantic.fields import FieldInfo

from base import Fault, InputError
from flankfilm.building.pair import gear_pair
from flankfilm.optimisation.task import Limit, OptimisationFile
from flankfilm.scene import Scene, parse_scene, read_scene, template
from flankfilm.scene.explain import model_in
from flankfilm.scene.sections.key import key_of
from flankfilm.studies.study_file import Follow, Range, StudyFile


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    return {fault.where: str(fault) for fault in caught.value.faults}


def changed(old: str, new: str) -> str:
    text = template()
    assert old in text
    return text.replace(old, new, 1)


def test_the_template_is_a_valid_scene_with_every_section():
    """Left out are those with which loads, film, gears and motion are others."""
    scene = parse_scene(template())
    left_out = {name for name in Scene.model_fields if getattr(scene, name) is None}
    assert left_out == {"alignment", "bearings", "heat", "rating", "roughness", "shafts"}
    commented = "\n".join(
        re.findall(r"^# (\[roughness\]|(?:sigma|density_per|tip|law|mean_plane).* = .*)", template(), re.M)
    )
    assert parse_scene(f"{template()}\n{commented}").roughness is not None
    rating = re.search(r"^# (\[rating\]\n(?:#.*\n)+)", template(), re.M)
    assert rating is not None
    lines = re.sub(r"^# (?=\w+ = )", "", rating[1], flags=re.M)
    assert parse_scene(f"{template()}\n{lines}").rating is not None


def keys(model: type[BaseModel]) -> set[str]:
    found = set(model.model_fields)
    for field in model.model_fields.values():
        nested = model_in(field.annotation)
        if nested is not None:
            found |= keys(nested)
    return found


def test_the_template_mentions_every_key():
    unmentioned = {key for key in keys(Scene) if not re.search(rf"\b{key}\b", template())}
    assert unmentioned == set()


@pytest.mark.parametrize(
    ("old", "new", "where", "said"),
    [
        ("module_mm = 2.0", "module = 2.0", "pair.module", "Did you mean module_mm"),
        ("module_mm = 2.0", "module_m = 0.002", "pair.module_m", "unit is part of the key"),
        ("module_mm = 2.0", "module_mm = -2.0", "pair.module_mm", "at least 0.01"),
        ("module_mm = 2.0", "module_mm = nan", "pair.module_mm", "finite"),
        ("module_mm = 2.0", "module_mm = inf", "pair.module_mm", "finite"),
        ("module_mm = 2.0", 'module_mm = "2 mm"', "pair.module_mm", "without quotes"),
        ("module_mm = 2.0", "module_mm = 2000", "pair.module_mm", "Check the unit"),
        (
            "youngs_modulus_GPa = 206",
            "youngs_modulus_GPa = 206e9",
            "material.youngs_modulus_GPa",
            "Check the unit",
        ),
        ("teeth = 36", "teeth = 3", "pair.pinion.teeth", "at least 5"),
        ("teeth = 36", "teeth = 36.5", "pair.pinion.teeth", "whole number"),
        ("teeth = 36", "teeth = true", "pair.pinion.teeth", "whole number"),
        ("teeth = 40", "teeth = 100000000", "pair.wheel.teeth", "at most 10000"),
        ("pinion_torque_Nm = 600", "pinion_torque_Nm = 0", "operating.pinion_torque_Nm", "at least"),
        ("pinion_speed_rpm = 2000", "pinion_speed_rpm = 0", "operating.pinion_speed_rpm", "at least"),
        ('model = "ehl"', 'model = "ehd"', "film.model", "Did you mean 'ehl'"),
        ("tolerance = 0.005", "tolerance = 0", "tolerance", "at least"),
        ('"report"]', '"reprot"]', "wants.4", "Did you mean 'report'"),
        ("points = 400", "points = 1", "dynamics.sweep.points", "at least 2"),
        ("[500, 30000]", "[30000, 500]", "dynamics.sweep", "must rise"),
        ("[operating]", "[operatin]", "[operating]", "is required"),
        ('rack = "ISO 53 A"', "rack = { h_aP = 1.0 }", "pair.rack.h_fP", "is required"),
    ],
)
def test_a_fault_names_key_and_remedy(old: str, new: str, where: str, said: str):
    found = faults(changed(old, new))
    assert where in found
    assert said in found[where]


@pytest.mark.parametrize(
    ("new", "where", "said"),
    [
        ('pairs = "independent"', "stiffness.pairs", "wanted vtk"),
        ('pairs = "coupled"\nmodel = "given"\namplitudes = [0.1]', "stiffness.model", "wanted film"),
    ],
)
def test_wants_that_a_model_cannot_give_are_refused(new: str, where: str, said: str):
    text = changed('pairs = "coupled"', new)
    if "given" in new:
        text = text.replace('model = "fem"', "", 1).replace('"vtk", ', "", 1)
    found = faults(text)
    assert said in found[where]


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ('model = "fem"', 'model = "potential-energy"', "stiffness.model"),
        ('pairs = "coupled"', 'pairs = "independent"', "stiffness.pairs"),
    ],
)
def test_contacts_that_move_are_asked_of_coupled_finite_elements_alone(old: str, new: str, where: str):
    """Other models left the key out without a word."""
    kept = re.sub(r"^wants = .*$", 'wants = ["stiffness"]', template(), flags=re.MULTILINE)
    found = faults(kept.replace(old, f"{new}\nmoving_contact = true", 1))
    assert "stiffness.moving_contact" in found[where]


@pytest.mark.parametrize("path", [3, None, {"title": "a scene"}])
def test_what_is_no_path_is_refused_by_name(path: object):
    with pytest.raises(InputError, match=r"path = .*: must be the path of a scene file"):
        read_scene(path)  # type: ignore[arg-type]


def test_all_faults_come_at_once():
    text = template()
    for old, new in (
        ("teeth = 36", "teeth = 3"),
        ("module_mm = 2.0", "module_mm = -1"),
        ("[lubricant]", "[lubricants]"),
    ):
        text = text.replace(old, new, 1)
    assert {"pair.pinion.teeth", "pair.module_mm", "lubricants", "[lubricant]"} <= set(faults(text))


def test_keys_of_a_measured_map_are_shown_and_suggested_as_those_of_other_tables():
    assert 'file = "pinion_map.csv"' in template()
    points = "roll_deg = [5.0, 32.0], z_mm = [-20.0, 20.0], materal_um = [[0.0, 1.0], [1.0, 0.0]]"
    text = template().replace("teeth = 36", f"deviations = {{ map = {{ {points} }} }}, teeth = 36", 1)
    assert "Did you mean material_um" in faults(text)["pair.pinion.deviations.map.materal_um"]


def test_dynamics_alone_is_a_complete_scene():
    scene = parse_scene(
        'wants = ["sweep"]\n[stiffness]\nmodel = "given"\namplitudes = [0.18]\n'
        "[dynamics]\nmean_force = 0.1\nerror_amplitude = 0.2\nhalf_backlash = 0.2\n"
        "sweep = { frequency = [0.5, 0.7], points = 10 }\n"
    )
    assert scene.dynamics is not None
    assert scene.dynamics.dimensionless
    assert scene.pair is None


def test_mixed_units_of_the_oscillator_are_refused():
    found = faults(changed("error_amplitude_um = 0", "error_amplitude_um = 10\nmean_force = 0.1"))
    assert "half_backlash" in found["dynamics"]


def test_binary_missing_and_folder(tmp_path):
    binary = tmp_path / "binary.toml"
    binary.write_bytes(bytes(range(256)))
    for path, said in (
        (binary, "not a text file"),
        (tmp_path / "none.toml", "does not exist"),
        (tmp_path, "folder"),
    ):
        with pytest.raises(InputError, match=said):
            read_scene(path)


def faults_or_none(text: str) -> tuple[Fault, ...] | None:
    try:
        parse_scene(text)
    except InputError as error:
        return error.faults
    return None


VALUES = st.one_of(
    st.none().map(lambda _: "nan"),
    st.integers(-(10**12), 10**12).map(str),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.sampled_from(["true", "[]", "{}", "[1, 2]", '"x"', "inf", "-inf", "1979-05-27", "[[]]", "{ a = 1 }"]),
)
LINES = [line for line in template().splitlines() if re.match(r"\w+ = ", line)]


@settings(max_examples=150, deadline=None)
@given(st.lists(st.tuples(st.sampled_from(LINES), VALUES), min_size=1, max_size=4))
def test_any_value_at_any_key_is_accepted_or_explained(changes: list[tuple[str, str]]):
    text = template()
    for line, value in changes:
        text = text.replace(line, f"{line.split(' = ')[0]} = {value}", 1)
    found = faults_or_none(text)
    assert found is None or all(fault.where and fault.allowed for fault in found)


@settings(max_examples=150, deadline=None)
@given(st.text(max_size=200))
def test_any_text_is_refused_with_a_reason(text: str):
    with pytest.raises(InputError):
        parse_scene(text)


def fields(model: type[BaseModel], path: str = "") -> dict[str, FieldInfo]:
    """Every field below a model, by its path."""
    found = {}
    for name, field in model.model_fields.items():
        found[path + name] = field
        nested = model_in(field.annotation)
        if nested is not None:
            found |= fields(nested, f"{path}{name}.")
    return found


@pytest.mark.parametrize("model", [Scene, StudyFile, Range, Follow, OptimisationFile, Limit])
def test_every_key_has_a_meaning(model: type[BaseModel]):
    assert {path for path, field in fields(model).items() if not field.description} == set()


def test_a_key_is_converted_by_the_unit_in_which_it_ends():
    scene = parse_scene(template())
    assert scene.pair is not None
    assert scene.pair.si() == {
        "module": 2e-3,
        "face_width": 40e-3,
        "helix_angle": 0.0,
        "tight": False,
    }
    assert scene.pair.pinion.si()["bore_radius"] == 0.5e-3 * 33.5
    assert scene.operating is not None
    assert scene.operating.value("pinion_speed_rpm") == pytest.approx(2000 * math.pi / 30, rel=1e-15)
    oil = parse_scene(
        changed("# iso_vg = 100", "iso_vg = 100")
        .replace("# temperature_C", "temperature_C")
        .replace("\nviscosity_Pa_s", "\n# ")
        .replace("\npressure_visc", "\n# ")
        .replace("\ndensity_kg_per_m3 = 910", "\n# ")
    )
    assert oil.lubricant is not None
    assert oil.lubricant.value("temperature_C") == 333.15


@pytest.mark.parametrize(
    "path", sorted(path for path, field in fields(Scene).items() if key_of(field).bounds)
)
def test_bounds_of_a_key_are_those_of_its_limit_in_si(path: str):
    """Up to the rounding of the conversion, so that what a scene takes the ground takes."""
    about = key_of(fields(Scene)[path])
    assert about.bounds is not None
    assert about.limit is not None
    for end in ("low", "high"):
        bound, limit = getattr(about.bounds, end), getattr(about.limit, end)
        assert about.si(bound) == pytest.approx(limit, rel=1e-11, abs=1e-300)


@pytest.mark.parametrize("text", ['"0.5%"', '"0.005"', "0.005"])
def test_a_tolerance_is_read_as_on_the_command_line(text: str):
    assert parse_scene(changed("tolerance = 0.005", f"tolerance = {text}")).tolerance == 0.005


@pytest.mark.parametrize("text", ['"half"', '"50%"', '"0.5%%"', '"-1%"', "true"])
def test_a_senseless_tolerance_is_refused(text: str):
    assert "0.4" in faults(changed("tolerance = 0.005", f"tolerance = {text}"))["tolerance"]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "bore_mm = 33.5",
            "bore_mm = 600",
            "pair.pinion.bore_mm = 600: must be at most 66 mm (a diameter). ",
        ),
        (
            "backlash_um = 50",
            "centre_distance_mm = 70",
            "pair.centre_distance_mm = 70: must be more than the sum of the base radii, 71.4167 mm. ",
        ),
        (
            "profile_shift = 0.0",
            "thickness_allowance_um = 5000",
            "pair.pinion.thickness_allowance_um = 5000: must be less than 1426 um. ",
        ),
        (
            "profile_shift = 0.0",
            "tip_relief = { amount_um = 20, length_mm = 200 }",
            "pair.pinion.tip_relief.length_mm = 200: must be at most the flank's 10.8437 mm. ",
        ),
        (
            "profile_shift = 0.0",
            "profile_shift = 1.5",
            "pair.wheel.tip_radius = 42 mm: must be at most 41.5816 mm ",
        ),
    ],
)
def test_faults_of_the_geometry_speak_of_the_scenes_keys_and_units(old: str, new: str, message: str):
    with pytest.raises(InputError) as caught:
        gear_pair(parse_scene(changed(old, new)))
    assert any(str(fault).startswith(message) for fault in caught.value.faults), str(caught.value)


def test_bounds_are_those_of_the_ground():
    """The same at both ends, in the unit of the key."""
    assert (
        "at least 0.01 and at most 1000 mm"
        in faults(changed("module_mm = 2.0", "module_mm = 0"))["pair.module_mm"]
    )
    found = faults(changed("poisson_ratio = 0.3", "poisson_ratio = 0.5"))["material.poisson_ratio"]
    assert "at least 0 and at most 0.4999" in found


@pytest.mark.parametrize("turn", [-1.0, 1.0])
def test_a_phase_is_one_turn_at_most(turn: float):
    text = template()
    assert "error_phase_deg = 0" in text
    whole = parse_scene(text.replace("error_phase_deg = 0", f"error_phase_deg = {360.0 * turn}"))
    assert whole.dynamics is not None
    found = faults(text.replace("error_phase_deg = 0", f"error_phase_deg = {360.5 * turn}"))
    assert "at least -360 and at most 360 deg" in found["dynamics.error_phase_deg"]
