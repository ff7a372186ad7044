"""Viscosity grades: ISO 3448, ISO 2909 (ASTM D2270) and ASTM D341.

The pairs of viscosities and their index are worked examples of ASTM D2270 as an open library of chemical
properties repeats them in its tests.
"""

import math

import pytest

from base import InputError, RangeWarning
from ehl import Lubricant
from ehl.oil.oil_grades import _INDEX_TABLE, GRADES, gold_coefficient, graded_oil, viscosity_index, walther


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


QUADRATICS = [
    (2.0, 3.8, 1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077),
    (3.8, 4.4, 3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183),
    (4.4, 5.0, 2.5, -7.2143, 13.812, 0.82143, 1.5679, 0.119),
    (5.0, 6.4, 0.101, 16.635, -45.469, 0.04985, 9.1613, -18.557),
    (6.4, 7.0, 3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656),
    (7.0, 7.7, 0.01191, 21.475, -72.87, 0.79762, -0.7321, 14.61),
    (7.7, 9.0, 0.41858, 16.1558, -56.04, 0.05794, 10.5156, -28.24),
    (9.0, 12.0, 0.88779, 7.5527, -16.6, 0.26665, 6.7015, -10.81),
    (12.0, 15.0, 0.7672, 10.7972, -38.18, 0.20073, 8.4658, -22.49),
    (15.0, 18.0, 0.97305, 5.3135, -2.2, 0.28889, 5.9741, -4.93),
    (18.0, 22.0, 0.97256, 5.25, -0.98, 0.24504, 7.416, -16.73),
    (22.0, 28.0, 0.91413, 7.4759, -21.82, 0.20323, 9.1267, -34.23),
    (28.0, 40.0, 0.87031, 9.7157, -50.77, 0.18411, 10.1015, -46.75),
    (40.0, 55.0, 0.84703, 12.6752, -133.31, 0.17029, 11.4866, -80.62),
    (55.0, 70.0, 0.85921, 11.1009, -83.19, 0.16841, 11.8493, -96.947),
]  # fmt: skip
"""ASTM D2270: L = a Y^2 + b Y + c and H = d Y^2 + e Y + f, from one viscosity at 100 degC Y to the next [mm^2/s]."""


def test_the_table_against_the_quadratics_that_astm_gives_for_it():
    """Two printed forms of the same curves; they agree within their rounding, 0.17 % at most."""
    for Y, L, H in _INDEX_TABLE:
        a, b, c, d, e, f = next(row[2:] for row in QUADRATICS if row[0] <= Y <= row[1])
        assert pytest.approx((a * Y + b) * Y + c, rel=2.5e-3) == L
        assert pytest.approx((d * Y + e) * Y + f, rel=2.5e-3) == H
    # beyond the table, at Y = 80: 0.8353 and 0.1684 times 6400, 14.67 and 11.85 times 80, less 216 and 97
    assert viscosity_index(6303.52, 80.0) == pytest.approx(0.0, abs=1e-9)
    assert viscosity_index(1928.76, 80.0) == pytest.approx(100.0, abs=1e-9)


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
    # 100^t with t = 0.1335, 0.1360 and 0.1485
    for base, alpha in (("pao", 7.382 * 1.849269), ("ester", 6.605 * 1.870682), ("pag", 5.489 * 1.981527)):
        assert gold_coefficient(100.0, base) == pytest.approx(1e-9 * alpha, rel=1e-6)


@pytest.mark.parametrize(
    ("base", "density_15", "per_K"),
    [("mineral", 885.0, 0.64), ("pao", 850.0, 0.60), ("ester", 950.0, 0.70), ("pag", 1050.0, 0.75)],
)
def test_density_falls_by_the_expansion_of_its_base(base, density_15, per_K):
    oil = graded_oil(220, 288.15 + 50.0, 150.0, base)
    assert oil.density == pytest.approx(density_15 - 50.0 * per_K, rel=1e-12)
    assert oil.viscosity == pytest.approx(1e-6 * oil.kinematic_viscosity * oil.density, rel=1e-12)
    assert graded_oil(220, 338.15, 150.0, base, 900.0).density == pytest.approx(
        900.0 - 50.0 * per_K, rel=1e-12
    )


@pytest.mark.parametrize("base", ["mineral", "pao", "ester", "pag"])
def test_slope_of_the_viscosity_is_that_of_its_line(base):
    cold, oil, hot = (Lubricant.from_iso_vg(220, 343.15 + T, base=base) for T in (-0.05, 0.0, 0.05))
    slope = -math.log(hot.viscosity / cold.viscosity) / 0.1
    assert oil.viscosity_slope == pytest.approx(slope, rel=1e-6)
    assert oil.expansion == pytest.approx((cold.density - hot.density) / 0.1 / oil.density, rel=1e-9)
    assert oil.temperature == 343.15


def test_faults_together_and_other_viscosities_warned_of():
    with pytest.raises(InputError) as caught:
        Lubricant.from_iso_vg(1, 90.0, viscosity_index=500, base="water", density_15=-1)
    where = [f.where for f in caught.value.faults]
    assert where == ["vg", "temperature", "viscosity_index", "base", "density_15"]
    with pytest.raises(InputError, match="higher index"):
        graded_oil(7, 313.15, 0.0)
    with pytest.warns(RangeWarning, match="no grade"):
        graded_oil(200, 313.15)
