import math
from dataclasses import dataclass

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from base import InputError
from ehl import (
    Barus,
    ConstantDensity,
    ConstantViscosity,
    DowsonHigginson,
    LineContact,
    Lubricant,
    Roelands,
    solve,
)

LAWS = [Roelands(2e-8, 0.6), Roelands(2e-8, 1.0), Barus(2e-8), ConstantViscosity()]


@given(st.floats(0, 4e9), st.sampled_from(LAWS))
def test_slopes_of_viscosity_agree_with_differences(p, law):
    step = 1e4
    high, low = law.log_ratio(p + step)[0], law.log_ratio(p)[0]
    assert (high - low) / step == pytest.approx(float(law.log_ratio(p + step / 2)[1]), rel=1e-5, abs=1e-15)


@pytest.mark.parametrize("law", LAWS)
def test_slope_at_ambient_pressure(law):
    value, slope = law.log_ratio(0.0)
    assert value == 0.0
    assert slope == pytest.approx(law.slope, rel=1e-14)


def test_roelands_of_index_one_is_barus_and_small_indices_are_logarithms():
    p = np.array([0.0, 1e7, 1e9])
    np.testing.assert_allclose(Roelands(2e-8, 1.0).log_ratio(p)[0], Barus(2e-8).log_ratio(p)[0], rtol=1e-13)
    # z -> 0: alpha p0 ln(1 + p/p0)
    expected = 2e-8 / 5.1e-9 * np.log1p(5.1e-9 * p)
    np.testing.assert_allclose(Roelands(2e-8, 1e-7).log_ratio(p)[0], expected, rtol=1e-6)


def test_the_laws_that_a_lubricant_chooses():
    assert isinstance(Lubricant(0.05, 2e-8).law, Roelands)
    assert Lubricant(0.05, 2e-8, roelands_z=1.0).law == Barus(2e-8)
    assert Lubricant(0.05, 0.0).law == ConstantViscosity()
    assert Lubricant(0.05, 2e-8).compression == DowsonHigginson()
    assert Lubricant(0.05, 2e-8, compressible=False).compression == ConstantDensity()
    assert Lubricant(0.05, 2e-8, viscosity_law=Barus(2e-8)).z == 1.0


@dataclass(frozen=True)
class Quadratic:
    """ln(eta/eta0) = alpha p - c p^2: a law from outside."""

    alpha: float
    c: float

    @property
    def slope(self):
        return self.alpha

    @property
    def reliable_below(self):
        return 1e9

    def log_ratio(self, p):
        p = np.asarray(p, dtype=float)
        return self.alpha * p - self.c * p**2, self.alpha - 2 * self.c * p


def test_a_law_from_outside_is_solved_with_the_same_newton_method():
    oil = Lubricant(0.05, 2e-8, viscosity_law=Quadratic(2e-8, 2e-18), density_law=ConstantDensity())
    film = solve(LineContact(6e4, 1.0, 0.01, 2.2e11, oil), nodes=129)
    assert film.converged
    assert film.cost.iterations < 30  # quadratic convergence needs the exact derivative
    barus = solve(LineContact(6e4, 1.0, 0.01, 2.2e11, Lubricant(0.05, 2e-8, roelands_z=1.0)), nodes=129)
    assert film.central_thickness == pytest.approx(barus.central_thickness, rel=0.15)
    assert math.isnan(oil.z)


def test_a_given_law_has_to_match():
    with pytest.raises(InputError) as caught:
        Lubricant(
            0.05,
            3e-8,
            roelands_z=0.5,
            viscosity_law=Barus(2e-8),
            density_law=DowsonHigginson(),
            compressible=False,
        )
    assert [f.where for f in caught.value.faults] == ["roelands_z", "pressure_viscosity", "compressible"]
