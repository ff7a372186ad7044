"""Load factors: tolerances by hand, limits of running in, masses of discs, ranges of speed, and faults."""

from __future__ import annotations

import math

import pytest

from base import InputError, RangeWarning
from gears import Blank, Gear, GearPair, Material
from gears.rating import (
    RatedSteel,
    load_factors,
    misalignment,
    reduced_mass,
    run_in,
    run_in_relief,
    tolerances,
)
from gears.rating.running_in import lead_allowance, pitch_allowance

STEELS = (RatedSteel("Eh", 1500e6, 430e6),) * 2


def pair_of(helix=0.0, **more):
    return GearPair(Gear(36, **more), Gear(40), 2e-3, 40e-3, helix_angle=math.radians(helix))


def factors_of(pair, speed=200.0, **more):
    effective = run_in(pair, STEELS, speed, tolerances(pair, 6))
    given = {"application_factor": 1.25, "effective": effective, "relief": 2e-6, "face_load_factor": 1.2}
    return load_factors(pair, 600.0, speed, **(given | more))


def test_tolerances_by_hand():
    """d 72 and 80 mm lie in 50..125, m_n 2 in 0.5..2, b 40 in 20..40."""
    m, d, b = 1.0, math.sqrt(50 * 125), math.sqrt(20 * 40)
    found = tolerances(pair_of(), 5)
    assert 1e6 * found.f_pt[0] == pytest.approx(5.0 if 0.3 * (m + 0.4 * d**0.5) + 4 < 5.25 else 5.5)
    assert 1e6 * found.F_p[1] == pytest.approx(round(0.3 * m + 1.25 * d**0.5 + 7))
    assert 1e6 * found.F_alpha[0] == pytest.approx(round(2 * (3.2 + 0.22 * d**0.5 + 0.7)) / 2)
    assert 1e6 * found.f_Hbeta[0] == pytest.approx(round(2 * (0.07 * d**0.5 + 0.45 * b**0.5 + 3)) / 2)
    assert found.f_pb[0] == found.f_pt[0] * math.cos(math.radians(20))


@pytest.mark.parametrize("name", ["f_pt", "F_p", "F_alpha", "f_falpha", "f_Halpha", "F_beta", "f_Hbeta"])
def test_two_grades_double_a_tolerance(name):
    """But for rounding: 4, 5 and 7 % of what is read in steps of 0.1, 0.5 and 1 um."""
    pair = pair_of()
    for grade in range(0, 11):
        fine, coarse = (getattr(tolerances(pair, g), name)[0] for g in (grade, grade + 2))
        assert coarse == pytest.approx(2.0 * fine, rel=0.11)


def test_running_in_of_hardened_and_soft_steels():
    hard, soft = STEELS[0], RatedSteel("V", 640e6, 250e6, 600e6)
    assert pitch_allowance(hard, 20e-6, 20.0) == pytest.approx(1.5e-6)
    assert pitch_allowance(hard, 200e-6, 20.0) == 3e-6
    assert pitch_allowance(soft, 200e-6, 4.0) == pytest.approx(50e-6)
    assert pitch_allowance(soft, 200e-6, 8.0) == pytest.approx(20e-6)
    assert pitch_allowance(soft, 200e-6, 11.0) == pytest.approx(10e-6)
    assert lead_allowance(soft, 30e-6, 4.0) == pytest.approx(15e-6)
    assert lead_allowance(soft, 300e-6, 11.0) == pytest.approx(20e-6)
    assert lead_allowance(RatedSteel("St", 200e6, 150e6, 300e6), 30e-6, 1.0) == 30e-6
    pair = pair_of()
    deviations = tolerances(pair, 8)
    mixed, same = (run_in(pair, s, 50.0, deviations).y_alpha for s in ((hard, soft), (hard, hard)))
    only_soft = run_in(pair, (soft, soft), 50.0, deviations).y_alpha
    assert mixed == pytest.approx(0.5 * (same + only_soft))


def test_reduced_mass_is_of_two_discs():
    """J/r_b^2 of a disc of the mean diameter, of both gears in series."""
    pair = pair_of()
    masses = []
    for profile, radius in zip(pair.teeth_profiles, pair.base_radii, strict=True):
        mean = 0.5 * (profile.tip_radius + profile.root_radius)
        masses.append(0.5 * math.pi * mean**4 * 7850.0 / radius**2)
    exact = masses[0] * masses[1] / (masses[0] + masses[1])
    assert reduced_mass(pair) == pytest.approx(
        exact, rel=3e-3
    )  # the standard scales the pinion's diameters by u
    turned = reduced_mass(GearPair(Gear(40), Gear(36), 2e-3, 40e-3))
    assert turned == pytest.approx(exact, rel=3e-3)
    thin = pair_of(blank=Blank(rim_thickness=4e-3, web_thickness=8e-3))
    assert 0.5 * exact < reduced_mass(thin) < exact


def test_ranges_of_speed_follow_the_resonance_ratio():
    pair = pair_of()
    resonance = factors_of(pair).resonance_speed
    for ratio, regime in ((0.3, "subcritical"), (1.3, "intermediate"), (1.5, "supercritical")):
        assert factors_of(pair, ratio * resonance).regime == regime
    for ratio in (0.86, 1.0, 1.14):
        with pytest.warns(RangeWarning, match="resonance"):
            assert factors_of(pair, ratio * resonance).regime == "main resonance"


def test_each_factor_stands_on_those_before_it():
    """Given K_Hbeta, a lighter line load has larger shares; a stiffer mean load, smaller ones."""
    pair = pair_of(20.0)
    rough = run_in(pair, STEELS, 200.0, tolerances(pair, 10))
    one, more = (factors_of(pair, effective=rough, face_load_factor=K) for K in (1.0, 2.0))
    assert one.K_v == more.K_v
    assert one.K_Halpha - 0.9 == pytest.approx(2.0 * (more.K_Halpha - 0.9), rel=1e-12)
    assert 1.0 < more.K_Fbeta < 2.0
    assert more.contact == pytest.approx(1.25 * more.K_v * 2.0 * more.K_Halpha)


def test_a_pinion_off_the_middle_of_its_shaft_is_misaligned_more():
    pair, deviations = pair_of(), tolerances(pair_of(), 5)
    middle, off = (misalignment(pair, 600.0, 100.0, STEELS, deviations, shaft=s) for s in (0.0, 0.5))
    assert off.f_sh == pytest.approx(1.5 * middle.f_sh)
    assert middle.f_ma == math.hypot(*deviations.f_Hbeta)
    none = misalignment(pair, 600.0, 100.0, STEELS, deviations, B_1=0.0, B_2=0.0)
    assert none.F_by == 0.0
    with pytest.raises(InputError, match="40 um"):
        misalignment(pair, 600.0, 100.0, STEELS, tolerances(pair, 12))


def test_faults_are_listed_together():
    with pytest.raises(InputError) as caught:
        tolerances(GearPair(Gear(36), Gear(40), 0.3e-3, 3e-3), 13)
    assert {"grade", "module", "pinion.face_width", "wheel.face_width"} == {
        f.where for f in caught.value.faults
    }
    plastic = Material(3e9, 0.4, 1140.0)
    pair = GearPair(Gear(36), Gear(40), 2e-3, 40e-3, material=plastic)
    steels = (RatedSteel("16MnCr5", 1500.0, 430e6), RatedSteel("Eh", 1500e6, math.nan))
    with pytest.raises(InputError) as caught:
        run_in(pair, steels, -1.0, tolerances(pair, 6))
    where = [fault.where for fault in caught.value.faults]
    assert {"speed", "pinion.steel.kind", "pinion.steel.contact_strength"} <= set(where)
    assert {"wheel.steel.bending_strength", "pinion.material.youngs_modulus"} <= set(where)
    with pytest.raises(InputError) as caught:
        factors_of(pair_of(), application_factor=0.5, face_load_factor=None)
    assert {f.where for f in caught.value.faults} == {"application_factor", "face_load_factor"}
    with pytest.raises(InputError, match="both"):
        factors_of(pair_of(), misalignment=1e-6)


def test_a_helix_beyond_the_standard_is_rated_with_a_warning():
    with pytest.warns(RangeWarning, match="up to 30 deg: at 35 deg"):
        factors_of(pair_of(35.0))


def test_relief_of_running_in():
    assert 1e6 * run_in_relief(STEELS) == pytest.approx((1500 / 97 - 18.45) ** 2 / 18 + 1.5)
