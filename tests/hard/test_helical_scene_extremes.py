"""Scenes of helical pairs at the ends of what is accepted: steep, hardly helical, wide, narrow, double."""

from __future__ import annotations

import math

import matplotlib.pyplot as plt
import numpy as np
import pytest

from base import InputError
from flankfilm import figures
from flankfilm.runs.check import check_scene
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.test_helical_scene import SCENE

TEXT = SCENE.replace("WANTS", '"geometry", "closed-forms"')
PRESSED = TEXT.replace('"geometry"', '"stiffness"').replace(
    "helix_angle_deg", "tight = true\nhelix_angle_deg"
)


def answered(angle: float, width: float = 40.0, torque: float = 600.0):
    text = TEXT.replace("deg = 20", f"deg = {angle!r}").replace("width_mm = 40.0", f"width_mm = {width!r}")
    return run_scene(parse_scene(text.replace("= 600", f"= {torque!r}")), None, use_cache=False).dataset


@pytest.mark.parametrize("angle", [45.0, -45.0])
@pytest.mark.filterwarnings("ignore")  # of ISO's ranges
def test_the_steepest_helix_is_answered(angle):
    found = answered(angle)
    assert float(found["pair_transverse_module"]) == pytest.approx(2e-3 * math.sqrt(2), rel=1e-12)
    assert float(found["mesh_force_axial"]) == pytest.approx(
        math.copysign(float(found["mesh_force_tangential"]), angle), rel=1e-12
    )
    assert float(found["iso6336_2_Z_beta"]) == pytest.approx(2**0.25, rel=1e-12)
    assert float(found["iso6336_3_Y_beta"]) == pytest.approx(0.75, rel=1e-12)  # beta counts to 30 deg


@pytest.mark.parametrize("angle", [45.0000001, -46.0, 90.0, 1e300])
def test_beyond_the_range_the_range_is_named(angle):
    with pytest.raises(InputError) as caught:
        check_scene(parse_scene(TEXT.replace("deg = 20", f"deg = {angle!r}")))
    (fault,) = caught.value.faults
    assert fault.where == "pair.helix_angle_deg"
    assert "at least -45 and at most 45 deg" in fault.allowed


def test_beyond_the_range_with_keys_of_spur_pairs_both_are_named():
    with pytest.raises(InputError) as caught:
        parse_scene(PRESSED.replace("deg = 20", "deg = 50"))
    assert {fault.where for fault in caught.value.faults} >= {"pair.helix_angle_deg", "pair.tight"}


def test_a_helix_of_a_nanodegree_is_the_spur_pair_but_for_its_name():
    slight, spur = answered(1e-9), answered(0.0)
    for name in ("pair_contact_ratio", "pair_base_pitch", "dimensions_span", "dimensions_over_pins"):
        assert slight[name].values == pytest.approx(spur[name].values, rel=1e-12), name
    assert slight["iso6336_2_stresses"].values == pytest.approx(spur["iso6336_2_stresses"].values, rel=1e-9)
    length = slight["contact_lines_length"].values
    assert {round(1e3 * value, 6) for value in length[[50, 180]]} == {80.0, 40.0}  # two pairs, then one
    with pytest.raises(InputError, match="tight"):
        check_scene(parse_scene(PRESSED.replace("deg = 20", "deg = 1e-9")))


@pytest.mark.parametrize("overlap", [0.01, 1.0, 3.0, 40.0])
@pytest.mark.filterwarnings("ignore")
def test_any_overlap_is_drawn(overlap):
    width = 1e3 * overlap * math.pi * 2e-3 / math.sin(math.radians(20.0))
    found = answered(20.0, width)
    assert float(found["pair_overlap_ratio"]) == pytest.approx(overlap, rel=1e-9)
    drawn = figures.lines_of_contact(found)
    low, high = drawn.axes[1].get_ylim()
    mean = 1e3 * float(found["contact_lines_mean"])
    assert low < mean < high
    level = np.ptp(found["contact_lines_length"].values) < 1e-9 * 1e-3 * mean
    assert level == (overlap == round(overlap))
    assert not level or high - low > 0.05 * mean  # no scale of rounding
    plt.close(drawn)


def test_rounding_of_a_level_length_is_not_drawn():
    found = answered(20.0, 1e3 * 2.0 * math.pi * 2e-3 / math.sin(math.radians(20.0)))
    wave = np.sin(np.arange(found["contact_lines_length"].size))
    rounded = found.assign(contact_lines_length=found["contact_lines_length"] * (1.0 + 1e-12 * wave))
    drawn = figures.lines_of_contact(rounded)
    assert np.ptp(drawn.axes[1].get_ylim()) > 0.05e3 * float(found["contact_lines_mean"])
    plt.close(drawn)


def test_a_double_helical_pair_is_two_halves():
    right, left = answered(30.0, 20.0, 300.0), answered(-30.0, 20.0, 300.0)
    assert float(right["mesh_force_axial"]) + float(left["mesh_force_axial"]) == 0.0
    for name in ("iso6336_2_stresses", "iso6336_1_c_gamma", "contact_lines_mean", "dimensions_span"):
        assert np.array_equal(right[name].values, left[name].values), name


@pytest.mark.parametrize("angle", [45.0, -45.0, 20.0, 1e-9])
@pytest.mark.filterwarnings("ignore")
def test_heat_that_closes_the_backlash_names_the_temperature_that_does_not(angle):
    text = TEXT.replace('"geometry", "closed-forms"', '"stiffness", "root-stress"')
    text = text.replace("deg = 20", f"deg = {angle!r}\nbacklash_um = 20")
    hot = text + "[heat]\npinion_temperature_C = 280\nwheel_temperature_C = 40\nhousing_temperature_C = 30\n"
    with pytest.raises(InputError) as caught:
        check_scene(parse_scene(hot))
    (fault,) = caught.value.faults
    assert fault.where == "heat.pinion_temperature_C"
    bound = fault.allowed.removeprefix("must be at most ").split()[0]
    said = check_scene(parse_scene(hot.replace("= 280", f"= {bound}")))
    assert any(line.startswith("Heat: backlash 20.0 µm cold, 0.0 µm warm") for line in said)
    with pytest.raises(InputError, match="pinion_temperature_C"):
        check_scene(parse_scene(hot.replace("= 280", f"= {float(bound) + 0.1}")))
