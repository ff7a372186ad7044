"""Drive trains that are hard to reduce: soft, overhung and stepped shafts, torque through the far end, forty modes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.linalg import eigh

import dynamics
from flankfilm.coupling import given_series, pair_drive
from flankfilm.coupling.drive.drive_reduced import drive_squares
from gears import Bearing, Gear, GearPair, Material, Shaft, ShaftSegment

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04).with_backlash(50e-6)
SERIES = given_series(8e8, [0.1, 0.05])
STEEL_AS_RUBBER = Material(youngs_modulus=2.06e9, poisson_ratio=0.3, density=7850.0)


def shaft(gear=0.1, torque=0.0, bearings=(0.02, 0.18), steps=1, **more) -> Shaft:
    parts = tuple(ShaftSegment(0.2 / steps, 0.035 + 0.001 * (k % 2)) for k in range(steps))
    return Shaft(parts, tuple(Bearing(z, 4e8) for z in bearings), gear, torque, **more)


CASES = {
    "100 times softer": (shaft(material=STEEL_AS_RUBBER), shaft(0.06, material=STEEL_AS_RUBBER)),
    "beyond both bearings": (shaft(0.19, bearings=(0.02, 0.08)), shaft(0.0, 0.2, bearings=(0.15, 0.2))),
    "bearings under the gear": (shaft(0.1, bearings=(0.09, 0.11)), shaft(0.1, 0.2, bearings=(0.1, 0.19))),
    "torque through the far end": (shaft(0.02, 0.2), shaft(0.18, 0.0)),
    "torque at the gear": (shaft(0.1, 0.1), None),
    "sixty steps": (shaft(steps=60), None),
}


@pytest.mark.parametrize("case", list(CASES))
def test_a_train_that_is_hard_to_reduce(case):
    """Frequencies from above and near, means by levers, forces within the tolerance, and a motion that settles."""
    shafts = CASES[case]
    drive = pair_drive(
        PAIR, SERIES, 300.0, 300.0, shafts=shafts, end_inertias=(0.02, 0.05), error_amplitude=2e-6,
        speeds=(100.0, 800.0), shaft_damping_ratio=0.02,
    )  # fmt: skip
    train = drive.shaft_damping.train
    exact = np.sqrt(eigh(train.in_contact.toarray(), train.mass.toarray(), eigvals_only=True)[1:])
    found = np.sqrt(drive_squares(drive.oscillator)) * drive.scales.omega_n
    assert np.all(found >= exact[: len(found)] * (1.0 - 1e-8))
    assert np.all(drive.reduction_change < 1e-6)
    assert drive.reduction_error <= 0.05
    assert drive.valid_to >= 36.0 * 800.0 / (2.0 * math.pi) * (1.0 - 1e-9)
    assert np.all(drive.element_error[drive.natural_frequencies < drive.valid_to] < 0.01)
    still = pair_drive(
        PAIR, SERIES, 300.0, 300.0, shafts=shafts, end_inertias=(0.02, 0.05), speeds=(100.0, 800.0)
    )
    rest, force = still.oscillator.rest_state()[None], 300.0 / PAIR.base_radii[0]
    carried = {one.name: float(one.of(rest)[0]) for one in still.outputs}
    for side, one in zip(("pinion", "wheel"), shafts, strict=True):
        if one is None:
            continue
        left, right = (bearing.position for bearing in one.bearings)
        lever = (one.gear_position - left) / (right - left)
        assert carried[f"{side} bearing 1"] == pytest.approx(
            force * (1.0 - lever), rel=1e-6, abs=1e-6 * force
        )
        assert carried[f"{side} bearing 2"] == pytest.approx(force * lever, rel=1e-6, abs=1e-6 * force)
        if one.gear_position != one.torque_position:
            torque = 300.0 * (1.0 if side == "pinion" else 40 / 36)
            assert carried[f"{side} shaft"] == pytest.approx(torque, rel=1e-6)
    orbit = dynamics.find_orbit(drive.oscillator, drive.oscillator.rest_state(), transient=50)
    assert orbit.converged, orbit.message
    assert orbit.error < 1e-9


@pytest.mark.slow
def test_forty_modes():
    """A long thin train up to high speeds: more than forty freedoms, and forces as the unreduced train has them."""
    long = Shaft(
        (ShaftSegment(0.6, 0.02),), (Bearing(0.02, 4e8), Bearing(0.3, 4e8), Bearing(0.58, 4e8)), 0.2, 0.0
    )
    drive = pair_drive(
        PAIR, SERIES, 100.0, 300.0, shafts=(long, long), end_inertias=(0.02, 0.05), error_amplitude=2e-6,
        speeds=(300.0, 2500.0), reduction_tolerance=0.02,
    )  # fmt: skip
    assert drive.oscillator.dimension >= 80
    assert drive.reduction_error <= 0.02
    orbit = dynamics.find_orbit(drive.oscillator, drive.oscillator.rest_state(), transient=200)
    assert orbit.converged, orbit.message
    assert orbit.error < 1e-8
