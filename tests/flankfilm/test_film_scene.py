"""Oil, supply and roughness in a scene: one way of saying each, all faults explained."""

from __future__ import annotations

import warnings

import pytest

from base import InputError, RangeWarning
from ehl import Barus, ConstantViscosity, LineContact, Meniscus, OilLayer
from flankfilm.building.film import film_model, lubricant, roughness
from flankfilm.coupling.films import films
from flankfilm.scene import parse_scene, template
from flankfilm.scene.sections.ground import under_keys
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import PLAN

_OIL = ("viscosity_Pa_s", "pressure_viscosity_per_GPa", "density_kg_per_m3 = 910")
NUMBERS = "".join(line for line in template().splitlines(keepends=True) if line.startswith(_OIL))
GRADE = "iso_vg = 100\ntemperature_C = 60\n"
SUPPLY = 'supply = "flooded"'
ROUGH = "[roughness]\nsigma_um = 0.3\ndensity_per_mm2 = 25000\ntip_radius_um = 10\n"


def changed(*changes: tuple[str, str]) -> str:
    text = template()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def faults(text: str) -> dict[str, str]:
    with pytest.raises(InputError) as caught:
        parse_scene(text)
    return {fault.where: str(fault) for fault in caught.value.faults}


def contact(load: float = 4.434e5) -> LineContact:
    oil = lubricant(parse_scene(template()))
    return LineContact(load=load, entrainment=2.58, radius=6.48e-3, reduced_modulus=2.2e11, lubricant=oil)


@pytest.mark.parametrize(
    ("old", "new", "where", "said"),
    [
        (NUMBERS, NUMBERS + GRADE, "lubricant", "not both ways at once"),
        (NUMBERS, "iso_vg = 100\n", "lubricant", "iso_vg and temperature_C"),
        (NUMBERS, "", "lubricant", "or iso_vg and temperature_C"),
        (NUMBERS, "viscosity_Pa_s = 0.075\n", "lubricant", "pressure_viscosity_per_GPa"),
        (NUMBERS, GRADE.replace("60", "333"), "lubricant.temperature_C", "at most 150"),
        (NUMBERS, GRADE + 'base = "minreal"\n', "lubricant.base", "Did you mean 'mineral'"),
        (NUMBERS, NUMBERS + 'viscosity_law = "barus"\nroelands_z = 0.6\n', "lubricant", "leave it out"),
        (NUMBERS, NUMBERS + 'viscosity_law = "constant"\n', "lubricant", "pressure_viscosity_per_GPa = 0"),
        (SUPPLY, 'supply = "oil-layer"', "film", "needs oil_layer_um"),
        (SUPPLY, 'supply = "meniscus"', "film", "meniscus_mm or meniscus_half_widths"),
        (SUPPLY, 'supply = "meniscus"\nmeniscus_mm = 0.2\nmeniscus_half_widths = 1.1', "film", "one of them"),
        (SUPPLY, 'supply = "meniscus"\noil_layer_um = 0.1', "film", "has no oil_layer_um"),
        (SUPPLY, "oil_layer_um = 0.1", "film", "has no oil_layer_um"),
        (
            SUPPLY,
            'supply = "meniscus"\nmeniscus_half_widths = 0.9',
            "film.meniscus_half_widths",
            "at least 1",
        ),
        (SUPPLY, 'supply = "oil-layer"\noil_layer_um = 0', "film.oil_layer_um", "at least 0.0001"),
        (
            "density_kg_per_m3 = 910",
            "density_kg_per_m3 = 0.91",
            "lubricant.density_kg_per_m3",
            "Check the unit",
        ),
        ("per_GPa = 19.6", "per_GPa = 19600", "lubricant.pressure_viscosity_per_GPa", "at most 100 1/GPa"),
        (SUPPLY, 'supply = "dry"', "film.supply", "'meniscus'"),
        (SUPPLY, 'supply = "oil-layer"\noil_layer_um = 0.1\ngrid = "article"', "film", "flooded films"),
        ("[stiffness]", ROUGH.replace("0.3", "-1") + "[stiffness]", "roughness.sigma_um", "at least 0.0001"),
        (
            "[stiffness]",
            ROUGH.replace("tip_", "") + "[stiffness]",
            "roughness.radius_um",
            "mean tip_radius_um",
        ),
    ],
)
def test_a_fault_names_key_and_remedy(old: str, new: str, where: str, said: str):
    found = faults(changed((old, new)))
    assert where in found
    assert said in found[where]


@pytest.mark.parametrize(
    ("film", "said"),
    [
        ('model = "dowson"\nsupply = "oil-layer"\noil_layer_um = 0.1', "flooded contacts"),
        ('stiffness = "dowson-central"\nsupply = "oil-layer"\noil_layer_um = 0.1', "flooded contacts"),
        ('model = "dowson"\nstiffness = "approach"', "dowson-central"),
    ],
)
def test_formulas_are_of_flooded_contacts(film: str, said: str):
    text = template()
    start, end = text.index("[film]"), text.index("[dynamics]")
    assert said in faults(f"{text[:start]}[film]\n{film}\n{text[end:]}")["film"]


def test_formulas_know_neither_roughness_nor_constant_viscosity():
    text = template()
    start, end = text.index("[film]"), text.index("[dynamics]")
    text = f'{text[:start]}[film]\nmodel = "dowson"\n{ROUGH}{text[end:]}'
    assert "knows no [roughness]" in faults(text)["film.model"]
    text = text.replace(ROUGH, "").replace("per_GPa = 19.6", "per_GPa = 0")
    assert "pressure leaves" in faults(text)["film.model"]


@pytest.mark.parametrize("film", ['supply = "oil-layer"\noil_layer_um = 0.1', ROUGH])
def test_what_the_film_needs_is_asked_for(film: str):
    text = template()
    oil, end, start = text.index("[lubricant]"), text.index("[stiffness]"), text.index("[film]")
    text = f"{text[:oil]}{text[end:start]}[film]\n{film}\n{text[text.index('[dynamics]') :]}"
    text = text.replace('"film", ', "", 1)
    assert "[lubricant]" in faults(text)


def test_an_oil_by_its_grade_is_that_of_the_film_solver():
    from ehl import Lubricant

    more = 'viscosity_index = 150\nbase = "pao"\ndensity_15_kg_per_m3 = 840\n'
    found = lubricant(parse_scene(changed((NUMBERS, GRADE + more))))
    assert found == Lubricant.from_iso_vg(100, 333.15, viscosity_index=150.0, base="pao", density_15=840.0)


def test_a_fault_that_only_the_oils_laws_know_names_the_scenes_key():
    scene = parse_scene(changed((NUMBERS, GRADE.replace("100", "7") + "viscosity_index = 0\n")))
    with pytest.raises(InputError) as caught:
        lubricant(scene)
    assert [fault.where for fault in caught.value.faults] == ["lubricant.viscosity_index"]


def test_laws_of_viscosity():
    barus = lubricant(parse_scene(changed((NUMBERS, NUMBERS + 'viscosity_law = "barus"\n'))))
    assert isinstance(barus.law, Barus)
    assert barus.law.slope == pytest.approx(19.6e-9)
    constant = 'viscosity_Pa_s = 0.075\nviscosity_law = "constant"\n'
    assert lubricant(parse_scene(changed((NUMBERS, constant)))).law == ConstantViscosity()
    for law, kind in (("barus", Barus), ("constant", ConstantViscosity)):
        graded = lubricant(parse_scene(changed((NUMBERS, GRADE + f'viscosity_law = "{law}"\n'))))
        assert isinstance(graded.law, kind)


def supply_of(scene, contact):
    return films.supply_of(film_model(scene, "ehl").supply, contact)


def test_supplies():
    c = contact()
    assert supply_of(parse_scene(template()), c) is None
    layer = parse_scene(changed((SUPPLY, 'supply = "oil-layer"\noil_layer_um = 0.11')))
    held = supply_of(layer, c)
    assert isinstance(held, OilLayer)
    assert held.thickness == pytest.approx(0.11e-6)
    relative = parse_scene(changed((SUPPLY, 'supply = "meniscus"\nmeniscus_half_widths = 1.5')))
    assert supply_of(relative, c) == Meniscus(-1.5 * c.half_width)
    fixed = parse_scene(changed((SUPPLY, 'supply = "meniscus"\nmeniscus_mm = 0.2')))
    placed = supply_of(fixed, c)
    assert isinstance(placed, Meniscus)
    assert placed.position == pytest.approx(-2e-4)
    with pytest.raises(InputError, match=r"film\.meniscus_mm"), under_keys(fixed.film, "film"):
        supply_of(fixed, contact(load=4.434e6))


def test_roughness_in_si():
    scene = parse_scene(changed(("[stiffness]", ROUGH + "[stiffness]")))
    rough = roughness(scene)
    assert rough is not None
    assert (rough.deviation, rough.density, rough.tip_radius) == pytest.approx((0.3e-6, 2.5e10, 10e-6))
    assert rough.law == "greenwood-tripp"
    assert roughness(parse_scene(template())) is None


@pytest.mark.parametrize(
    "film", ['supply = "oil-layer"\noil_layer_um = 0.1', 'grid = "article"', ROUGH, ""], ids=str.split
)
def test_auto_solves_what_no_formula_knows(film: str, monkeypatch):
    text = template()
    text = f"{text[: text.index('[film]')]}[film]\n{film}\n{text[text.index('[dynamics]') :]}"
    text = text.replace('"film", ', "", 1).replace("tolerance = 0.005", "tolerance = 0.01")
    # the whole tolerance is the film's: no share of it for the order of a series
    assert 'fourier_order = "auto"' in text
    text = text.replace('fourier_order = "auto"', "fourier_order = 1")
    from flankfilm.files.cache import Cache

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        model = Engine(parse_scene(text), Cache(None))[PLAN].film.choice
    assert model == ("ehl" if film else "none")


def test_a_wanted_film_is_solved_without_a_film_section():
    from flankfilm.files.cache import Cache

    text = template()
    scene = parse_scene(f"{text[: text.index('[film]')]}{text[text.index('[dynamics]') :]}")
    assert Engine(scene, Cache(None))[PLAN].film.choice == "ehl"


@pytest.mark.parametrize(
    ("keys", "sigma_um"),
    [
        ("Ra_um = 0.4", 0.4 * 1.2533141 * 2**0.5),
        ("Ra_um = 0.3\nwheel_Ra_um = 0.4", 0.5 * 1.2533141),
        ("Rz_um = 2.4", 0.4 * 1.2533141 * 2**0.5),
        ("sigma_um = 0.7", 0.7),
    ],
)
def test_roughness_as_drawings_have_it(keys: str, sigma_um: float):
    rough = roughness(parse_scene(f"{template()}\n[roughness]\n{keys}\n"))
    assert rough is not None
    assert 1e6 * rough.deviation == pytest.approx(sigma_um, rel=1e-6)
    assert rough.number == pytest.approx(0.04)
    given = f"{template()}\n[roughness]\n{keys}\ndensity_per_mm2 = 25000\ntip_radius_um = 10\n"
    with pytest.warns(RangeWarning, match="sigma beta eta"):
        known = roughness(parse_scene(given))
    assert known is not None
    assert (known.density, known.tip_radius) == pytest.approx((25e9, 10e-6))


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ("", "one of Ra_um, Rz_um and sigma_um, not none"),
        ("Ra_um = 0.4\nsigma_um = 0.5", "not Ra_um and sigma_um"),
        ("Rz_um = 2.4\nwheel_Ra_um = 0.4", "must have Ra_um of the pinion"),
    ],
)
def test_roughness_has_one_measure(keys: str, said: str):
    assert said in faults(f"{template()}\n[roughness]\n{keys}\n")["roughness"]
