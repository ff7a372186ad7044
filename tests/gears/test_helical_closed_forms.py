"""Standards' factors of helical gears: limits, identities, hands, and what is refused."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from base import RangeWarning
from gears import Gear, GearPair, GeometryError, GeometryWarning, closed_form, half_width, peak_pressure
from gears.closed_form.root_stress import helix_factor
from gears.closed_form.virtual_gear import virtual_gear

GEARS = Gear(36), Gear(40)
angles = st.floats(1.0, 30.0)


def helical(degrees: float, gears=GEARS, face_width: float = 40e-3, **more: object) -> GearPair:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GeometryWarning)
        return GearPair(*gears, 2e-3, face_width, helix_angle=math.radians(degrees), **more)


def numbers(pair: GearPair) -> np.ndarray:
    """All figures of the standard for a pair."""
    force = pair.normal_force(600.0)
    stiffness, contact = closed_form.iso6336(pair), closed_form.iso6336_2(pair, force)
    root, face = closed_form.iso6336_3(pair, force), closed_form.iso6336_face_load(pair, 600.0, 10e-6)
    return np.array(
        [
            *(stiffness.c_th, stiffness.c_prime, stiffness.c_gamma, stiffness.c_gamma_beta),
            *(contact.Z_H, contact.Z_eps, contact.Z_beta, contact.Z_B, contact.Z_D, *contact.stresses),
            *(value for s in root.sections for value in (s.Y_F, s.Y_S, s.s_Fn, s.h_Fe, s.rho_F)),
            *(root.Y_beta, *root.stresses, face.K_Hbeta, face.K_Fbeta),
            closed_form.iso6336_transverse_load(pair, 600.0, 10e-6).K_Halpha,
            closed_form.ohlendorf_loss_factor(pair),
        ]
    )


@settings(deadline=None, max_examples=30)
@given(angles)
def test_hands_have_equal_factors(degrees):
    assert np.array_equal(numbers(helical(degrees)), numbers(helical(-degrees)))


@pytest.mark.parametrize("beta", [1e-3, 1e-5, 1e-7])
def test_factors_go_over_into_those_of_spur_gears(beta):
    spur = numbers(GearPair(*GEARS, 2e-3, 40e-3))
    slight = numbers(GearPair(*GEARS, 2e-3, 40e-3, helix_angle=beta))
    # overlap enters Z_eps, Y_beta, Z_B and K_Halpha linearly
    assert np.allclose(slight, spur, rtol=5 * beta + 1e-12)
    assert not np.array_equal(slight, spur)


@settings(deadline=None, max_examples=30)
@given(angles)
def test_zone_and_helix_factors_are_the_pressure_of_the_whole_force_on_the_mean_lines(degrees):
    """Z_H Z_E Z_eps at an overlap of one: the pressure at C under an even load on the mean length of the lines."""
    pair = helical(degrees, face_width=2e-3 * math.pi / math.sin(math.radians(degrees)) * 1.01)
    force = pair.normal_force(600.0)
    stress = closed_form.iso6336_2(pair, force)
    line_load = force / (pair.face_width * pair.contact_ratio / math.cos(pair.base_helix_angle))
    radius = pair.path_at(pair.points.C).radius[0] / math.cos(pair.base_helix_angle)
    pressure = peak_pressure(line_load, radius, pair.reduced_modulus)
    assert half_width(line_load, radius, pair.reduced_modulus) > 0.0
    assert stress.stresses[0] / stress.Z_beta == pytest.approx(float(pressure), rel=1e-9)
    assert stress.Z_beta == pytest.approx(1.0 / math.sqrt(math.cos(pair.helix_angle)))


def test_contact_ratio_factor_goes_from_shared_pairs_to_shared_lines():
    ratio = helical(20.0).contact_ratio
    for overlap in (0.01, 0.5, 0.999, 1.0, 1.001, 2.0):
        width = overlap * 2e-3 * math.pi / math.sin(math.radians(20.0))
        Z_eps = closed_form.iso6336_2(helical(20.0, face_width=width), 1e4).Z_eps
        counted = min(overlap, 1.0)
        assert Z_eps**2 == pytest.approx((4.0 - ratio) / 3.0 * (1.0 - counted) + counted / ratio, rel=1e-12)


def test_single_pair_factors_vanish_with_an_overlap_of_one():
    few = Gear(14, 0.4), Gear(60)
    spur = closed_form.iso6336_2(helical(0.0, few), 1e4)
    assert spur.Z_B > 1.02
    half, whole = (
        helical(10.0, few, face_width=w * 2e-3 * math.pi / math.sin(math.radians(10.0))) for w in (0.5, 1.0)
    )
    assert closed_form.iso6336_2(whole, 1e4).Z_B == 1.0
    pitch, total = half.points.C, half.line_of_action
    M_1 = math.sqrt(pitch * (total - pitch) / (half.points.B * (total - half.points.B)))
    assert pytest.approx(0.5 * M_1 + 0.5, rel=1e-12) == closed_form.iso6336_2(half, 1e4).Z_B


def test_helix_factor_counts_overlap_to_one_and_the_angle_to_30_degrees():
    assert helix_factor(math.radians(12.0), 0.5) == pytest.approx(0.95)
    assert helix_factor(math.radians(-12.0), 5.0) == pytest.approx(0.9)
    assert helix_factor(math.radians(45.0), 1.0) == pytest.approx(0.75)


@settings(deadline=None, max_examples=30)
@given(angles, st.sampled_from([(18, 0.3), (36, 0.0), (60, -0.2)]))
def test_the_virtual_gear_is_the_standards(degrees, gear):
    pair = helical(degrees, (Gear(*gear, thickness_allowance=2e-5), Gear(40)))
    m, z, x = pair.module, gear[0], gear[1]
    alpha, beta, base = pair.rack.alpha, pair.helix_angle, pair.base_helix_angle
    tooth = pair.teeth_profiles[0]
    virtual = virtual_gear(tooth, pair.helix)
    z_n = z / (math.cos(base) ** 2 * math.cos(beta))
    d_n = m * z_n
    d_bn, d_an = d_n * math.cos(alpha), d_n + 2 * (tooth.tip_radius - tooth.reference_radius)
    assert virtual.teeth == pytest.approx(z_n)
    assert 2 * virtual.base_radius == pytest.approx(d_bn)
    assert 2 * virtual.flank_end_radius == pytest.approx(d_an)
    involute = math.tan(alpha) - alpha
    half = (0.5 * math.pi + 2 * x * math.tan(alpha)) / z_n + involute - 2e-5 / d_n
    assert virtual.base_half_angle == pytest.approx(half, rel=1e-12)
    beyond = math.pi * m * math.cos(alpha) * (pair.contact_ratio / math.cos(base) ** 2 - 1.0)
    outer = math.sqrt((0.5 * d_an) ** 2 - (0.5 * d_bn) ** 2) - beyond
    found = virtual.load_rho(tooth, pair.points.D, pair.base_pitch)
    assert found == pytest.approx(outer, rel=1e-12)


def test_transverse_load_factors_keep_their_limits():
    pair = helical(20.0)
    even = closed_form.iso6336_transverse_load(pair, 600.0, 0.0)
    assert even.K_Halpha == even.K_Falpha == 1.0
    total = pair.total_contact_ratio
    q = closed_form.iso6336(pair).c_gamma * 1e9 * 8e-6 / (600.0 / pair.reference_radii[0] / pair.face_width)
    some = closed_form.iso6336_transverse_load(pair, 600.0, 8e-6)
    assert some.K_Halpha == pytest.approx(0.9 + 0.4 * q * math.sqrt(2 * (total - 1) / total))
    narrow = helical(20.0, face_width=5e-3)
    q = closed_form.iso6336(narrow).c_gamma * 1e9 * 8e-6 / (30.0 / narrow.reference_radii[0] / 5e-3)
    at = closed_form.iso6336_transverse_load(narrow, 30.0, 8e-6)
    assert at.K_Halpha == pytest.approx(0.5 * narrow.total_contact_ratio * (0.9 + 0.4 * q))
    rough = closed_form.iso6336_transverse_load(pair, 1.0, 1e-3)
    Z_eps = closed_form.iso6336_2(pair, 1e4).Z_eps
    assert rough.K_Halpha == pytest.approx(total / (pair.contact_ratio * Z_eps**2))
    assert rough.K_Falpha == rough.limits[1] < rough.K_Halpha
    for torque, deviation in ((0.0, 1e-6), (600.0, -1e-6), (math.nan, 0.0)):
        with pytest.raises(GeometryError):
            closed_form.iso6336_transverse_load(pair, torque, deviation)


def test_the_dynamic_factor_takes_the_total_contact_ratio():
    pair = helical(20.0)
    at = closed_form.iso6336_dynamic(
        pair, 1e4, 0.38, [1e3, 1e5], pitch_deviation=5e-6, profile_deviation=5e-6
    )
    total = pair.total_contact_ratio
    above = 0.47 * at.B_p + 0.12 / (total - 1.74) * at.B_f
    seven = 0.125 * math.sin(math.pi * (min(total, 2.5) - 2.0)) + 0.875
    assert at.K_v[1] == pytest.approx(above + seven)
    load = 1e4 * math.cos(pair.rack.alpha) * math.cos(pair.helix_angle) / 40e-3
    assert at.B_p == pytest.approx(closed_form.iso6336(pair).c_prime * 1e9 * 5e-6 / load)


def test_deflections_and_friction_of_spur_gears_refuse_a_helix():
    pair = helical(20.0)
    path = pair.path_of_contact(3)
    for form in (
        lambda: closed_form.ishikawa(pair, path),
        lambda: closed_form.potential_energy(pair, path),
        lambda: closed_form.weber_banaschek(pair, path, 1e4),
        lambda: closed_form.hertz(pair, path, 1e4),
        lambda: closed_form.schlenk_friction(pair, 600.0, 200.0, 0.06, 0.4e-6),
    ):
        with pytest.raises(GeometryError, match=r"pair.helix_angle = 0.349066 rad \(20 deg\): must be 0 for"):
            form()


def test_beta_45_has_finite_factors():
    pair = helical(45.0, (Gear(20, 0.2), Gear(31)))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        assert np.all(np.isfinite(numbers(pair)))
