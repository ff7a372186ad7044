"""REXS files in and out: what they say, what they lack, what is out of scope, and what is hostile."""

from __future__ import annotations

import math
import tomllib
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.exchange.bring_in import imported
from flankfilm.exchange.draft import Draft, scene_text
from flankfilm.exchange.rexs_file import parse_model
from flankfilm.exchange.rexs_pair import draft_of, stages
from flankfilm.exchange.rexs_write import rexs_text
from flankfilm.scene import parse_scene
from gears import BasicRack, Blank, Gear, GearPair, Material, TipRelief

# Elements, attribute ids and units of the REXS schemas: up to 1.1 a gear names its tool by an
# ordered_reference, its flanks are of type flank_geometry and angles have the unit "°"; later the flank
# names it by a manufacturing_step, flanks are of type cylindrical_gear_flank and the unit is "deg".
# Numbers of the sun and a planet in the FVA's example of a planetary stage.
OLD = """<?xml version="1.0" encoding="UTF-8" standalone="no"?>
<model applicationId="FVA Workbench" applicationVersion="5.5" date="2019-06-05T11:46:35+02:00" version="1.1">
  <relations>
    <!--Stage relation-->
    <relation id="1" type="stage">
      <ref hint="cylindrical_gear" id="53" role="gear_1"/>
      <ref hint="cylindrical_stage" id="211" role="stage"/>
      <ref hint="cylindrical_gear" id="247" role="gear_2"/>
    </relation>
    <relation id="2" order="1" type="ordered_reference">
      <ref hint="cylindrical_gear" id="53" role="origin"/>
      <ref hint="rack_shaped_tool" id="83" role="referenced"/>
    </relation>
    <relation id="3" order="1" type="ordered_reference">
      <ref hint="cylindrical_gear" id="247" role="origin"/>
      <ref hint="rack_shaped_tool" id="84" role="referenced"/>
    </relation>
    <relation id="4" type="reference">
      <ref hint="cylindrical_gear" id="53" role="origin"/>
      <ref hint="material" id="86" role="referenced"/>
    </relation>
    <relation id="5" type="reference">
      <ref hint="cylindrical_gear" id="247" role="origin"/>
      <ref hint="material" id="86" role="referenced"/>
    </relation>
    <relation id="6" type="flank">
      <ref hint="cylindrical_gear" id="53" role="gear"/>
      <ref hint="flank_geometry" id="250" role="left"/>
      <ref hint="flank_geometry" id="251" role="right"/>
    </relation>
    <relation id="7" type="flank">
      <ref hint="cylindrical_gear" id="247" role="gear"/>
      <ref hint="flank_geometry" id="254" role="left"/>
      <ref hint="flank_geometry" id="255" role="right"/>
    </relation>
  </relations>
  <components>
    <component id="211" name="Stirnradstufe [10]" type="cylindrical_stage">
      <attribute id="center_distance" unit="mm">78.0</attribute>
      <attribute id="common_face_width" unit="mm">50.0</attribute>
    </component>
    <component id="53" name="Sonnenrad [53]" type="cylindrical_gear">
      <attribute id="face_width" unit="mm">50.0</attribute>
      <attribute id="helix_angle_reference_diameter" unit="°">0.0</attribute>
      <attribute id="normal_module" unit="mm">4.0</attribute>
      <attribute id="number_of_teeth" unit="none">17</attribute>
      <attribute id="support_vector" unit="mm"><array><c>125.0</c><c>0.0</c><c>0.0</c></array></attribute>
    </component>
    <component id="247" name="Planetenrad [54]" type="cylindrical_gear">
      <attribute id="face_width" unit="mm">50.0</attribute>
      <attribute id="helix_angle_reference_diameter" unit="°">-0.0</attribute>
      <attribute id="normal_module" unit="mm">4.0</attribute>
      <attribute id="number_of_teeth" unit="none">22</attribute>
    </component>
    <component id="83" name="Werkzeug [83]" type="rack_shaped_tool">
      <attribute id="addendum_coefficient_reference_profile" unit="none">1.25</attribute>
      <attribute id="dedendum_coefficient_reference_profile" unit="none">1.3</attribute>
      <attribute id="tip_radius_factor" unit="none">0.25</attribute>
    </component>
    <component id="84" name="Werkzeug [84]" type="rack_shaped_tool">
      <attribute id="addendum_coefficient_reference_profile" unit="none">1.25</attribute>
      <attribute id="tip_radius_factor" unit="none">0.25</attribute>
    </component>
    <component id="86" name="bsp_18CrNiMo7-6_Eh [86]" type="material">
      <attribute id="density" unit="kg / dm^3">7.85</attribute>
      <attribute id="elastic_modulus" unit="N / mm^2">210000.0</attribute>
      <attribute id="poisson_ratio" unit="none">0.3</attribute>
    </component>
    <component id="250" name="" type="flank_geometry">
      <attribute id="tooth_tip_chamfer" unit="mm">0.0</attribute>
      <attribute id="normal_pressure_angle" unit="°">20.0</attribute>
      <attribute id="addendum_modification_coefficient" unit="none">0.0</attribute>
    </component>
    <component id="251" name="" type="flank_geometry">
      <attribute id="normal_pressure_angle" unit="°">20.0</attribute>
      <attribute id="addendum_modification_coefficient" unit="none">0.0</attribute>
    </component>
    <component id="254" name="" type="flank_geometry">
      <attribute id="addendum_modification_coefficient" unit="none">0.0</attribute>
      <attribute id="normal_pressure_angle" unit="°">20.0</attribute>
    </component>
    <component id="255" name="" type="flank_geometry">
      <attribute id="normal_pressure_angle" unit="°">20.0</attribute>
    </component>
  </components>
</model>
"""


def brought(tmp_path, text, **more):
    path = tmp_path / "model.rexs"
    path.write_text(text, encoding="utf-8")
    return imported(path, **more)


def changed(old, new, count=1):
    assert old in OLD
    return OLD.replace(old, new, count)


def refused(tmp_path, text, **more):
    with pytest.raises(InputError) as caught:
        brought(tmp_path, text, **more)
    return str(caught.value)


def test_a_file_of_version_1_1_gives_its_pair(tmp_path):
    found = brought(tmp_path, OLD)
    assert found.faults == ()
    scene = parse_scene(found.text)
    pair = gear_pair(scene)
    assert (pair.pinion.teeth, pair.wheel.teeth) == (17, 22)
    assert pair.module == pytest.approx(4e-3)
    assert pair.face_width == pytest.approx(50e-3)
    assert pair.working_centre_distance == pytest.approx(78e-3)
    assert (pair.rack.h_fP, pair.rack.rho_fP) == (1.25, 0.25)
    assert scene.material is not None
    assert (scene.material.youngs_modulus_GPa, scene.material.density_kg_per_m3) == (210.0, 7850.0)
    assert any("which gear drives" in note for note in found.notes)


PAIR = GearPair(
    pinion=Gear(teeth=19, profile_shift=0.35, bore_radius=8e-3, tip_alteration=-0.04, tip_chamfer=0.1e-3),
    wheel=Gear(teeth=31, profile_shift=-0.1, bore_radius=17e-3),
    module=2.5e-3,
    face_width=22e-3,
    rack=BasicRack(h_aP=1.05, h_fP=1.35, rho_fP=0.3, alpha=math.radians(22.5)),
    material=(Material(210e9, 0.3, 7800.0), Material(113e9, 0.26, 7200.0)),
    centre_distance=63.3e-3,
)


def test_a_pair_goes_out_and_comes_back(tmp_path):
    text, left_out = rexs_text(PAIR, 'A <pair> & "more"')
    found = brought(tmp_path, text)
    assert left_out == ()
    assert found.faults == ()
    scene = parse_scene(found.text)
    assert scene.title == 'A <pair> & "more"'
    back = gear_pair(scene)
    assert back.pinion == PAIR.pinion
    assert back.wheel == PAIR.wheel
    assert back.rack.alpha == pytest.approx(PAIR.rack.alpha, rel=1e-14)
    assert (back.rack.h_aP, back.rack.h_fP, back.rack.rho_fP) == (1.05, 1.35, 0.3)
    assert back.working_centre_distance == pytest.approx(PAIR.working_centre_distance, rel=1e-13)
    assert [m.youngs_modulus for m in back.materials] == pytest.approx([210e9, 113e9])
    for own, theirs in zip(PAIR.teeth_profiles, back.teeth_profiles, strict=True):
        assert theirs.tip_radius == pytest.approx(own.tip_radius, rel=1e-12)
        assert theirs.root_radius == pytest.approx(own.root_radius, rel=1e-12)


def test_what_rexs_is_not_given_is_told():
    relieved = GearPair(
        pinion=Gear(teeth=36, thickness_allowance=20e-6, tip_relief=TipRelief(10e-6, 1e-3)),
        wheel=Gear(teeth=40, blank=Blank(5e-3, 10e-3)),
        module=2e-3,
        face_width=40e-3,
    )
    _, left_out = rexs_text(relieved, "")
    assert [message.split(":")[0] for message in left_out] == ["pinion", "pinion", "wheel"]
    assert "blank" in left_out[2]


def test_the_driving_gear_is_the_pinion(tmp_path):
    text, _ = rexs_text(PAIR, "")
    swapped = text.replace(">true<", ">x<").replace(">false<", ">true<").replace(">x<", ">false<")
    assert gear_pair(parse_scene(brought(tmp_path, swapped).text)).pinion.teeth == 31


def test_what_the_file_lacks_stays_open_and_is_listed(tmp_path):
    text = changed('<attribute id="normal_module" unit="mm">4.0</attribute>', "", 2)
    text = text.replace('<attribute id="addendum_modification_coefficient" unit="none">0.0</attribute>', "")
    text = text.replace('type="ordered_reference"', 'type="unknown"')
    found = brought(tmp_path, text)
    listed = {fault.where for fault in found.faults}
    assert listed == {
        "pair.module_mm",
        "pair.pinion.profile_shift",
        "pair.wheel.profile_shift",
        "pair.rack.h_fP",
        "pair.rack.rho_fP",
    }
    assert all(fault.remedy for fault in found.faults)
    # the scene is refused until all of them are given, under the same keys
    with pytest.raises(InputError) as caught:
        parse_scene(found.text)
    assert {fault.where for fault in caught.value.faults} >= listed - {"pair.rack.h_fP", "pair.rack.rho_fP"}


def test_a_named_rack_fills_in_for_a_missing_tool_alone(tmp_path):
    without = OLD.replace('type="ordered_reference"', 'type="unknown"')
    found = brought(tmp_path, without, rack="D")
    assert found.faults == ()
    assert gear_pair(parse_scene(found.text)).rack.h_fP == 1.4
    assert "has its own" in refused(tmp_path, OLD, rack="D")
    steep = without.replace('unit="°">20.0<', 'unit="°">25.0<')
    assert "25 deg" in refused(tmp_path, steep, rack="A")


def test_a_tip_diameter_becomes_a_tip_alteration(tmp_path):
    given_tip = changed(
        '<attribute id="number_of_teeth" unit="none">17</attribute>',
        '<attribute id="number_of_teeth" unit="none">17</attribute>'
        '<attribute id="tip_diameter" unit="mm">75.6</attribute>',
    )
    pair = gear_pair(parse_scene(brought(tmp_path, given_tip).text))
    assert pair.teeth_profiles[0].tip_radius == pytest.approx(37.8e-3, rel=1e-12)
    assert pair.pinion.tip_alteration == pytest.approx(-0.05, abs=1e-12)


@pytest.mark.parametrize(
    ("name", "unit", "value"),
    [
        ("tip_radius", "mm", "1.0"),
        ("tip_corner_radius_factor_reference_profile", "none", "0.25"),  # version 2.0
        ("tip_corner_radius_reference_profile", "mum", "1000.0"),
    ],
)
def test_the_tools_tip_radius_has_several_names(tmp_path, name, unit, value):
    text = OLD.replace('"tip_radius_factor" unit="none">0.25', f'"{name}" unit="{unit}">{value}')
    text = text.replace('version="1.1"', 'version="2.0.0"')
    assert gear_pair(parse_scene(brought(tmp_path, text).text)).rack.rho_fP == 0.25


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            'id="dedendum_coefficient_reference_profile"',
            'id="machining_allowance_din_3972_1952"',
            "must be in mm",
        ),
        ('unit="°">-0.0<', 'unit="°">-15.0<', "must be 0 deg: an external pair has one helix angle"),
        (
            '"cylindrical_gear">\n      <attribute id="face_width"',
            '"ring_gear">\n      <attribute id="face_width"',
            "external",
        ),
        ('type="stage"', 'type="other"', "holds no stage"),
        ('id="normal_module" unit="mm">4.0', 'id="normal_module" unit="mm">5.0', "normal_module"),
        ('id="normal_module" unit="mm">4.0', 'id="normal_module" unit="inch">4.0', "must be in mm"),
        ('unit="none">17<', 'unit="none">seventeen<', "finite number"),
        ('unit="none">17<', 'unit="none">nan<', "finite number"),
        ('unit="°">20.0<', 'unit="°">22.0<', "normal_pressure_angle"),
        ('profile" unit="none">1.25', 'profile" unit="none">1.4', "one basic rack"),
        ('id="dedendum_coefficient_reference_profile"', 'id="protuberance_amount_factor"', "protuberance"),
        ('role="gear_2"', 'role="gear_3"', "has no gear_2"),
        ('version="1.1"', 'version="7"', "not a REXS version"),
        ("<model ", "<!DOCTYPE model><model ", "document type declaration"),
        ('id="84" name', 'id="83" name', "stands twice"),
    ],
)
def test_what_is_out_of_scope_is_refused_by_name(tmp_path, old, new, message):
    assert message in refused(tmp_path, changed(old, new))


def test_teeth_that_are_no_whole_number_are_the_scenes_fault(tmp_path):
    found = brought(tmp_path, changed('unit="none">17<', 'unit="none">17.5<'))
    assert [fault.where for fault in found.faults] == ["pair.pinion.teeth"]


def test_gears_that_cannot_run_are_told_at_once(tmp_path):
    found = brought(tmp_path, changed('unit="mm">78.0', 'unit="mm">70.0'))
    assert any("centre_distance" in fault.where for fault in found.faults)


def test_one_of_several_stages_is_chosen_by_its_id(tmp_path):
    second = '<relation id="9" type="stage"><ref id="212" role="stage"/></relation></relations>'
    text = OLD.replace("</relations>", second, 1)
    text = text.replace("</components>", '<component id="212" type="cylindrical_stage"/></components>', 1)
    assert set(stages(parse_model(text.encode(), "m"))) == {"211", "212"}
    assert "--stage 211" in refused(tmp_path, text)
    assert brought(tmp_path, text, stage="211").faults == ()
    assert "is no stage" in refused(tmp_path, text, stage="5")


def test_modifications_and_other_tools_are_told(tmp_path):
    text = OLD.replace(
        "</relations>",
        '<relation id="9" type="assembly"><ref id="250" role="assembly"/><ref id="99" role="part"/></relation>'
        "</relations>",
        1,
    ).replace("</components>", '<component id="99" type="tip_relief"/></components>', 1)
    text = text.replace(
        'id="84" name="Werkzeug [84]" type="rack_shaped_tool"', 'id="84" name="S" type="cutter_wheel_tool"'
    )
    found = brought(tmp_path, text)
    assert any("tip_relief" in note and "not taken over" in note for note in found.notes)
    assert any("cutter_wheel_tool" in note for note in found.notes)
    assert {fault.where for fault in found.faults} == {"pair.rack.h_fP", "pair.rack.rho_fP"}


class TestHostileFiles:
    def test_entities_are_not_expanded(self):
        bomb = '<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;">]><model version="1.4">&b;</model>'
        with pytest.raises(InputError, match="document type"):
            parse_model(bomb.encode(), "bomb")
        outside = '<!DOCTYPE m SYSTEM "file:///etc/passwd"><model version="1.4"/>'
        with pytest.raises(InputError, match="document type"):
            parse_model(outside.encode(), "outside")

    def test_depth_is_bounded(self):
        with pytest.raises(InputError, match="deeper"):
            parse_model(b'<model version="1.4">' + b"<a>" * 100_000, "deep")

    def test_long_values_do_not_gather(self):
        long = '<model version="1.4"><components><component id="1"><attribute id="a">'
        long += "\n".join("x" * 50 for _ in range(50_000)) + "</attribute></component></components></model>"
        assert all(
            len(value) <= 1000
            for component in parse_model(long.encode(), "long").components.values()
            for value, _ in component.attributes.values()
        )

    @pytest.mark.parametrize(
        "content", [b"", b"PK\x03\x04", b'{"model": {}}', b"\xff\xfe\x00", b"<model", b"<svg/>"]
    )
    def test_other_files_are_refused(self, tmp_path, content):
        path = tmp_path / "other.rexs"
        path.write_bytes(content)
        with pytest.raises(InputError):
            imported(path)

    def test_missing_and_folder(self, tmp_path):
        for path, said in ((tmp_path, "folder"), (tmp_path / "none.rexs", "does not exist")):
            with pytest.raises(InputError, match=said):
                imported(path)

    @settings(max_examples=200, deadline=5000)
    @given(st.text(max_size=60))
    def test_names_cannot_leave_the_comment_or_the_title(self, name):
        draft = Draft(name, name, (name, name), notes=[name])
        scene = tomllib.loads(scene_text(draft))
        assert scene["title"] == name[:200]
        assert set(scene) == {"title", "wants", "pair"}

    @settings(max_examples=300, deadline=5000)
    @given(st.integers(0, len(OLD) - 1), st.integers(0, 60), st.text(max_size=20))
    def test_any_damage_is_read_or_refused(self, at, cut, put):
        text = OLD[:at] + put + OLD[at + cut :]
        with suppress(InputError):  # and nothing else
            scene_text(draft_of(parse_model(text.encode("utf-8", "replace"), "damaged"), "damaged"))


def test_messages_about_files_of_thousands_of_stages_are_short():
    """They listed every stage, in megabytes."""
    relations = "".join(
        f'<relation id="{k}" type="stage"><ref id="{k}" role="stage"/></relation>' for k in range(1, 5001)
    )
    components = "".join(
        f'<component id="{k}" type="cylindrical_stage" name="{"stage " * 20}"/>' for k in range(1, 5001)
    )
    text = f'<model version="1.1"><relations>{relations}</relations><components>{components}</components></model>'
    model = parse_model(text.encode(), "large.rexs")
    for stage in (None, "none"):
        with pytest.raises(InputError) as caught:
            draft_of(model, "large.rexs", stage)
        assert "4988 more" in str(caught.value)
        assert len(str(caught.value)) < 2000
