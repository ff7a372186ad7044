"""Blanks from a scene: keys, faults under them, studies, results and the models that know no web."""

from __future__ import annotations

import pytest

from base import InputError
from flankfilm.build import gear_pair
from flankfilm.cache import Cache
from flankfilm.plan.stiffness_choice import teeth
from flankfilm.scene import parse_scene
from flankfilm.stages.catalogue import COMPLIANCE
from flankfilm.stages.engine import Engine
from tests.flankfilm.program import EXAMPLES

TEXT = (EXAMPLES / "article.toml").read_text(encoding="utf-8")
WHEEL = "bore_mm = 37.5"


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
    assert told[0].startswith("pair.wheel.blank.rim_thickness_mm = 0.5: must be 1 mm to 12.5 mm")
    assert told[1].startswith("pair.wheel.blank.web_thickness_mm = 41: must be 2 mm to 40 mm")
    with pytest.raises(InputError, match=r"pair\.wheel\.blank\.hub_mm = 80: must be 37\.5 mm to 73 mm"):
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
        update={"stiffness": some.stiffness.model_copy(update={"model": "auto"}), "wants": ["stiffness"]}
    )
    assert "a gear has a web" in teeth(some, gear_pair(some)).why
