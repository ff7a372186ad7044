"""Losses of the mesh name what is missing, what is out of bounds, and what does not go together."""

from __future__ import annotations

from dataclasses import replace

import pytest

import flankfilm as ff
from base import InputError
from ehl import STEEL, Lubricant, Solid
from flankfilm.coupling import Flanks
from gears import Gear, GearPair, Material
from tests.validation.article import PAIR

OIL = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
PLASTIC = Material(youngs_modulus=3e9, poisson_ratio=0.4, density=1140.0)


def refused(match: str, pair: GearPair = PAIR, oil: Lubricant = OIL, **options) -> None:
    with pytest.raises(InputError, match=match):
        ff.mesh_losses(pair, 600.0, 200.0, oil, model="potential-energy", **options)


def test_a_newtonian_oil_is_refused_with_what_to_give():
    refused("eyring_stress.*must be given for losses.*5e6", oil=replace(OIL, eyring_stress=None))


def test_a_plastic_gear_is_no_steel():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, material=(PAIR.materials[0], PLASTIC))
    refused("steel, of a wheel of 3 GPa", pair=pair)
    refused("steel, of a pinion", pair=GearPair(Gear(36), Gear(40), 2e-3, 40e-3, material=PLASTIC))


@pytest.mark.parametrize(
    ("options", "match"),
    [
        ({"flanks": Flanks(friction=0.1)}, "flanks.friction"),
        ({"solids": (STEEL,)}, "solids"),
        ({"solids": (Solid(0.3, 1140.0, 1700.0), 3.0)}, "solids"),
        ({"bulk_temperatures": (353.0,)}, "bulk_temperatures.*two numbers"),
        ({"bulk_temperatures": (353.0, 80.0)}, "bulk_temperatures.*80.*at least 200"),
        ({"bulk_temperatures": (353.0, 700.0)}, "bulk_temperatures.*700.*at most 600"),
        ({"heat_transfer": (5.0, 5.0)}, "ambient_temperature.*beside heat_transfer"),
        ({"ambient_temperature": 293.15}, "heat_transfer.*beside ambient_temperature"),
        ({"heat_transfer": (5.0, 0.0), "ambient_temperature": 293.15}, "heat_transfer.*more than 0"),
        (
            {
                "heat_transfer": (5.0, 5.0),
                "ambient_temperature": 293.15,
                "bulk_temperatures": (353.0, 353.0),
            },
            "left out beside heat_transfer",
        ),
        ({"boundary_friction": 0.7}, "boundary_friction"),
        ({"boundary_band": (0.11, 0.2)}, "boundary_band"),
        ({"boundary_band": 0.1}, "boundary_band"),
        ({"roughness": 4e-7}, "roughness.*ehl.Roughness"),
        ({"positions": 1}, "positions"),
        ({"tolerance": 0.0}, "tolerance"),
    ],
)
def test_faults_name_argument_and_remedy(options, match):
    refused(match, **options)


def test_faults_are_listed_together():
    refused("(?s)flanks.friction.*positions", flanks=Flanks(friction=0.1), positions=0)
