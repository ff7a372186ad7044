"""Drive trains of pairs: balance of torques and bearing forces, rigid shafts, modes, faults."""

from __future__ import annotations

import math

import numpy as np
import pytest

import dynamics
from base import InputError
from flankfilm.coupling import drive_sweep, given_series, mesh_cycle, mesh_series, pair_drive, pair_oscillator
from gears import Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(36, bore_radius=0.01675), Gear(40, bore_radius=0.01875), 2e-3, 0.04).with_backlash(50e-6)
SPEED = 209.44


@pytest.fixture(scope="module")
def cycle():
    return mesh_series(mesh_cycle(PAIR, 600.0, model="potential-energy"), order=1)


def shaft(gear=0.06, torque=0.0, stiffness=4e8) -> Shaft:
    return Shaft(
        (ShaftSegment(0.2, 0.035),), (Bearing(0.02, stiffness), Bearing(0.18, stiffness)), gear, torque
    )


def test_torques_and_bearings_carry_the_load(cycle):
    """Over a period shafts carry the torques, bearings the normal force by the lever: momentum leaves nothing else."""
    drive = pair_drive(
        PAIR,
        cycle,
        600.0,
        SPEED,
        shafts=(shaft(), shaft(0.1)),
        end_inertias=(0.02, 0.05),
        error_amplitude=5e-6,
    )
    swept = drive_sweep(drive, speed=[290.0, 300.0])
    force = 600.0 / PAIR.base_radii[0]
    shares = [0.12 / 0.16, 0.04 / 0.16], [0.5, 0.5]
    forces = [force * share for side in shares for share in side]
    assert swept.bearings == ("pinion bearing 1", "pinion bearing 2", "wheel bearing 1", "wheel bearing 2")
    assert swept.shafts == ("pinion shaft", "wheel shaft")
    for way in ("up", "down"):
        for figure, mean in (("bearing_force", forces), ("shaft_torque", (600.0, 600.0 * 40 / 36))):
            # what a sweep leaves of the transient, 1e-6
            mean_of, swing, greatest = (
                getattr(swept, f"{figure}{kind}")[way] for kind in ("_mean", "_swing", "")
            )
            assert mean_of == pytest.approx(np.tile(mean, (2, 1)), rel=2e-6)
            assert np.all(greatest >= mean_of)
            assert np.all(swing > 0.0)
    assert swept.greatest_bearing_force == swept.bearing_force_peak.max()
    for way in ("up", "down"):
        assert np.all(swept.bearing_force_peak >= swept.bearing_force[way].max(axis=0))
        assert np.all(swept.shaft_torque_peak >= swept.shaft_torque[way].max(axis=0))
    assert swept.converged
    assert swept.sampling_error < 1e-3


def test_dampers_of_bearings_move_with_their_springs(cycle):
    """Where every damper is a hundredth of a millisecond of its spring, so is what it carries."""
    beta = 1e-5
    bearings = tuple(Bearing(at, k, beta * k) for at, k in ((0.02, 4e8), (0.18, 3e8)))
    damped = Shaft((ShaftSegment(0.2, 0.035),), bearings, 0.06, 0.0)
    drive = pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(damped, damped), end_inertias=(0.02, 0.05))
    carried = [one for one in drive.outputs if "bearing" in one.name]
    assert len(carried) == 4
    for one in carried:
        assert np.any(one.displacement)
        assert one.speed == pytest.approx(beta * drive.rigid.scales.omega_n * one.displacement, rel=1e-9)


def test_a_mode_is_met_at_the_speed_whose_meshes_have_its_frequency(cycle):
    drive = pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(shaft(), shaft(0.1)), end_inertias=(0.02, 0.05))
    meshes = drive.resonance_speeds * PAIR.pinion.teeth / (2.0 * math.pi)
    assert meshes == pytest.approx(drive.natural_frequencies, rel=1e-12)


def test_without_shafts_it_is_the_pair(cycle):
    """Two free gears: the relative motion is that of `pair_oscillator`, multipliers and all."""
    ours = pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(None, None), error_amplitude=5e-6)
    theirs = pair_oscillator(PAIR, cycle, 600.0, SPEED, error_amplitude=5e-6).oscillator
    orbit, other = (dynamics.find_orbit(o, o.rest_state(), transient=400) for o in (ours.oscillator, theirs))
    x, v = ours.oscillator.contact_motion(np.zeros(1), orbit.state[None])
    assert ours.freedoms == ("pinion gear", "wheel gear")
    assert np.concatenate([x, v]) == pytest.approx(other.state, abs=1e-12)
    assert orbit.multipliers[:2] == pytest.approx(other.multipliers, abs=1e-12)
    assert ours.natural_frequencies == pytest.approx([ours.rigid.natural_frequency], rel=1e-12)
    assert ours.outputs == ()


def test_stiff_shafts_come_to_rigid_ones(cycle):
    """Shafts and bearings 1e4 times as stiff as the mesh: the mesh mode is the rigid pair's, to 1e-3; and solved."""
    thick = Shaft((ShaftSegment(0.02, 0.2),), (Bearing(0.0, 1e13), Bearing(0.02, 1e13)), 0.01, 0.01)
    drive = pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(thick, thick))
    felt = drive.shafts[0]
    inertias = [inertia + felt.inertia[0, 0] for inertia in PAIR.moments_of_inertia]
    whole = pair_oscillator(PAIR, cycle, 600.0, SPEED, extra_inertia=(felt.inertia[0, 0],) * 2)
    assert drive.natural_frequencies[0] == pytest.approx(whole.natural_frequency, rel=1e-2)
    assert inertias[0] > PAIR.moments_of_inertia[0]
    orbit = dynamics.find_orbit(drive.oscillator, drive.oscillator.rest_state(), transient=100)
    assert orbit.converged


def test_lowest_mode_is_that_of_the_ends(cycle):
    """Heavy motor and load on soft shafts: two inertias on springs in series, the gears beside them hardly count."""
    heavy = (2.0, 5.0)
    drive = pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(shaft(), shaft()), end_inertias=heavy)
    ratio = 40 / 36
    first, second = (felt.torsion_stiffness for felt in drive.shafts)
    mesh = drive.rigid.scales.mean_stiffness * PAIR.base_radii[0] ** 2
    side = [felt.bending_stiffness * PAIR.base_radii[0] ** 2 for felt in drive.shafts]
    series = 1.0 / (1.0 / first + ratio**2 / second + 1.0 / mesh + sum(1.0 / s for s in side))
    reduced_inertia = 1.0 / (1.0 / heavy[0] + ratio**2 / heavy[1])
    expected = math.sqrt(series / reduced_inertia) / (2 * math.pi)
    assert drive.natural_frequencies[0] == pytest.approx(expected, rel=5e-3)


@pytest.mark.parametrize(
    ("changes", "where"),
    [
        ({"end_inertias": (-1.0, 0.0)}, "end_inertias.pinion"),
        ({"shaft_damping_ratio": 2.0}, "shaft_damping_ratio[0]"),
        ({"shaft_damping_ratio": ()}, "shaft_damping_ratio"),
        ({"reduction_tolerance": 0.0}, "reduction_tolerance"),
        ({"damping_band": (0.0, 2.0)}, "damping_band[0]"),
    ],
)
def test_what_is_no_drive(cycle, changes, where):
    with pytest.raises(InputError) as raised:
        pair_drive(PAIR, cycle, 600.0, SPEED, shafts=(shaft(), shaft()), **changes)
    assert raised.value.faults[0].where == where


def test_series_without_a_cycle():
    series = given_series(8e8, [0.18], [0.0])
    drive = pair_drive(PAIR, series, 600.0, SPEED, shafts=(shaft(), None))
    assert drive.error is None
    assert drive.freedoms == (
        "pinion gear", "pinion end", "pinion deflection", "pinion tilt", "wheel gear"
    )  # fmt: skip
