"""Blanks: what does not fit is told all at once; radii, inertia, wind-up and ISO's factors follow the zones."""

from __future__ import annotations

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import RangeWarning
from gears import STEEL, Blank, Gear, GearPair, GeometryError, closed_form
from gears.closed_form.root_stress import rim_factor
from gears.closed_form.tooth_stiffness import blank_factor
from gears.tooth.blank import Zone

M, WIDTH = 3e-3, 30e-3


def pair(blank, bore=0.02, width=WIDTH):
    return GearPair(Gear(25), Gear(70, bore_radius=bore, blank=blank), M, width)


def refused(blank, **more):
    with pytest.raises(GeometryError) as caught:
        pair(blank, **more)
    return {fault.where: fault for fault in caught.value.faults}


def test_zones_lie_from_the_root_circle_to_the_bore():
    some = pair(Blank(8e-3, 9e-3, hub_radius=0.03))
    root = some.root_radii[1]
    assert some.teeth_profiles[1].zones == (
        Zone(root - 8e-3, root, 1.0),
        Zone(0.03, root - 8e-3, 0.3),
        Zone(0.02, 0.03, 1.0),
    )
    assert some.rim_thicknesses == pytest.approx((0.5 * some.root_radii[0], 8e-3))
    assert some.web_thicknesses == pytest.approx((WIDTH, 9e-3))
    to_bore = pair(Blank(8e-3, 9e-3)).teeth_profiles[1]
    assert [zone.thickness for zone in to_bore.zones] == [1.0, 0.3]
    assert pair(Blank(8e-3, WIDTH)).teeth_profiles[1] == pair(None).teeth_profiles[1]


def test_all_faults_come_at_once_with_what_is_allowed():
    found = refused(Blank(1e-3, 31e-3, hub_radius=0.03, web_offset=2e-3))
    assert list(found) == [f"wheel.blank.{name}" for name in ("rim_thickness", "web_offset", "web_thickness")]
    assert "three-dimensional" in found["wheel.blank.web_offset"].remedy
    root = pair(None).root_radii[1]
    assert found["wheel.blank.rim_thickness"].allowed == f"must be 0.0015 m to {root - 0.03 - 0.25 * M:.6g} m"
    assert found["wheel.blank.web_thickness"].allowed == "must be 0.0015 m to 0.03 m"
    found = refused(Blank(1e-3, 1e-3, hub_radius=0.015))
    assert list(found) == ["wheel.blank.hub_radius", "wheel.blank.web_thickness"]
    assert list(refused(Blank(0.0, -1.0, 0.0))) == [
        "wheel.blank.rim_thickness",
        "wheel.blank.web_thickness",
        "wheel.blank.hub_radius",
    ]
    # a faulty face width does not hide the rest
    assert "wheel.blank.rim_thickness" in refused(Blank(1e-3, 9e-3), width=-1.0)


def test_a_blank_that_just_fits_is_accepted():
    root = pair(None).root_radii[1]
    thin = pair(Blank(0.5 * M, 0.05 * WIDTH, hub_radius=0.02)).teeth_profiles[1]
    assert thin.rim_thickness == pytest.approx(0.5 * M)
    assert len(thin.zones) == 2  # the hub is the bore
    thick = root - 0.03 - 0.2501 * M
    assert pair(Blank(thick, 9e-3, hub_radius=0.03)).teeth_profiles[1].rim_thickness == pytest.approx(thick)


def test_inertia_is_that_of_the_zones():
    some = pair(Blank(8e-3, 9e-3, hub_radius=0.03))
    tooth, thick = some.teeth_profiles[1], WIDTH * 0.5 * math.pi * STEEL.density
    rings = sum(
        thickness * (outer**4 - inner**4)
        for inner, outer, thickness in (
            (0.02, 0.03, 1.0),
            (0.03, tooth.root_radius - 8e-3, 0.3),
            (tooth.root_radius - 8e-3, tooth.reference_radius, 1.0),
        )
    )
    assert some.moments_of_inertia[1] == pytest.approx(thick * rings, rel=1e-12)


@pytest.mark.parametrize("on_bore", [0.0, 1e-7, 1e-5])
def test_wind_up_of_stepped_bodies_is_the_integral_of_the_torque(on_bore):
    zones = pair(Blank(8e-3, 9e-3, hub_radius=0.03)).teeth_profiles[1].zones
    static, inertial, inside = 0.0, 0.0, on_bore
    x, weight = np.polynomial.legendre.leggauss(40)
    total = on_bore + sum(zone.thickness * (zone.outer**4 - zone.inner**4) for zone in zones)
    for zone in reversed(zones):
        r = zone.inner + 0.5 * (zone.outer - zone.inner) * (x + 1)
        dr = 0.5 * (zone.outer - zone.inner) * weight
        s = (inside + zone.thickness * (r**4 - zone.inner**4)) / total
        static += np.sum(dr / (zone.thickness * r**3))
        inertial += np.sum(dr * s**2 / (zone.thickness * r**3))
        inside += zone.thickness * (zone.outer**4 - zone.inner**4)
    scale = 0.1**2 / (2 * math.pi * 80e9)
    assert closed_form.body_wind_up(zones, 0.1, 80e9) == pytest.approx(scale * static, rel=1e-12)
    assert closed_form.inertial_wind_up(zones, 0.1, 80e9, on_bore) == pytest.approx(
        scale * inertial, rel=1e-12
    )


def test_iso_6336_1_takes_the_weaker_blank():
    """C_R = 1 + ln(b_s/b)/(5 exp(s_R/(5 m)))."""
    some = pair(Blank(3 * M, 0.2 * WIDTH))
    c_r = 1 + math.log(0.2) / (5 * math.exp(0.6))
    assert c_r == pytest.approx(0.82334, abs=5e-6)
    found, disc = closed_form.iso6336(some), closed_form.iso6336(pair(None))
    assert pytest.approx(c_r, rel=1e-12) == found.C_R
    assert found.c_gamma == pytest.approx(c_r * disc.c_gamma, rel=1e-12)
    both = replace(some, pinion=Gear(25, bore_radius=8e-3, blank=Blank(3 * M, 0.5 * WIDTH)))
    assert pytest.approx(c_r, rel=1e-12) == closed_form.iso6336(both).C_R
    with pytest.warns(
        RangeWarning, match=r"web of 0\.1 face widths counts as 0\.2.*rim of 0\.6 modules counts as 1"
    ):
        thin = closed_form.iso6336(pair(Blank(0.6 * M, 0.1 * WIDTH)))
    assert pytest.approx(1 + math.log(0.2) / (5 * math.exp(0.2)), rel=1e-12) == thin.C_R
    assert blank_factor(pair(None).teeth_profiles[1]) == 1.0


def test_iso_6336_3_takes_the_rim_of_the_blank_and_refuses_a_thin_one_with_the_right_advice():
    some = pair(Blank(0.8 * 2.25 * M, 9e-3))
    found = closed_form.iso6336_3(some, 1e4)
    assert (1.0, pytest.approx(1.6 * math.log(2.242 / 0.8), rel=1e-9)) == found.Y_B
    assert rim_factor(0.8) == pytest.approx(1.6488, abs=5e-5)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        thin, held = pair(Blank(0.4 * 2.25 * M, 9e-3)), pair(None, bore=some.root_radii[1] - 0.4 * 2.25 * M)
    with pytest.raises(
        GeometryError, match=r"wheel\.blank\.rim_thickness = 0\.4 tooth depths.*take the rim on its web"
    ):
        closed_form.iso6336_3(thin, 1e4)
    with pytest.raises(
        GeometryError, match=r"wheel\.bore_radius = 0\.4 .*held at the bore are unsafe too.*blank"
    ):
        closed_form.iso6336_3(held, 1e4)


@pytest.mark.parametrize(
    "form", [closed_form.ishikawa, closed_form.weber_banaschek, closed_form.potential_energy]
)
def test_closed_forms_of_deflection_say_that_they_know_discs_only(form):
    some = pair(Blank(8e-3, 9e-3))
    with pytest.warns(
        RangeWarning, match=r"wheel's body is taken as a disc, without its web of 0\.3 face widths"
    ):
        form(some, some.path_of_contact(3), *(() if form is closed_form.ishikawa else (1e4,)))
