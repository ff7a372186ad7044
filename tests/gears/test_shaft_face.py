"""Bending and twist of shafts over the face, against beams and bars worked out by hand and ISO 6336-1's formula."""

from __future__ import annotations

import numpy as np
import pytest

from gears import Bearing, Material, Shaft, ShaftSegment
from gears.pair.shaft_face import shaft_over_face

STEEL = Material(206e9, 0.3, 7850.0)
LENGTH, DIAMETER, WIDTH, FORCE = 0.4, 0.03, 0.04, 1e4
Z = ((np.arange(64) + 0.5) / 64 - 0.5) * WIDTH
NO_LEVER = 1e-12


def _shaft(beside: float, torque: float = 0.0) -> Shaft:
    """Slender shaft on stiff bearings at its ends, the gear some way beside its middle."""
    bearings = Bearing(0.0, 1e13), Bearing(LENGTH, 1e13)
    return Shaft((ShaftSegment(LENGTH, DIAMETER),), bearings, 0.5 * LENGTH + beside, torque, STEEL)


def _misalignment(shaft: Shaft, lever: float = NO_LEVER) -> float:
    deflection = shaft_over_face(shaft, Z, lever).between @ np.full(64, FORCE / 64)
    return float(np.polyfit(Z, deflection, 1)[0] * WIDTH)


@pytest.mark.parametrize("beside", [0.02, 0.06, 0.1, -0.06])
def test_slope_is_that_of_a_beam_on_two_supports(beside):
    """F s (l^2/4 - s^2) 2/(3 E I l), load at a point; the face and shear change it by under 1 %."""
    inertia = np.pi / 64 * DIAMETER**4
    slope = FORCE * 2 * beside * (LENGTH**2 / 4 - beside**2) / (3 * STEEL.youngs_modulus * inertia * LENGTH)
    assert _misalignment(_shaft(beside)) == pytest.approx(-slope * WIDTH, rel=0.01)


def test_slope_near_the_middle_is_the_shafts_part_of_iso_6336_1():
    """f_sh = 0.023 F_m/b K' l s/d_sh^4 b^2 [um, N/mm], K' = 0.8 without stiffening by the gear.

    As quoted by programs, linear in s. Its .8 x .023 is 12 % more than 64/(6 pi E) of a beam.
    """
    beside = 0.004
    line, l, s, d, b = FORCE / 40.0, 1e3 * LENGTH, 1e3 * beside, 1e3 * DIAMETER, 1e3 * WIDTH
    f_sh = 1e-6 * 0.023 * line * 0.8 * l * s / d**4 * b**2
    assert abs(_misalignment(_shaft(beside))) == pytest.approx(f_sh / 1.117, rel=0.01)


def test_twist_is_that_of_a_bar_whose_torque_leaves_along_the_face():
    lever, polar = 0.03, np.pi / 32 * DIAMETER**4
    both = shaft_over_face(_shaft(0.0), Z, lever).between - shaft_over_face(_shaft(0.0), Z, NO_LEVER).between
    way = Z - Z[0]
    stiffness = STEEL.youngs_modulus / 2.6 * polar
    # from the first cell on: T(z) falls evenly, by the 64th part at each cell
    turned = FORCE / 64 * np.array([np.minimum(way, one).sum() for one in way]) / stiffness
    np.testing.assert_allclose(both @ np.full(64, FORCE / 64), lever**2 * turned, rtol=1e-6, atol=1e-12)
    mirrored = shaft_over_face(_shaft(0.0, LENGTH), Z, lever).between
    first = shaft_over_face(_shaft(0.0), Z, lever).between
    np.testing.assert_allclose(mirrored, first[::-1, ::-1], rtol=1e-6)


def test_flexibility_is_symmetric_and_definite():
    shaft = Shaft(
        (ShaftSegment(0.1, 0.03), ShaftSegment(0.1, 0.05, 0.02)),
        (Bearing(0.01, 3e8), Bearing(0.06, 5e8)),
        0.15,
        0.0,
        STEEL,
    )
    found = shaft_over_face(shaft, Z, 0.03)
    np.testing.assert_array_equal(found.between, found.between.T)
    assert np.linalg.eigvalsh(found.between).min() > -1e-9 * np.abs(found.between).max()


def test_a_gear_that_is_set_off_sits_where_its_own_middle_is():
    own = shaft_over_face(_shaft(0.05), Z + 0.01, 0.03).between
    np.testing.assert_allclose(shaft_over_face(_shaft(0.05), Z, 0.03, -0.01).between, own, rtol=1e-7)


@pytest.mark.parametrize("off", [1e-17, 1e-16, -1e-15, 1e-13, 1e-11])
def test_a_step_of_the_shaft_at_a_place_but_for_rounding(off):
    """Two nodes as far apart as rounding made the flexibility twice as large."""

    def stepped(end: float) -> np.ndarray:
        segments = ShaftSegment(end, 0.03), ShaftSegment(0.2 - end, 0.04)
        shaft = Shaft(segments, (Bearing(0.0, 1e9), Bearing(0.2, 1e9)), 0.1, 0.0, STEEL)
        return shaft_over_face(shaft, np.linspace(-0.01, 0.01, 16), 0.03).between

    at = 0.1 + np.linspace(-0.01, 0.01, 16)[5]
    np.testing.assert_allclose(stepped(at + off), stepped(at), rtol=1e-8)
