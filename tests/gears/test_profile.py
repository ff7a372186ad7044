"""Generated teeth: the curves join, their normals and parameters fit, the trochoid is the rack's envelope."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from gears import BasicRack, Gear, TipRelief
from gears.tooth.profile import generate

RACK = BasicRack()
teeth = st.integers(5, 10_000)
shifts = st.floats(-0.8, 1.5)


def sound(z, x, rack=RACK, **more):
    """Tooth of a module of 1 m, if the rack leaves one."""
    assume(0.5 * z - rack.h_fP + x > 0.05)
    tooth = generate(Gear(z, x, **more), 1.0, rack)
    assume(tooth is not None)
    assert tooth is not None
    assume(tooth.flank_end_radius > tooth.form_radius + 1e-6)
    return tooth


@settings(deadline=None)
@given(teeth, shifts)
def test_fillet_joins_root_circle_and_involute(z, x):
    tooth = sound(z, x)
    foot, top = tooth.fillet(np.array([0.0, 1.0]))
    size = 1e-15 * z * 20 + 1e-14
    assert math.hypot(*foot) == pytest.approx(tooth.root_radius, abs=size)
    assert math.atan2(foot[0], foot[1]) == pytest.approx(tooth.root_half_angle, abs=1e-13)
    assert np.allclose(top, tooth.involute(tooth.flank_rho[0]), rtol=0, atol=size + 1e-13)
    normals = tooth.fillet_normal(np.array([0.0, 1.0]))
    assert np.allclose(normals[0], foot / math.hypot(*foot), atol=1e-12)
    if not tooth.undercut:
        assert np.allclose(normals[1], tooth.normal(tooth.flank_rho[0]), atol=1e-12)


@settings(deadline=None)
@given(teeth, shifts)
def test_fillet_is_regular_and_rises(z, x):
    tooth = sound(z, x)
    t = np.linspace(0, 1, 101)
    radius = np.linalg.norm(tooth.fillet(t), axis=1)
    assert np.all(np.diff(radius) > 0)
    curve = tooth.fillet_curve
    speed = curve.speed(t * curve.end)
    assert np.all(speed > 0)
    assert speed.max() / speed.min() < 60


@pytest.mark.parametrize(("z", "x"), [(5, 0.0), (17, 0.0), (36, 0.0), (36, 1.3), (200, -0.8), (10_000, 0.5)])
def test_normals_are_across_the_curves_and_speed_is_their_length(z, x):
    tooth = generate(Gear(z, x), 1.0, RACK)
    assert tooth is not None
    h = 1e-5
    t = np.linspace(0.05, 0.95, 19)
    tangent = (tooth.fillet(t + h) - tooth.fillet(t - h)) / (2 * h)
    assert (
        np.abs((tangent * tooth.fillet_normal(t)).sum(1)).max() < 1e-6 * np.linalg.norm(tangent, axis=1).max()
    )
    end = tooth.fillet_curve.end
    assert np.allclose(np.linalg.norm(tangent, axis=1), end * tooth.fillet_curve.speed(end * t), rtol=1e-6)
    turned = np.stack((-tooth.fillet_normal(t)[:, 1], tooth.fillet_normal(t)[:, 0]), axis=1)
    assert np.all((tangent * turned).sum(1) > 0)
    rho = np.linspace(*tooth.flank_rho, 21)[1:-1]
    tangent = (tooth.involute(rho + h) - tooth.involute(rho - h)) / (2 * h)
    assert np.allclose((tangent * tooth.normal(rho)).sum(1), 0, atol=1e-6 * np.abs(tangent).max())
    assert np.allclose(np.linalg.norm(tooth.normal(rho), axis=1), 1)


@settings(deadline=None)
@given(teeth, shifts)
def test_involute_lies_at_its_half_angle_and_radius(z, x):
    tooth = sound(z, x)
    rho = np.linspace(*tooth.flank_rho, 7)
    points = tooth.involute(rho)
    radius = np.hypot(rho, tooth.base_radius)
    assert np.allclose(np.linalg.norm(points, axis=1), radius, rtol=1e-14)
    assert np.allclose(
        np.arctan2(points[:, 0], points[:, 1]), tooth.half_angle(radius), atol=1e-9 / z + 1e-13
    )


@pytest.mark.parametrize(("z", "x"), [(9, 0.0), (17, 0.0), (36, 0.3), (80, -0.5)])
def test_fillet_is_the_envelope_of_the_rolling_rack(z, x):
    """Independent construction: the rack rolled through many positions touches each point of the fillet.

    The distance of a point from the arc's centre, smallest over all positions, is the arc's radius: less would
    be cut away, more would be left standing.
    """
    rack = RACK
    tooth = generate(Gear(z, x), 1.0, rack)
    assert tooth is not None
    r = 0.5 * z
    centre_depth = rack.h_fP - rack.rho_fP - x
    half = math.pi / 4 - (rack.h_fP - rack.rho_fP) * math.tan(rack.alpha) - rack.rho_fP / math.cos(rack.alpha)
    roll = np.linspace(-0.6, 0.6, 4001) * max(1.0, 5.0 / r)
    # rack tooth centred in the gap at polar angle pi/z, turned back by the roll; left-hand arc centre
    along = r * roll - half
    angle = math.pi / z - roll
    x_c = along * np.cos(angle) + (r - centre_depth) * np.sin(angle)
    y_c = (r - centre_depth) * np.cos(angle) - along * np.sin(angle)
    points = tooth.fillet(np.linspace(0.02, 0.98, 25))
    distance = np.hypot(points[:, :1] - x_c, points[:, 1:] - y_c).min(axis=1)
    assert np.allclose(distance, rack.rho_fP, rtol=0, atol=2e-6)


@settings(deadline=None)
@given(st.integers(5, 16), st.floats(-0.8, 0.0))
def test_undercut_when_the_rack_reaches_below_the_base_tangent_point(z, x):
    tooth = sound(z, x)
    least = 1.25 - 0.38 * (1 - math.sin(RACK.alpha)) - 0.5 * z * math.sin(RACK.alpha) ** 2
    assert tooth.undercut == (x < least)


def test_slightest_undercut_is_continuous():
    """Across the onset of undercut form radius and joint stay continuous, down to cuts of 1e-14 modules."""
    onset = 1.25 - 0.38 * (1 - math.sin(RACK.alpha)) - 8.5 * math.sin(RACK.alpha) ** 2
    for below in np.logspace(-15, -2, 27):
        tooth = generate(Gear(17, onset - below), 1.0, RACK)
        assert tooth is not None
        limit = 0.5 * below / math.sin(RACK.alpha)
        assert tooth.flank_rho[0] == pytest.approx(limit, rel=0.05 + 5 * below, abs=2e-7)
        gap = tooth.fillet(1.0) - tooth.involute(tooth.flank_rho[0])
        assert np.abs(gap).max() < 1e-13


def test_full_radius_fillet_replaces_overlapping_arcs():
    rack = BasicRack(rho_fP=0.6)
    assert rack.full_radius
    assert rack.fillet_radius == pytest.approx(rack.largest_fillet_radius)
    assert rack.fillet_radius == pytest.approx(0.4719, abs=1e-4)
    tooth = generate(Gear(30), 1.0, rack)
    assert tooth is not None
    assert tooth.root_half_angle == pytest.approx(math.pi / 30, rel=1e-14)
    assert not BasicRack().full_radius
    assert not BasicRack(alpha=math.radians(30), h_fP=1.5).largest_fillet_radius > 0


@settings(deadline=None)
@given(st.integers(8, 500), st.floats(-0.3, 0.6), st.floats(0.0, 0.1))
def test_allowance_turns_flank_and_fillet_and_leaves_the_circles(z, x, allowance):
    plain, thin = sound(z, x), sound(z, x, thickness_allowance=allowance)
    turn = allowance / z
    rotation = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    t = np.linspace(0, 1, 9)
    assert np.allclose(thin.fillet(t), plain.fillet(t) @ rotation.T, atol=1e-12)
    assert thin.form_radius == pytest.approx(plain.form_radius, abs=1e-10)
    assert (thin.root_radius, thin.tip_radius) == (plain.root_radius, plain.tip_radius)
    reference = 0.5 * z
    if plain.form_radius < reference < plain.tip_radius:
        thinner = 2 * reference * float(plain.half_angle(reference) - thin.half_angle(reference))
        assert thinner == pytest.approx(allowance, abs=1e-12)


def test_chamfer_is_straight_at_45_degrees_and_ends_on_the_tip_circle():
    tooth = generate(Gear(30, tip_chamfer=0.1), 1.0, RACK)
    assert tooth is not None
    start, middle, end = tooth.chamfer(np.array([0.0, 0.5, 1.0]))
    assert math.hypot(*start) == pytest.approx(tooth.tip_radius - 0.1)
    assert math.hypot(*end) == pytest.approx(tooth.tip_radius)
    assert math.atan2(end[0], end[1]) == pytest.approx(tooth.tip_half_angle)
    assert np.allclose(middle, (start + end) / 2)
    direction, up = (end - start) / np.linalg.norm(end - start), start / np.linalg.norm(start)
    assert direction @ up == pytest.approx(math.sqrt(0.5))


@pytest.mark.parametrize("form", ["linear", "parabolic"])
def test_relief_grows_from_zero_to_its_amount(form):
    tooth = generate(Gear(30, tip_relief=TipRelief(0.02, 0.5, form)), 1.0, RACK)
    assert tooth is not None
    end = tooth.flank_rho[1]
    relief = tooth.relief(np.array([tooth.flank_rho[0], end - 0.5, end - 0.25, end]))
    assert np.allclose(relief, [0, 0, 0.01 if form == "linear" else 0.005, 0.02])


@settings(deadline=None, max_examples=40)
@given(st.integers(5, 300), st.floats(-0.5, 0.8), st.floats(0.0, 0.2))
def test_boundary_angle_follows_the_curves(z, x, chamfer):
    tooth = sound(z, x, tip_chamfer=chamfer)
    t = np.linspace(0.02, 0.98, 11)
    for points in (tooth.fillet(t), tooth.involute(np.interp(t, [0, 1], tooth.flank_rho)), tooth.chamfer(t)):
        radius = np.linalg.norm(points, axis=1)
        angle = np.arctan2(points[:, 0], points[:, 1])
        assert np.allclose(tooth.boundary_angle(np.minimum(radius, tooth.tip_radius)), angle, atol=1e-9)
    assert tooth.boundary_angle(0.99 * tooth.root_radius) == pytest.approx(math.pi / z)
    assert tooth.boundary_angle(1.01 * tooth.tip_radius) == -np.inf
