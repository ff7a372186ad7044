"""Span, size over balls and thicknesses of helical gears against the flanks themselves, in space."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from scipy.optimize import minimize

from gears import Gear, GearPair, GeometryWarning, dimensions
from gears.tooth.profile import ToothProfile
from gears.tooth.rotation import turned

CASES = [(24, 0.3, 10.0), (36, 0.0, 20.0), (17, 0.2, -30.0), (95, -0.2, 15.0), (40, 0.1, 45.0)]


def pair_of(teeth: int, shift: float, degrees: float, **more: object) -> GearPair:
    """Gear of module 1 mm on a face of 30 mm, with a mate that runs with anything."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GeometryWarning)
        gears = Gear(teeth, shift, **more), Gear(60)
        return GearPair(*gears, 1e-3, 30e-3, helix_angle=math.radians(degrees))


def flank(pair: GearPair, rho: float, z: float, turn: float = 0.0) -> np.ndarray:
    """Point of the right-hand flank of a pinion's tooth in space, right-handed for a positive helix angle [m]."""
    tooth: ToothProfile = pair.teeth_profiles[0]
    along = math.tan(pair.base_helix_angle) / tooth.base_radius
    return np.append(turned(tooth.involute(rho), turn + along * z), z)


def normal(pair: GearPair, rho: float, z: float, turn: float) -> np.ndarray:
    """Unit normal of that flank by differences."""
    h = 1e-7
    across = flank(pair, rho + h, z, turn) - flank(pair, rho - h, z, turn)
    along = flank(pair, rho, z + h, turn) - flank(pair, rho, z - h, turn)
    product = np.cross(across, along)
    return product / np.linalg.norm(product)


@pytest.mark.parametrize(("teeth", "shift", "degrees"), CASES)
def test_a_span_touches_two_flanks_whose_normals_are_opposite(teeth, shift, degrees):
    pair = pair_of(teeth, shift, degrees, thickness_allowance=2e-5)
    sizes, tooth = dimensions(pair), pair.teeth_profiles[0]
    span, k = sizes.span[0], sizes.span_teeth[0]
    rho = math.sqrt(sizes.span_diameter[0] ** 2 / 4 - tooth.base_radius**2)
    # turned by half about the middle of the gap or tooth, the k teeth are their own image: (x, z) becomes (-x, -z)
    turn, z = -0.5 * (k - 1) * tooth.pitch_angle, 0.5 * span * math.sin(pair.base_helix_angle)
    point = flank(pair, rho, z, turn)
    across = point - point * np.array([-1.0, 1.0, -1.0])
    assert np.linalg.norm(across) == pytest.approx(span, rel=1e-12)
    assert abs(normal(pair, rho, z, turn) @ across) == pytest.approx(span, rel=1e-9)


@pytest.mark.parametrize(("teeth", "shift", "degrees"), CASES)
@pytest.mark.parametrize("factor", [1.0, 1.07])
def test_balls_touch_the_flanks_of_a_gap(teeth, shift, degrees, factor):
    pair = pair_of(teeth, shift, degrees, thickness_allowance=1e-5)
    ball = factor * dimensions(pair).pin_diameter[0]
    sizes, tooth = dimensions(pair, (ball, None)), pair.teeth_profiles[0]
    odd = math.cos(0.5 * math.pi / teeth) if teeth % 2 else 1.0
    reach = 0.5 * (sizes.over_pins[0] - ball) / odd
    gap = math.pi / teeth
    centre = reach * np.array([math.sin(gap), math.cos(gap), 0.0])

    def distance(place: np.ndarray) -> float:
        return float(np.linalg.norm(flank(pair, 1e-3 * place[0], 1e-3 * place[1]) - centre)) * 1e3

    contact = math.sqrt(sizes.pin_contact_diameter[0] ** 2 / 4 - tooth.base_radius**2)
    nearest = minimize(
        distance, [1e3 * contact, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-13}
    )
    assert nearest.fun == pytest.approx(0.5e3 * ball, rel=1e-9)
    assert 1e-3 * nearest.x[0] == pytest.approx(contact, rel=1e-4)
    assert abs(nearest.x[1]) == pytest.approx(0.5e3 * ball * math.sin(abs(pair.base_helix_angle)), rel=1e-3)


@pytest.mark.parametrize(("teeth", "shift", "degrees"), CASES)
def test_balls_that_are_not_given_touch_at_the_shifted_reference_circle(teeth, shift, degrees):
    pair = pair_of(teeth, shift, degrees)
    sizes = dimensions(pair)
    wanted = sizes.reference_diameter[0] + 2 * shift * pair.module
    larger = dimensions(pair, (sizes.pin_diameter[0] + 0.1e-3, None)).pin_contact_diameter[0]
    # rounded up to two digits: up to a tenth of a millimetre more than what touches there
    excess = sizes.pin_contact_diameter[0] - wanted
    assert -1e-9 <= excess <= 1.05 * (larger - sizes.pin_contact_diameter[0])


@pytest.mark.parametrize("degrees", [8.0, 25.0, 45.0])
def test_thicknesses_are_normal_ones(degrees):
    pair = pair_of(30, 0.2, degrees, thickness_allowance=3e-5)
    sizes, tooth = dimensions(pair), pair.teeth_profiles[0]
    nominal = 0.5 * math.pi + 2 * 0.2 * math.tan(math.radians(20.0))
    assert 1e3 * sizes.tooth_thickness[0] == pytest.approx(nominal - 0.03, rel=1e-12)
    # the chord of the shortest line across the tooth on the reference cylinder
    r, s, c = tooth.reference_radius, sizes.tooth_thickness[0], math.cos(pair.helix_angle)
    turn, rise = 0.5 * s * c / r, s * math.sin(pair.helix_angle)
    assert sizes.chordal_thickness[0] == pytest.approx(math.hypot(2 * r * math.sin(turn), rise), rel=1e-5)
    arc = tooth.tip_radius * (1 - math.cos(turn)) + tooth.tip_radius - r
    assert sizes.chordal_height[0] == pytest.approx(arc, rel=5e-3)
    tip = math.atan(math.tan(pair.helix_angle) * tooth.tip_radius / r)
    assert sizes.tip_thickness[0] == pytest.approx(
        2 * tooth.tip_radius * tooth.tip_half_angle * math.cos(tip), rel=1e-12
    )


def test_a_span_needs_a_face_that_is_wide_enough():
    gears, angle = (Gear(40), Gear(60)), math.radians(30.0)
    wide = dimensions(GearPair(*gears, 1e-3, 30e-3, helix_angle=angle))
    least = wide.span[0] * math.sin(math.radians(28.0243))
    narrow = dimensions(GearPair(*gears, 1e-3, 0.99 * least, helix_angle=angle))
    assert narrow.span_teeth[0] < wide.span_teeth[0]
    none = dimensions(GearPair(*gears, 1e-3, 1e-3, helix_angle=angle))
    assert none.span_teeth[0] == 0
    assert math.isnan(none.span[0])
    assert np.isfinite(none.over_pins[0])


def test_both_hands_measure_the_same():
    right, left = (dimensions(pair_of(36, 0.1, degrees)) for degrees in (20.0, -20.0))
    for name in ("span", "span_teeth", "over_pins", "tooth_thickness", "tip_thickness", "pin_diameter"):
        assert np.array_equal(getattr(right, name), getattr(left, name))


@pytest.mark.parametrize("beta", [1e-3, 1e-5, 1e-8])
def test_sizes_go_over_into_those_of_spur_gears(beta):
    gears = Gear(25, 0.1, thickness_allowance=1e-5), Gear(40)
    spur, slight = (dimensions(GearPair(*gears, 1e-3, 2e-2, helix_angle=angle)) for angle in (0.0, beta))
    for name in (
        "span",
        "over_pins",
        "tooth_thickness",
        "chordal_thickness",
        "chordal_height",
        "tip_thickness",
    ):
        assert getattr(slight, name) == pytest.approx(getattr(spur, name), rel=20 * beta**2 + 1e-13)
