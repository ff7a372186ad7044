"""Helical pairs: the transverse section, its fillet, and spur gears as the case of no helix."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from base import RangeWarning
from gears import BasicRack, Gear, GearPair, GeometryError, GeometryWarning, check_meshing, closed_form
from gears.tooth.helix import Helix
from gears.tooth.profile import generate

PAIR = Gear(36), Gear(40)
angles = st.floats(0.0, math.radians(45.0))
racks = st.sampled_from(
    [BasicRack(), BasicRack(1.0, 1.4, 0.39), BasicRack(1.0, 1.25, 0.25, math.radians(25.0))]
)


def helical(degrees: float, gears=PAIR, **more: object) -> GearPair:
    """Pair of module 2 mm with a face of 40 mm, unless given."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", GeometryWarning)
        sizes = {"module": 2e-3, "face_width": 40e-3} | more
        return GearPair(*gears, **sizes, helix_angle=math.radians(degrees))


def sound(z, x, angle, rack, **more):
    """Tooth of a normal module of 1 m, if the rack leaves one."""
    tooth = generate(Gear(z, x, **more), 1.0, rack, helix_angle=angle)
    assume(tooth is not None)
    assert tooth is not None
    assume(tooth.flank_end_radius > tooth.form_radius + 1e-6)
    assume(tooth.root_radius > 0.05)
    return tooth


def test_a_helix_of_none_is_factors_of_one_and_summands_of_zero():
    helix = Helix(0.0, math.radians(20.0))
    assert helix.cosine == helix.base_cosine == 1.0
    assert helix.base_sine == helix.base_tangent == helix.base_angle == 0.0
    alpha = helix.normal_pressure_angle
    assert helix.transverse_pressure_angle == alpha
    assert helix.transverse_sine == math.sin(alpha)
    assert helix.transverse_cosine == math.cos(alpha)
    assert helix.transverse_tangent == math.tan(alpha)
    assert helix.virtual_teeth(17) == 17


def test_spur_pairs_have_the_formulas_of_spur_gears_to_the_last_bit():
    pair = GearPair(Gear(19, 0.3), Gear(53, -0.1), module=3e-3, face_width=30e-3, centre_distance=110e-3)
    alpha = pair.rack.alpha
    for gear, tooth in zip((pair.pinion, pair.wheel), pair.teeth_profiles, strict=True):
        radius = 0.5 * gear.teeth * pair.module
        assert tooth.reference_radius == radius
        assert tooth.base_radius == radius * math.cos(alpha)
        curve, beta = tooth.fillet_curve, np.linspace(0.0, tooth.fillet_curve.end, 33)
        distance = curve.depth / np.cos(beta) + curve.arc_radius
        turn = curve.foot_angle + curve.depth * np.tan(beta) / radius
        across, up = -distance * np.sin(beta), radius - distance * np.cos(beta)
        points = (across * np.cos(turn) + up * np.sin(turn), up * np.cos(turn) - across * np.sin(turn))
        assert np.array_equal(curve.point(beta), np.stack(points, axis=-1))
        assert np.array_equal(curve.normal(beta)[:, 0], np.sin(beta + turn))
    assert pair.base_pitch == math.pi * pair.module * math.cos(alpha)
    assert pair.normal_force(600.0) == 600.0 / pair.base_radii[0]
    assert pair.overlap_ratio == pair.axial_force(600.0) == 0.0
    assert pair.total_contact_ratio == pair.contact_ratio
    assert pair.transverse_module == pair.module


@given(angles, st.floats(math.radians(14.0), math.radians(30.0)))
def test_angles_obey_the_identities_of_iso_21771(beta, alpha):
    helix = Helix(beta, alpha)
    transverse, base = helix.transverse_pressure_angle, helix.base_angle
    assert math.tan(transverse) == pytest.approx(math.tan(alpha) / math.cos(beta), rel=1e-13)
    assert helix.transverse_tangent == pytest.approx(math.tan(transverse), rel=1e-13)
    assert helix.transverse_sine == pytest.approx(math.sin(transverse), rel=1e-13)
    assert helix.transverse_cosine == pytest.approx(math.cos(transverse), rel=1e-13)
    assert math.tan(base) == pytest.approx(math.tan(beta) * math.cos(transverse), rel=1e-12, abs=1e-300)
    assert helix.base_tangent == pytest.approx(math.tan(base), rel=1e-12, abs=1e-300)
    assert helix.base_cosine == pytest.approx(math.cos(base), rel=1e-13)


@settings(deadline=None)
@given(st.integers(6, 2000), st.floats(-0.6, 1.2), angles, racks)
def test_fillets_join_root_circle_and_involute_and_rise(z, x, angle, rack):
    tooth = sound(z, x, angle, rack)
    t = np.linspace(0, 1, 101)
    points, normals = tooth.fillet(t), tooth.fillet_normal(t)
    size = 1e-14 * z + 1e-13
    assert math.hypot(*points[0]) == pytest.approx(tooth.root_radius, abs=size)
    assert np.allclose(points[-1], tooth.involute(tooth.flank_rho[0]), rtol=0, atol=size)
    assert np.all(np.diff(np.linalg.norm(points, axis=1)) > 0)
    assert np.all(tooth.fillet_curve.speed(t * tooth.fillet_curve.end) > 0)
    assert np.allclose(np.linalg.norm(normals, axis=1), 1.0)
    assert np.allclose(normals[0], points[0] / math.hypot(*points[0]), atol=1e-12)
    if not tooth.undercut:
        assert np.allclose(normals[-1], tooth.normal(tooth.flank_rho[0]), atol=1e-11)


@pytest.mark.parametrize(
    ("z", "x", "degrees"), [(8, 0.2, 30.0), (17, 0.0, 45.0), (36, 0.3, 20.0), (80, -0.5, 8.0)]
)
def test_the_fillet_is_the_envelope_of_the_ellipse_of_the_rolling_rack(z, x, degrees):
    """Rolled through many positions, the oblique rack's tip arc touches each point of the fillet and cuts none.

    Across the rack lengths of its normal section are cos(beta) times those of the transverse one; there the smallest
    distance of a point from the arc's centre is the arc's radius.
    """
    rack, c = BasicRack(), math.cos(math.radians(degrees))
    tooth = generate(Gear(z, x), 1.0, rack, helix_angle=math.radians(degrees))
    assert tooth is not None
    r = 0.5 * z / c
    depth = rack.h_fP - rack.rho_fP - x
    half = math.pi / 4 - (rack.h_fP - rack.rho_fP) * math.tan(rack.alpha) - rack.rho_fP / math.cos(rack.alpha)
    roll = np.linspace(-0.8, 0.8, 20001) * max(1.0, 5.0 / r)
    angle = math.pi / z - roll  # of the pitch point, from the tooth's centre line
    points = tooth.fillet(np.linspace(0.02, 0.98, 25))[:, None]
    along = points[..., 0] * np.cos(angle) - points[..., 1] * np.sin(angle)
    up = points[..., 0] * np.sin(angle) + points[..., 1] * np.cos(angle)
    nearest = np.hypot(c * (along - r * roll) + half, up - (r - depth)).min(axis=1)
    assert np.allclose(nearest, rack.rho_fP, rtol=0, atol=2e-6)


@pytest.mark.parametrize("degrees", [5.0, 30.0, 45.0])
def test_normals_are_across_the_fillet_and_speed_is_its_length(degrees):
    for z, x in ((8, 0.3), (36, 0.0), (36, 1.1)):
        tooth = generate(Gear(z, x), 1.0, BasicRack(), helix_angle=math.radians(degrees))
        assert tooth is not None
        h, t = 1e-5, np.linspace(0.05, 0.95, 19)
        tangent = (tooth.fillet(t + h) - tooth.fillet(t - h)) / (2 * h)
        end = tooth.fillet_curve.end
        assert np.allclose((tangent * tooth.fillet_normal(t)).sum(1), 0.0, atol=1e-6)
        assert np.allclose(
            np.linalg.norm(tangent, axis=1), end * tooth.fillet_curve.speed(end * t), rtol=1e-6
        )


@settings(deadline=None, max_examples=12)
@given(st.integers(18, 90), st.integers(18, 90), st.floats(-0.2, 0.5), angles, st.floats(0.0, 0.02))
def test_rolled_together_the_sections_have_the_backlash_over_cos_beta_b(z1, z2, x, angle, apart):
    gears = Gear(z1, x), Gear(z2, 0.1)
    try:
        tight = helical(math.degrees(angle), gears)
        far = tight.working_centre_distance + apart * tight.module
        pair = helical(math.degrees(angle), gears, centre_distance=far)
    except GeometryError:
        assume(False)
        raise
    assert check_meshing(tight, 5).angle_deviation < 1e-9
    clearance = check_meshing(pair, 5).back_clearance
    assert clearance * math.cos(pair.base_helix_angle) == pytest.approx(pair.backlash, abs=1e-11)
    along = pair.transverse_backlash * math.cos(pair.working_pressure_angle)
    assert clearance == pytest.approx(along, abs=1e-11)


def test_thickness_and_backlash_allowances_belong_to_the_normal_section():
    pair = helical(25.0)
    wide = pair.with_backlash(80e-6)
    assert wide.backlash == pytest.approx(80e-6, rel=1e-9)
    assert 2 * wide.pinion.thickness_allowance * math.cos(pair.rack.alpha) == pytest.approx(80e-6, rel=1e-9)
    cut = helical(25.0, (Gear(36, 0.1, generating_shift=0.05), Gear(40)))
    assert cut.backlash == pytest.approx(0.1 * 2e-3 * math.sin(pair.rack.alpha), rel=1e-9)
    far = pair.centre_distance_of_backlash(80e-6)
    assert helical(25.0, centre_distance=far).backlash == pytest.approx(80e-6, rel=1e-9)


@given(st.floats(0.1, 45.0))
@settings(deadline=None, max_examples=30)
def test_hands_are_mirror_images(degrees):
    right, left = helical(degrees), helical(-degrees)
    assert right.teeth_profiles[0].fillet_curve.point(np.array([0.3])).tolist() == (
        left.teeth_profiles[0].fillet_curve.point(np.array([0.3])).tolist()
    )
    for name in (
        "base_radii",
        "tip_radii",
        "form_radii",
        "points",
        "contact_ratio",
        "overlap_ratio",
        "backlash",
    ):
        assert getattr(right, name) == getattr(left, name)
    assert right.normal_force(600.0) == left.normal_force(600.0) > 600.0 / right.base_radii[0]
    assert right.axial_force(600.0) == -left.axial_force(600.0) > 0.0
    assert right.base_helix_angle == -left.base_helix_angle > 0.0


@pytest.mark.parametrize("beta", [1e-3, 1e-5, 1e-7, 1e-9])
def test_sizes_go_over_into_those_of_spur_gears(beta):
    spur, slight = GearPair(*PAIR, 2e-3, 40e-3), GearPair(*PAIR, 2e-3, 40e-3, helix_angle=beta)
    for name in ("base_radii", "tip_radii", "form_radii", "root_radii", "contact_ratio", "base_pitch"):
        assert getattr(slight, name) == pytest.approx(getattr(spur, name), rel=2 * beta**2 + 1e-14)
    t = np.linspace(0, 1, 17)
    distance = slight.teeth_profiles[0].fillet(t) - spur.teeth_profiles[0].fillet(t)
    assert np.abs(distance).max() < 0.05 * beta**2 + 1e-16
    assert slight.overlap_ratio == pytest.approx(40 * beta / (2 * math.pi), rel=1e-6)


def test_forces_at_the_reference_cylinders_and_in_the_base_tangent_plane_are_one_force():
    pair = helical(20.0)
    normal, transverse = pair.normal_force(600.0), 600.0 / pair.base_radii[0]
    assert normal**2 == pytest.approx(transverse**2 + pair.axial_force(600.0) ** 2)
    parts = [force(600.0) for force in (pair.tangential_force, pair.radial_force, pair.axial_force)]
    assert math.sqrt(sum(part**2 for part in parts)) == pytest.approx(normal)
    assert pair.axial_force(600.0) == pytest.approx(parts[0] * math.tan(pair.helix_angle))


def test_beta_45_and_few_undercut_teeth_are_pairs():
    steep = helical(45.0, (Gear(20, 0.2), Gear(31)))
    assert steep.base_helix_angle == pytest.approx(math.asin(math.sqrt(0.5) * math.cos(steep.rack.alpha)))
    pair = helical(12.0, (Gear(8, 0.35), Gear(40, tip_alteration=-0.2)))
    assert pair.teeth_profiles[0].undercut
    assert check_meshing(pair, 7).overlap < 1e-9
    # a helix makes undercut rarer: z 16 without shift is cut as spur, not at 20 degrees
    assert helical(0.0, (Gear(16), Gear(40))).teeth_profiles[0].undercut
    assert not helical(20.0, (Gear(16), Gear(40))).teeth_profiles[0].undercut


def test_overlap_makes_up_for_a_path_shorter_than_the_base_pitch():
    short = Gear(30, tip_alteration=-0.45), Gear(30, tip_alteration=-0.45)
    with pytest.raises(GeometryError, match="contact_ratio"):
        helical(0.0, short)
    assert helical(30.0, short).contact_ratio < 1.0 < helical(30.0, short).total_contact_ratio
    with pytest.raises(GeometryError, match=r"contact_ratio = 0\.8"):
        helical(30.0, short, face_width=0.5e-3)
    apart = helical(30.0, short).working_centre_distance + 3e-3
    with pytest.raises(GeometryError, match=r"contact_ratio = -0\."):
        helical(30.0, short, centre_distance=apart)
    with pytest.warns(RangeWarning, match="transverse contact ratio 0.* is below 1"):
        closed_form.iso6336_2(helical(30.0, short), 1e4)


@pytest.mark.parametrize("angle", [20.0, math.radians(46.0), math.nan, "20 deg", None, True])
def test_helix_angles_that_are_none_are_refused_with_a_remedy(angle):
    with pytest.raises(GeometryError, match=r"helix_angle = .*radians \(20 deg is 0.349066\)"):
        GearPair(*PAIR, 2e-3, 40e-3, helix_angle=angle)


def test_a_transverse_module_given_for_the_normal_one_is_seen():
    beta = math.radians(15.0)
    transverse = 2e-3 / math.cos(beta)
    with pytest.warns(GeometryWarning, match=r"module: 2.07055 mm is no module of ISO 54, .* it is 2 mm"):
        GearPair(*PAIR, transverse, 40e-3, helix_angle=beta)
    for degrees, printed in ((15.0, 2.0706e-3), (30.0, 2.3094e-3)):
        distance = helical(degrees).working_centre_distance
        with pytest.raises(GeometryError, match=r"give m_t cos\(helix_angle\) = 0.0020*"):
            helical(degrees, module=printed, centre_distance=distance)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        GearPair(*PAIR, 2e-3, 40e-3, helix_angle=beta)
        GearPair(*PAIR, 2.07e-3, 40e-3)


def test_repr_names_the_helix():
    assert "module 2 mm, helix angle -20 deg, face" in repr(helical(-20.0))
    assert "helix" not in repr(helical(0.0))
