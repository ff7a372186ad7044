"""Sizes of drawings and inspection sheets against tables, and against the generated tooth itself."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gears import Gear, GearPair, GeometryError, TipRelief, dimensions


def pair_of(teeth: int, shift: float, allowance: float = 0.0, **more: object) -> GearPair:
    """A gear with a mate that runs with anything."""
    gear = Gear(teeth=teeth, profile_shift=shift, thickness_allowance=allowance, **more)
    return GearPair(gear, Gear(teeth=60), module=1e-3, face_width=1e-2)


@pytest.mark.parametrize(("teeth", "number", "span"), [(20, 3, 7.6604), (30, 4, 10.7526), (60, 7, 20.0292)])
def test_span_of_tables_for_module_one(teeth, number, span):
    """Tables of handbooks, for 20 degrees, module 1 and no shift, to the last digit."""
    found = dimensions(pair_of(teeth, 0.0))
    assert found.span_teeth[0] == number
    assert 1e3 * found.span[0] == pytest.approx(span, abs=5e-5)


@pytest.mark.parametrize(("teeth", "shift", "allowance"), [(18, 0.4, 0.0), (25, -0.1, 4e-5), (36, 0.0, 2e-5)])
def test_pins_and_spans_touch_the_generated_flanks(teeth, shift, allowance):
    pair = pair_of(teeth, shift, allowance)
    found, tooth = dimensions(pair), pair.teeth_profiles[0]
    flank = tooth.involute(np.linspace(*tooth.flank_rho, 20001))  # of the tooth about +y
    pin, over = found.pin_diameter[0], found.over_pins[0]
    reach = 0.5 * (over - pin) / (math.cos(0.5 * math.pi / teeth) if teeth % 2 else 1.0)
    gap = math.pi / teeth
    distance = np.linalg.norm(flank - reach * np.array([math.sin(gap), math.cos(gap)]), axis=1)
    assert distance.min() == pytest.approx(0.5 * pin, rel=1e-6)
    radius = np.linalg.norm(flank[np.argmin(distance)])
    assert 2 * radius == pytest.approx(found.pin_contact_diameter[0], rel=1e-4)
    # the outer flanks of a span stand (k - 1) pitches apart; the planes touch where their normals are opposite
    half = 0.5 * (found.span_teeth[0] - 1) * tooth.pitch_angle
    turn = np.array([[math.cos(half), -math.sin(half)], [math.sin(half), math.cos(half)]])
    assert 2 * float((flank @ turn).max(axis=0)[0]) == pytest.approx(found.span[0], rel=1e-6)


def test_thickness_follows_shift_and_allowance():
    found = dimensions(pair_of(20, 0.3, 5e-5))
    nominal = 0.5 * math.pi + 2 * 0.3 * math.tan(math.radians(20.0))
    assert 1e3 * found.tooth_thickness[0] == pytest.approx(nominal - 0.05, rel=1e-12)
    assert found.chordal_thickness[0] < found.tooth_thickness[0]
    thick, thin = (dimensions(pair_of(20, 0.3, one)).span[0] for one in (0.0, 5e-5))
    assert thick - thin == pytest.approx(5e-5 * math.cos(math.radians(20.0)), rel=1e-9)


def test_sliding_and_active_diameters_are_those_of_the_path():
    pair = GearPair(Gear(teeth=20), Gear(teeth=31), module=2e-3, face_width=2e-2)
    found, path = dimensions(pair), pair.path_of_contact(n=2)
    pinion, wheel = path.specific_sliding
    assert found.sliding_at_root == pytest.approx([pinion[0], wheel[1]])
    assert found.sliding_at_tip == pytest.approx([pinion[1], wheel[0]])
    assert found.active_root_diameter == pytest.approx([2 * path.radii[0][0], 2 * path.radii[1][1]])
    assert np.all(found.active_root_diameter > found.form_diameter)


def test_what_a_gear_does_not_have_is_nan():
    relieved = Gear(teeth=12, profile_shift=0.3, tip_relief=TipRelief(1e-5, 3e-3))
    found = dimensions(GearPair(relieved, Gear(teeth=60), module=1e-3, face_width=1e-2), (None, 0.2e-3))
    assert found.span_teeth.tolist() == [0, 7]
    assert np.isnan(found.span).tolist() == [True, False]
    assert np.isnan(found.over_pins).all()
    with pytest.raises(GeometryError, match=r"pin_diameters\.wheel"):
        dimensions(pair_of(20, 0.0), (None, -1.0))
