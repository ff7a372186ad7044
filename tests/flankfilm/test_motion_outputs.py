"""What studies say of the motion, against known folds, the discs' inertia and the flow itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dynamics
from base import InputError
from flankfilm.files.cache import Cache
from flankfilm.scene import parse_scene
from flankfilm.stages.engine import Engine
from flankfilm.studies.outputs import OUTPUTS
from tests.flankfilm.scenes import ARTICLE

OWN = """
wants = ["sweep", "diagram"]
[stiffness]
model = "given"
amplitudes = [0.18]
phases_deg = [0]
[dynamics]
damping_ratio = 0.05
mean_force = 0.1
error_amplitude = 0.2
half_backlash = 0.2
sweep = { frequency = [0.6, 0.7], points = 3 }
diagram = { frequency = [0.56, 0.7], max_period = 1, searches = 2 }
"""

PAIR = f"""
wants = ["fourier"]
{ARTICLE}
[stiffness]
model = "given"
mean_N_per_m = 7.6e8
amplitudes = [0.18]
phases_deg = [0.0]
[dynamics]
damping_ratio = 0.05
error_amplitude_um = 10
sweep = {{ speed_rpm = [2000, 4000], points = 5 }}
"""


def values(text: str, wants: set[str]) -> dict[str, float]:
    engine = Engine(parse_scene(text), Cache(None))
    known = {name: one for name, one in OUTPUTS.items() if set(one.wants) <= wants and name not in OF_TRAINS}
    return {name: one.value(engine) for name, one in known.items()}


OF_TRAINS = {
    *("lowest_drive_frequency_Hz", "drive_mesh_frequency_Hz", "drive_frequency_error"),
    *("greatest_bearing_force_N", "greatest_shaft_torque_Nm", "drive_sweep_error", "drive_valid_to_Hz"),
    *("greatest_bearing_force_error", "greatest_shaft_torque_error", "drive_sampling_error"),
    *("greatest_bearing_force_model_error", "greatest_shaft_torque_model_error"),
    *("drive_tilt_stiffness_Nm_per_rad", "drive_load_centre_mm", "drive_tilt_change"),
    *("drive_load_travel_mm", "drive_load_travel_error"),
    *(f"greatest_{of}_{what}" for of in ("run_up", "map") for what in ("bearing_force_N", "shaft_torque_Nm")),
}
"""Outputs that need [shafts]: tests/flankfilm/test_drive_scene.py."""


def test_what_drive_trains_carry_is_refused_without_shafts():
    engine = Engine(parse_scene(OWN), Cache(None))
    for name in OF_TRAINS:
        with pytest.raises(InputError, match=r"shafts|pair"):
            OUTPUTS[name].value(engine)


@pytest.fixture(scope="module")
def own() -> dict[str, float]:
    return values(OWN, {"sweep", "diagram"})


def test_first_jumps_are_the_known_folds(own):
    assert own["jump_frequency_rising"] == pytest.approx(0.6555759637891, abs=1e-10)
    assert own["jump_frequency_falling"] == pytest.approx(0.5694026368887, abs=1e-10)
    assert math.isnan(own["jump_speed_rising_rpm"])  # in its own units it has no speed
    assert math.isnan(own["jump_error_rising"])


def test_forces_and_losses_of_contact_are_those_of_the_flow(own):
    oscillator = dynamics.GearOscillator(
        dynamics.FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, 0.2
    )
    forces, apart = [], []
    for way in ("up", "down"):
        found = dynamics.sweep(oscillator, "frequency", np.array([0.6, 0.65, 0.7]), way)
        for frequency, states, periods in zip(found.values, found.states, found.periods, strict=True):
            here = oscillator.with_parameter("frequency", float(frequency))
            motion = dynamics.trajectory(here, states[-1], periods=int(periods), points_per_period=4000)
            bearing = np.maximum(motion.x - 0.2, 0.0) + np.minimum(motion.x + 0.2, 0.0)
            stiffness = 1.0 + 0.18 * np.cos(frequency * motion.tau)
            forces.append((stiffness * bearing).max() / 0.1)
            apart.append(100 * np.mean(motion.x < 0.2))
    assert own["greatest_force_factor"] == pytest.approx(max(forces), rel=1e-3)
    assert own["separated_percent"] == pytest.approx(max(apart), abs=0.3)


def test_the_natural_frequency_is_that_of_two_discs():
    found = values(PAIR, {"fourier"})
    inertias = [
        0.5 * math.pi * 7850 * 0.04 * (r**4 - bore**4) for r, bore in ((36e-3, 16.75e-3), (40e-3, 18.75e-3))
    ]
    bases = [r * math.cos(math.radians(20)) for r in (36e-3, 40e-3)]
    mass = 1 / sum(base**2 / inertia for base, inertia in zip(bases, inertias, strict=True))
    natural = math.sqrt(7.6e8 / mass) / (2 * math.pi)
    assert found["natural_frequency_Hz"] == pytest.approx(natural, rel=1e-9)
    assert found["resonance_speed_rpm"] == pytest.approx(60 * natural / 36, rel=1e-9)
    assert math.isnan(found["natural_frequency_error"])  # of a given stiffness it is not known
