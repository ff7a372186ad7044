"""Viscosity grades: ISO 3448, ISO 2909 (ASTM D2270) and ASTM D341.

The pairs of viscosities and their index are worked examples of ASTM D2270 as an open library of chemical
properties repeats them in its tests.
"""

import math

import pytest

from base import InputError, RangeWarning
from ehl import Lubricant
from ehl.grades import GRADES, gold_coefficient, graded_oil, viscosity_index, walther


@pytest.mark.parametrize(
    ("nu_40", "nu_100", "index", "off"),
    [
        (73.3, 8.86, 92.43, 0.1),
        (22.83, 5.05, 156.42, 0.3),
        (53.47, 7.80, 111.31, 0.05),
        (73.5, 8.86, 92.03, 0.1),
        (1000.0, 100.0, 192.998, 0.001),
    ],
)
def test_worked_examples_of_the_viscosity_index(nu_40, nu_100, index, off):
    assert viscosity_index(nu_40, nu_100) == pytest.approx(index, abs=off)


def test_the_thinned_table_against_entries_of_the_standard_that_are_not_in_it():
    for nu_100, L, H in [
        (4.7, 35.13, 25.63),
        (6.2, 61.52, 40.15),
        (10.5, 160.6, 88.95),
        (19.0, 449.9, 212.7),
    ]:
        # an oil of index 0 or 100 at this viscosity
        assert viscosity_index(L, nu_100) == pytest.approx(0.0, abs=1.2)
        assert viscosity_index(H, nu_100) == pytest.approx(100.0, abs=1.2)


def test_walther_meets_its_two_viscosities_and_is_straight_between():
    assert walther(313.15, 220.0, 19.0) == pytest.approx(220.0, rel=1e-12)
    assert walther(373.15, 220.0, 19.0) == pytest.approx(19.0, rel=1e-12)
    middle = math.sqrt(313.15 * 373.15)
    y = [math.log10(math.log10(walther(T, 220.0, 19.0) + 0.7)) for T in (313.15, middle, 373.15)]
    assert y[1] == pytest.approx(0.5 * (y[0] + y[2]), rel=1e-12)


@pytest.mark.parametrize("vg", [v for v in GRADES if v >= 10])
@pytest.mark.parametrize("index", [95, 150])
def test_a_grade_gives_back_its_viscosity_and_index(vg, index):
    oil = graded_oil(vg, 313.15, index)
    assert oil.kinematic_viscosity == pytest.approx(vg, rel=1e-9)
    assert viscosity_index(vg, oil.kinematic_viscosity_100) == pytest.approx(index, abs=1e-6)


def test_typical_gear_oil():
    # VG 220, index 95: 18.7 to 19.1 mm^2/s at 100 degC on data sheets
    oil = graded_oil(220, 373.15, 95)
    assert oil.kinematic_viscosity == pytest.approx(18.9, abs=0.3)
    cool, hot = (Lubricant.from_iso_vg(220, T, viscosity_index=95) for T in (313.15, 363.15))
    assert cool.viscosity == pytest.approx(220e-6 * 869.0, rel=1e-3)
    assert 20e-9 < cool.pressure_viscosity < 22e-9
    assert hot.viscosity < 0.12 * cool.viscosity
    assert hot.pressure_viscosity < cool.pressure_viscosity
    assert hot.density == pytest.approx(cool.density - 32.0)


def test_gold_by_hand():
    # 100^0.139 = 10^0.278 = 1.8967
    assert gold_coefficient(100.0) == pytest.approx(18.785e-9, rel=1e-3)
    assert gold_coefficient(1.0, "pag") == pytest.approx(5.489e-9)


def test_faults_together_and_other_viscosities_warned_of():
    with pytest.raises(InputError) as caught:
        Lubricant.from_iso_vg(1, 90.0, viscosity_index=500, base="water", density_15=-1)
    where = [f.where for f in caught.value.faults]
    assert where == ["vg", "temperature", "viscosity_index", "base", "density_15"]
    with pytest.raises(InputError, match="higher index"):
        graded_oil(7, 313.15, 0.0)
    with pytest.warns(RangeWarning, match="no grade"):
        graded_oil(200, 313.15)
