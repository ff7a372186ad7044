"""Helical pairs in REXS files: hands, both sections, out and back, and stages that others have published."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import pytest

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.exchange.bring_in import imported
from flankfilm.exchange.rexs_sections import Sections
from flankfilm.exchange.rexs_write import rexs_file, rexs_text
from flankfilm.scene import parse_scene
from gears import BasicRack, Gear, GearPair
from tests.flankfilm.program import command
from tests.flankfilm.test_exchange_rexs import OLD, brought, refused


def helical(degrees: float) -> GearPair:
    return GearPair(
        pinion=Gear(teeth=19, profile_shift=0.35, bore_radius=8e-3, tip_alteration=-0.04, tip_chamfer=0.1e-3),
        wheel=Gear(teeth=31, profile_shift=-0.1, generating_shift=-0.12, bore_radius=17e-3),
        module=2.5e-3,
        face_width=22e-3,
        rack=BasicRack(h_aP=1.05, h_fP=1.35, rho_fP=0.3, alpha=math.radians(22.5)),
        helix_angle=math.radians(degrees),
    )


@pytest.mark.parametrize("ending", [".rexs", ".rexsj", ".rexsz"])
@pytest.mark.parametrize("degrees", [17.3, -17.3, 44.0, 1e-3])
def test_a_pair_goes_out_and_comes_back(tmp_path, degrees, ending):
    pair, path = helical(degrees), Path(tmp_path / f"pair{ending}")
    content, left_out = rexs_file(pair, "Helical", path)
    path.write_bytes(content)
    found = imported(path)
    assert left_out == ()
    assert found.faults == ()
    assert found.notes == ()
    back = gear_pair(parse_scene(found.text))
    assert back.helix_angle == pytest.approx(pair.helix_angle, rel=1e-13)
    for own, theirs in ((pair.pinion, back.pinion), (pair.wheel, back.wheel)):
        # a tip alteration follows from the tip diameter, of which it is a thousandth
        assert theirs.tip_alteration == pytest.approx(own.tip_alteration, abs=1e-12)
        assert dataclasses.replace(theirs, tip_alteration=own.tip_alteration) == own
    assert back.module == pytest.approx(pair.module, rel=1e-14)
    assert (back.rack.h_aP, back.rack.h_fP, back.rack.rho_fP) == (1.05, 1.35, 0.3)
    assert back.rack.alpha == pytest.approx(pair.rack.alpha, rel=1e-14)
    assert back.working_centre_distance == pytest.approx(pair.working_centre_distance, rel=1e-13)
    for own, theirs in zip(pair.teeth_profiles, back.teeth_profiles, strict=True):
        assert theirs.tip_radius == pytest.approx(own.tip_radius, rel=1e-12)
        assert theirs.root_radius == pytest.approx(own.root_radius, rel=1e-12)
        assert theirs.base_radius == pytest.approx(own.base_radius, rel=1e-13)


def test_a_right_handed_pinion_is_above_zero_and_its_wheel_below():
    text, _ = rexs_text(helical(20.0), "")
    name = '"helix_angle_reference_diameter" unit="deg">'
    angles = [float(part.split("<")[0]) for part in text.split(name)[1:]]
    assert angles == [pytest.approx(20.0, rel=1e-13), pytest.approx(-20.0, rel=1e-13)]
    spur, _ = rexs_text(helical(0.0), "")
    assert [part.split("<")[0] for part in spur.split(name)[1:]] == ["0.0", "0.0"]


def test_the_driving_gear_gives_the_hand(tmp_path):
    text, _ = rexs_text(helical(17.3), "")
    swapped = text.replace(">true<", ">x<").replace(">false<", ">true<").replace(">x<", ">false<")
    pair = gear_pair(parse_scene(brought(tmp_path, swapped).text))
    assert (pair.pinion.teeth, math.degrees(pair.helix_angle)) == (31, pytest.approx(-17.3))


# The stages of SEW's three-stage gearbox (1.0) and the FVA's industrial gear unit (1.4) that are published with
# rexs-api-java and REXSapi: teeth, normal module, helix angle, shifts and face width, all cut by 20 deg. The centre
# distance of no backlash follows from them, and is the one that the files say.
PUBLISHED = {
    "SEW 1": ((23, 67), 1.0, 30.0, (0.581, 0.5131), 11.0, 53.0),
    "SEW 2": ((13, 76), 1.25, -10.0, (0.521, -0.094), 15.0, 57.0),
    "SEW 3": ((14, 87), 1.5, 10.0, (0.536, -0.4815), 36.0, 77.0),
    "FVA 24": ((27, 51), 4.5, 21.0, (0.231415, 0.231415), 50.0, 190.0),
    "FVA 41": ((23, 34), 6.5, -10.0, (0.15074, 0.15074), 74.0, 190.0),
}


def stage(teeth, module, beta, shifts, width, distance, signs=(1, -1)):
    """A file of version 1.1 with the numbers of a published stage."""
    text = (
        OLD.replace(">17<", f">{teeth[0]}<").replace(">22<", f">{teeth[1]}<").replace(">4.0<", f">{module}<")
    )
    text = text.replace(">0.0</attribute>\n      <attribute id=\"normal_module", f">{signs[0] * beta}</attribute>\n"
                        "      <attribute id=\"normal_module")  # fmt: skip
    text = text.replace('unit="°">-0.0<', f'unit="°">{signs[1] * beta}<').replace(">50.0<", f">{width}<")
    coefficient = 'id="addendum_modification_coefficient" unit="none">0.0<'
    for x in (shifts[0], shifts[0], shifts[1]):
        text = text.replace(coefficient, coefficient.replace(">0.0<", f">{x}<"), 1)
    return text.replace(">78.0<", f">{distance}<")


@pytest.mark.filterwarnings("ignore:centre_distance")  # some are short of no backlash by rounding
@pytest.mark.parametrize("name", PUBLISHED)
def test_published_stages_fit_their_centre_distance(tmp_path, name):
    numbers = PUBLISHED[name]
    found = brought(tmp_path, stage(*numbers))
    assert found.faults == ()
    pair = gear_pair(parse_scene(found.text))
    assert math.degrees(pair.helix_angle) == pytest.approx(numbers[2])
    assert pair.module == pytest.approx(1e-3 * numbers[1])
    without = GearPair(
        Gear(numbers[0][0], profile_shift=numbers[3][0]),
        Gear(numbers[0][1], profile_shift=numbers[3][1]),
        module=pair.module,
        face_width=pair.face_width,
        rack=pair.rack,
        helix_angle=pair.helix_angle,
    )
    assert 1e3 * without.working_centre_distance == pytest.approx(numbers[5], abs=1e-4)


HELICAL = stage((27, 51), 4.5, 21.0, (0.231415, 0.231415), 50.0, 190.0)
SECOND = '<attribute id="number_of_teeth" unit="none">51</attribute>'
FIRST = '<attribute id="number_of_teeth" unit="none">27</attribute>'


def beside(text: str, place: str, name: str, value: float, unit: str) -> str:
    assert place in text
    return text.replace(place, f'{place}<attribute id="{name}" unit="{unit}">{value!r}</attribute>')


@pytest.mark.parametrize("signs", [(1, 1), (-1, -1), (1, 0), (0, -1)])
def test_hands_that_do_not_fit_are_refused(tmp_path, signs):
    text = stage((27, 51), 4.5, 21.0, (0.231415, 0.231415), 50.0, 190.0, signs)
    said = refused(tmp_path, text)
    assert "helix_angle_reference_diameter" in said
    assert f"must be {-signs[0] * 21.0 + 0.0:g} deg" in said
    assert "opposite hands" in said


def test_angles_that_differ_are_refused(tmp_path):
    text = HELICAL.replace('unit="°">-21.0<', 'unit="°">-21.5<')
    assert "must be -21 deg" in refused(tmp_path, text)


def test_a_mate_without_an_angle_has_the_other_hand(tmp_path):
    for sign in (21.0, -21.0):
        text = HELICAL.replace(
            f'<attribute id="helix_angle_reference_diameter" unit="°">{sign}</attribute>', ""
        )
        found = brought(tmp_path, text)
        assert math.degrees(gear_pair(parse_scene(found.text)).helix_angle) == pytest.approx(21.0)
        assert any("of the other hand" in note for note in found.notes)


M_T = 4.5 / math.cos(math.radians(21.0))
ALPHA_T = math.degrees(math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(21.0))))
BETA_B = math.degrees(math.asin(math.sin(math.radians(21.0)) * math.cos(math.radians(20.0))))
FLANK = '<attribute id="normal_pressure_angle" unit="°">20.0</attribute>'


@pytest.mark.parametrize(
    ("place", "name", "value", "unit"),
    [
        (FIRST, "transverse_module", M_T, "mm"),
        (FIRST, "reference_circle_diameter", 27 * M_T, "mm"),
        (FIRST, "helix_angle_base_circle", BETA_B, "°"),
        (SECOND, "helix_angle_base_diameter", -BETA_B, "°"),
        (SECOND, "helix_angle_base_circle", BETA_B, "°"),  # version 1.1 has no signs there
        (FLANK, "pressure_angle_in_the_transverse_section", ALPHA_T, "°"),
    ],
)
def test_figures_of_both_sections_agree_or_are_refused(tmp_path, place, name, value, unit):
    for rounded in (value, float(f"{value:.5g}")):
        assert brought(tmp_path, beside(HELICAL, place, name, rounded, unit)).faults == ()
    said = refused(tmp_path, beside(HELICAL, place, name, value * 1.001, unit))
    assert name in said
    assert f"must be {abs(value):.7g}" in said
    assert "normal_module is m_t cos(beta)" in said


def test_a_transverse_module_given_as_the_normal_one_is_refused(tmp_path):
    mistaken = HELICAL.replace(">4.5<", f">{M_T:.6g}<")
    said = refused(tmp_path, beside(mistaken, FIRST, "reference_circle_diameter", 27 * M_T, "mm"))
    assert "reference_circle_diameter" in said
    # nothing but the module says it: the gears do not fit, and what fits is named
    found = brought(tmp_path, mistaken)
    assert any("give m_t cos(helix_angle)" in str(fault) for fault in found.faults)


def test_a_transverse_module_alone_gives_the_normal_one(tmp_path):
    text = HELICAL.replace('id="normal_module" unit="mm">4.5<', f'id="transverse_module" unit="mm">{M_T!r}<')
    found = brought(tmp_path, text)
    assert gear_pair(parse_scene(found.text)).module == pytest.approx(4.5e-3, rel=1e-11)
    assert any("m_t cos(beta)" in note for note in found.notes)


def test_spur_pairs_have_one_section():
    sections = Sections(2.0, 20.0, 0.0)
    values = {attribute.name: value for attribute, value, _ in sections.of_gear(36)}
    assert values["transverse_module"] == 2.0
    assert values["reference_circle_diameter"] == 72.0
    assert values["helix_angle_base_circle"] == 0.0
    assert sections.of_flank()[1] == 20.0


def test_a_helix_beyond_the_range_is_the_scenes_fault(tmp_path):
    steep = stage((27, 51), 4.5, 60.0, (0.231415, 0.231415), 50.0, 190.0)
    found = brought(tmp_path, steep)
    assert "pair.helix_angle_deg" in {fault.where for fault in found.faults}


def test_the_commands_bring_it_out_and_in(tmp_path):
    scene = (
        'wants = ["geometry"]\n[pair]\nmodule_mm = 2.0\nface_width_mm = 40.0\nhelix_angle_deg = -20\n'
        "pinion = { teeth = 36 }\nwheel = { teeth = 40 }\n"
    )
    (tmp_path / "scene.toml").write_text(scene, encoding="utf-8")
    command("export-rexs", "scene.toml", cwd=tmp_path)
    command("import", "scene.rexs", "--out", "back.toml", cwd=tmp_path)
    back = parse_scene((tmp_path / "back.toml").read_text(encoding="utf-8"))
    assert back.pair is not None
    assert back.pair.helix_angle_deg == pytest.approx(-20.0, rel=1e-14)
    pressed = (tmp_path / "back.toml").read_text(encoding="utf-8").replace('"geometry"', '"stiffness"')
    with pytest.raises(InputError, match="twisted teeth that bear on both sides"):
        parse_scene(pressed.replace("helix_angle_deg", "tight = true\nhelix_angle_deg"))
