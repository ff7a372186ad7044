"""Shafts under the face that stay held where one load has brought them: the force over the approach of the bodies."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from base import InputError
from gears import Alignment, Gear, GearPair, Shaft, ShaftSegment
from tests.stiff_shafts import ENDS, stiffest_shafts, tilting_shaft

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
MEAN = 100.0
LEVEL = (
    Shaft((ShaftSegment(0.2, 0.04),), ENDS, 0.09, 0.0),
    Shaft((ShaftSegment(0.2, 0.05),), ENDS, 0.12, 0.2),
)
"""Bend and twist under their gears too, with all of the face in contact."""


TILTING = tilting_shaft(0.05, 0.025), tilting_shaft(0.14, 0.03)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.02)


def cycles(bodies, torques, held_under=None, **more):
    given = {"cells": 16, "face_model": "walls", "beyond_path": False, "shafts": LEVEL} | more
    return fem.mesh_cycle(bodies.pair, torques, 8, bodies, shafts_held_under=held_under, **given)


def slope(less: fem.MeshCycle, more: fem.MeshCycle) -> np.ndarray:
    return (more.force - less.force) / (more.transmission_error - less.transmission_error)


@pytest.mark.parametrize("moving", [False, True])
@pytest.mark.parametrize("shafts", [LEVEL, TILTING])
def test_under_the_load_that_has_brought_them_nothing_changes(bodies, shafts, moving):
    """Of loaded flanks and of back flanks."""
    given = {"shafts": shafts, "moving_contact": moving, "beyond_path": True}
    for torque in (MEAN, -MEAN):
        bent, held = cycles(bodies, torque, **given), cycles(bodies, torque, torque, **given)
        for name in ("transmission_error", "stiffness", "secant_stiffness", "forces"):
            np.testing.assert_allclose(getattr(held, name), getattr(bent, name), rtol=1e-6, atol=1e-9)
        np.testing.assert_allclose(held.face.shaft_deflection, bent.face.shaft_deflection, rtol=1e-6)
        np.testing.assert_allclose(held.face.mesh_matrix, bent.face.mesh_matrix, rtol=1e-5)
        assert held.error == pytest.approx(bent.error, rel=1e-2)


@pytest.mark.slow
def test_figures_of_the_cycle_are_those_of_the_load_too(bodies):
    """By arcs between the positions, on which the load brings the shafts elsewhere at every position."""
    bent, held = cycles(bodies, MEAN), cycles(bodies, MEAN, MEAN)
    assert held.mean_stiffness == pytest.approx(bent.mean_stiffness, rel=1e-8)
    assert held.transmission_error_range == pytest.approx(bent.transmission_error_range, rel=1e-6)
    assert held.errors["mean_stiffness"] == pytest.approx(bent.errors["mean_stiffness"], rel=1e-3)


@pytest.mark.parametrize("moving", [False, True])
def test_slope_over_the_turn_is_the_stiffness_under_every_torque(bodies, moving):
    """Of a turn that counts the shafts it is a small part of it."""
    less, mean, more = cycles(bodies, [0.999 * MEAN, MEAN, 1.001 * MEAN], moving_contact=moving)
    assert np.all(slope(less, more) < 0.3 * mean.stiffness)
    for share in (0.4, 1.0, 2.5):
        torques = [step * share * MEAN for step in (0.999, 1.0, 1.001)]
        less, here, more = cycles(bodies, torques, MEAN, moving_contact=moving)
        np.testing.assert_allclose(slope(less, more), here.stiffness, rtol=2e-6)


def test_force_over_the_turn_is_that_of_the_alignment_that_the_load_leads_to(bodies):
    """Shafts that tilt their gears and do not bend under them: the same turns beyond that of the mean load."""
    torques = [0.2 * MEAN, MEAN, 2.0 * MEAN]
    held = cycles(bodies, torques, MEAN, shafts=TILTING)
    bent = held[1].face.shaft_misalignment.sum(axis=0)
    for row in (0, 5):
        aligned = cycles(bodies, torques, shafts=None, alignment=Alignment(float(bent[row])))
        for one, other in ((0, 1), (1, 2)):
            turns = [
                (each[other].transmission_error - each[one].transmission_error)[row]
                for each in (held, aligned)
            ]
            assert turns[0] == pytest.approx(turns[1], rel=1e-5)
        for one, other in zip(held, aligned, strict=True):
            np.testing.assert_allclose(one.face.shaft_misalignment.sum(axis=0), bent, rtol=1e-9)
            assert one.secant_stiffness[row] == pytest.approx(other.secant_stiffness[row], rel=1e-5)


def test_a_light_load_bears_where_the_held_shafts_leave_the_flanks_close(bodies):
    """Not all over the face, as on shafts that it bends itself."""
    light = 1e-3 * MEAN
    bent, held = cycles(bodies, light, shafts=TILTING), cycles(bodies, light, MEAN, shafts=TILTING)
    for cycle, few in ((bent, False), (held, True)):
        touched = np.count_nonzero(cycle.line_load.sum(axis=1), axis=-1)
        assert np.all((touched < 4) == few)


@pytest.mark.parametrize("moving", [False, True])
def test_rigid_shafts_change_nothing(bodies, moving):
    """By the stiffest shafts there may be, and half of what these still change."""
    torques = [0.3 * MEAN, 2.0 * MEAN]
    plain = cycles(bodies, torques, shafts=None, moving_contact=moving)
    found, other = (
        cycles(bodies, torques, MEAN, shafts=(one, one), moving_contact=moving) for one in stiffest_shafts()
    )
    for rigid, first, second in zip(plain, found, other, strict=True):
        for name in ("transmission_error", "stiffness", "secant_stiffness"):
            led = 2.0 * getattr(first, name) - getattr(second, name)
            np.testing.assert_allclose(led, getattr(rigid, name), rtol=1e-8)
            assert np.any(getattr(first, name) != getattr(rigid, name))


@pytest.mark.parametrize("moving", [False, True])
def test_flanks_on_both_sides_are_parted_each_along_its_line_of_action(moving):
    """Teeth that overlap: under the load itself nothing changes, and slopes are the stiffness."""
    plain = GearPair(Gear(36), Gear(40), 2e-3, 0.04)
    tight = replace(plain, centre_distance=plain.centre_distance_of_backlash(-20e-6), tight=True)
    bodies = fem.compliance(tight, tolerance=0.05)
    given = {"cells": 8, "alignment": Alignment(8e-6), "moving_contact": moving}
    bent = cycles(bodies, 60.0, **given)
    less, held, more = cycles(bodies, [59.9, 60.0, 60.1], 60.0, **given)
    assert np.all(bent.opposite_force > 0.0)
    for name in ("transmission_error", "stiffness", "forces", "opposite_force"):
        np.testing.assert_allclose(getattr(held, name), getattr(bent, name), rtol=1e-5, atol=1e-11)
    np.testing.assert_allclose(slope(less, more), held.stiffness, rtol=1e-3)


def test_faults_say_what_is_wrong(bodies):
    with pytest.raises(InputError, match=r"shafts_held_under.*requires shafts"):
        cycles(bodies, MEAN, MEAN, shafts=None)
    for held_under in (-MEAN, 0.0):
        with pytest.raises(InputError, match=r"shafts_held_under.*sign of every torque"):
            cycles(bodies, MEAN, held_under)
    with pytest.raises(InputError, match="shafts_held_under"):
        cycles(bodies, MEAN, float("nan"))
