"""Laws of the contact where shafts give way under the face: what the drive train has as beams counts once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import fem
from flankfilm.coupling import Flanks, LoadedTeeth, contact_laws, given_series, pair_drive, unequal_pitches
from flankfilm.coupling.rating.contact_laws import SHARES, ContactLaws
from gears import Bearing, Gear, GearPair, Material, Shaft, ShaftSegment

PAIR = GearPair(Gear(20), Gear(30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
TORQUE, POSITIONS, F_PB = 100.0, 8, 3e-6
ENDS = Bearing(0.005, 5e8), Bearing(0.195, 5e8)
SHAFTS = (
    Shaft((ShaftSegment(0.2, 0.04),), ENDS, 0.09, 0.0),
    Shaft((ShaftSegment(0.2, 0.05),), ENDS, 0.12, 0.2),
)
"""All of the face stays in contact on them."""

FLANKS = Flanks(False, cells=16, face_model="walls")
MEAN = SHARES.index(1.0)


@pytest.fixture(scope="module")
def bodies() -> fem.PairCompliance:
    return fem.compliance(PAIR, tolerance=0.02)


def teeth_on(bodies, shafts) -> LoadedTeeth:
    return LoadedTeeth(PAIR, TORQUE, compliance=bodies, flanks=replace(FLANKS, shafts=shafts))


@pytest.fixture(scope="module")
def teeth(bodies) -> LoadedTeeth:
    return teeth_on(bodies, SHAFTS)


@pytest.fixture(scope="module")
def even(teeth):
    return teeth.cycle(POSITIONS)


@pytest.fixture(scope="module")
def laws(teeth, even) -> ContactLaws:
    return contact_laws(teeth, even, F_PB, POSITIONS)


def slope_at_mean(curve: np.ndarray, force: float) -> np.ndarray:
    """Of the force, by a parabola through the mean load and its neighbours."""
    near = np.array(SHARES[MEAN - 1 : MEAN + 2]) * force
    by_force = [
        np.polynomial.Polynomial.fit(near, row, 2).deriv()(force) for row in curve[MEAN - 1 : MEAN + 2].T
    ]
    return 1.0 / np.array(by_force)


def elastic(teeth: LoadedTeeth) -> np.ndarray:
    """Slope of the force by the turn, the shafts' give among it."""
    less, more = (replace(teeth, torque=share * TORQUE).cycle(POSITIONS) for share in (0.999, 1.001))
    force = more.contact.force - less.contact.force
    return force / (more.transmission_error - less.transmission_error)


def test_slope_at_the_mean_load_is_the_tangent_of_the_mesh_cycle(laws, even, teeth):
    """Of the turn of the gears it is a fifth of that: the shafts are softer than the mesh."""
    found = slope_at_mean(laws.even, even.contact.force)
    np.testing.assert_allclose(found, even.stiffness, rtol=1e-3)
    assert np.all(elastic(teeth) < 0.25 * even.stiffness)


def test_law_and_beams_in_series_are_the_contact_on_elastic_shafts(laws, even, teeth):
    """With the bending of the train's beams at the gears; what twists under the face is all that is left."""
    drive = pair_drive(PAIR, given_series(8e8), TORQUE, 200.0, shafts=SHAFTS, end_inertias=(1.0, 1.0))
    beams = sum(1.0 / felt.bending_stiffness for felt in drive.shafts)
    series = 1.0 / (1.0 / slope_at_mean(laws.even, even.contact.force) + beams)
    np.testing.assert_allclose(series, elastic(teeth), rtol=0.01)


def test_under_the_mean_load_it_deflects_as_the_mesh_cycle(laws, even):
    """From the first touch on shafts that are held: gears that are out of line approach by the root of a light load."""
    np.testing.assert_allclose(laws.secant, even.secant_stiffness, rtol=1e-9)
    np.testing.assert_allclose(laws.even[MEAN], even.contact.force / even.secant_stiffness, rtol=1e-9)
    light = laws.even[0] / laws.even[MEAN]
    assert np.all((light > 0.0) & (light < np.sqrt(SHARES[0])))


def test_slow_teeth_stand_where_the_loaded_contact_has_them(laws, even, teeth):
    """With the deviation too, whose load bears elsewhere on the flanks."""
    pitches = unequal_pitches(teeth, even, F_PB)
    for row, cycle in zip(laws.added[1:], pitches.unequal, strict=True):
        np.testing.assert_allclose(row, pitches.added_error(cycle), atol=1e-12)


def test_stiff_shafts_leave_the_law_without_them(bodies):
    """By the stiffest shafts there may be, and half of what these still change."""
    stiff, half = (
        Shaft(
            (ShaftSegment(0.2, 10.0),), (Bearing(0.0, size), Bearing(0.2, size)), 0.1, 0.0, Material(size, 0.3, 7850.0)
        )
        for size in (1e13, 5e12)
    )  # fmt: skip
    plain, found, other = (
        contact_laws(teeth, teeth.cycle(4), 0.0, 4)
        for teeth in (teeth_on(bodies, each) for each in (None, (stiff, stiff), (half, half)))
    )
    np.testing.assert_allclose(2.0 * found.even - other.even, plain.even, rtol=1e-7)


def test_without_shafts_it_is_the_turn_itself(bodies):
    """Bitwise: no shaft is held, and nothing is left out."""
    for shafts in (None, (None, None)):
        teeth = teeth_on(bodies, shafts)
        laws = contact_laws(teeth, teeth.cycle(4), 0.0, 4)
        cycles = fem.mesh_cycle(
            PAIR, [share * TORQUE for share in SHARES], 4, bodies, False, cells=16, face_model="walls"
        )
        level = cycles[MEAN]
        touch = level.transmission_error - level.force / level.secant_stiffness
        for row, cycle in zip(laws.even, cycles, strict=True):
            assert np.array_equal(row, cycle.transmission_error - touch)
