"""Keys of films with heat: oil, materials and the temperature of the flanks."""

from __future__ import annotations

import math

import pytest

from base import InputError
from ehl import Lubricant
from flankfilm.building.film import boundary_friction, flank_temperatures, lubricant
from flankfilm.building.pair import gear_pair
from flankfilm.scene import parse_scene, template

NUMBERS = "viscosity_Pa_s = 0.075\npressure_viscosity_per_GPa = 19.6\n"
GRADE = 'iso_vg = 100\ntemperature_C = 60\nbase = "pao"\n'


def scene_of(oil: str, more: str = ""):
    return parse_scene(f'wants = ["report"]\n[lubricant]\n{oil}{more}')


def test_keys_are_the_oil_s_numbers_in_its_units():
    oil = lubricant(
        scene_of(
            NUMBERS,
            "temperature_C = 80\nviscosity_slope_per_K = 0.035\nconductivity_W_per_m_K = 0.13\n"
            "heat_capacity_J_per_kg_K = 1900\nthermal_expansion_per_K = 7e-4\neyring_stress_MPa = 6\n"
            "limiting_shear_ratio = 0.05\n",
        )
    )
    assert (oil.temperature, oil.viscosity_slope, oil.conductivity) == (353.15, 0.035, 0.13)
    assert (oil.heat_capacity, oil.expansion) == (1900.0, 7e-4)
    assert (oil.eyring_stress, oil.limiting_shear_ratio) == (6e6, 0.05)


def test_a_grade_has_its_own_and_keys_replace_them():
    assert lubricant(scene_of(GRADE)) == Lubricant.from_iso_vg(100, 333.15, base="pao")
    own = lubricant(scene_of(GRADE, "viscosity_slope_per_K = 0.05\n"))
    assert own.viscosity_slope == 0.05
    assert own.limiting_shear_ratio == 0.035


def test_flanks_have_the_temperature_of_the_gears_where_it_is_given():
    warm = "[heat]\npinion_temperature_C = 90\nwheel_temperature_C = 70\n"
    assert flank_temperatures(scene_of(GRADE)) is None
    assert flank_temperatures(scene_of(GRADE, "[heat]\nhousing_temperature_C = 50\n")) is None
    assert flank_temperatures(scene_of(GRADE, warm)) == pytest.approx((363.15, 343.15))
    assert flank_temperatures(scene_of(GRADE, "[heat]\nwheel_temperature_C = 70\n")) == (293.15, 343.15)
    assert lubricant(scene_of(GRADE, warm)) == Lubricant.from_iso_vg(100, 353.15, base="pao")
    of_the_flanks = lubricant(scene_of(NUMBERS, warm))
    assert (of_the_flanks.viscosity, of_the_flanks.temperature) == (0.075, 353.15)
    of_the_oil = lubricant(scene_of(NUMBERS, "temperature_C = 60\n" + warm))
    colder = Lubricant(0.075, 19.6e-9, temperature=333.15)
    ratio, slope = colder.hot_log_viscosity(0.0, 353.15)
    assert of_the_oil.viscosity == pytest.approx(0.075 * math.exp(ratio))
    assert of_the_oil.pressure_viscosity == pytest.approx(float(slope))


def rough_of(more: str = ""):
    return scene_of(GRADE, f"[roughness]\nRa_um = 0.4\n{more}")


def test_the_friction_of_asperities_is_a_key_with_a_band():
    assert boundary_friction(scene_of(GRADE)) == {}
    assert boundary_friction(rough_of()) == {"boundary_friction": 0.1, "boundary_band": None}
    given = rough_of("boundary_friction = 0.07\nboundary_friction_band = [0.05, 0.08]\n")
    assert boundary_friction(given) == {"boundary_friction": 0.07, "boundary_band": (0.05, 0.08)}
    assert "boundary_friction = 0.1" in template()
    for wrong in (
        "boundary_friction = 0.9\n",
        "boundary_friction = 0.2\nboundary_friction_band = [0.08, 0.12]\n",
        "boundary_friction_band = [0.12, 0.08]\n",
        "boundary_friction_band = [0.08]\n",
    ):
        with pytest.raises(InputError, match="boundary_friction"):
            rough_of(wrong)


def test_a_grade_is_not_known_at_every_temperature_of_gears():
    with pytest.raises(
        InputError, match=r"heat\.pinion_temperature_C = 165: must be from -20 to 150 degC"
    ) as caught:
        lubricant(scene_of(GRADE, "[heat]\npinion_temperature_C = 190\nwheel_temperature_C = 140\n"))
    assert "by its numbers" in str(caught.value)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("eyring_stress_MPa", 5e6, "at most 1000 MPa"),
        ("limiting_shear_ratio", 4.7, "at most 1"),
        ("viscosity_slope_per_K", 4.0, "at most 0.5 1/K"),
        ("conductivity_W_per_m_K", 140, "at most 10 W/(m K)"),
        ("heat_capacity_J_per_kg_K", 2.0, "at least 10"),
        ("thermal_expansion_per_K", 0.65, "at most 0.01 1/K"),
        ("temperature_C", 353.15, "at most 150"),
    ],
)
def test_a_wrong_unit_of_the_oil_is_seen(key, value, said):
    with pytest.raises(InputError) as caught:
        scene_of(NUMBERS, f"{key} = {value}\n")
    (fault,) = caught.value.faults
    assert fault.where == f"lubricant.{key}"
    assert said in fault.allowed


def test_a_material_conducts_heat():
    steel = "poisson_ratio = 0.3\ndensity_kg_per_m3 = 7850\n"
    text = "".join(line for line in template().splitlines(keepends=True) if not line.startswith("#"))
    start = text.index("[material]")
    text = f"{text[:start]}[material]\nyoungs_modulus_GPa = 206\n{steel}CONDUCTS\n{text[text.index('[operating]') :]}"
    pair = gear_pair(parse_scene(text.replace("CONDUCTS", "conductivity_W_per_m_K = 41")))
    assert [(m.conductivity, m.heat_capacity) for m in pair.materials] == [(41.0, 470.0)] * 2
    with pytest.raises(InputError, match=r"material\.heat_capacity_J_per_kg_K = 0\.47"):
        parse_scene(text.replace("CONDUCTS", "heat_capacity_J_per_kg_K = 0.47"))
