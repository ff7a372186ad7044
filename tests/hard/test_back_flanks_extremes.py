"""Back flanks at their limits: heat that eats the backlash, overlap up to the bound, reversal through zero, jams."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from gears import Gear, GearDeviations, GearPair, Heat, Material, PitchDeviations, warm_pair

PLASTIC = Material(3e9, 0.4, 1140.0, thermal_expansion=80e-6)


@pytest.mark.slow
def test_heat_from_play_through_zero_to_pressed_teeth():
    cold = replace(GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(20e-6), tight=True)
    found = []
    for rise in (0.0, 40.0, 71.0, 72.0, 100.0):
        warm = warm_pair(cold, Heat(293.15 + rise, 293.15 + rise))
        bodies = fem.compliance(warm.pair, tolerance=0.02)
        cycle = fem.mesh_cycle(warm.pair, 20.0, 8, bodies, base_pitch_difference=warm.base_pitch_difference)
        assert cycle.converged
        found.append((warm.backlash, cycle.opposite_force.mean(), cycle.mean_stiffness))
    backlash, opposite, stiffness = np.transpose(found)
    assert np.all(np.diff(backlash) < 0.0)
    assert backlash[0] > 0.0 > backlash[-1]
    assert np.all(opposite[backlash > 0.0] == 0.0)
    assert opposite[-1] > 500.0
    assert stiffness[-1] > stiffness[0]


def test_unequal_temperatures_make_a_saw_of_the_transmission_error():
    cold = GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(80e-6)
    warm = warm_pair(cold, Heat(373.15, 323.15, 343.15))
    bodies = fem.compliance(warm.pair, tolerance=0.02)
    step = warm.base_pitch_difference
    even, uneven = (
        fem.mesh_cycle(warm.pair, 1e-3, 40, bodies, beyond_path=False, base_pitch_difference=by)
        for by in (0.0, step)
    )
    # without load the pair that is farthest on along the path carries, with a slope of one difference a base pitch
    d_0 = uneven.unloaded_transmission_error
    assert np.ptp(even.unloaded_transmission_error) == 0.0
    assert np.ptp(d_0) == pytest.approx(step * 39 / 40, rel=1e-6)
    # under a load that deflects the teeth by many times as much the load shares hardly change
    heavy = [fem.mesh_cycle(warm.pair, 2000.0, 10, bodies, base_pitch_difference=by) for by in (0.0, step)]
    assert np.abs(heavy[1].load_share - heavy[0].load_share).max() < 0.05


@pytest.mark.parametrize("overlap", [1e-9, 1e-6, 3e-5])
def test_overlap_of_any_size(overlap):
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(-overlap), tight=True)
    bodies = fem.compliance(pair, tolerance=0.02)
    rest = fem.mesh_cycle(pair, 0.0, 6, bodies)
    np.testing.assert_allclose(rest.forces.sum(axis=1), rest.opposite_force, rtol=1e-2)
    assert np.all(np.abs(rest.transmission_error - 0.5 * overlap) < 0.5 * overlap)


def test_reversal_through_zero_is_steady_where_teeth_are_pressed():
    plain = GearPair(Gear(17, 0.2), Gear(23), 2e-3, 0.02)
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(-4e-6), tight=True)
    bodies = fem.compliance(pair, tolerance=0.02)
    torques = [-30.0, -1.0, -1e-6, 0.0, 1e-6, 1.0, 30.0]
    cycles = fem.mesh_cycle(pair, torques, 6, bodies)
    moved = np.array([cycle.transmission_error for cycle in cycles])
    assert np.all(np.diff(moved, axis=0) > 0.0)
    np.testing.assert_allclose(moved[2], moved[4], rtol=0.0, atol=1e-12)
    np.testing.assert_allclose(cycles[2].stiffness, cycles[4].stiffness, rtol=1e-5)


def test_a_sweep_that_meets_zero_with_play_is_refused_with_its_remedy():
    pair = GearPair(Gear(36), Gear(40), 2e-3, 0.04).with_backlash(50e-6)
    bodies = fem.compliance(pair, tolerance=0.02)
    with pytest.raises(InputError, match="Leave it out, or give less backlash") as error:
        fem.mesh_cycle(pair, [-100.0, 0.0, 100.0], 4, bodies)
    (fault,) = error.value.faults
    assert (fault.where, fault.value) == ("torque", "0")
    assert len(fem.mesh_cycle(pair, [-100.0, 100.0], 4, bodies)) == 2


def test_a_tooth_that_jams_presses_its_own_pitches_alone():
    loose = GearPair(Gear(12, 0.3), Gear(24), 2e-3, 0.02).with_backlash(8e-6)
    pair = replace(loose, tight=True)
    cumulative = np.zeros(12)
    cumulative[5] = 20e-6
    deviations = (GearDeviations(None, PitchDeviations(tuple(cumulative))), None)
    bodies = fem.compliance(pair, tolerance=0.02)
    cycle = fem.mesh_cycle(pair, 2.0, 8, bodies, deviations=deviations, pitches=12)
    assert cycle.converged
    assert "jam" in cycle.message
    pressed = cycle.opposite_force > 0.0
    one_side = fem.mesh_cycle(
        loose, 2.0, 8, fem.compliance(loose, tolerance=0.02), deviations=deviations, pitches=12
    )
    assert "which is left out; give more backlash, or a tight pair" in one_side.message
    np.testing.assert_array_equal(one_side.forces[~pressed], cycle.forces[~pressed])
    assert 0 < pressed.sum() < len(pressed) / 3
    assert np.all(cycle.back_gap[pressed] < 5e-6)
    with pytest.raises(InputError, match="must not be 0"):
        fem.mesh_cycle(pair, 0.0, 8, bodies, deviations=deviations, pitches=12)


def test_plastic_on_steel_swells_shut():
    cold = replace(
        GearPair(
            Gear(17, 0.2, tip_alteration=-0.1),
            Gear(51, tip_alteration=-0.1),
            1e-3,
            0.01,
            material=(Material(206e9, 0.3, 7850.0), PLASTIC),
        ),
        tight=True,
    ).with_backlash(60e-6)
    warm = warm_pair(cold, Heat(313.15, 353.15, 303.15))
    assert warm.backlash < 0.0
    bodies = fem.compliance(warm.pair, tolerance=0.02)
    cycle = fem.mesh_cycle(warm.pair, 0.05, 6, bodies, base_pitch_difference=warm.base_pitch_difference)
    assert cycle.converged
    assert np.any(cycle.opposite_force > 0.0)
    np.testing.assert_allclose(cycle._moments()[0][0] * warm.pair.base_radii[0], 0.05, rtol=1e-9)
