"""Growth by heat: backlash, pressure angle and base pitches against gears drawn at their own temperatures."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from gears import Blank, Gear, GearPair, GeometryError, Heat, Material, TipRelief, warm_pair

PLASTIC = Material(youngs_modulus=3e9, poisson_ratio=0.4, density=1140.0, thermal_expansion=80e-6)


def pair(**options):
    return GearPair(Gear(36, 0.1), Gear(40, -0.05), 2e-3, 0.04, **options).with_backlash(50e-6)


def test_nothing_grows_at_the_temperature_of_reference():
    cold = pair()
    warm = warm_pair(cold, Heat())
    assert warm.pair is cold
    assert (warm.backlash, warm.base_pitch_difference) == (cold.backlash, 0.0)


def test_all_of_one_temperature_and_material_keeps_its_angles():
    cold = pair()
    warm = warm_pair(cold, Heat(373.15, 373.15, 373.15))
    growth = 1 + 11.5e-6 * 80
    assert warm.pressure_angle == pytest.approx(cold.working_pressure_angle, rel=1e-9)
    assert warm.backlash == pytest.approx(growth * cold.backlash, rel=1e-6)
    assert warm.base_pitch_difference == 0.0
    assert warm.pair.module == pytest.approx(growth * cold.module, rel=1e-14)


@pytest.mark.parametrize("temperatures", [(393.15, 353.15, 323.15), (293.15, 343.15, 303.15)])
def test_involutes_drawn_at_their_own_temperatures_roll_with_the_gaps_that_are_said(temperatures):
    cold = pair(material=(Material(206e9, 0.3, 7850.0), PLASTIC))
    heat = Heat(*temperatures, housing_expansion=23e-6)
    warm = warm_pair(replace(cold, tight=True), heat)
    s_1, s_2, s_h = heat.growths(cold)
    r_1, r_2 = cold.base_radii[0] * s_1, cold.base_radii[1] * s_2
    psi_1, psi_2 = (tooth.base_half_angle for tooth in cold.teeth_profiles)
    distance = cold.working_centre_distance * s_h
    alpha = math.acos((r_1 + r_2) / distance)
    assert warm.pressure_angle == pytest.approx(alpha, rel=1e-12)
    assert warm.centre_distance == pytest.approx(distance, rel=1e-14)
    line, small = distance * math.sin(alpha), 1.5 * abs(s_1 - s_2)  # the first order in s_1 - s_2
    grown = warm.pair
    places = np.linspace(grown.points.A, grown.points.E, 7)
    # front flanks: the pinion turned on from C by x/r_b of the grown gears, the wheel by the ratio of the teeth
    start_1, start_2 = math.tan(alpha) - psi_1 - alpha, math.tan(alpha) - psi_2 - alpha
    pitch = 2 * math.pi / cold.wheel.teeth
    for place in places:
        turn = (place - grown.points.C) / grown.base_radii[0]
        first, second = start_1 + turn, start_2 - turn * cold.pinion.teeth / cold.wheel.teeth
        gap = line - r_1 * (first + psi_1 + alpha) - r_2 * (second + psi_2 + alpha)
        said = -warm.base_pitch_difference / cold.base_pitch * (place - grown.points.C)
        assert gap == pytest.approx(said, abs=small * abs(said) + 1e-10)
        behind = line - r_1 * (-first + psi_1 + alpha) - r_2 * (-second - pitch + psi_2 + alpha)
        back = grown.base_radii[0] * (-first + psi_1 + alpha)
        said = warm.backlash - warm.base_pitch_difference / cold.base_pitch * (back - grown.points.C)
        assert behind == pytest.approx(
            said, abs=small * (abs(said - warm.backlash) + abs(warm.backlash)) + 1e-10
        )


@pytest.mark.parametrize("degrees", [20.0, -8.0, 1e-6])
def test_helicoids_at_their_own_temperatures_have_one_gap_along_a_line(degrees):
    """That at mid-face: leads grow as base circles do, so that lines on both flanks keep their angle."""
    cold = pair(material=(Material(206e9, 0.3, 7850.0), PLASTIC), helix_angle=math.radians(degrees))
    heat = Heat(393.15, 343.15, 323.15, housing_expansion=23e-6)
    warm = warm_pair(replace(cold, tight=True), heat)
    s_1, s_2, s_h = heat.growths(cold)
    (cold_1, cold_2), (psi_1, psi_2) = (
        cold.base_radii,
        [tooth.base_half_angle for tooth in cold.teeth_profiles],
    )
    r_1, r_2, distance = cold_1 * s_1, cold_2 * s_2, cold.working_centre_distance * s_h
    alpha = math.acos((r_1 + r_2) / distance)
    line, small, grown = distance * math.sin(alpha), 1.5 * abs(s_1 - s_2), warm.pair
    assert grown.helix_angle == cold.helix_angle
    assert warm.pressure_angle == pytest.approx(alpha, rel=1e-12)
    pitch = 2 * math.pi / cold.wheel.teeth
    turns = [math.tan(cold.helix.base_angle) / radius for radius in (cold_1, cold_2)]  # per length, cold
    for middle in np.linspace(grown.points.A, grown.points.E, 3):
        turn = (middle - grown.points.C) / grown.base_radii[0]
        said = -warm.base_pitch_difference / cold.base_pitch * (middle - grown.points.C)
        for z in (-0.02, 0.0, 0.013):
            first = math.tan(alpha) - psi_1 - alpha + turn + z * turns[0] / s_1
            second = math.tan(alpha) - psi_2 - alpha - turn * 36 / 40 - z * turns[1] / s_2
            gap = line - r_1 * (first + psi_1 + alpha) - r_2 * (second + psi_2 + alpha)
            assert gap == pytest.approx(said, abs=small * abs(said) + 1e-10)
            behind = line - r_1 * (-first + psi_1 + alpha) - r_2 * (-second - pitch + psi_2 + alpha)
            back = grown.base_radii[0] * (alpha + psi_1 - (math.tan(alpha) - psi_1 - alpha + turn))
            apart = -warm.base_pitch_difference / cold.base_pitch * (back - grown.points.C)
            within = small * (abs(apart) + abs(grown.backlash)) + 1e-10
            assert behind == pytest.approx(grown.base_tangent_backlash + apart, abs=within)


def test_shape_in_modules_stays():
    cold = GearPair(
        Gear(36, bore_radius=15e-3, tip_relief=TipRelief(20e-6, 2e-3), tip_chamfer=1e-4),
        Gear(40, blank=Blank(rim_thickness=6e-3, web_thickness=10e-3, hub_radius=25e-3), bore_radius=15e-3),
        2e-3,
        0.04,
    ).with_backlash(80e-6)
    grown = warm_pair(cold, Heat(373.15, 343.15, 333.15)).pair
    for before, after in zip((cold.pinion, cold.wheel), (grown.pinion, grown.wheel), strict=True):
        assert after.bore_radius / grown.module == pytest.approx(before.bore_radius / cold.module, rel=1e-14)
        allowance = before.thickness_allowance / cold.module
        assert after.thickness_allowance / grown.module == pytest.approx(allowance, rel=1e-14)
    assert grown.wheel.blank.hub_radius / grown.module == pytest.approx(25e-3 / cold.module, rel=1e-14)
    assert grown.contact_ratio == pytest.approx(cold.contact_ratio, abs=0.02)


@pytest.mark.parametrize(
    ("heat", "key", "side"),
    [
        (Heat(393.15, 393.15, 293.15), "heat.wheel_temperature", "at most"),
        (Heat(453.15, 303.15, 293.15), "heat.pinion_temperature", "at most"),
        (Heat(housing_temperature=193.15), "heat.housing_temperature", "at least"),
    ],
)
def test_heat_that_eats_the_backlash_is_refused_with_the_temperature_allowed(heat, key, side):
    cold = GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(20e-6)
    with pytest.raises(GeometryError, match="give more backlash") as error:
        warm_pair(cold, heat)
    (fault,) = error.value.faults
    assert fault.where == key
    bound = float(fault.allowed.split(side)[1].split()[0])
    just = replace(heat, **{key.removeprefix("heat."): bound + (-0.01 if side == "at most" else 0.01)})
    assert 0.0 <= warm_pair(cold, just).backlash < 1e-8
    assert warm_pair(replace(cold, tight=True), heat).backlash < 0.0


def test_values_out_of_bounds():
    with pytest.raises(GeometryError, match="pinion_temperature"):
        warm_pair(pair(), Heat(pinion_temperature=80.0))
    with pytest.raises(GeometryError, match="thermal_expansion"):
        pair(material=replace(PLASTIC, thermal_expansion=-1e-5))
    with pytest.raises(GeometryError, match="tight"):
        pair(tight=1)


def test_tight_pairs_have_a_bound_too():
    plain = GearPair(Gear(36, tip_alteration=-0.1), Gear(40, tip_alteration=-0.1), 2e-3, 0.04)
    distance = plain.centre_distance_of_backlash(-0.0999 * 2e-3)
    assert replace(plain, centre_distance=distance, tight=True).backlash == pytest.approx(-0.0999 * 2e-3)
    with pytest.raises(GeometryError, match="tight = true"):
        replace(plain, centre_distance=distance)
    further = plain.centre_distance_of_backlash(-0.11 * 2e-3)
    with pytest.raises(GeometryError, match=r"must be at least 0\.0757"):
        replace(plain, centre_distance=further, tight=True)
