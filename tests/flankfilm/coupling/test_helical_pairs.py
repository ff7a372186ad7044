"""Closed forms and films on them refuse helical pairs, whatever the model of their stiffness."""

from __future__ import annotations

import math

import numpy as np
import pytest

from base import InputError
from ehl import Lubricant
from flankfilm import coupling
from gears import Gear, GearPair

PAIR = GearPair(Gear(teeth=24), Gear(teeth=31), 2e-3, 20e-3, helix_angle=math.radians(15.0))
OIL = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)

ASKED = {
    "mesh cycle": lambda: coupling.mesh_cycle(PAIR, 100.0, model="potential-energy"),
    "loaded teeth": lambda: coupling.LoadedTeeth(PAIR, 100.0, "ishikawa", "independent"),
    "single pairs": lambda: coupling.single_pair_stiffness(
        PAIR, 1e3, np.array([PAIR.points.C]), "weber-banaschek"
    ),
    "films": lambda: coupling.lubricated_cycle(
        PAIR, 100.0, 200.0, OIL, model="potential-energy", film=coupling.FilmModel("dowson")
    ),
    "closed forms beside": lambda: coupling.compare_closed_forms(PAIR, 100.0),
}


@pytest.mark.parametrize("name", ASKED)
def test_what_knows_spur_gears_alone_refuses_a_helix(name):
    with pytest.raises(InputError, match=r"pair.helix_angle = 0.261799 rad \(15 deg\): must be 0 for"):
        ASKED[name]()
