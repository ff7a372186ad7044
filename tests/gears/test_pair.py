"""The pair: radii, path, backlash, placement, speeds, by identities that hold for every pair."""

from __future__ import annotations

import math
import pickle
import subprocess
import sys
import warnings

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gears import Gear, GearPair, GeometryError, GeometryWarning, Material
from gears.tooth.rotation import mirrored, turned

numbers = st.integers(18, 200)
shift = st.floats(-0.1, 0.5)


def sound_pair(z1, z2, x1=0.0, x2=0.0, **more):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", GeometryWarning)
            return GearPair(Gear(z1, x1), Gear(z2, x2), module=2e-3, face_width=20e-3, **more)
    except GeometryError:
        assume(False)
        raise


@settings(deadline=None)
@given(numbers, numbers, shift, shift)
def test_path_identities(z1, z2, x1, x2):
    pair = sound_pair(z1, z2, x1, x2)
    path, points = pair.path_of_contact(13), pair.points
    total = pair.working_centre_distance * math.sin(pair.working_pressure_angle)
    assert np.allclose(path.rho1 + path.rho2, total, rtol=1e-12)
    assert path.rho1[0] == points.A
    assert path.rho1[-1] == points.E
    assert np.allclose(path.radius, 1 / (1 / path.rho1 + 1 / path.rho2))
    assert path.position[0] == 0.0
    assert math.isclose(points.B, points.E - pair.base_pitch)
    assert math.isclose(points.D, points.A + pair.base_pitch)
    assert sum(pair.pitch_radii) == pytest.approx(pair.working_centre_distance)
    assert pair.pitch_radii[1] / pair.pitch_radii[0] == pytest.approx(pair.ratio)
    assert path.radii[1][0] == pytest.approx(pair.tip_radii[1])
    assert path.radii[0][-1] == pytest.approx(pair.tip_radii[0])
    pitch = pair.path_at(points.C)
    assert pitch.radii[0][0] == pytest.approx(pair.pitch_radii[0])
    assert pitch.sliding(100.0)[0] == pytest.approx(0.0, abs=1e-12)
    assert np.arctan(pitch.rho1[0] / pair.base_radii[0]) == pytest.approx(pair.working_pressure_angle)
    first, second = path.surface_speeds(100.0)
    assert np.allclose(path.entrainment(100.0), (first + second) / 2)
    assert np.allclose(path.sliding(100.0), first - second)
    assert np.all(np.diff(path.sliding(100.0)) > 0)


@settings(deadline=None)
@given(numbers, numbers, shift, shift)
def test_working_angle_leaves_no_backlash(z1, z2, x1, x2):
    """The teeth fill the pitch circle exactly: s_w1 + s_w2 = p_w, by the generated half angles."""
    pair = sound_pair(z1, z2, x1, x2)
    assert pair.backlash == 0.0
    thickness = [
        2 * r * float(tooth.base_half_angle - (math.tan(a) - a))
        for r, tooth, a in zip(
            pair.pitch_radii, pair.teeth_profiles, [pair.working_pressure_angle] * 2, strict=True
        )
    ]
    assert sum(thickness) == pytest.approx(2 * math.pi * pair.pitch_radii[0] / z1, rel=1e-12)


@settings(deadline=None)
@given(numbers, numbers, shift, shift, st.floats(0.0, 0.2))
def test_centre_distance_and_allowance_give_the_backlash_of_the_teeth(z1, z2, x1, x2, apart):
    nominal = sound_pair(z1, z2, x1, x2)
    pair = sound_pair(z1, z2, x1, x2, centre_distance=nominal.working_centre_distance + apart * 2e-3)
    pair = pair.with_backlash(pair.backlash + 1e-5)
    alpha = pair.working_pressure_angle
    thickness = sum(
        2 * r * float(tooth.base_half_angle - (math.tan(alpha) - alpha))
        for r, tooth in zip(pair.pitch_radii, pair.teeth_profiles, strict=True)
    )
    gap = 2 * math.pi * pair.pitch_radii[0] / z1 - thickness
    assert pair.backlash == pytest.approx(gap * math.cos(alpha), abs=1e-14)


@settings(deadline=None)
@given(numbers, numbers, shift, shift, st.floats(0, 1))
def test_placed_flanks_touch_with_opposite_normals(z1, z2, x1, x2, where):
    pair = sound_pair(z1, z2, x1, x2).with_backlash(3e-5)
    rho = pair.points.A + where * (pair.points.E - pair.points.A)
    placed, path, (first, second) = pair.placement(rho), pair.path_at(rho), pair.teeth_profiles
    assert np.allclose(placed.pinion(mirrored(first.involute(path.rho1))), placed.contact_point, atol=1e-15)
    assert np.allclose(placed.wheel(mirrored(second.involute(path.rho2))), placed.contact_point, atol=1e-14)
    assert np.allclose(
        turned(mirrored(first.normal(path.rho1)), placed.pinion_angle), placed.normal, atol=1e-13
    )
    assert np.allclose(
        turned(mirrored(second.normal(path.rho2)), placed.wheel_angle), -placed.normal, atol=1e-13
    )
    assert np.allclose(placed.wheel_centre, [0, pair.working_centre_distance])


def test_the_loaded_pinion_turns_anticlockwise_and_pushes_the_wheel_clockwise(article_pair):
    early, late = (article_pair.placement(rho) for rho in (article_pair.points.A, article_pair.points.E))
    assert late.pinion_angle > early.pinion_angle
    assert late.wheel_angle < early.wheel_angle
    arm = early.contact_point - early.wheel_centre
    assert arm[0] * early.normal[1] - arm[1] * early.normal[0] < 0
    # the next tooth of each gear, one pitch behind, touches one base pitch earlier
    next_pair = article_pair.placement(article_pair.points.E - article_pair.base_pitch)
    first, second = article_pair.teeth_profiles
    assert next_pair.pinion_angle == pytest.approx(late.pinion_angle - first.pitch_angle)
    assert next_pair.wheel_angle == pytest.approx(late.wheel_angle + second.pitch_angle)


def test_swapping_the_gears_mirrors_the_path():
    one = GearPair(Gear(20, 0.3), Gear(51, -0.1), 3e-3, 30e-3)
    two = GearPair(Gear(51, -0.1), Gear(20, 0.3), 3e-3, 30e-3)
    assert one.contact_ratio == pytest.approx(two.contact_ratio, rel=1e-12)
    assert np.allclose(one.path_of_contact(5).rho1, two.path_of_contact(5).rho2[::-1], rtol=1e-10)


def test_everything_scales_with_the_module():
    small, large = (GearPair(Gear(20, 0.3), Gear(51), m, 0.03) for m in (1e-3, 8e-3))
    assert large.working_centre_distance == pytest.approx(8 * small.working_centre_distance)
    assert large.contact_ratio == pytest.approx(small.contact_ratio, rel=1e-12)


def test_chamfer_shortens_the_path():
    plain = GearPair(Gear(30), Gear(40), 2e-3, 0.02)
    cut = GearPair(Gear(30, tip_chamfer=2e-4), Gear(40, tip_chamfer=1e-4), 2e-3, 0.02)
    assert cut.points.E < plain.points.E
    assert cut.points.A > plain.points.A
    assert cut.path_of_contact(2).radii[0][-1] == pytest.approx(cut.tip_radii[0] - 2e-4)
    assert cut.path_of_contact(2).radii[1][0] == pytest.approx(cut.tip_radii[1] - 1e-4)


def test_two_materials_bores_and_inertia():
    steel, bronze = Material(206e9, 0.3, 7850.0), Material(110e9, 0.34, 8800.0)
    pair = GearPair(Gear(30), Gear(40, bore_radius=0.01), 2e-3, 0.02, material=(steel, bronze))
    expected = 2 / ((1 - 0.3**2) / 206e9 + (1 - 0.34**2) / 110e9)
    assert pair.reduced_modulus == pytest.approx(expected)
    assert pair.bore_radii == (pytest.approx(0.5 * pair.root_radii[0]), 0.01)
    disc = 0.5 * math.pi * 8800.0 * 0.02 * (0.04**4 - 0.01**4)
    assert pair.moments_of_inertia[1] == pytest.approx(disc)
    assert pair.normal_force(100.0) * pair.base_radii[0] == pytest.approx(100.0)


def test_path_refuses_points_off_the_line_of_action(article_pair):
    for rho in (-1e-3, np.nan, 1.0):
        with pytest.raises(GeometryError, match="rho1"):
            article_pair.path_at(rho)
    with pytest.raises(GeometryError, match="points"):
        article_pair.path_of_contact(1)


def test_backlash_below_that_of_the_centre_distance_is_refused():
    pair = GearPair(Gear(30), Gear(40), 2e-3, 0.02, centre_distance=70.2e-3)
    for wanted in (0.0, -1e-5, math.nan):
        with pytest.raises(GeometryError, match="backlash"):
            pair.with_backlash(wanted)
    assert pair.with_backlash(2e-4).with_backlash(pair.backlash).backlash == pytest.approx(pair.backlash)


def test_pairs_compare_pickle_and_hash(article_pair):
    again = pickle.loads(pickle.dumps(article_pair))
    assert again == article_pair
    assert hash(again) == hash(article_pair)
    assert again.points == article_pair.points


def test_import_is_light():
    code = (
        "import sys, gears; heavy = {'scipy', 'numba', 'gmsh', 'skfem', 'matplotlib', 'pyvista'}; "
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("shift", [0.0, 0.1, 0.2, 0.3])
def test_what_rounding_leaves_of_no_backlash_is_zero(shift):
    for teeth in range(18, 90, 5):
        first, second = Gear(21, shift), Gear(teeth, shift)
        distance = GearPair(first, second, 2e-3, 0.02).working_centre_distance
        pair = GearPair(first, second, 2e-3, 0.02, centre_distance=distance)
        assert pair.backlash == 0.0
        assert pair.with_backlash(50e-6).with_backlash(0.0).backlash == 0.0
