"""What wants and keys declare of themselves: rules, lists and simplified scenes follow from it."""

from __future__ import annotations

import copy
from typing import Any, get_args

import pytest

from base import Fault, InputError
from flankfilm.building.face import varies_by
from flankfilm.scene import Scene
from flankfilm.scene.explain import model_in
from flankfilm.scene.plain_gears import plain_flanks
from flankfilm.scene.reader import validated
from flankfilm.scene.schema import Want
from flankfilm.scene.sections.key import Traits, key_of
from flankfilm.scene.wants import MOTIONS, WANTS, ranges

RANGE = {"speed_rpm": [500, 30000]}
WHOLE = {
    "pair": {"module_mm": 2.0, "face_width_mm": 40.0, "pinion": {"teeth": 36}, "wheel": {"teeth": 40}},
    "material": {"youngs_modulus_GPa": 206.0, "poisson_ratio": 0.3},
    "operating": {"pinion_torque_Nm": 600.0, "pinion_speed_rpm": 2000.0, "torques_Nm": [100.0, 600.0]},
    "lubricant": {"viscosity_Pa_s": 0.075, "pressure_viscosity_per_GPa": 19.6, "temperature_C": 60.0},
    "dynamics": {"sweep": RANGE, "diagram": RANGE, "run_up": RANGE, "bearing_forces": RANGE},
    "rating": {
        "accuracy_grade": 6, "K_A": 1.25, "life_h": 20000.0,
        "pinion": {"steel": "Eh", "sigma_Hlim_MPa": 1500.0, "sigma_Flim_MPa": 430.0, "root_Rz_um": 20.0},
    },
}  # fmt: skip
"""All that any want needs, but for those of gears in space."""

HELD = [{"position_mm": 0.0, "radial_N_per_m": 1e8, "axial_N_per_m": 1e8, "tilting_Nm_per_rad": 1e5}]

IN_SPACE: dict[str, Any] = WHOLE | {
    "pair": WHOLE["pair"] | {"helix_angle_deg": 15.0},
    "bearings": {"pinion": HELD, "wheel": HELD},
}
"""All that gears in space need."""

VALUES: dict[str, Any] = {
    "tight": True,
    "alignment": {},
    "tip_rounding_um": 30.0,
    "tip_relief": {"amount_um": 20.0, "length_mm": 2.0},
    "map": {"roll_deg": [5.0, 32.0], "z_mm": [-20.0, 20.0], "material_um": [[0.0, 1.0], [1.0, 0.0]]},
}
"""Of keys whose example is none, or stands in a file."""


def put(raw: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    """A scene with another value at a path; None leaves the key out."""
    changed = copy.deepcopy(raw)
    *tables, key = path.split(".")
    table = changed
    for name in tables:
        table = table.setdefault(name, {})
    if value is None:
        table.pop(key, None)
    else:
        table[key] = copy.deepcopy(value)
    return changed


def faults(raw: dict[str, Any]) -> tuple[Fault, ...]:
    try:
        validated(copy.deepcopy(raw))
    except InputError as error:
        return error.faults
    return ()


def plain(value: Any) -> Any:
    """An example as a file has it."""
    if isinstance(value, dict):
        return {name: plain(inner) for name, inner in value.items()}
    return [plain(inner) for inner in value] if isinstance(value, tuple) else value


def keys(model: Any = Scene, path: str = "") -> list[tuple[str, Any]]:
    """Every key of a scene and its field."""
    listed = []
    for name, field in model.model_fields.items():
        listed.append((f"{path}{name}", field))
        if (inner := model_in(field.annotation)) is not None and "tuple" not in str(field.annotation):
            listed += keys(inner, f"{path}{name}.")
    return listed


def value_of(path: str, field: Any) -> Any:
    return VALUES.get(path.rpartition(".")[2], plain(key_of(field).example))


def with_trait(name: str) -> list[tuple[str, Any]]:
    return [(path, field) for path, field in keys() if getattr(key_of(field).traits, name)]


@pytest.mark.parametrize("want", WANTS)
def test_a_want_is_accepted_with_all_that_it_needs_and_asks_for_each_part_of_it(want: str):
    in_space = want == "bearing-forces"
    raw, traits = {"wants": [want], **(IN_SPACE if in_space else WHOLE)}, WANTS[want]
    assert faults(raw) == ()
    needs_pair = traits.gears or traits.mesh
    sections = {
        "pair": needs_pair,
        "material": needs_pair and not traits.unloaded,
        "operating": needs_pair and not traits.unloaded,
        "lubricant": traits.films,
        "dynamics": traits.motion,
        "rating": traits.rated,
        **({"bearings": True} if in_space else {}),
    }
    for section, needed in sections.items():
        lacking = {fault.where for fault in faults(put(raw, section, None))}
        assert lacking == ({f"[{section}]"} if needed else set())
    for key in traits.keys:
        lacking = [fault for fault in faults(put(raw, key.path, None)) if fault.where == key.path]
        assert [fault.allowed for fault in lacking] == [f"is required by the wanted {want}"]
        assert lacking[0].remedy == key.remedy


def test_the_names_of_wants_are_those_that_a_scene_takes():
    assert get_args(Want) == tuple(WANTS)
    assert faults({"wants": ["swep"], **WHOLE})[0].where == "wants.0"
    assert ranges(WANTS) == ["sweep", "diagram", "run_up", "bearing_forces"]
    assert set(MOTIONS) == {name for name, want in WANTS.items() if want.motion}


@pytest.mark.parametrize(("path", "field"), with_trait("finite_elements"), ids=lambda part: str(part)[:40])
def test_a_key_of_finite_elements_is_refused_with_a_closed_form(path: str, field: Any):
    closed = put({"wants": ["stiffness"], **WHOLE}, "stiffness.model", "ishikawa")
    name = path if "." in path else f"[{path}]"
    assert faults(closed) == ()
    said = {fault.where: fault.allowed for fault in faults(put(closed, path, value_of(path, field)))}
    assert said["stiffness.model"] == f'must be "fem" for {name}'


LEADS = {"crowning_um", "lead_slope_um", "end_relief_um", "lead_twist_um"}
FLANKS = {*LEADS, "tip_rounding_um", "deviations", "wear"}


@pytest.mark.parametrize(
    ("trait", "names"),
    [
        (
            "finite_elements",
            FLANKS | {"face_width_mm", "hub", "tight", "alignment", "friction", "moving_contact"}
            | {"reference", "stiffness_reference"},
        ),
        ("along_face", LEADS | {"face_width_mm", "map", "lead", "alignment"}),
        ("meshed", FLANKS | {"tip_relief", "end_relief_length_mm"}),
        ("beside_shafts", {"portraits_rpm", "portraits_frequency"}),
        ("beside_segments", {"radial_stiffness_N_per_m", "torsional_stiffness_Nm_per_rad"}
         | {"in_plane_um", "out_of_plane_um"}),
    ],
)  # fmt: skip
def test_keys_with_a_trait(trait: str, names: set[str]):
    usual = getattr(Traits(), trait)
    others = [path for path, field in keys() if getattr(key_of(field).traits, trait) != usual]
    last = [path.rpartition(".")[2] for path in others if not path.startswith("pair.wheel.")]
    assert sorted(last) == sorted(names)
    assert {path.replace(".pinion.", ".wheel.") for path in others} >= {p for p in others if ".wheel." in p}


def test_no_other_key_is_named_by_that_rule():
    known = {path for path, _ in with_trait("finite_elements")}
    closed = put({"wants": ["stiffness"], **WHOLE}, "stiffness.model", "ishikawa")
    for path, field in keys():
        value = value_of(path, field)
        inside = any(path.startswith(f"{name}.") for name in known)
        if path in known or inside or value is None or path == "stiffness.model":
            continue
        said = [f.allowed for f in faults(put(closed, path, value)) if f.where.startswith("stiffness.")]
        assert not [allowed for allowed in said if path in allowed], path


@pytest.mark.parametrize(("path", "field"), with_trait("along_face"), ids=lambda part: str(part)[:40])
def test_the_load_varies_by_a_key_along_the_face_alone_and_plain_flanks_lose_what_no_mesh_shows(
    path: str, field: Any
):
    raw = {"wants": ["geometry"], **WHOLE}
    if path.endswith("end_relief_um"):
        raw = put(raw, path.replace("_um", "_length_mm"), 5.0)
    scene = validated(put(raw, path, value_of(path, field)))
    assert varies_by(scene) == [path if "." in path else f"[{path}]"]
    gear = path.split(".")[2:3]
    shown = not gear or gear == ["face_width_mm"]
    assert bool(varies_by(plain_flanks(scene))) == shown


def test_plain_flanks_have_nothing_that_no_mesh_shows():
    unseen = [(path, field) for path, field in keys() if not key_of(field).traits.meshed]
    assert {path.rpartition(".")[2] for path, _ in unseen} >= {"tip_relief", "wear", "crowning_um"}
    raw = {"wants": ["geometry"], **WHOLE}
    for path, field in unseen:
        raw = put(raw, path, value_of(path, field))
    plain_scene = plain_flanks(validated(raw))
    assert plain_scene.pair == validated({"wants": ["geometry"], **WHOLE}).pair
