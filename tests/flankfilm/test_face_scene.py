"""Face width in scenes: leads and alignment from their keys to the ground, and what scenes with them cannot have."""

from __future__ import annotations

import pytest

from base import InputError
from flankfilm.beforehand import refuse
from flankfilm.build import gear_pair
from flankfilm.build_face import face, varies_by
from flankfilm.scene import parse_scene
from flankfilm.scene.plain_gears import plain_flanks
from gears import Alignment, Lead
from tests.flankfilm.scenes import ishikawa

SCENE = ishikawa("Face", "stiffness").replace('model = "ishikawa"\npairs = "independent"\n', "")
LEADS = SCENE.replace(
    "pinion = { teeth = 36 }",
    "pinion = { teeth = 36, crowning_um = 10, end_relief_um = 8, end_relief_length_mm = 5 }",
).replace("wheel = { teeth = 40 }", "wheel = { teeth = 40, lead_slope_um = -6 }")
ALIGNED = SCENE + "[alignment]\nin_plane_um = 20\ncells = 32\n"


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        refuse(parse_scene(text))
    return {fault.where: str(fault) for fault in caught.value.faults}


def test_keys_become_leads_and_alignment():
    pair = gear_pair(parse_scene(LEADS))
    assert pair.pinion.lead == Lead(
        crowning=pytest.approx(10e-6), end_relief=pytest.approx(8e-6), end_relief_length=pytest.approx(5e-3)
    )
    assert pair.wheel.lead == Lead(slope=pytest.approx(-6e-6))
    assert face(parse_scene(LEADS)) == {}
    given = face(parse_scene(ALIGNED))
    assert given == {"alignment": Alignment(pytest.approx(20e-6)), "cells": 32, "face_model": "free-ends"}
    assert face(parse_scene(ALIGNED + 'out_of_plane_um = 50\nface_model = "walls"'))[
        "alignment"
    ] == Alignment(pytest.approx(20e-6), pytest.approx(50e-6))


def test_what_varies_the_load_is_named_and_plain_flanks_have_none_of_it():
    assert varies_by(parse_scene(SCENE)) == []
    assert varies_by(parse_scene(LEADS)) == [
        "pair.pinion.crowning_um",
        "pair.pinion.end_relief_um",
        "pair.wheel.lead_slope_um",
    ]
    assert varies_by(parse_scene(SCENE + "[alignment]\n")) == ["[alignment]"]
    assert gear_pair(plain_flanks(parse_scene(LEADS))) == gear_pair(parse_scene(SCENE))


def test_faults_of_keys_come_together_in_their_units():
    found = faults(LEADS.replace("crowning_um = 10", "crowning_um = 1010").replace("= -6", "= 1e6"))
    assert "at least -1000 and at most 1000 um" in found["pair.pinion.crowning_um"]
    assert "at least -1000 and at most 1000 um" in found["pair.wheel.lead_slope_um"]
    found = faults(ALIGNED.replace("= 20", "= 6000").replace("= 32", "= 2"))
    assert "at least -5000 and at most 5000 um" in found["alignment.in_plane_um"]
    assert "at least 4 and at most 512" in found["alignment.cells"]
    assert (
        "20 mm, half the face" in faults(LEADS.replace("= 5 }", "= 21 }"))["pair.pinion.end_relief_length_mm"]
    )


def test_what_is_of_even_loads_is_refused_at_once_before_anything_is_computed():
    text = ALIGNED.replace('["stiffness"]', '["stiffness", "film", "root-stress", "vtk"]').replace(
        "pinion_torque_Nm = 600", "pinion_torque_Nm = 600\npinion_speed_rpm = 2000"
    )
    text += '[lubricant]\nviscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\n[film]\nmodel = "ehl"\n'
    with pytest.raises(InputError) as caught:
        refuse(parse_scene(text))
    found = [str(fault) for fault in caught.value.faults]
    assert [one.partition(":")[0] for one in found] == [
        'wants = "film"',
        'wants = "root-stress"',
        'wants = "vtk"',
        "film.model = 'ehl'",
    ]
    assert all("by [alignment]" in one and "or drop [alignment]" in one for one in found)
