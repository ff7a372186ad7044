"""Keys of the shafts: what a scene says of them in SI, and every fault at once under its key."""

import pytest

from base import InputError
from flankfilm.files.cache import Cache
from flankfilm.scene import parse_scene, template
from flankfilm.scene.sections.key import key_of
from flankfilm.scene.sections.shafts import BearingSection, SegmentSection
from flankfilm.scene.toml import toml
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import DRY_CYCLE

BEARINGS = "[{ position_mm = 20, stiffness_N_per_m = 4e8 }, { position_mm = 180, stiffness_N_per_m = 4e8 }]"
SHAFT = (
    f"segments = [{{ length_mm = 200, diameter_mm = 40 }}]\nbearings = {BEARINGS}\ngear_position_mm = 100\n"
)


def scene(shafts: str, wants: str = '"sweep"', changes: tuple[tuple[str, str], ...] = ()):
    text = template().replace('"stiffness", "film", "sweep", "vtk", "report"', wants)
    for before, after in changes:
        assert before in text
        text = text.replace(before, after)
    return parse_scene(f"{text}\n{shafts}")


def faults(shafts: str, wants: str = '"sweep"', changes: tuple[tuple[str, str], ...] = ()) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        scene(shafts, wants, changes)
    return {fault.where: f"{fault.value} {fault.allowed}. {fault.remedy}" for fault in caught.value.faults}


def test_a_shaft_is_in_si():
    found = scene(f"[shafts.pinion]\n{SHAFT}torque_position_mm = 200\ninertia_kg_m2 = 0.02").shafts
    shaft = found.pinion.shaft()
    assert (shaft.length, shaft.gear_position, shaft.torque_position) == (0.2, 0.1, 0.2)
    assert [(b.position, b.stiffness, b.damping) for b in shaft.bearings] == [
        (0.02, 4e8, 0.0),
        (0.18, 4e8, 0.0),
    ]
    assert shaft.segments[0].diameter == 0.04
    assert found.wheel is None
    assert found.damping_ratio == (0.01,)


def test_a_shaft_without_steps_is_rigid():
    found = scene("[shafts.wheel]\ninertia_kg_m2 = 0.05\ncoupling_stiffness_Nm_per_rad = 2e4").shafts.wheel
    assert found.rigid
    assert found.shaft() is None
    assert found.value("coupling_stiffness_Nm_per_rad") == 2e4


def test_damping_is_one_number_or_a_list():
    assert scene(f"[shafts]\ndamping_ratio = 0.02\n[shafts.pinion]\n{SHAFT}").shafts.damping_ratio == (0.02,)
    given = f"[shafts]\ndamping_ratio = [0.02, 0.01]\n[shafts.pinion]\n{SHAFT}"
    assert scene(given).shafts.damping_ratio == (0.02, 0.01)


def test_all_faults_of_both_shafts_come_at_once():
    wrong = SHAFT.replace("200", "-200").replace("= 40", "= 40, bore_mm = 99000")
    found = faults(
        f"[shafts]\ndamping_ratio = [0.02, 3]\n[shafts.pinion]\n{wrong}\n[shafts.wheel]\n"
        "coupling_stiffness_Nm_per_rad = 2e4\ntorque_position_mm = 4"
    )
    assert {*found} == {
        "shafts.damping_ratio.1",
        "shafts.pinion.segments.0.length_mm",
        "shafts.pinion.segments.0.bore_mm",
        "shafts.wheel.inertia_kg_m2",
        "shafts.wheel.torque_position_mm",
    }
    assert "100000 mm" in found["shafts.pinion.segments.0.length_mm"]


def test_what_the_shaft_refuses_stands_under_its_keys_in_millimetres():
    wrong = SHAFT.replace("= 40", "= 40, bore_mm = 50").replace("180", "1800").replace("= 100", "= 1000")
    found = faults(f"[shafts.wheel]\n{wrong}")
    assert "less than the diameter, 40 mm" in found["shafts.wheel.segments.0.bore_mm"]
    assert "at most 200 mm" in found["shafts.wheel.bearings.1.position_mm"]
    assert "at most 200 mm" in found["shafts.wheel.gear_position_mm"]


@pytest.mark.parametrize(
    ("shafts", "where", "says"),
    [
        ("[shafts]\ndamping_ratio = 0.01", "shafts", "must have [shafts.pinion] or [shafts.wheel]"),
        (
            f"[shafts]\ndamping_ratio = 0.01\nrayleigh = {{ of_mass_per_s = 3 }}\n[shafts.pinion]\n{SHAFT}",
            "shafts",
            "damping_ratio or rayleigh, not both",
        ),
        (
            f"[shafts.pinion]\n{SHAFT.replace('gear_position_mm = 100', '')}",
            "shafts.pinion.gear_position_mm",
            "is required by the segments",
        ),
        (f"[shafts.pinion]\nbearings = {BEARINGS}", "shafts.pinion.bearings", "must have segments"),
        (
            f"[shafts.pinion]\n{SHAFT.split('bearings')[0]}gear_position_mm = 100",
            "shafts.pinion.bearings",
            "at least two",
        ),
    ],
)
def test_what_does_not_go_together_is_refused(shafts, where, says):
    assert says in faults(shafts)[where]


@pytest.mark.parametrize(
    ("wants", "changes", "where", "says"),
    [
        ('"sweep"', (("# portraits_rpm =", "portraits_rpm ="),), "dynamics.portraits_rpm", "rigid shafts"),
        (
            '"sweep"',
            (("bore_mm = 33.5 }", "bore_mm = 33.5, hub = { radial_stiffness_N_per_m = 5e8 } }"),),
            "pair.pinion.hub.radial_stiffness_N_per_m",
            "counts the shaft twice",
        ),
        (
            '"sweep"',
            (("[dynamics]", "[alignment]\nin_plane_um = 20\n[dynamics]"),),
            "alignment.in_plane_um",
            "gives the alignment twice, beside shafts.pinion.segments",
        ),
    ],
)
def test_what_the_rest_of_the_scene_says_twice_or_cannot_have_is_refused(wants, changes, where, says):
    assert says in faults(f"[shafts.pinion]\n{SHAFT}", wants, changes)[where]


def test_results_depend_on_what_bends_under_the_face_alone():
    """Keys of the kept film and mesh: of [shafts] nothing without cells, and with them neither inertia nor damping."""

    def keys(shaft: str, alignment: str) -> dict[str, object]:
        changes = (("[dynamics]", f"{alignment}[dynamics]"),)
        found = scene(f"[shafts.pinion]\n{shaft}torque_position_mm = 200\n", '"film"', changes)
        return Engine(found, Cache(None)).inputs(DRY_CYCLE)

    rigid = parse_scene(template().replace('"stiffness", "film", "sweep", "vtk", "report"', '"film"'))
    cells = "[alignment]\ncells = 16\n"
    assert keys(SHAFT, "") == Engine(rigid, Cache(None)).inputs(DRY_CYCLE)
    whole = keys(SHAFT, cells)
    assert whole != keys(SHAFT, "")
    assert whole == keys(f"{SHAFT}inertia_kg_m2 = 0.02\n", cells)
    assert whole == keys(SHAFT.replace("= 4e8 }, {", "= 4e8, damping_N_s_per_m = 9 }, {"), cells)
    assert whole == keys(SHAFT, f"{cells}in_plane_tolerance_um = 5\n")
    assert whole != keys(SHAFT.replace("diameter_mm = 40", "diameter_mm = 41"), cells)
    assert whole != keys(SHAFT.replace("= 4e8 }, {", "= 5e8 }, {"), cells)
    assert whole != keys(SHAFT, cells.replace("16", "18"))


def test_rigid_shafts_leave_alignment_and_hubs_to_the_other_sections():
    hub = (("bore_mm = 33.5 }", "bore_mm = 33.5, hub = { radial_stiffness_N_per_m = 5e8 } }"),)
    assert scene("[shafts.pinion]\ninertia_kg_m2 = 0.02", changes=hub).shafts.pinion.rigid


@pytest.mark.parametrize(
    ("section", "table", "number"),
    [
        (SegmentSection, "segments", "length_mm"),
        (SegmentSection, "segments", "diameter_mm"),
        (SegmentSection, "segments", "bore_mm"),
        (BearingSection, "bearings", "position_mm"),
        (BearingSection, "bearings", "stiffness_N_per_m"),
        (BearingSection, "bearings", "damping_N_s_per_m"),
    ],
)
def test_numbers_of_tables_in_lists_are_refused_beyond_their_bounds(section, table, number):
    limit = key_of(section.model_fields[number]).bounds
    tables = {
        "segments": {"length_mm": 200, "diameter_mm": 40},
        "bearings": {"position_mm": 20, "stiffness_N_per_m": 4e8},
    }
    for end, side in ((limit.low, -1.0), (limit.high, 1.0)):
        tables[table] = {**tables[table], number: end + side * max(1.0, abs(end))}
        text = "\n".join(f"{name} = [{toml(one)}]" for name, one in tables.items())
        found = faults(f"[shafts.pinion]\n{text}\ngear_position_mm = 100")
        assert f"{limit.high:g}" in found[f"shafts.pinion.{table}.0.{number}"]
