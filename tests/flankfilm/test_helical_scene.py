"""Scenes of helical pairs: what is answered, against formulas by hand; what spur pairs alone have, refused at once."""

from __future__ import annotations

import csv
import math
from fnmatch import fnmatchcase

import numpy as np
import pytest

from base import InputError
from flankfilm import figures
from flankfilm.building.face import face
from flankfilm.building.pair import gear_pair, warm_pair
from flankfilm.figures.style import narrow
from flankfilm.files.cache import Cache
from flankfilm.runs.check import check_scene
from flankfilm.runs.report import _asked
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene, read_scene, template
from flankfilm.scene.needs_of_helix import HELIX, KEYS_OF_SPUR
from flankfilm.scene.reader import parse_toml, validated
from flankfilm.scene.schema import Scene
from flankfilm.scene.sections.key import key_of
from flankfilm.scene.wants import MOTIONS, WANTS
from flankfilm.stages.engine import Engine
from flankfilm.stages.excitation import EXCITATION, REVOLUTION_ERROR
from flankfilm.stages.mesh import DRY_CYCLE
from flankfilm.studies.outputs import OUTPUTS
from gears import Gear, GearPair
from tests.flankfilm.explained import unexplained
from tests.flankfilm.pictured import faults_of
from tests.flankfilm.program import EXAMPLES, command
from tests.flankfilm.test_traits import put

SCENE = """
title = "Helical"
wants = [WANTS]
[pair]
module_mm = 2.0
face_width_mm = 40.0
helix_angle_deg = 20
pinion = { teeth = 36 }
wheel = { teeth = 40 }
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 600
pinion_speed_rpm = 2000
"""
MOTION = """
[dynamics]
sweep = { speed_rpm = [4000, 14000], points = 12 }
diagram = { speed_rpm = [4000, 14000] }
run_up = { speed_rpm = [4000, 14000], seconds = 0.2 }
bearing_forces = { speed_rpm = [500, 6000], points = 12 }
"""
BEARINGS = """
[bearings]
pinion = [{ position_mm = 0, radial_N_per_m = 3e8, axial_N_per_m = 1e8, tilting_Nm_per_rad = 1e6 }]
wheel = [{ position_mm = 0, radial_N_per_m = 3e8, axial_N_per_m = 1e8, tilting_Nm_per_rad = 1e6 }]
"""
ANSWERED = '"geometry", "closed-forms"'
RATING = """
[rating]
accuracy_grade = 6
K_A = 1.25
life_h = 20000
flank_Rz_um = 4.8
pinion = { steel = "Eh", sigma_Hlim_MPa = 1500, sigma_Flim_MPa = 430, root_Rz_um = 20 }
oil = { nu_40_mm2_per_s = 220 }
"""

OIL = """
[lubricant]
viscosity_Pa_s = 0.075
pressure_viscosity_per_GPa = 19.6
eyring_stress_MPa = 5
temperature_C = 80
"""

# by hand: m_n 2, z 36/40, b 40, beta 20 deg, 600 N m
BETA, ALPHA_N = math.radians(20.0), math.radians(20.0)
M_T = 2e-3 / math.cos(BETA)
ALPHA_T = math.atan(math.tan(ALPHA_N) / math.cos(BETA))
BETA_B = math.atan(math.tan(BETA) * math.cos(ALPHA_T))
R_1, R_2 = 18 * M_T, 20 * M_T
R_B1, R_B2 = R_1 * math.cos(ALPHA_T), R_2 * math.cos(ALPHA_T)
PITCH = math.pi * M_T * math.cos(ALPHA_T)
EPS_ALPHA = (
    math.sqrt((R_1 + 2e-3) ** 2 - R_B1**2)
    + math.sqrt((R_2 + 2e-3) ** 2 - R_B2**2)
    - (R_1 + R_2) * math.sin(ALPHA_T)
) / PITCH
EPS_BETA = 40e-3 * math.sin(BETA) / (math.pi * 2e-3)


def scene(wants: str = ANSWERED, old: str = "", new: str = "") -> Scene:
    text = SCENE.replace("WANTS", wants)
    assert old in text
    return parse_scene(text.replace(old, new, 1))


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        check_scene(parse_scene(text))
    return {fault.where: str(fault) for fault in caught.value.faults}


class TestKey:
    def test_the_template_shows_it(self):
        assert "helix_angle_deg = 0.0\n" in template()
        raw = parse_toml(template(), "scene")
        assert raw["pair"]["helix_angle_deg"] == 0.0

    def test_a_template_with_a_helix_is_answered(self):
        text = template().replace("helix_angle_deg = 0.0", "helix_angle_deg = -12.5", 1)
        start = text.index("wants = [")
        text = f'{text[:start]}wants = ["geometry", "report"]{text[text.index("]", start) + 1 :]}'
        assert gear_pair(parse_scene(text)).helix_angle == pytest.approx(math.radians(-12.5), rel=1e-15)
        assert check_scene(parse_scene(text))

    @pytest.mark.parametrize("angle", [45.0, -45.0, 1e-9])
    def test_ends_of_the_range_are_gears(self, angle):
        pair = gear_pair(scene(old="helix_angle_deg = 20", new=f"helix_angle_deg = {angle!r}"))
        assert pair.helix_angle == pytest.approx(math.radians(angle), rel=1e-15)

    @pytest.mark.parametrize(
        ("value", "said"),
        [
            ("45.1", "-45 and at most 45 deg"),
            ("-50", "-45"),
            ("nan", "finite"),
            ("true", "number"),
            ('"20"', "number"),
        ],
    )
    def test_what_is_no_angle_is_refused_by_its_key(self, value, said):
        text = SCENE.replace("WANTS", '"geometry"').replace("deg = 20", f"deg = {value}")
        found = faults(text)
        assert list(found) == [HELIX]
        assert said in found[HELIX]

    @pytest.mark.parametrize(
        ("old", "new", "where"),
        [
            ("helix_angle_deg", "beta_deg", "pair.beta_deg"),
            ("{ teeth = 36 }", "{ teeth = 36, helix_angle_deg = 20 }", "pair.pinion.helix_angle_deg"),
        ],
    )
    def test_other_spellings_are_told_the_key(self, old, new, where):
        found = faults(SCENE.replace("WANTS", '"geometry"').replace(old, new, 1))
        assert "Give pair.helix_angle_deg" in found[where]

    def test_a_tip_diameter_is_that_of_the_transverse_section(self):
        given = scene('"geometry"', "{ teeth = 36 }", "{ teeth = 36, tip_diameter_mm = 80.5 }")
        pair = gear_pair(given)
        assert 2e3 * pair.teeth_profiles[0].tip_radius == pytest.approx(80.5, rel=1e-12)

    def test_backlash_is_normal(self):
        pair = gear_pair(scene('"geometry"', "face_width_mm", "backlash_um = 50\nface_width_mm"))
        assert pair.backlash == pytest.approx(50e-6, rel=1e-9)

    def test_gears_and_housing_that_grow_alike_keep_every_angle(self):
        heat = "[heat]\nhousing_expansion_per_K = 12e-6\n" + "".join(
            f"{part}_temperature_C = 120\n" for part in ("pinion", "wheel", "housing")
        )
        text = SCENE.replace("WANTS", '"geometry"').replace(
            "face_width_mm", "backlash_um = 50\nface_width_mm"
        )
        text = text.replace("poisson_ratio", "thermal_expansion_per_K = 12e-6\npoisson_ratio")
        warm = warm_pair(parse_scene(text + heat))
        grown = 1.0 + 100.0 * 12e-6
        assert warm.backlash == pytest.approx(50e-6 * grown, rel=1e-6)
        assert warm.pair.helix_angle == pytest.approx(BETA, rel=1e-15)
        assert warm.pair.contact_ratio == pytest.approx(EPS_ALPHA, rel=1e-9)


class TestTable:
    def test_rows_are_keys_of_the_scene(self):
        def paths(model, start=""):
            from flankfilm.scene.explain import model_in

            for name, field in model.model_fields.items():
                assert key_of(field) is not None
                yield f"{start}{name}"
                if (inner := model_in(field.annotation)) is not None:
                    yield from paths(inner, f"{start}{name}.")

        known = list(paths(Scene))
        for row in KEYS_OF_SPUR:
            assert any(fnmatchcase(path, row.path) for path in known), row.path

    @pytest.mark.parametrize("edges", ["", "[stiffness]\ncontact_beyond_path = true\n"])
    @pytest.mark.parametrize("want", WANTS)
    def test_each_want_is_answered(self, want, edges):
        text = SCENE.replace("WANTS", f'"{want}"')
        if want in MOTIONS:
            text += MOTION
        if want in ("torques", "dynamic-map"):
            text = text.replace("pinion_speed", "torques_Nm = [300, 600]\npinion_speed")
        if want in ("film", "losses"):
            text += OIL
        if want == "bearing-forces":
            text += BEARINGS
        if want == "rating":
            text += RATING
        assert check_scene(parse_scene(text + edges))

    GIVEN = (
        ("stiffness.model", "weber-banaschek", True),
        ("stiffness.model", "ishikawa", True),
        ("stiffness.model", "potential-energy", True),
        ("stiffness.pairs", "independent", True),
        ("stiffness.moving_contact", True, True),
        ("operating.friction", 0.05, "space"),
        ("stiffness.plane", "stress", False),
        ("pair.tight", True, False),
        ("pair.pinion.blank", {"rim_thickness_mm": 6.0, "web_thickness_mm": 12.0}, False),
        ("pair.wheel.tip_rounding_um", 20.0, False),
    )

    @pytest.mark.parametrize(("path", "value", "always"), GIVEN)
    def test_each_key_is_refused_beside_loaded_teeth(self, path, value, always):
        beside = (
            (["stiffness"], always != "space"),
            (["sweep"], always != "space"),
            (["bearing-forces"], True),
            (["geometry", "closed-forms"], always is True),
        )
        for wants, refused in beside:
            raw = put(parse_toml(SCENE.replace("WANTS", '"geometry"'), "scene"), path, value) | {
                "wants": wants
            }
            try:
                validated(raw)
                found = {}
            except InputError as error:
                found = {fault.where.strip("[]"): str(fault) for fault in error.faults}
            assert ("helical pairs have no" in found.get(path, "")) == refused, (wants, found)
            if refused:
                assert "must be" in found[path]
                assert found[path].endswith("or give pair.helix_angle_deg = 0")
        spur = put(put(raw, HELIX, 0.0), "wants", ["stiffness"])
        validated(spur)

    @pytest.mark.parametrize(
        "braking", ["power_kW = -12.5", "pinion_torque_Nm = -600", "torques_Nm = [100, -300]"]
    )
    def test_a_braking_pinion_is_taken(self, braking):
        text = SCENE.replace("WANTS", '"stiffness"')
        if "torques" in braking:
            text = text.replace('"stiffness"', '"torques"').replace(
                "pinion_speed", f"{braking}\npinion_speed"
            )
        else:
            text = text.replace("pinion_torque_Nm = 600", braking)
        assert check_scene(parse_scene(text))

    def test_deviations_and_wear_of_each_tooth_are_taken(self):
        pitches = ", ".join("1.0, -1.0" for _ in range(18))
        gear = f"{{ teeth = 36, deviations.single_pitch_um = [{pitches}] }}"
        worn = "{ teeth = 40, wear = { roll_deg = [14.0, 28.0], depth_um = [1.0, 0.0] } }"
        text = SCENE.replace("WANTS", '"revolution"').replace("{ teeth = 36 }", gear)
        assert check_scene(parse_scene(text.replace("{ teeth = 40 }", worn)))

    def test_every_row_has_its_case(self):
        for row in KEYS_OF_SPUR:
            assert any(fnmatchcase(path, row.path) for path, _, _ in self.GIVEN), row.path

    def test_contact_beyond_the_path_is_left_out_unless_it_is_asked_for(self):
        text = SCENE.replace("WANTS", '"stiffness"')
        assert parse_scene(text).stiffness.contact_beyond_path is None
        assert not parse_scene(text).tip_edges
        asked = parse_scene(text + "[stiffness]\ncontact_beyond_path = true\n")
        assert asked.tip_edges
        assert not parse_scene(text + "[stiffness]\ncontact_beyond_path = false\n").tip_edges
        assert parse_scene(text.replace("deg = 20", "deg = 0")).tip_edges

    @pytest.mark.parametrize(("given", "told"), [("", False), ("false", False), ("true", True)])
    def test_the_inputs_of_a_report_say_what_contact_there_was(self, given, told):
        edges = f"[stiffness]\ncontact_beyond_path = {given}\n" if given else ""
        told_so = _asked(parse_scene(SCENE.replace("WANTS", '"stiffness"') + edges))
        assert told_so["stiffness"]["contact_beyond_path"] is told

    def test_rounded_tips_are_taken_with_contact_beyond_the_path(self):
        text = SCENE.replace("WANTS", '"stiffness"').replace(
            "{ teeth = 36 }", "{ teeth = 36, tip_rounding_um = 50 }"
        )
        key = "pair.pinion.tip_rounding_um"
        for held in ("", "[stiffness]\ncontact_beyond_path = false\n"):
            fault = faults(text + held)[key]
            assert "Give contact_beyond_path = true in [stiffness]" in fault
        free = text + "[stiffness]\ncontact_beyond_path = true\n"
        assert check_scene(parse_scene(free))
        # too large ones are refused as on spur pairs, with what is allowed
        with pytest.raises(InputError, match=r"tip_rounding_um = 900: must be at most"):
            check_scene(parse_scene(free.replace("um = 50", "um = 900")))

    def test_cached_results_are_of_the_contact_that_was_asked_for(self):
        """Stages go by what the key does."""
        text = SCENE.replace("WANTS", '"sweep"') + MOTION
        scenes = [parse_scene(text + edges) for edges in ("", "[stiffness]\ncontact_beyond_path = true\n")]
        for stage in (DRY_CYCLE, EXCITATION, REVOLUTION_ERROR):
            held, free = (stage.inputs(scene) for scene in scenes)
            assert held != free, stage.name

    def test_leads_and_alignment_are_taken(self):
        text = SCENE.replace("{ teeth = 36 }", "{ teeth = 36, crowning_um = 10, face_width_mm = 45 }")
        assert check_scene(
            parse_scene(text.replace("WANTS", '"stiffness"') + "[alignment]\nin_plane_um = 20\n")
        )

    def test_shafts_bend_under_lines_without_an_alignment(self):
        shaft = """[shafts.pinion]
segments = [{ length_mm = 200, diameter_mm = 40 }]
bearings = [{ position_mm = 20, stiffness_N_per_m = 4e8 }, { position_mm = 180, stiffness_N_per_m = 4e8 }]
gear_position_mm = 100
"""
        text = SCENE.replace("WANTS", '"stiffness"') + shaft
        pinion, wheel = face(parse_scene(text))["shafts"]
        assert pinion.gear_position == pytest.approx(0.1)
        assert wheel is None
        assert check_scene(parse_scene(text))
        assert parse_scene(text).face != parse_scene(SCENE.replace("WANTS", '"stiffness"')).face
        assert "shafts" not in face(parse_scene(text.replace("deg = 20", "deg = 0")))

    def test_motion_on_shafts_that_bend_asks_for_a_bearing_that_holds_them(self):
        shaft = """[shafts.pinion]
segments = [{ length_mm = 200, diameter_mm = 40 }]
bearings = [{ position_mm = 20, stiffness_N_per_m = 4e8 }, { position_mm = 180, stiffness_N_per_m = 4e8 }]
gear_position_mm = 100
"""
        text = SCENE.replace("WANTS", '"sweep"') + MOTION + shaft
        with pytest.raises(
            InputError, match=r"shafts\.pinion\.bearings.*along its axis.*axial_stiffness_N_per_m"
        ):
            parse_scene(text)
        assert check_scene(parse_scene(text.replace("180, ", "180, axial_stiffness_N_per_m = 1e8, ")))
        parse_scene(text.replace("deg = 20", "deg = 0"))

    def test_films_of_every_model_are_taken(self):
        for film in (
            'model = "dowson"',
            'model = "ehl"',
            'supply = "meniscus"\nmeniscus_mm = 2.0',
            'model = "none"',
        ):
            text = SCENE.replace("WANTS", '"stiffness"') + OIL + f"[film]\n{film}\n"
            assert check_scene(parse_scene(text)), film

    def test_all_at_once_with_status_2_before_anything_is_computed(self, tmp_path):
        text = SCENE.replace("WANTS", '"stiffness", "film", "sweep"')
        text += '[stiffness]\nmodel = "weber-banaschek"\nmoving_contact = true\n'
        (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
        for arguments in (("check", "scene.toml"), ("run", "scene.toml", "--out", "out")):
            done = command(*arguments, cwd=tmp_path, status=2)
            for said in (
                "stiffness.model = 'weber-banaschek'", "stiffness.moving_contact = true",
            ):  # fmt: skip
                assert said in done.stderr
            assert not (tmp_path / "out").exists()

    @pytest.mark.parametrize(
        "arguments",
        [
            ("verify", "scene.toml", "--out", "out"),
            ("export-traction", "scene.toml"),
        ],
        ids=lambda arguments: arguments[0],
    )
    def test_commands_of_spur_pairs_say_so(self, tmp_path, arguments):
        oil = "[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\n"
        (tmp_path / "scene.toml").write_text(SCENE.replace("WANTS", '"geometry"') + oil, encoding="utf-8")
        done = command(*arguments, cwd=tmp_path, status=2)
        assert "pair.helix_angle_deg = 20: must be 0 for" in done.stderr


@pytest.fixture(scope="module")
def answered(tmp_path_factory):
    folder = tmp_path_factory.mktemp("helical")
    return run_scene(scene(f'{ANSWERED}, "report"'), folder, use_cache=False)


class TestAnswers:
    def test_sizes_forces_and_lines_of_contact(self, answered):
        by_hand = {
            "pair_helix_angle": BETA,
            "pair_base_helix_angle": BETA_B,
            "pair_module": 2e-3,
            "pair_transverse_module": M_T,
            "pair_normal_pressure_angle": ALPHA_N,
            "pair_transverse_pressure_angle": ALPHA_T,
            "pair_contact_ratio": EPS_ALPHA,
            "pair_overlap_ratio": EPS_BETA,
            "pair_total_contact_ratio": EPS_ALPHA + EPS_BETA,
            "contact_lines_mean": 40e-3 * EPS_ALPHA / math.cos(BETA_B),
            "contact_lines_across": 40e-3 / math.cos(BETA_B),
            "mesh_force_normal": 600 / R_B1 / math.cos(BETA_B),
            "mesh_force_tangential": 600 / R_1,
            "mesh_force_radial": 600 / R_1 * math.tan(ALPHA_T),
            "mesh_force_axial": 600 / R_1 * math.tan(BETA),
            "iso6336_2_Z_beta": 1 / math.sqrt(math.cos(BETA)),
            "iso6336_3_Y_beta": 1 - 20 / 120,
        }
        data = answered.dataset
        for name, value in by_hand.items():
            assert float(data[name]) == pytest.approx(value, rel=1e-12), name
            assert data[name].attrs.get("error_note"), name
        assert data["pair_module"].attrs["long_name"] == "normal module"
        moments = 600 / R_1 * math.tan(BETA) * np.array([R_1, R_2])  # V-0: working are reference circles
        assert data["mesh_force_tilting_moment"].values == pytest.approx(moments, rel=1e-12)
        # ISO's values of the table in physics, met to its digits
        assert float(data["iso6336_1_c_gamma"]) == pytest.approx(18.485, abs=5e-4)
        assert float(data["iso6336_1_c_gamma_beta"]) == pytest.approx(0.85 * 18.485, abs=5e-4)

    def test_the_length_over_the_cycle_has_the_harmonics_by_quadrature(self, answered):
        data = answered.dataset
        n = np.arange(1, 6)
        amplitudes = 2 * np.abs(np.sinc(n * EPS_ALPHA) * np.sinc(n * EPS_BETA))
        assert data["contact_lines_harmonics"].values == pytest.approx(amplitudes, rel=1e-9)
        length = data["contact_lines_length"].values[:-1]
        waves = np.exp(-2j * math.pi * np.outer(n, data["contact_lines_position"].values[:-1]))
        assert 2 * np.abs(waves @ length) / length.sum() == pytest.approx(amplitudes, abs=2e-5)
        assert float(data["contact_lines_minimum"]) <= length.min() * (1 + 1e-12)
        assert length.max() <= float(data["contact_lines_maximum"]) * (1 + 1e-12)

    def test_drawn_lines_are_as_long_as_the_sum_and_of_the_hand(self, answered):
        data = answered.dataset
        travel, face = (data[f"contact_lines_shown_{name}"].values for name in ("travel", "face"))
        at = data["contact_lines_shown_position"].values
        for place in np.unique(at):
            own = at == place
            total = np.hypot(np.diff(travel[own]), np.diff(face[own])).sum()
            there = np.interp(place, data["contact_lines_position"], data["contact_lines_length"])
            assert total == pytest.approx(there, rel=1e-3)
        # rho1 = rho1(0) + z tan(beta_b) on a right-handed pinion that turns anticlockwise about z and drives
        assert np.diff(travel) / np.diff(face) == pytest.approx(math.tan(BETA_B), rel=1e-9)
        other = run_scene(scene('"geometry"', "= 20", "= -20"), None, use_cache=False).dataset
        slope = np.diff(other["contact_lines_shown_travel"]) / np.diff(other["contact_lines_shown_face"])
        assert slope == pytest.approx(-math.tan(BETA_B), rel=1e-9)
        assert float(other["mesh_force_axial"]) == pytest.approx(-float(data["mesh_force_axial"]), rel=1e-12)

    def test_tables_and_page_follow(self, answered):
        folder = answered.folder
        assert folder is not None
        with (folder / "csv" / "geometry.csv").open(encoding="utf-8", newline="") as file:
            rows = {row["figure"].split(",")[0]: row for row in csv.DictReader(file)}
        assert float(rows["overlap ratio"]["pair"]) == pytest.approx(EPS_BETA, rel=1e-12)
        assert (
            float(rows["axial force F_a on the pinion; above 0 along the axis about which it turns"]["pair"])
            > 0
        )
        assert rows["tilting moment of the axial force"]["wheel"]
        assert (folder / "csv" / "contact_lines.csv").exists()
        page = (folder / "report.html").read_text(encoding="utf-8")
        for said in (
            "helix angle on the base cylinder", "total contact ratio", "The pinion is right-handed",
            "flankfilm.figures.lines_of_contact", "Z_beta", "Y_beta", "c_gamma_beta", "axial force F_a",
            "face 40 mm, helix angle 20°",
        ):  # fmt: skip
            assert said in page, said

    def test_the_picture_keeps_to_what_pictures_keep_to(self, answered):
        assert faults_of(figures.lines_of_contact(answered.dataset)) == []
        with narrow():
            assert faults_of(figures.lines_of_contact(answered.dataset)) == []
        other = run_scene(scene('"geometry"', "= 20", "= 0"), None, use_cache=False).dataset
        with pytest.raises(ValueError, match="run a scene whose pair has a helix angle"):
            figures.lines_of_contact(other)

    def test_every_figure_is_explained(self, answered):
        assert not unexplained(answered.dataset)

    def test_the_example_runs(self):
        found = run_scene(read_scene(EXAMPLES / "helical.toml"), None, use_cache=False)
        assert not found.failures
        assert float(found.dataset["pair_backlash"]) == pytest.approx(50e-6, rel=1e-9)
        assert float(found.dataset["iso6336_1_c_gamma"]) == pytest.approx(18.485, abs=5e-4)

    def test_check_says_hand_overlap_and_lengths(self):
        lines = check_scene(scene(old="= 20", new="= -20"))
        said = "Helix: left-handed pinion, overlap ratio 2.1774, total contact ratio 3.7373, lines of contact 63.968 to"
        assert any(line.startswith(said) for line in lines)

    def test_study_outputs(self):
        engine = Engine(scene(ANSWERED), Cache(None))
        by_hand = {
            "overlap_ratio": EPS_BETA,
            "total_contact_ratio": EPS_ALPHA + EPS_BETA,
            "base_helix_angle_deg": math.degrees(BETA_B),
            "transverse_module_mm": 1e3 * M_T,
            "transverse_pressure_angle_deg": math.degrees(ALPHA_T),
            "axial_force_N": 600 / R_1 * math.tan(BETA),
            "mean_contact_length_mm": 40 * EPS_ALPHA / math.cos(BETA_B),
            "minimum_contact_length_mm": 63.9677,
            "maximum_contact_length_mm": 67.4086,
            "contact_length_harmonic_1": 2 * abs(np.sinc(EPS_ALPHA) * np.sinc(EPS_BETA)),
            "contact_length_harmonic_5": 2 * abs(np.sinc(5 * EPS_ALPHA) * np.sinc(5 * EPS_BETA)),
            "iso_helix_factor": 1 / math.sqrt(math.cos(BETA)),
        }
        for name, value in by_hand.items():
            assert OUTPUTS[name].value(engine) == pytest.approx(value, rel=1e-6), name
        assert OUTPUTS["iso_mesh_stiffness_N_per_mm_um"].value(engine) == pytest.approx(18.485, abs=1e-3)


class TestSpur:
    def test_a_helix_of_nothing_is_no_key_at_all(self):
        spur = run_scene(scene('"geometry"', "= 20", "= 0"), None, use_cache=False).dataset
        plain = run_scene(scene('"geometry"', "helix_angle_deg = 20\n", ""), None, use_cache=False).dataset
        assert list(spur.variables) == list(plain.variables)
        for name in plain.variables:
            assert np.array_equal(spur[name].values, plain[name].values), name
            assert spur[name].attrs == plain[name].attrs, name

    def test_reports_of_spur_pairs_say_nothing_of_helices(self, tmp_path):
        run_scene(scene('"geometry", "report"', "= 20", "= 0"), tmp_path, use_cache=False)
        page = (tmp_path / "report.html").read_text(encoding="utf-8").split("Inputs")[0]
        table = (tmp_path / "csv" / "geometry.csv").read_text(encoding="utf-8")
        for word in ("overlap", "helix angle on", "lines of contact", "axial force", "transverse module"):
            assert word not in table
            assert word not in page
        assert not (tmp_path / "csv" / "contact_lines.csv").exists()
        pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3)
        assert pair.overlap_ratio == 0.0
        assert pair.transverse_module == pair.module
