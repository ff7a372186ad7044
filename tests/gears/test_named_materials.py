"""Named materials against printed elasticity factors, and names in scenes."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from base import InputError
from flankfilm.building.pair import gear_pair
from flankfilm.scene import parse_scene
from gears import MATERIALS, Gear, GearPair, GeometryError, Material, closed_form, named_material

SCENE = """
wants = ["geometry"]
[pair]
module_mm = 2
face_width_mm = 20
pinion = { teeth = 20 }
wheel = { teeth = 40 }
"""


@pytest.mark.parametrize(
    ("wheel", "printed"), [("steel 18CrNiMo7-6", 189.8), ("cast steel", 188.9), ("steel C45", 189.8)]
)
def test_elasticity_factors_of_the_standard(wheel, printed):
    """Z_E of steel with each, as ISO 6336-2 prints it in sqrt(MPa)."""
    pair = GearPair(
        Gear(20), Gear(40), 2e-3, 2e-2, material=(named_material("steel 16MnCr5"), named_material(wheel))
    )
    assert pytest.approx(printed, abs=0.1) == closed_form.iso6336_2(pair, 1e3).Z_E / 1e3


def test_each_is_a_sound_material_with_its_source():
    for name, known in MATERIALS.items():
        assert known.material.faults() == (), name
        assert len(known.source) > 20
        assert 0.0 < known.scatter < 0.5
    with pytest.raises(GeometryError, match="must be a name of the list"):
        named_material("unobtainium")


def test_plastics_say_what_temperature_and_time_do():
    for name, known in MATERIALS.items():
        plastic = known.material.youngs_modulus < 30e9
        assert plastic == bool(known.material.thermal_expansion > 50e-6), name
        if plastic:
            assert "creep" in known.note
            assert "temperature" in known.note or "degC" in known.note or "humidity" in known.note


def test_the_page_has_every_material_with_its_constants():
    page = Path("docs/howto/materials.md").read_text(encoding="utf-8")
    rows = [line.split("|")[1:-1] for line in page.splitlines() if line.startswith("| `")]
    printed = {name.strip(" `"): cells for name, *cells in rows}
    for name in ("cast steel", "EN-GJL-250", "PA66 dry", "PA66 conditioned", "POM", "PEEK"):
        known = MATERIALS[name].material
        E, nu, density, expansion = (float(cell) for cell in printed[name][:4])
        assert (E * 1e9, nu, density) == pytest.approx(
            (known.youngs_modulus, known.poisson_ratio, known.density)
        )
        assert expansion * 1e-6 == pytest.approx(known.thermal_expansion)
        k, c = (float(cell) for cell in printed[name][4].split(","))
        assert (k, c) == (known.conductivity, known.heat_capacity)
        assert float(printed[name][5].strip(" %")) == pytest.approx(100 * MATERIALS[name].scatter)


def test_names_in_scenes():
    both = gear_pair(parse_scene(f'{SCENE}[material]\nname = "steel 42CrMo4"\n'))
    assert both.materials == (named_material("steel"), named_material("steel"))
    own = '[material.pinion]\nname = "steel"\n[material.wheel]\nname = "PA66 dry"\nyoungs_modulus_GPa = 2.1\n'
    pair = gear_pair(parse_scene(SCENE + own))
    nylon = named_material("PA66 dry")
    assert pair.materials[1] == replace(nylon, youngs_modulus=2.1e9)
    plain = "[material]\nyoungs_modulus_GPa = 100\npoisson_ratio = 0.25\n"
    assert gear_pair(parse_scene(SCENE + plain)).materials[0] == Material(100e9, 0.25, 7850.0)
    for text, said in (
        ('[material]\nname = "unobtainium"\n', "material.name"),
        ("[material]\npoisson_ratio = 0.3\n", "must have a name, or youngs_modulus_GPa"),
        ('[material.pinion]\nname = "steel"\n[material.wheel]\npoisson_ratio = 0.3\n', "or a name"),
        (
            '[material]\nname = "steel"\n[material.pinion]\nname = "steel"\n[material.wheel]\nname = "steel"\n',
            "not both",
        ),
    ):
        with pytest.raises(InputError, match=said):
            parse_scene(SCENE + text)


def test_steel_on_steel_by_formula():
    steel = named_material("steel")
    assert math.sqrt(steel.plane_strain_modulus / (2 * math.pi)) / 1e3 == pytest.approx(189.8, abs=0.1)
