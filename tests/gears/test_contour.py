"""Contours: points on the exact curves, chords within the tolerance, arcs exact, closed."""

from __future__ import annotations

import math

import numpy as np
import pytest

from gears import BasicRack, Gear, GearPair, GeometryError, TipRelief
from gears.tooth.contour import chords, contour

PAIRS = {
    "plain": GearPair(pinion=Gear(teeth=36), wheel=Gear(teeth=40), module=2e-3, face_width=0.04),
    "undercut": GearPair(
        pinion=Gear(teeth=14), wheel=Gear(teeth=30, tip_alteration=-0.3), module=5e-3, face_width=0.04
    ),
    "full fillet, chamfer": GearPair(
        pinion=Gear(teeth=25, profile_shift=0.3, tip_chamfer=0.3e-3, thickness_allowance=30e-6),
        wheel=Gear(teeth=30),
        module=3e-3,
        face_width=0.04,
        rack=BasicRack(h_fP=1.25, rho_fP=1.0),
    ),
}
PROFILES = {name: pair.teeth_profiles[0] for name, pair in PAIRS.items()}


def area(points):
    x, y = points.T
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def polar(points):
    return np.hypot(*points.T), np.arctan2(points[:, 0], points[:, 1])


@pytest.mark.parametrize("name", PROFILES)
def test_points_lie_on_the_exact_curves(name):
    profile = PROFILES[name]
    curve = profile.fillet_curve
    for segment in contour(profile, 1, 1e-6).segments:
        points = np.abs(segment.points) if segment.part in ("flank", "fillet") else segment.points
        radius, angle = polar(points)
        if segment.part == "flank":
            wrong = (angle - profile.half_angle(radius)) * radius
        elif segment.part == "fillet":
            # across the curve: at the root circle a radius gives the place along it to 1e-8 alone
            beta = curve.beta_at(radius, curve.end)
            wrong = np.sum((points - curve.point(beta)) * curve.normal(beta), axis=-1)
        else:
            continue
        assert np.max(np.abs(wrong)) < 1e-12 * profile.module


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("tolerance", [1e-5, 1e-6, 1e-8])
def test_chords_keep_within_the_tolerance(name, tolerance):
    # independent of the spacing: boundary_angle gives the material's edge at any radius
    profile = PROFILES[name]
    fine = np.linspace(profile.root_radius, profile.tip_radius, 20_001)[1:-1]
    edge = np.asarray(profile.boundary_angle(fine))
    exact = fine[:, None] * np.stack((np.sin(edge), np.cos(edge)), axis=-1)
    points, _ = contour(profile, 1, tolerance).polygon()
    half = points[(points[:, 0] > 0)]
    half = half[np.hypot(*half.T) > profile.root_radius * (1 - 1e-9)]
    chord = np.diff(half, axis=0)
    distance = np.full(len(exact), np.inf)
    for start, along in zip(half[:-1], chord, strict=True):
        share = np.clip(((exact - start) @ along) / (along @ along), 0.0, 1.0)
        distance = np.minimum(distance, np.hypot(*(exact - start - share[:, None] * along).T))
    assert np.max(distance) <= 1.02 * tolerance
    assert np.max(distance) >= 0.3 * tolerance  # and they are no finer than asked for


def test_the_number_of_chords_grows_with_the_root_of_the_tolerance():
    counts = [len(contour(PROFILES["plain"], 1, 10.0**-k).polygon()[0]) for k in (6, 8)]
    assert counts[1] / counts[0] == pytest.approx(10.0, rel=0.15)


def test_chords_of_a_circle_are_the_fewest():
    def circle(t):
        return np.stack((np.cos(t), np.sin(t)), axis=-1)

    points = chords(circle, 0.0, math.pi, 1e-4)
    fewest = math.ceil(math.pi / (2.0 * math.acos(1.0 - 1e-4)))
    assert fewest <= len(points) - 1 <= fewest + 1


@pytest.mark.parametrize("tolerance", [0.3, 0.1, 0.05, 0.01])
def test_points_between_the_vertices_confirm_the_tolerance(tolerance):
    # inflections: there the estimate from curvature alone asks for too few chords
    def wave(t):
        return np.stack((t, 0.3 * np.sin(3 * t)), axis=-1)

    points = chords(wave, 0.0, 2.0 * math.pi, tolerance)
    exact = wave(np.linspace(0.0, 2.0 * math.pi, 20_001))
    at = np.clip(np.searchsorted(points[:, 0], exact[:, 0]) - 1, 0, len(points) - 2)
    chord, apart = np.diff(points, axis=0)[at], exact - points[at]
    distance = np.abs(chord[:, 0] * apart[:, 1] - chord[:, 1] * apart[:, 0]) / np.hypot(*chord.T)
    assert np.max(distance) <= tolerance


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("teeth", [None, 1, 3])
def test_contours_are_closed_anticlockwise_and_hold_their_area(name, teeth):
    profile = PROFILES[name]
    found = contour(profile, teeth, 1e-7)
    for before, after in zip(found.segments[-1:] + found.segments[:-1], found.segments, strict=True):
        assert np.array_equal(before.points[-1], after.points[0])
    # material between root and tip circle from the boundary angle, an independent quadrature
    radius = np.linspace(profile.root_radius, profile.tip_radius, 40_001)
    edge = np.clip(np.asarray(profile.boundary_angle(radius)), 0.0, None)
    tooth = float(np.trapezoid(2.0 * edge * radius, radius))
    count = teeth or profile.teeth
    inner = 0.0 if teeth is None else profile.bore_radius
    body = 0.5 * count * profile.pitch_angle * (profile.root_radius**2 - inner**2)
    assert area(found.polygon()[0]) == pytest.approx(count * tooth + body, rel=2e-5)
    assert (found.bore_radius is None) == (teeth is not None)


@pytest.mark.parametrize("name", PROFILES)
def test_arcs_are_exact_and_turn_by_their_angle(name):
    profile = PROFILES[name]
    radii = {"root": profile.root_radius, "land": profile.tip_radius, "bore": profile.bore_radius}
    for segment in contour(profile, 2, 1e-6).segments:
        if segment.angle == 0.0:
            continue
        assert np.hypot(*segment.points.T) == pytest.approx(radii[segment.part], rel=1e-14)
        chord = float(np.linalg.norm(segment.points[1] - segment.points[0]))
        # of a bulge b: sagitta b c / 2, radius c (1 + b^2) / (4 b)
        assert chord * (1 + segment.bulge**2) / (4 * abs(segment.bulge)) == pytest.approx(
            radii[segment.part], rel=1e-9
        )
        assert (segment.angle < 0.0) == (segment.part == "bore")


@pytest.mark.parametrize("form", ["linear", "parabolic"])
@pytest.mark.parametrize("chamfer", [0.0, 0.2e-3])
def test_relief_is_taken_off_normal_to_the_flank(form, chamfer):
    relief = TipRelief(20e-6, 2e-3, form)
    pair = GearPair(
        pinion=Gear(teeth=36, tip_relief=relief, tip_chamfer=chamfer),
        wheel=Gear(teeth=40),
        module=2e-3,
        face_width=0.04,
    )
    profile = pair.teeth_profiles[0]
    found = contour(profile, 1, 1e-7)
    flanks = [s for s in found.segments if s.part == "flank" and s.points[0, 0] > 0]
    assert len(flanks) == 2  # a kink where the relief starts
    radius, angle = polar(flanks[1].points)
    assert radius[-1] == pytest.approx(profile.flank_end_radius, rel=1e-12)
    # along the normal, which touches the base circle, the point is rho - relief from it
    left = np.sqrt(radius**2 - profile.base_radius**2)
    turn = profile.base_half_angle - angle + np.arctan(left / profile.base_radius)
    rolled = turn * profile.base_radius
    assert rolled - left == pytest.approx(profile.relief(rolled), abs=1e-12)
    plain, _ = contour(profile, 1, 1e-7, relief=False).polygon()
    assert area(found.polygon()[0]) < area(plain)


@pytest.mark.parametrize(
    ("teeth", "tolerance", "where"),
    [
        (0, 1e-6, "teeth"),
        (37, 1e-6, "teeth"),
        (1, 0.0, "tolerance"),
        (1, math.nan, "tolerance"),
        (None, 1e-10, "tolerance"),
    ],
)
def test_senseless_requests_are_refused(teeth, tolerance, where):
    profile = PAIRS["plain"].teeth_profiles[0]
    if teeth is None:
        profile = GearPair(
            pinion=Gear(teeth=3000), wheel=Gear(teeth=3000), module=2e-3, face_width=0.04
        ).teeth_profiles[0]
    with pytest.raises(GeometryError) as caught:
        contour(profile, teeth, tolerance)
    assert caught.value.faults[0].where == where


def test_a_relief_steeper_than_the_flank_is_refused():
    profile = GearPair(
        pinion=Gear(teeth=36, tip_relief=TipRelief(0.4e-3, 0.5e-3)),
        wheel=Gear(teeth=40),
        module=2e-3,
        face_width=0.04,
    ).teeth_profiles[0]
    with pytest.raises(GeometryError, match="Relieve less"):
        contour(profile, 1, 1e-6)
