"""Scenes with temperatures, pressed teeth and a braking pinion."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from flankfilm import coupling
from flankfilm.building.pair import gear_pair
from flankfilm.coupling.mesh.flanks import PLAIN_FLANKS
from flankfilm.files.cache import Cache
from flankfilm.scene.reader import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import HEAT, PAIR, loaded_teeth

WARM = """
wants = ["geometry"]
tolerance = 0.02
[pair]
module_mm = 2.0
face_width_mm = 40.0
pinion = { teeth = 36, bore_mm = 33.5 }
wheel = { teeth = 40, bore_mm = 37.5 }
backlash_um = 50
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[heat]
pinion_temperature_C = 100.0
wheel_temperature_C = 70.0
housing_temperature_C = 50.0
[operating]
pinion_torque_Nm = -300.0
"""


def test_a_braking_pinion_and_a_warm_pair_in_a_scene():
    scene = parse_scene(WARM)
    engine = Engine(scene, Cache(None))
    warm = engine[HEAT]
    assert engine[PAIR] == warm.pair
    assert warm.cold_backlash == pytest.approx(50e-6)
    assert 25e-6 < warm.backlash < 35e-6
    teeth = loaded_teeth(engine, by_elements=True)
    assert teeth.torque == -300.0
    assert teeth.flanks.base_pitch_difference == warm.base_pitch_difference > 0.0
    cycle = teeth.cycle(10)
    assert cycle.contact.flank == "back"
    assert not cycle.contact.moving_contact  # of steel
    assert np.all(cycle.transmission_error < -warm.backlash)
    closed = replace(teeth, model="potential-energy", pairs="coupled", flanks=PLAIN_FLANKS, compliance=None)
    braking, driving = closed.cycle(10), replace(closed, torque=300.0).cycle(10)
    assert braking.mean_secant_stiffness == pytest.approx(driving.mean_secant_stiffness, rel=1e-6)
    assert braking.transmission_error.max() < -warm.backlash
    motion = coupling.pair_oscillator(
        engine[PAIR], braking, -300.0, 100.0, error_amplitude=1e-6, fourier_order=1
    )
    assert motion.mean_force == pytest.approx(0.1)
    assert motion.backlash == pytest.approx(warm.backlash)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        (
            "wheel_temperature_C = 70.0",
            "wheel_temperature_C = 200.0",
            r"heat\.wheel_temperature_C = 200: must be at most",
        ),
        ("wheel_temperature_C = 70.0", "wheel_temperature_C = 2000.0", r"heat\.wheel_temperature_C"),
        ("pinion_torque_Nm = -300.0", "pinion_torque_Nm = 0.0", r"operating\.pinion_torque_Nm"),
        (
            "poisson_ratio = 0.3",
            "poisson_ratio = 0.3\nthermal_expansion_per_K = 0.1",
            "thermal_expansion_per_K",
        ),
        (
            "[material]",
            'tight = true\n[stiffness]\nmodel = "ishikawa"\n[material]',
            'must be "fem" for pair.tight',
        ),
    ],
)
def test_what_warm_scenes_refuse(old, new, said):
    with pytest.raises(InputError, match=said):
        gear_pair(parse_scene(WARM.replace(old, new)))


@pytest.mark.slow
def test_pressed_teeth_of_a_warm_pair():
    hot = WARM.replace("wheel_temperature_C = 70.0", "wheel_temperature_C = 180.0").replace(
        "[pair]", "[pair]\ntight = true"
    )
    engine = Engine(parse_scene(hot), Cache(None))
    assert engine[PAIR].backlash < 0.0
    cycle = replace(loaded_teeth(engine, by_elements=True), torque=5.0).cycle(6)
    assert np.all(cycle.contact.opposite_force > 0.0)
    with pytest.raises(InputError, match="must be at least 0 for the motion"):
        coupling.pair_oscillator(engine[PAIR], cycle, 5.0, 100.0)
