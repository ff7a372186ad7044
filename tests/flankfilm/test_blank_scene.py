"""Blanks from a scene: keys, faults under them, studies, results and the models that know no web."""

from __future__ import annotations

import pytest

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.files.cache import Cache
from flankfilm.plan.stiffness_choice import teeth
from flankfilm.scene import parse_scene
from flankfilm.scene.plain_gears import held_on_hubs
from flankfilm.scene.reader import validated
from flankfilm.scene.sections.gears import HubSection
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import COMPLIANCE
from flankfilm.studies.plan import read_plan
from tests.flankfilm.program import EXAMPLES

TEXT = (EXAMPLES / "article.toml").read_text(encoding="utf-8")
WHEEL = "bore_mm = 37.5"
BLANK = "blank = { rim_thickness_mm = 6, web_thickness_mm = 12 }"


def scene(more="", **blank):
    keys = ", ".join(f"{key} = {value}" for key, value in blank.items())
    assert WHEEL in TEXT
    return parse_scene(TEXT.replace(WHEEL, f"{WHEEL}, blank = {{ {keys} }}") + more)


def test_keys_become_the_gear():
    pair = gear_pair(scene(rim_thickness_mm=6, web_thickness_mm=12, hub_mm=50))
    blank = pair.wheel.blank
    assert (blank.rim_thickness, blank.web_thickness, blank.hub_radius, blank.web_offset) == pytest.approx(
        (6e-3, 12e-3, 25e-3, 0.0)
    )
    assert pair.pinion.blank is None
    bodies = Engine(scene(rim_thickness_mm=6, web_thickness_mm=12), Cache(None))[COMPLIANCE]
    assert bodies.rim_thickness[1] == pytest.approx(6e-3)


def test_all_faults_are_told_under_their_keys_in_their_units():
    with pytest.raises(InputError) as caught:
        gear_pair(scene(rim_thickness_mm=0.5, web_thickness_mm=41, hub_mm=50))
    told = [str(fault) for fault in caught.value.faults]
    assert told[0].startswith("pair.wheel.blank.rim_thickness_mm = 0.5: must be 1 mm to 11.9999 mm")
    assert told[1].startswith("pair.wheel.blank.web_thickness_mm = 41: must be 2 mm to 40 mm")
    with pytest.raises(InputError, match=r"pair\.wheel\.blank\.hub_mm = 80: must be 37\.5 mm to 72 mm"):
        gear_pair(scene(rim_thickness_mm=6, web_thickness_mm=12, hub_mm=80))
    with pytest.raises(InputError, match=r"pair\.wheel\.blank\.rim_thickness_mm.*\n?.*web_thickness_mm"):
        gear_pair(scene(hub_mm=50))


def test_a_web_off_the_middle_is_refused_with_the_reason():
    with pytest.raises(
        InputError, match=r"web_offset_mm = 3: must be 0 mm.*tilts the rim.*three-dimensional"
    ):
        gear_pair(scene(rim_thickness_mm=6, web_thickness_mm=12, web_offset_mm=3))


def test_a_choice_of_models_takes_finite_elements_for_a_web():
    some = scene(rim_thickness_mm=6, web_thickness_mm=12)
    some = some.model_copy(
        update={"stiffness": some.stiffness.model_copy(update={"model": "auto"}), "wants": ("stiffness",)}
    )
    assert "a gear has a web" in teeth(some, gear_pair(some)).why


def test_a_rigid_hub_may_fill_the_hub_of_the_blank():
    """The root stress is computed with a bore as large as the rigid hub."""
    some = scene(rim_thickness_mm=6, web_thickness_mm=12, hub_mm=44)
    wheel = some.pair.wheel.model_copy(update={"hub": HubSection(hub_mm=50.0)})
    some = some.model_copy(update={"pair": some.pair.model_copy(update={"wheel": wheel})})
    zones = gear_pair(held_on_hubs(some)).teeth_profiles[1].zones
    assert [(zone.inner, zone.thickness) for zone in zones] == [
        (pytest.approx(37.5e-3 - 6e-3), 1.0),
        (pytest.approx(25e-3), pytest.approx(0.3)),
    ]
    with_hub = gear_pair(held_on_hubs(scene(rim_thickness_mm=6, web_thickness_mm=12, hub_mm=44)))
    assert len(with_hub.teeth_profiles[1].zones) == 3


def test_a_study_varies_the_web(tmp_path):
    (tmp_path / "scene.toml").write_text(TEXT.replace(WHEEL, f"{WHEEL}, {BLANK}"), encoding="utf-8")
    (tmp_path / "study.toml").write_text(
        'scene = "scene.toml"\noutputs = ["contact_ratio"]\n[vary]\n'
        '"pair.wheel.blank.web_thickness_mm" = [8.0, 20.0]\n',
        encoding="utf-8",
    )
    plan = read_plan(tmp_path / "study.toml")
    webs = [gear_pair(validated(plan.raw_scene(i))).web_thicknesses for i in range(2)]
    assert webs == [pytest.approx((0.04, 0.008)), pytest.approx((0.04, 0.02))]
