"""Plastics at the edge of what contacts that move can do: back flanks about to bear, quarter modules, pressed teeth."""

from __future__ import annotations

import itertools
from dataclasses import replace

import numpy as np
import pytest

import fem
from gears import Gear, GearPair, Material, TipRelief

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
POM = Material(2.8e9, 0.36, 1410.0)
REMEDY = "reduce the torque, or let contacts stay"


def on_pa66(**more):
    return GearPair(Gear(17), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66), **more)


def first_bearing(pair, bodies, low, high, **options):
    """Torques just before and just after back flanks bear at some position [N m], or none up to the higher one."""

    def bears(torque):
        cycle = fem.mesh_cycle(pair, torque, 20, bodies, **options)
        assert cycle.converged, cycle.message
        return bool(np.any(cycle.opposite_force > 0.0))

    assert not bears(low)
    assert bears(high)
    while high / low > 1.0 + 1e-6:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if bears(middle) else (middle, high)
    return low, high


@pytest.mark.parametrize("beyond", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_steel_on_pa66_just_before_and_just_after_back_flanks_bear(beyond):
    """A millionth of the torque changes every figure by as much, and calls of several torques change nothing."""
    pair = on_pa66()
    bodies = fem.compliance(pair, tolerance=0.005)
    low, high = first_bearing(pair, bodies, 50.0, 100.0 if beyond else 70.0, beyond_path=beyond)
    before, after, far = fem.mesh_cycle(pair, (low, high, 1.05 * high), 20, bodies, beyond_path=beyond)
    for cycle in (before, after, far):
        assert cycle.moving_contact
    np.testing.assert_allclose(after.transmission_error, before.transmission_error, rtol=1e-5)
    np.testing.assert_allclose(after.secant_stiffness, before.secant_stiffness, rtol=1e-5)
    assert after.model_error == pytest.approx(before.model_error, rel=0.2)
    assert np.all(far.transmission_error > after.transmission_error)
    alone = fem.mesh_cycle(pair, high, 20, bodies, beyond_path=beyond)
    np.testing.assert_allclose(alone.forces, after.forces, rtol=1e-9, atol=1e-6)


def test_pom_of_a_quarter_module_is_that_of_ten_times_its_size():
    """Everything scales with the module where torques go with its cube; with overlap, both sides bear."""
    found = []
    for module in (0.25e-3, 2.5e-3):
        plain = GearPair(Gear(30, 0.1), Gear(40), module, 8 * module, material=POM)
        distance = plain.centre_distance_of_backlash(-0.005 * module)
        pair = replace(plain, centre_distance=distance, tight=True)
        bodies = fem.compliance(pair, tolerance=0.01)
        scale = (module / 1e-3) ** 3
        torques = [0.0, 0.1 * scale, 2.0 * scale]
        cycles = fem.mesh_cycle(pair, torques, 8, bodies)
        assert all(cycle.converged and cycle.moving_contact for cycle in cycles)
        assert np.all(cycles[0].opposite_force > 0.0)
        found.append([cycle.transmission_error / module for cycle in cycles])
    np.testing.assert_allclose(found[0], found[1], rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("beyond", [False, True])
@pytest.mark.parametrize(
    "materials", [(STEEL, POM), (POM, STEEL), (POM, POM)], ids=["wheel", "pinion", "both"]
)
def test_deflections_up_to_a_quarter_of_a_module_grow_steadily_or_are_refused(materials, beyond):
    """Neither drops the motion nor hides a back flank: D grows with the torque until the first order ends."""
    pair = GearPair(Gear(19, 0.2), Gear(45, -0.1), 1.5e-3, 12e-3, material=materials)
    bodies = fem.compliance(pair, tolerance=0.005)
    torques = np.linspace(2.0, 60.0, 30)
    cycles = fem.mesh_cycle(pair, torques, 10, bodies, beyond_path=beyond)
    good = [cycle for cycle in cycles if cycle.converged]
    assert [cycle.converged for cycle in cycles] == sorted(
        [cycle.converged for cycle in cycles], reverse=True
    )
    assert all(cycle.moving_contact for cycle in cycles)
    assert max(float(cycle.transmission_error.max()) for cycle in good) > 0.1 * pair.module
    for less, more in itertools.pairwise(good):
        assert np.all(more.transmission_error > less.transmission_error)
    errors = [cycle.model_error for cycle in good]
    assert errors == sorted(errors)
    assert all(REMEDY in cycle.message for cycle in cycles if not cycle.converged)
    stays = fem.mesh_cycle(pair, torques[len(good) - 1], 10, bodies, beyond_path=beyond, moving_contact=False)
    leap = np.max(np.abs(good[-1].transmission_error / stays.transmission_error - 1))
    assert stays.model_error > leap


def test_pressed_plastics_through_zero_torque_with_friction_and_relief():
    plain = GearPair(
        Gear(17, 0.4, tip_relief=TipRelief(8e-6, 1e-3)), Gear(51), 2e-3, 20e-3, material=(STEEL, PA66)
    )
    pair = replace(plain, centre_distance=plain.centre_distance_of_backlash(-30e-6), tight=True)
    bodies = fem.compliance(pair, tolerance=0.02)
    cycles = fem.mesh_cycle(pair, (-4.0, -1e-6, 0.0, 1e-6, 4.0), 8, bodies, friction=0.1)
    for less, more in itertools.pairwise(cycles):
        assert less.converged, less.message
        assert np.all(more.transmission_error > less.transmission_error)
    np.testing.assert_allclose(cycles[1].transmission_error, cycles[3].transmission_error, atol=1e-11)
    np.testing.assert_allclose(cycles[2].stiffness, cycles[3].stiffness, rtol=1e-4)


def test_a_torque_beyond_all_bounds_leaves_the_others_of_its_call():
    pair = on_pa66()
    bodies = fem.compliance(pair, tolerance=0.02)
    cycles = fem.mesh_cycle(pair, (5.0, 1e5, 20.0, -5.0), 2, bodies)
    assert [cycle.converged for cycle in cycles] == [True, False, True, True]
    assert REMEDY in cycles[1].message
