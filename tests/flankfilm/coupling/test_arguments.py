"""Arguments that are no numbers, no pair or no record: an error that names them, not a bare one from within."""

from __future__ import annotations

import numpy as np
import pytest

import fem
import flankfilm as ff
from base import InputError
from ehl import Lubricant
from gears import Gear, GearPair

PAIR = GearPair(Gear(24), Gear(31), 2e-3, 20e-3)
OIL = Lubricant(0.075, 19.6e-9, 860.0, temperature=353.15, eyring_stress=5e6)
NONSENSE = ("180", None, b"1", pytest.param(object(), id="object"), [1.0, "a"], [[1.0], [2.0, 3.0]], 1j, {})


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, 0.05)


def named(call, name: str) -> None:
    with pytest.raises(InputError) as error:
        call()
    assert any(str(fault.where).split("[")[0] == name for fault in error.value.faults), str(error.value)


@pytest.mark.parametrize("value", NONSENSE, ids=str)
@pytest.mark.parametrize("name", ["torque", "pair", "positions", "base_pitch_difference", "friction"])
def test_of_a_mesh_cycle(bodies, name, value):
    given = {"pair": PAIR, "torque": 100.0, "positions": 4, "compliance": bodies} | {name: value}
    named(lambda: fem.mesh_cycle(**given), name)


@pytest.mark.parametrize("name", ["compliance", "film", "deviations", "alignment", "cells", "shafts"])
@pytest.mark.parametrize("value", ["180", pytest.param(object(), id="object"), 1j])
def test_of_a_mesh_cycle_that_may_be_left_out(bodies, name, value):
    given = {"positions": 4, "compliance": bodies, name: value}
    named(lambda: fem.mesh_cycle(PAIR, 100.0, **given), name)


@pytest.mark.parametrize("value", NONSENSE, ids=str)
def test_of_closed_forms_losses_and_compliances(bodies, value):
    model = {"model": "potential-energy", "positions": 4}
    named(lambda: ff.mesh_cycle(PAIR, value, **model), "torque")
    named(lambda: ff.mesh_cycle(value, 100.0, **model), "pair")
    named(lambda: ff.mesh_losses(PAIR, value, 100.0, OIL, **model), "torque")
    named(lambda: ff.mesh_losses(PAIR, 100.0, value, OIL, **model), "speed")
    named(lambda: ff.lubricated_cycle(PAIR, value, 100.0, OIL, model="potential-energy"), "torque")
    named(lambda: fem.compliance(value, 0.05), "pair")
    named(lambda: fem.single_pair_stiffness(PAIR, value, PAIR.points.C, bodies), "force")
    named(lambda: fem.single_pair_stiffness(PAIR, 100.0, value, bodies), "rho1")
    if value is not None:
        named(lambda: ff.mesh_cycle(PAIR, 100.0, model="potential-energy", positions=value), "positions")


def test_torques_of_any_real_kind_are_the_same(bodies):
    one = fem.mesh_cycle(PAIR, 100.0, 2, bodies)
    for torque in (100, np.float32(100.0), np.int64(100), np.array(100.0)):
        assert fem.mesh_cycle(PAIR, torque, 2, bodies).mean_stiffness == one.mean_stiffness
    assert len(fem.mesh_cycle(PAIR, np.array([50, 100]), 2, bodies)) == 2
