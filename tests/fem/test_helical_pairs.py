"""Finite elements refuse helical pairs: operators of spur gears would give numbers that look sound."""

from __future__ import annotations

import math

import numpy as np
import pytest

import fem
from base import Faults, InputError
from fem.influence.gear_shape import shapes
from fem.laws.mesh_setup import MeshSetup
from gears import Gear, GearPair

GEARS = Gear(teeth=24), Gear(teeth=31)
HELICAL = GearPair(*GEARS, 2e-3, 20e-3, helix_angle=math.radians(20.0))
SLIGHT = GearPair(*GEARS, 2e-3, 20e-3, helix_angle=-1e-9)
MESSAGE = r"pair.helix_angle = .*deg\): must be 0 for .*spur gears"

ASKED = {
    "compliance": fem.compliance,
    "fillets": fem.fillets,
    "mesh_cycle": lambda pair: fem.mesh_cycle(pair, torque=100.0),
    "mesh_cycle of torques": lambda pair: fem.mesh_cycle(pair, torque=[50.0, 100.0]),
    "slices": lambda pair: fem.mesh_cycle(pair, torque=100.0, cells=8, face_model="slices"),
    "single pair": lambda pair: fem.single_pair_stiffness(pair, force=1e3, rho1=pair.points.C),
    "unloaded": fem.unloaded_transmission_error,
    "shapes": lambda pair: shapes(pair, pair.teeth_profiles, "strain"),
}


@pytest.mark.parametrize("pair", [HELICAL, SLIGHT], ids=["20 deg", "slight"])
@pytest.mark.parametrize("name", ASKED)
def test_whatever_is_asked_of_finite_elements_is_refused_by_key_value_and_remedy(name, pair):
    with pytest.raises(InputError, match=MESSAGE) as refusal:
        ASKED[name](pair)
    assert "Give helix_angle = 0" in str(refusal.value)
    assert "contact_lines" in str(refusal.value)


def test_bodies_of_a_spur_pair_do_not_open_the_way():
    bodies = fem.compliance(GearPair(*GEARS, 2e-3, 20e-3), tolerance=0.1)
    with pytest.raises(InputError, match=MESSAGE):
        fem.mesh_cycle(HELICAL, torque=100.0, compliance=bodies)
    with pytest.raises(InputError, match=MESSAGE):
        fem.single_pair_stiffness(HELICAL, force=1e3, rho1=HELICAL.points.C, compliance=bodies)


def test_a_setup_notes_it_once_beside_other_faults_and_none_of_spur_pairs():
    faults = Faults()
    MeshSetup(HELICAL, positions=0).check(faults)
    assert sorted(fault.where for fault in faults.found) == ["pair.helix_angle", "positions"]
    spur = Faults()
    MeshSetup(GearPair(*GEARS, 2e-3, 20e-3, helix_angle=0.0)).check(spur)
    assert not spur.found
    assert np.all(fem.unloaded_transmission_error(GearPair(*GEARS, 2e-3, 20e-3), 3) == 0.0)
