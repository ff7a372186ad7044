"""Flanks that differ over profile and face together: twists that cancel, slices, tables of what is known, faults."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from base import InputError
from fem import PairCompliance, compliance, mesh_cycle
from fem.laws.contact_candidates import contact_candidates
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import FaceSetting, face_setting
from gears import (
    Alignment,
    Bearing,
    Gear,
    GearPair,
    Lead,
    LeadTrace,
    Material,
    Shaft,
    ShaftSegment,
    Topography,
)

STEEL, PA66 = Material(206e9, 0.3, 7850.0), Material(3e9, 0.4, 1140.0)
PAIR = GearPair(Gear(teeth=20), Gear(teeth=30), module=2e-3, face_width=20e-3).with_backlash(100e-6)
PLASTIC = replace(PAIR, material=(STEEL, PA66)).with_backlash(300e-6)
TWIST, TORQUE, POSITIONS = 60e-6, 100.0, 8
SOFT = Shaft((ShaftSegment(0.2, 0.02),), (Bearing(0.0, 1e12), Bearing(0.2, 1e12)), 0.06, 0.0)
CURVE = np.array([12e-6, 3e-6, 0.0, 5e-6, 6e-6])
PLACES = np.linspace(-0.5, 0.5, 5) * PAIR.face_width
FIGURES = ("transmission_error", "stiffness", "line_load", "unloaded_transmission_error")


@pytest.fixture(scope="module")
def bodies() -> PairCompliance:
    return compliance(PAIR, tolerance=0.02)


@pytest.fixture(scope="module")
def plastic() -> PairCompliance:
    return compliance(PLASTIC, tolerance=0.02)


def with_leads(pinion=None, wheel=None, pair=PAIR):
    first, second = pinion or Lead(), wheel or Lead()
    return replace(pair, pinion=replace(pair.pinion, lead=first), wheel=replace(pair.wheel, lead=second))


def cycle(bodies, pair=PAIR, torque=TORQUE, cells=16, face_model="walls", **more):
    own = bodies if pair == bodies.pair else replace(bodies, pair=pair)
    return mesh_cycle(pair, torque, POSITIONS, own, cells=cells, face_model=face_model, **more)


def same(one, other, rtol=1e-9):
    for name in FIGURES:
        wanted = getattr(other, name)
        size = np.abs(wanted).max() or 1e-6
        np.testing.assert_allclose(getattr(one, name), wanted, rtol=rtol, atol=rtol * size, err_msg=name)


def matching_table(pair=PAIR):
    """Of the wheel, what the pinion's twist lacks at every place of the line of action."""
    (low, high), rho2 = pair.active_profiles[0], np.linspace(*pair.active_profiles[1], 4)
    rho1, z = pair.line_of_action - rho2, np.linspace(-0.5, 0.5, 3) * pair.face_width
    up = 2.0 * (rho1 - low) / (high - low) - 1.0
    return Topography(rho2, z, TWIST / 4.0 * up[:, None] * (2.0 * z / pair.face_width))


@pytest.mark.parametrize("wheel", [Lead(twist=TWIST), Lead(topography=matching_table())])
def test_twists_that_match_are_plain_flanks(bodies, wheel):
    """On the line of action one flank has in excess what the other lacks, by both ways to say it."""
    tilted = {"alignment": Alignment(20e-6), "beyond_path": False}
    plain = cycle(bodies, **tilted)
    same(cycle(bodies, with_leads(Lead(twist=TWIST), wheel), **tilted), plain)
    alone = cycle(bodies, with_leads(Lead(twist=TWIST)), **tilted)
    assert np.abs(alone.line_load - plain.line_load).max() > 0.1 * plain.line_load.max()


@pytest.mark.parametrize("beyond", [False, True])
def test_where_one_pair_bears_a_twist_is_a_slope_of_the_lead(bodies, beyond):
    twisted = cycle(bodies, with_leads(Lead(twist=TWIST)), beyond_path=beyond)
    alone = np.flatnonzero(np.count_nonzero(twisted.forces, axis=1) == 1)
    assert len(alone) >= 1
    low, high = PAIR.active_profiles[0]
    for position in alone:
        pair = int(np.argmax(twisted.forces[position]))
        up = 2.0 * (twisted.flank_rho[0, position, pair] - low) / (high - low) - 1.0
        sloped = cycle(bodies, with_leads(Lead(slope=0.5 * TWIST * up)), beyond_path=beyond)
        assert np.count_nonzero(sloped.forces[position]) == 1
        for name in ("transmission_error", "stiffness", "line_load"):
            found, wanted = (getattr(one, name)[position] for one in (twisted, sloped))
            np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


def test_a_twist_turned_round_mirrors_the_face(bodies):
    one, other = (cycle(bodies, with_leads(Lead(twist=sign * TWIST))) for sign in (1, -1))
    np.testing.assert_allclose(one.line_load, other.line_load[..., ::-1], rtol=1e-8, atol=1e-3)
    np.testing.assert_allclose(one.transmission_error, other.transmission_error, rtol=1e-9)


def test_without_load_the_nearest_corner_of_the_flanks_touches(bodies):
    """The pair that is farther from the middle of its profile, at the end of the face where material is in excess."""
    twisted = with_leads(Lead(twist=TWIST))
    found = cycle(bodies, twisted, 1e-4, beyond_path=False)
    (low, high), pitch = PAIR.active_profiles[0], PAIR.base_pitch
    place = low + (found.position[:, None] + np.arange(2)) * pitch
    far = np.where(place <= high, np.abs(2.0 * (place - low) / (high - low) - 1.0), 0.0).max(axis=1)
    np.testing.assert_allclose(found.unloaded_transmission_error, -0.25 * TWIST * far, rtol=1e-9)
    assert np.all(np.abs(found.transmission_error - found.unloaded_transmission_error) < 0.2e-6)


@pytest.mark.parametrize("torque", [TORQUE, -TORQUE])
def test_a_table_that_varies_along_the_face_alone_is_a_lead(bodies, torque):
    """The general way and the one along z alone: the same numbers, tip edges and loads on either side included."""
    trace = Lead(trace=LeadTrace(PLACES, CURVE, "linear"))
    span = PAIR.active_profiles[0]
    made = Lead(topography=Topography(np.linspace(*span, 4), PLACES, np.tile(CURVE, (4, 1)), "linear"))
    one, other = (cycle(bodies, with_leads(lead), torque) for lead in (made, trace))
    same(one, other)


def test_gaps_of_both_sides_count_the_first_touch_of_each_pair():
    """Of a lead the same as of its table; of twists that match none."""
    trace = Lead(trace=LeadTrace(PLACES, CURVE, "linear"))
    made = Lead(topography=Topography([1e-3, 20e-3], PLACES, [CURVE, CURVE], "linear"))
    twist = Lead(twist=TWIST)

    def gaps(pair, beyond):
        setup = MeshSetup(pair, POSITIONS, beyond, face=face_setting(pair, Alignment(), 8, "walls"))
        return contact_candidates(setup)

    for lead, wheel, other, beyond in ((made, None, trace, True), (twist, twist, None, False)):
        one, plain = gaps(with_leads(lead, wheel), beyond), gaps(with_leads(other), beyond)
        np.testing.assert_allclose(one.gap, plain.gap, rtol=0, atol=1e-15)
        np.testing.assert_allclose(one.back_gap, plain.back_gap, rtol=0, atol=1e-15)
    alone, plain = gaps(with_leads(twist), False), gaps(PAIR, False)
    assert np.all(alone.back_gap < plain.back_gap - 1e-6)


@pytest.mark.slow
def test_contacts_that_move_have_the_same_first_touch(plastic):
    trace = Lead(trace=LeadTrace(PLACES, CURVE, "linear"))
    span = PLASTIC.active_profiles[1]
    made = Lead(topography=Topography(np.linspace(*span, 4), PLACES, np.tile(CURVE, (4, 1)), "linear"))
    one, other = (
        cycle(plastic, with_leads(None, lead, PLASTIC), 5.0, 8, moving_contact=True) for lead in (made, trace)
    )
    assert one.moving_contact
    same(one, other)
    np.testing.assert_allclose(one.flank_rho, other.flank_rho, rtol=1e-9)


def test_contacts_that_move_on_twisted_flanks_are_those_that_stay_where_they_hardly_do(bodies):
    """Steel under a light load."""
    twisted = with_leads(Lead(twist=TWIST), Lead(topography=matching_table()))
    twisted = with_leads(replace(twisted.pinion.lead, twist=0.5 * TWIST), twisted.wheel.lead)
    stays, moves = (cycle(bodies, twisted, 20.0, moving_contact=moving) for moving in (False, True))
    np.testing.assert_allclose(moves.transmission_error, stays.transmission_error, rtol=0.02)
    np.testing.assert_allclose(moves.line_load, stays.line_load, atol=0.05 * stays.line_load.max())


@pytest.mark.slow
def test_both_sides_of_the_teeth_are_twisted(bodies):
    """Teeth pressed together: matching twists on both gears are plain flanks on both sides."""
    pressed = replace(PAIR, tight=True, centre_distance=PAIR.working_centre_distance - 8e-6)
    pressed = replace(pressed, pinion=Gear(teeth=20), wheel=Gear(teeth=30))
    assert pressed.backlash < 0.0
    plain = cycle(bodies, pressed, 10.0, 8, beyond_path=False)
    matched = cycle(
        bodies, with_leads(Lead(twist=TWIST), Lead(twist=TWIST), pressed), 10.0, 8, beyond_path=False
    )
    same(matched, plain)


def test_twist_alone_makes_cells():
    setting = face_setting(with_leads(Lead(twist=TWIST)), None, None, "walls")
    assert setting is not None
    assert setting.cells == 64
    assert setting.topographic
    assert face_setting(PAIR, None, None, "walls") is None


def test_gaps_along_oblique_lines_are_those_of_their_places():
    """Radii that change along the face (positions, pairs, cells): cell after cell as that of its section."""
    leads = Lead(crowning=5e-6, twist=TWIST), Lead(topography=matching_table())
    pair = with_leads(*leads)
    face = FaceSetting(6, Alignment(10e-6, 300e-6), leads)
    z = np.broadcast_to(face.middles(pair.face_width), (2, 3, 6))
    rho1 = np.random.default_rng(1).uniform(*pair.active_profiles[0], size=z.shape)
    rho = np.stack([rho1, pair.line_of_action - rho1])
    found = face.gaps_at(pair, z, rho)
    assert found.shape == z.shape
    for place in np.ndindex(z.shape):
        single = face.gaps_at(pair, z[place], rho[(slice(None), *place)])
        assert float(single) == pytest.approx(float(found[place]), rel=1e-12)
        removed = sum(
            lead.removed_at(z[place], radius, width, span)
            for lead, radius, width, span in zip(
                leads, rho[(slice(None), *place)], pair.face_widths, pair.active_profiles, strict=True
            )
        )
        radius = 1.0 / (1.0 / rho[0][place] + 1.0 / rho[1][place])
        apart = face.alignment.gap(z[place], pair.face_width, radius)
        assert float(found[place]) == pytest.approx(float(removed + apart), rel=1e-12)


def test_faults(bodies):
    far = Topography([1.0, 2.0], [40.0, 60.0], np.zeros((2, 2)))
    with pytest.raises(InputError) as told:
        cycle(bodies, with_leads(Lead(topography=far), Lead(end_relief=1e-6, end_relief_length=1.0)))
    where = [fault.where for fault in told.value.faults]
    assert where == [
        "pinion.lead.topography.rho",
        "pinion.lead.topography.z",
        "wheel.lead.end_relief_length",
    ]
    assert all(fault.remedy for fault in told.value.faults)


@pytest.mark.parametrize("lead", [Lead(twist=TWIST), Lead(topography=matching_table())])
def test_shafts_that_give_way_under_twisted_flanks_are_refused(bodies, lead):
    with pytest.raises(InputError, match="must be left out where shafts give way"):
        cycle(bodies, with_leads(None, lead), shafts=(SOFT, None))
