"""What of finite elements helical pairs have, and what is refused: operators of spur gears would give sound looks."""

from __future__ import annotations

import math
from dataclasses import replace

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
    "fillets": fem.fillets,
    "single pair": lambda pair: fem.single_pair_stiffness(pair, force=1e3, rho1=pair.points.C),
}


@pytest.mark.parametrize("pair", [HELICAL, SLIGHT], ids=["20 deg", "slight"])
@pytest.mark.parametrize("name", ASKED)
def test_what_knows_spur_gears_alone_is_refused_by_key_value_and_remedy(name, pair):
    with pytest.raises(InputError, match=MESSAGE) as refusal:
        ASKED[name](pair)
    assert "Give helix_angle = 0" in str(refusal.value)
    assert "contact_lines" in str(refusal.value)


@pytest.mark.parametrize("model", ["slices", "walls"])
def test_there_are_no_walls_or_slices_of_a_helix(model):
    with pytest.raises(InputError, match="face_model"):
        fem.mesh_cycle(HELICAL, torque=100.0, cells=8, face_model=model)


def test_bodies_of_a_spur_pair_do_not_open_the_way():
    bodies = fem.compliance(GearPair(*GEARS, 2e-3, 20e-3), tolerance=0.1)
    with pytest.raises(InputError, match="of another pair"):
        fem.mesh_cycle(HELICAL, torque=100.0, compliance=bodies)
    with pytest.raises(InputError, match=MESSAGE):
        fem.single_pair_stiffness(HELICAL, force=1e3, rho1=HELICAL.points.C, compliance=bodies)


def test_a_setup_notes_a_fault_once_beside_others_and_none_of_spur_pairs():
    faults = Faults()
    MeshSetup(HELICAL, positions=0, beyond_path=False, tip_rounding=1e-5).check(faults)
    assert sorted(fault.where for fault in faults.found) == ["positions", "tip_rounding"]
    spur = Faults()
    MeshSetup(GearPair(*GEARS, 2e-3, 20e-3, helix_angle=0.0)).check(spur)
    assert not spur.found
    assert np.all(fem.unloaded_transmission_error(GearPair(*GEARS, 2e-3, 20e-3), 3) == 0.0)


def test_plain_lines_of_contact_touch_without_a_turn():
    assert np.all(fem.unloaded_transmission_error(HELICAL, 7) == 0.0)


def test_the_shape_is_that_of_either_hand():
    first, second = (
        shapes(replace(HELICAL, helix_angle=angle), HELICAL.teeth_profiles, "strain")
        for angle in (HELICAL.helix_angle, -HELICAL.helix_angle)
    )
    assert first == second
    assert first[0].profile.base_radius == pytest.approx(HELICAL.base_radii[0] / 2e-3, rel=1e-11)


@pytest.mark.parametrize("degrees", [0.0, 20.0])
def test_angles_of_numpy_are_angles(degrees):
    pair = GearPair(*GEARS, 2e-3, 20e-3, helix_angle=np.radians(degrees))
    with pytest.raises(InputError) as refusal:
        fem.mesh_cycle(pair, torque=100.0, positions=0)
    assert [fault.where for fault in refusal.value.faults] == ["positions"]
