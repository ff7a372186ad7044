"""Shafts under couples: closed forms of beams, reciprocity, equilibrium of bearings."""

from __future__ import annotations

import numpy as np
import pytest

from gears import Bearing, Material, Shaft, ShaftSegment
from gears.pair.shaft_face import shaft_over_face
from gears.pair.tilting_shaft import bearing_forces, tilting_shaft

STEEL = Material(206e9, 0.3, 7850.0)
LENGTH, DIAMETER = 0.4, 0.03
SECOND_MOMENT, AREA = np.pi / 64 * DIAMETER**4, np.pi / 4 * DIAMETER**2
SHEAR = 6.0 * 1.3 / (7.0 + 6.0 * 0.3) * STEEL.shear_modulus * AREA
"""Cowper's kappa G A of a solid circle."""

STEPPED = Shaft(
    (ShaftSegment(0.1, 0.02), ShaftSegment(0.06, 0.035), ShaftSegment(0.09, 0.025)),
    (Bearing(0.01, 2e8), Bearing(0.15, 5e8), Bearing(0.24, 1e8)),
    0.13,
    0.25,
    STEEL,
)


def _span(at: float) -> Shaft:
    ends = Bearing(0.0, 1e13), Bearing(LENGTH, 1e13)
    return Shaft((ShaftSegment(LENGTH, DIAMETER),), ends, at, 0.0, STEEL)


def test_a_couple_in_the_middle_of_a_span() -> None:
    """The section turns by C l/(12 E I) and C/(l kappa G A), and does not deflect."""
    found = tilting_shaft(_span(0.5 * LENGTH), np.array([0.0])).bent[:, 0, :, 0]
    turn = LENGTH / (12.0 * STEEL.youngs_modulus * SECOND_MOMENT) + 1.0 / (LENGTH * SHEAR)
    assert found[1, 1] == pytest.approx(turn, rel=1e-6)
    assert abs(found[0, 1]) < 1e-6 * turn * LENGTH


@pytest.mark.parametrize("at", [0.1, 0.25, 0.3])
def test_a_couple_anywhere_on_a_span(at: float) -> None:
    """v = C a b (b - a)/(3 E I l) under the couple; bending alone, on which shear has no part there."""
    rest = LENGTH - at
    found = tilting_shaft(_span(at), np.array([0.0])).bent[:, 0, :, 0]
    deflection = at * rest * (rest - at) / (3.0 * STEEL.youngs_modulus * SECOND_MOMENT * LENGTH)
    assert abs(found[0, 1]) == pytest.approx(abs(deflection), rel=1e-6)
    turn = (LENGTH**2 - 3.0 * at * rest) / (3.0 * STEEL.youngs_modulus * SECOND_MOMENT * LENGTH)
    assert found[1, 1] == pytest.approx(turn + 1.0 / (LENGTH * SHEAR), rel=1e-6)


def test_a_couple_is_two_forces_and_slopes_are_differences_of_deflections() -> None:
    """Sections turn by the slope of the line that another force bends, less the angle of shear, R/(kappa G A)."""
    step = 2e-3
    found = tilting_shaft(_span(0.13), np.array([-0.02, -step, 0.0, step])).bent
    shear = (0.13 - 0.02) / LENGTH / SHEAR
    by_forces = (found[0, 0, 0, 3] - found[0, 0, 0, 1]) / (2.0 * step)
    assert found[0, 0, 1, 2] == pytest.approx(by_forces + shear, rel=1e-4)
    by_deflections = (found[0, 3, 0, 0] - found[0, 1, 0, 0]) / (2.0 * step)
    assert found[1, 2, 0, 0] == pytest.approx(by_deflections + shear, rel=1e-4)


def test_forces_alone_are_those_over_the_face() -> None:
    z = np.linspace(-0.02, 0.02, 9)
    found, face = tilting_shaft(STEPPED, z, 2e-3, 0.04), shaft_over_face(STEPPED, z, 0.03, 2e-3, 0.04)
    np.testing.assert_allclose(found.bent[0, :, 0], face.bent, rtol=1e-10)
    np.testing.assert_allclose(0.03**2 * found.twisted, face.twisted, rtol=1e-12)


def test_bearings_carry_forces_and_couples() -> None:
    """Three of them: sums of forces and of moments about the left end."""
    z, offset = np.array([-0.01, 0.0, 0.02]), 1e-3
    found = tilting_shaft(STEPPED, z, offset).bearings
    place = np.array([bearing.position for bearing in STEPPED.bearings])
    np.testing.assert_allclose(found[:, 0].sum(axis=0), 1.0, rtol=1e-9)
    np.testing.assert_allclose(place @ found[:, 0], STEPPED.gear_position - offset + z, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1].sum(axis=0), 0.0, atol=1e-7)
    np.testing.assert_allclose(place @ found[:, 1], 1.0, rtol=1e-9)
    along, tilting = np.array([1e4, 2e4]), np.array([30.0, -20.0])
    forces = bearing_forces(STEPPED, along, tilting, 55.0, offset)
    np.testing.assert_allclose(forces.sum(axis=0), np.stack([along, 0.0 * along], axis=-1), atol=1e-6)
    moments = np.einsum("b,bnp->np", place - STEPPED.gear_position + offset, forces)
    np.testing.assert_allclose(moments, np.stack([tilting, np.full(2, 55.0)], axis=-1), rtol=1e-9)
