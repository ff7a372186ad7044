import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base import InputError, RangeWarning
from ehl import Lubricant

OIL = Lubricant(viscosity=0.06, pressure_viscosity=22.6e-9, density=910.0)


def test_derived_index_gives_roelands_law_in_its_usual_form():
    p = np.array([0.0, 1e6, 1e8, 1e9])
    usual = (math.log(0.06) + 9.67) * ((1 + 5.1e-9 * p) ** OIL.z - 1)
    np.testing.assert_allclose(OIL.log_viscosity(p)[0], usual, rtol=1e-13, atol=1e-15)
    assert pytest.approx(0.646, abs=5e-4) == OIL.z


def test_slope_at_ambient_pressure_is_alpha_for_any_index():
    for z in (0.3, 0.68, 1.0):
        oil = Lubricant(0.05, 2e-8, roelands_z=z)
        assert oil.log_viscosity(0.0)[1] == pytest.approx(2e-8, rel=1e-14)


def test_index_one_is_barus_and_alpha_zero_is_constant():
    p = np.linspace(0, 1e9, 5)
    np.testing.assert_allclose(
        Lubricant(0.05, 2e-8, roelands_z=1.0).log_viscosity(p)[0], 2e-8 * p, rtol=1e-13
    )
    assert not Lubricant(0.05, 0.0).log_viscosity(p)[0].any()


@given(st.floats(0, 4e9), st.floats(0.2, 1.0), st.booleans())
def test_slopes_agree_with_differences(p, z, compressible):
    oil = Lubricant(0.05, 2e-8, roelands_z=z, compressible=compressible)
    step = 1e3
    for law in (oil.log_viscosity, oil.density_ratio):
        high, low = law(p + step)[0], law(max(p - step, 0.0))[0]
        width = p + step - max(p - step, 0.0)
        assert (high - low) / width == pytest.approx(float(law(p + step / 2)[1]), rel=2e-4, abs=1e-17)


def test_density_limits():
    assert OIL.density_ratio(0.0)[0] == 1.0
    assert OIL.density_ratio(1e15)[0] == pytest.approx(1 + 0.6 / 1.7, rel=1e-5)
    assert Lubricant(0.05, 2e-8, compressible=False).density_ratio(1e9)[0] == 1.0


def test_all_faults_are_listed_at_once():
    with pytest.raises(InputError) as caught:
        Lubricant(viscosity=float("nan"), pressure_viscosity=-1.0, density=0.0, roelands_z=float("inf"))
    assert [f.where for f in caught.value.faults] == [
        "viscosity",
        "pressure_viscosity",
        "density",
        "roelands_z",
    ]
    assert str(caught.value).count("\n") == 3


def test_an_oil_thinner_than_the_pole_of_the_law_is_refused():
    with pytest.raises(InputError, match="Give roelands_z"):
        Lubricant(viscosity=5e-5, pressure_viscosity=1e-8)


def test_an_unusual_index_is_warned_of():
    with pytest.warns(RangeWarning, match="Roelands index"):
        Lubricant(viscosity=0.06, pressure_viscosity=60e-9)


def test_an_oil_at_another_temperature_is_the_same_oil():
    oil = Lubricant(0.075, 19.6e-9, 910.0, temperature=353.15, viscosity_slope=0.04)
    warm = oil.at_temperature(378.15)
    p, T = np.array([0.0, 3e8, 1e9]), np.array([360.0, 378.15, 420.0])
    ratio = math.log(warm.viscosity / oil.viscosity)
    np.testing.assert_allclose(
        warm.hot_log_viscosity(p, T)[0] + ratio, oil.hot_log_viscosity(p, T)[0], atol=1e-12
    )
    assert warm.z == pytest.approx(oil.z)
    h = 1e-3
    by_T = (oil.hot_log_viscosity(0.0, 378.15 + h)[0] - oil.hot_log_viscosity(0.0, 378.15 - h)[0]) / (2 * h)
    assert warm.viscosity_slope == pytest.approx(-float(by_T), rel=1e-6)
    assert warm.density == pytest.approx(910.0 * (1 - 25 * 6.5e-4))


def test_oil_thickens_by_roelands_law_as_it_cools_towards_135_below_zero():
    """ln(eta) + 9.67 grows as a power of the distance from 138 K, by the slope that the oil has at its temperature."""
    oil = Lubricant(0.1, 2e-8, temperature=338.0, viscosity_slope=0.04)
    above = math.log(0.1) + 9.67
    power = 0.04 * 200.0 / above
    assert math.log(oil.at_temperature(238.0).viscosity) + 9.67 == pytest.approx(above * 2**power, rel=1e-12)
