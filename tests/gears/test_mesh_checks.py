"""Guards: each fault is found, named and comes with the others; what is sound passes."""

from __future__ import annotations

import math
import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gears import (
    BasicRack,
    Gear,
    GearPair,
    GeometryError,
    GeometryWarning,
    Heat,
    Material,
    TipRelief,
    closed_form,
    warm_pair,
)


def faults(pinion=None, wheel=None, module=2e-3, face_width=20e-3, **more):
    with pytest.raises(GeometryError) as caught:
        GearPair(pinion or Gear(30), wheel or Gear(40), module, face_width, **more)
    for fault in caught.value.faults:
        assert fault.remedy
        assert fault.allowed
        assert str(fault) in str(caught.value)
    return [fault.where for fault in caught.value.faults]


@pytest.mark.parametrize("teeth", [3, 4, 0, -36, 10_001, 100_000_000, 36.0, 36.5, "36", True, None, math.nan])
def test_teeth(teeth):
    assert faults(Gear(teeth)) == ["pinion.teeth"]


@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf, "2", None, 1j])
def test_values_that_are_no_finite_numbers(bad):
    for name in ("profile_shift", "tip_alteration", "thickness_allowance", "tip_chamfer"):
        assert faults(wheel=Gear(40, **{name: bad})) == [f"wheel.{name}"]
    for name in ("module", "face_width"):
        assert faults(**{name: bad}) == [name]
    if bad is not None:
        assert faults(Gear(30, bore_radius=bad)) == ["pinion.bore_radius"]
        assert faults(centre_distance=bad) == ["centre_distance"]
    assert faults(rack=BasicRack(h_aP=bad)) == ["rack.h_aP"]
    assert faults(material=Material(bad, 0.3, 7850.0)) == ["material.youngs_modulus"]


@pytest.mark.parametrize(
    ("where", "keywords"),
    [
        ("module", {"module": -2e-3}),
        ("module", {"module": 2.0}),
        ("face_width", {"face_width": 0.0}),
        ("centre_distance", {"centre_distance": 0.0}),
        ("pinion.profile_shift", {"pinion": Gear(30, 5.0)}),
        ("pinion.thickness_allowance", {"pinion": Gear(30, thickness_allowance=-1e-6)}),
        ("wheel.tip_chamfer", {"wheel": Gear(40, tip_chamfer=-1e-6)}),
        ("wheel.bore_radius", {"wheel": Gear(40, bore_radius=0.0)}),
        ("pinion.tip_relief.form", {"pinion": Gear(30, tip_relief=TipRelief(1e-5, 1e-3, "cubic"))}),
        ("pinion.tip_relief.amount", {"pinion": Gear(30, tip_relief=TipRelief(-1e-5, 1e-3))}),
        ("rack.alpha", {"rack": BasicRack(alpha=20.0)}),
        ("rack.h_fP", {"rack": BasicRack(h_fP=2.5)}),
        ("material.poisson_ratio", {"material": Material(206e9, 0.5, 7850.0)}),
        ("material.wheel.density", {"material": (Material(206e9, 0.3, 7850.0), Material(206e9, 0.3, -1.0))}),
        ("material", {"material": "steel"}),
        ("pinion", {"pinion": 36}),
    ],
)
def test_values_out_of_bounds(where, keywords):
    assert faults(**keywords) == [where]


def test_all_faults_at_once():
    found = faults(
        Gear(3, math.nan),
        Gear(40, bore_radius=1.0, tip_alteration=0.9),
        material=Material(206.0, 0.3, 7850.0),
    )
    values = ["pinion.teeth", "pinion.profile_shift", "material.youngs_modulus"]
    assert found == [*values, "wheel.tip_alteration", "wheel.bore_radius"]


def test_pointed_tip():
    assert "pinion.tip_alteration" in faults(Gear(12, 1.0))
    # the highest tip that the message allows has a land, a thousandth more has none
    with pytest.raises(GeometryError) as caught:
        GearPair(Gear(12, 1.0), Gear(40, -0.5, tip_alteration=-0.1), 2e-3, 0.02)
    highest = float(caught.value.faults[0].allowed.split()[4])
    with pytest.warns(GeometryWarning, match="top land"):
        GearPair(
            Gear(12, 1.0, tip_alteration=highest - 1e-3), Gear(40, -0.5, tip_alteration=-0.1), 2e-3, 0.02
        )
    assert "pinion.tip_alteration" in faults(
        Gear(12, 1.0, tip_alteration=highest + 1e-3), Gear(40, -0.5, tip_alteration=-0.1)
    )


def test_tooth_eaten_by_allowance_or_chamfer():
    assert faults(Gear(30, thickness_allowance=3.2e-3)) == ["pinion.thickness_allowance"]
    assert "pinion.tip_chamfer" in faults(Gear(30, tip_chamfer=1.8e-3))


def test_bore_and_rim():
    pair = GearPair(Gear(30), Gear(40), 2e-3, 0.02)
    root = pair.root_radii[0]
    assert faults(Gear(30, bore_radius=root)) == ["pinion.bore_radius"]
    assert faults(Gear(30, bore_radius=1.2 * root)) == ["pinion.bore_radius"]
    assert faults(Gear(30, bore_radius=root - 0.2e-3)) == ["pinion.bore_radius"]
    with pytest.warns(GeometryWarning, match="rim"):
        GearPair(Gear(30, bore_radius=root - 1e-3), Gear(40), 2e-3, 0.02)


def test_neck_and_root():
    assert faults(Gear(5, -0.8)) == ["pinion.profile_shift", "pinion.bore_radius"]
    assert faults(Gear(6, -0.8)) == ["pinion.profile_shift"]


def test_relief_longer_than_the_flank():
    assert faults(Gear(30, tip_relief=TipRelief(1e-5, 0.1))) == ["pinion.tip_relief.length"]
    assert faults(Gear(30, tip_relief=TipRelief(1.1e-3, 1e-3))) == ["pinion.tip_relief.amount"]


def test_contact_ratio_below_one():
    assert "contact_ratio" in faults(centre_distance=72.2e-3)
    assert "contact_ratio" in faults(centre_distance=90e-3)


def test_interference_names_the_tip_that_is_too_high_and_the_remedy_works():
    assert faults(Gear(12), Gear(60)) == ["wheel.tip_radius"]
    with pytest.raises(GeometryError) as caught:
        GearPair(Gear(12), Gear(60), 2e-3, 0.02)
    largest = float(caught.value.faults[0].allowed.split()[4])
    nominal = 0.5 * 60 * 2e-3 + 2e-3
    assert GearPair(Gear(12), Gear(60, tip_alteration=(largest - nominal) / 2e-3 - 1e-4), 2e-3, 0.02)
    assert faults(Gear(60), Gear(12)) == ["pinion.tip_radius"]


def test_tip_against_root_circle():
    with pytest.raises(GeometryError, match="The tip of the wheel meets the root circle of the pinion"):
        GearPair(Gear(40, -0.3), Gear(40, tip_alteration=0.4), 2e-3, 0.02)


def test_jam():
    assert faults(centre_distance=69.9e-3) == ["centre_distance"]
    pair = GearPair(
        Gear(30, thickness_allowance=5e-5),
        Gear(40, thickness_allowance=5e-5),
        2e-3,
        0.02,
        centre_distance=69.9e-3,
    )
    assert 0 < pair.backlash < 1e-4


def test_nominal_centre_distance_does_not_jam_by_rounding():
    for z1 in range(20, 60):
        assert (
            abs(GearPair(Gear(z1), Gear(77), 2.5e-3, 0.02, centre_distance=(z1 + 77) * 1.25e-3).backlash)
            < 1e-15
        )


CATALOGUE = {
    "FZG type C": ((16, 24), (0.182, 0.172), 4.5e-3, 91.5e-3, 91.503304e-3),
    "18/36": ((18, 36), (0.3890, 0.5039), 21e-3, 584e-3, 584.000537e-3),
}
"""Teeth, shifts, module and centre distance as catalogues print them; the one of no backlash."""


@pytest.mark.parametrize("name", CATALOGUE)
def test_centre_distance_rounded_short_is_that_of_no_backlash(name):
    """One branch of rounding: every figure is that of the pair without a given distance."""
    teeth, shifts, module, given, exact = CATALOGUE[name]
    gears = [Gear(z, x) for z, x in zip(teeth, shifts, strict=True)]
    with pytest.warns(
        GeometryWarning, match=rf"centre_distance: {1e3 * given:g} mm is .* {1e3 * exact:.9g} mm"
    ):
        pair = GearPair(*gears, module, 10 * module, centre_distance=given)
    plain = GearPair(*gears, module, 10 * module)
    assert pair.working_centre_distance == pytest.approx(exact, rel=1e-8)
    assert abs(pair.backlash) < 1e-12 * module
    assert pair.contact_ratio == pytest.approx(plain.contact_ratio, rel=1e-12)
    found, expected = (closed_form.iso6336_3(one, 1e4).stresses for one in (pair, plain))
    assert found == pytest.approx(expected, rel=1e-12)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert replace(pair, face_width=module).centre_distance == pair.centre_distance  # said once
    assert pair.with_backlash(50e-6).backlash == pytest.approx(50e-6, rel=1e-12)


def test_only_the_last_digit_is_forgiven():
    teeth, shifts, module, given, exact = CATALOGUE["FZG type C"]
    gears = [Gear(z, x) for z, x in zip(teeth, shifts, strict=True)]
    with pytest.warns(GeometryWarning, match="centre_distance"):
        GearPair(*gears, module, 14e-3, centre_distance=exact - 0.00199 * module)
    with pytest.raises(GeometryError, match="The teeth jam"):
        GearPair(*gears, module, 14e-3, centre_distance=exact - 0.00201 * module)
    as_given = GearPair(*gears, module, 14e-3, centre_distance=given, tight=True)
    assert as_given.working_centre_distance == given
    assert as_given.backlash < -2e-6
    # what thins the teeth counts: with it the distance is long enough
    thinned = [replace(gear, thickness_allowance=5e-6) for gear in gears]
    assert GearPair(*thinned, module, 14e-3, centre_distance=given).working_centre_distance == given


def test_heat_that_eats_the_last_micrometre_is_no_rounding():
    pair = GearPair(Gear(30), Gear(40), 2e-3, 0.02)
    with pytest.raises(GeometryError, match=r"Heat leaves -\d"):
        warm_pair(pair, Heat(pinion_temperature=294.15))


def test_no_line_of_action():
    assert faults(centre_distance=60e-3) == ["centre_distance"]


def test_no_working_angle():
    found = faults(Gear(30, -0.79), Gear(30, -0.79))
    assert found == ["pinion.profile_shift + wheel.profile_shift"]


def test_thin_tip_warns():
    with pytest.warns(GeometryWarning, match="top land is 0.1"):
        GearPair(Gear(10, 0.51), Gear(40, -0.51), 2e-3, 0.02)


def test_error_pickles():
    with pytest.raises(GeometryError) as caught:
        GearPair(Gear(3), Gear(40), 2e-3, 0.02)
    assert pickle.loads(pickle.dumps(caught.value)).faults == caught.value.faults


@pytest.mark.filterwarnings("ignore::gears.tooth.errors.GeometryWarning")
@settings(deadline=None, max_examples=300)
@given(
    st.integers(5, 200),
    st.integers(5, 200),
    st.floats(-0.8, 1.5),
    st.floats(-0.8, 1.5),
    st.floats(-0.5, 0.2),
    st.floats(0, 4e-4),
    st.one_of(st.none(), st.floats(0.95, 1.05)),
)
def test_every_pair_is_either_refused_or_computed(z1, z2, x1, x2, k, chamfer, apart):
    """Nothing but GeometryError leaves the constructor, and a pair that stands has finite figures."""
    distance = None if apart is None else apart * (z1 + z2) * 1e-3
    try:
        pair = GearPair(
            Gear(z1, x1, tip_alteration=k),
            Gear(z2, x2, tip_chamfer=chamfer),
            2e-3,
            0.02,
            centre_distance=distance,
        )
    except GeometryError:
        return
    assert pair.contact_ratio >= 1.0
    assert pair.backlash >= -1e-14
    path = pair.path_of_contact(5)
    for tooth, rho in zip(pair.teeth_profiles, (path.rho1, path.rho2), strict=True):
        assert tooth.root_radius < tooth.form_radius < tooth.flank_end_radius <= tooth.tip_radius
        assert 0 < tooth.tip_half_angle < tooth.root_half_angle <= 0.5 * tooth.pitch_angle + 1e-15
        assert rho.min() >= tooth.flank_rho[0] - 1e-14
        assert np.all(np.isfinite(tooth.fillet(np.linspace(0, 1, 5))))


@pytest.mark.parametrize("chamfer", [4.6e-3, 0.09, 1.0])
def test_a_chamfer_higher_than_the_tooth_is_refused(chamfer):
    # beyond 2.4 tip radii its line would miss the tip circle altogether
    with pytest.raises(GeometryError) as caught:
        GearPair(
            pinion=Gear(teeth=36, tip_chamfer=chamfer), wheel=Gear(teeth=40), module=2e-3, face_width=0.04
        )
    assert [fault.where for fault in caught.value.faults] == ["pinion.tip_chamfer"]


def test_a_thin_rim_is_told_over_the_depth_of_the_tooth():
    """Tip to root 2.25 modules of 2 mm: 4.5 mm, of which a rim of 1 mm is 0.22, and one of 2.2 mm 0.49."""
    root = GearPair(Gear(30), Gear(40), 2e-3, 0.02).root_radii[0]
    for rim, share in ((1e-3, "0.22"), (2.2e-3, "0.49")):
        with pytest.warns(GeometryWarning, match=f"pinion: the rim is {share} of the tooth depth thick"):
            GearPair(Gear(30, bore_radius=root - rim), Gear(40), 2e-3, 0.02)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        GearPair(Gear(30, bore_radius=root - 2.3e-3), Gear(40), 2e-3, 0.02)
