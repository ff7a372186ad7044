"""Shafts under the cells of the face: against the alignment that they come to, and their own faults."""

from __future__ import annotations

import numpy as np
import pytest

from base import InputError
from fem import Compliance, compliance, mesh_cycle
from gears import Alignment, Bearing, Gear, GearPair, Shaft, ShaftSegment

PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE = 100.0
ENDS = Bearing(0.005, 5e8), Bearing(0.195, 5e8)
STIFF = 0.4
"""Diameter of a step that does not bend by itself [m]."""


@pytest.fixture(scope="module")
def bodies() -> Compliance:
    return compliance(PAIR, tolerance=0.02)


def _tilting(at: float, diameter: float = 0.025) -> Shaft:
    """Shaft that bends beside its gear but not under it."""
    parts = (at - 0.015, diameter), (0.03, STIFF), (0.185 - at, diameter)
    return Shaft(tuple(ShaftSegment(*one) for one in parts), ENDS, at, 0.0)


def _cycle(bodies, **more):
    return mesh_cycle(PAIR, TORQUE, 8, bodies, cells=16, face_model="walls", **more)


def test_rigid_shafts_change_nothing(bodies):
    stiff = Shaft((ShaftSegment(0.2, 1.0),), (Bearing(0.0, 1e13), Bearing(0.2, 1e13)), 0.1, 0.0)
    plain, found = _cycle(bodies), _cycle(bodies, shafts=(stiff, stiff))
    np.testing.assert_allclose(found.line_load, plain.line_load, rtol=1e-3)
    np.testing.assert_allclose(found.stiffness, plain.stiffness, rtol=1e-3)
    assert np.abs(found.face.shaft_misalignment).max() < 1e-8
    assert not np.any(plain.face.shaft_misalignment)


@pytest.mark.parametrize("shafts", [(_tilting(0.05), None), (_tilting(0.05), _tilting(0.14, 0.03))])
def test_loads_are_those_of_the_alignment_that_the_shafts_come_to(bodies, shafts):
    """Each position by itself, with the moment of its own loads about mid-face: what an iteration would end at."""
    found = _cycle(bodies, shafts=shafts)
    bent = found.face.shaft_misalignment.sum(axis=0)
    assert np.ptp(bent) > 0.01 * np.abs(bent).max() > 1e-7
    for row in (0, 3, 6):
        given = _cycle(bodies, alignment=Alignment(float(bent[row])))
        np.testing.assert_allclose(
            found.line_load[row], given.line_load[row], atol=2e-3 * given.line_load[row].max()
        )
        assert found.transmission_error[row] == pytest.approx(given.transmission_error[row], rel=2e-3)


def test_the_moment_of_the_loads_turns_shafts_back(bodies):
    """Loads that leave mid-face tilt a shaft less than the same force at mid-face does."""
    shaft = _tilting(0.05, 0.02)
    light, heavy = (
        mesh_cycle(PAIR, torque, 8, bodies, cells=16, face_model="walls", shafts=(shaft, None))
        for torque in (1.0, 100.0)
    )
    factor = light.face_load_factor, heavy.face_load_factor
    np.testing.assert_allclose(
        factor[0], factor[1], rtol=0.25
    )  # shafts, unlike an alignment, bend by the load
    assert factor[1].min() > 1.02
    # the gear sits left of the shaft's middle: its right end gives way more
    assert (heavy.face.shaft_misalignment[0] > 0.0).all()
    assert not np.any(heavy.face.shaft_misalignment[1])


def test_the_stiffness_is_the_slope_of_the_force(bodies):
    """Between mid-faces: dF/dD by differences of torques."""
    shafts = _tilting(0.05), _tilting(0.14)
    less, mid, more = mesh_cycle(
        PAIR, [99.9, 100.0, 100.1], 8, bodies, cells=16, face_model="walls", shafts=shafts
    )
    slope = (more.force - less.force) / (more.transmission_error - less.transmission_error)
    np.testing.assert_allclose(mid.stiffness, slope, rtol=1e-5)


def test_a_wide_pinion_winds_up_towards_its_coupling(bodies):
    """Torque comes in at the right: the right end of the face bears more."""
    thin = Shaft((ShaftSegment(0.2, 0.012),), (Bearing(0.08, 1e12), Bearing(0.12, 1e12)), 0.1, 0.2)
    found = _cycle(bodies, shafts=(thin, None))
    assert (found.line_load[..., -1].sum(axis=1) > found.line_load[..., 0].sum(axis=1)).all()


def test_faults_name_the_shaft(bodies):
    short = Shaft((ShaftSegment(0.2, 0.03),), ENDS, 0.195, 0.0)
    with pytest.raises(InputError, match=r"shafts\[1\]\.gear_position") as told:
        _cycle(bodies, shafts=(None, short))
    assert "0.01" in str(told.value)
