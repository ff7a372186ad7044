"""Keys that engineers give instead of others: tip diameter, power; lengths in inches; loads that no gear bears."""

from __future__ import annotations

import math

import pytest

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.runs.check import check_scene
from flankfilm.scene import parse_scene, template

TORQUE = "pinion_torque_Nm = 600"
PINION = "pinion = { teeth = 36, profile_shift = 0.0, bore_mm = 33.5 }"


def with_pinion(keys: str) -> str:
    assert PINION in template()
    return template().replace(PINION, f"pinion = {{ teeth = 36, bore_mm = 33.5, {keys} }}", 1)


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    return {fault.where: str(fault) for fault in caught.value.faults}


def test_a_tip_diameter_gives_the_tip_alteration():
    pinion = gear_pair(parse_scene(with_pinion("profile_shift = 0.1, tip_diameter_mm = 76.0"))).pinion
    assert pinion.tip_alteration == pytest.approx(-0.1, abs=1e-12)
    built = gear_pair(parse_scene(with_pinion("profile_shift = 0.1, tip_diameter_mm = 76.0")))
    assert 2e3 * built.teeth_profiles[0].tip_radius == pytest.approx(76.0, abs=1e-9)


def test_the_nominal_tip_diameter_changes_nothing():
    assert gear_pair(parse_scene(with_pinion("tip_diameter_mm = 76.0"))) == gear_pair(parse_scene(template()))


def test_a_tip_diameter_that_cannot_be_is_refused_under_its_own_key():
    with pytest.raises(InputError) as caught:
        gear_pair(parse_scene(with_pinion("tip_diameter_mm = 96.0")))
    (fault,) = caught.value.faults
    assert fault.where == "pair.pinion.tip_diameter_mm"
    assert fault.value == "96"


def test_tip_diameter_and_alteration_exclude_each_other():
    found = faults(with_pinion("tip_alteration = 0.1, tip_diameter_mm = 76.0"))
    assert "tip_diameter_mm" in found["pair.pinion.tip_alteration"]


def test_power_and_speed_give_the_torque():
    operating = parse_scene(template().replace(TORQUE, "power_kW = 125.0", 1)).operating
    assert operating is not None
    assert operating.pinion_torque_Nm == pytest.approx(125e3 / (2000 * 2 * math.pi / 60))


@pytest.mark.parametrize(
    ("new", "where", "said"),
    [
        ("power_kW = 125.0\npinion_torque_Nm = 600", "operating.pinion_torque_Nm", "596.831"),
        ('power_kW = "125"', "operating.power_kW", "without quotes"),
        ("power_kW = 1e7", "operating.power_kW", "at most"),
        ("power_kW = 0", "operating.pinion_torque_Nm", "at least"),
    ],
)
def test_a_power_that_cannot_be_is_refused(new: str, where: str, said: str):
    found = faults(template().replace(TORQUE, new, 1))
    assert list(found) == [where]
    assert said in found[where]


def test_a_power_needs_a_speed():
    text = template().replace(TORQUE, "power_kW = 125.0", 1).replace("pinion_speed_rpm = 2000", "", 1)
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    assert any("required by power_kW" in str(fault) for fault in caught.value.faults)


@pytest.mark.parametrize(
    ("old", "new", "where", "said"),
    [
        ("module_mm = 2.0", "module_in = 0.1", "pair.module_in", "Write module_mm = 2.54"),
        ("backlash_um = 50", "backlash_in = 0.002", "pair.backlash_in", "Write backlash_um = 50.8"),
        ("module_mm = 2.0", 'module_in = "a"', "pair.module_in", "1 inch is 25.4 mm"),
        (
            "module_mm = 2.0",
            "module_mm = 2.0\nbeta_deg = 12",
            "pair.beta_deg",
            "Give pair.helix_angle_deg",
        ),
    ],
)
def test_inches_are_refused_with_their_value_and_helices_by_name(old: str, new: str, where: str, said: str):
    found = faults(template().replace(old, new, 1))
    assert list(found) == [where]
    assert said in found[where]


def test_a_torque_beyond_any_steel_is_warned_of_by_its_key():
    warned = check_scene(parse_scene(template().replace(TORQUE, "pinion_torque_Nm = 302000", 1)))
    assert any(line.startswith("Warning: operating.pinion_torque_Nm = 302000") for line in warned)
    assert not any("strength" in line for line in check_scene(parse_scene(template())))
