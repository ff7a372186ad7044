"""Moes' central film of line contacts: H. Moes, Wear 159 (1992) 57-66.

The formula is a fit for incompressible oil with Barus' viscosity; its own accuracy is a few per cent between the
regimes.
"""

import pytest

from ehl import LineContact, moes_central
from tests.ehl.films import quiet


def test_formula_by_hand():
    # M = 20, L = 10: RI 0.15, EI 1.439664, RP 5.973725, EP 5.069603, s = 1.4 + 1.6 exp(-2 EI/RI) = 1.4
    contact = LineContact.from_moes(20.0, 10.0)
    isoviscous = (0.15 ** (7 / 3) + 1.439664 ** (7 / 3)) ** 0.6
    piezoviscous = (5.973725**-3.5 + 5.069603**-3.5) ** -0.4
    expected = (isoviscous + piezoviscous) ** (1 / 1.4)
    assert moes_central(contact) / contact.moes_film == pytest.approx(expected, rel=1e-5)
    # M = 0.1, L = 0: RI 30, EI 4.154005, s = 1.4 + 1.6 exp(-0.276934)
    contact = LineContact.from_moes(0.1, 0.0)
    s = 1.4 + 1.6 * 0.758105
    expected = (30 ** (7 / 3) + 4.154005 ** (7 / 3)) ** (3 / 7)
    assert s == pytest.approx(2.61296, rel=1e-5)
    assert moes_central(contact) / contact.moes_film == pytest.approx(expected, rel=1e-5)
    # M = 1, L = 5: both halves matter, s = 1.4 + 1.6 exp(-2 * 2.621/3)
    contact = LineContact.from_moes(1.0, 5.0)
    s = 1.4 + 1.6 * 0.174238
    isoviscous = (3 ** (7 / 3) + 2.621 ** (7 / 3)) ** (3 * s / 7)
    piezoviscous = (3.763211**-3.5 + 4.383593**-3.5) ** (-2 * s / 7)
    expected = (isoviscous + piezoviscous) ** (1 / s)
    assert moes_central(contact) / contact.moes_film == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize("M", [5.0, 20.0, 100.0, 500.0])
@pytest.mark.parametrize("L", [0.0, 2.5, 10.0, 20.0])
def test_central_film_against_the_fit(M, L):
    contact = LineContact.from_moes(M, L, roelands_z=1.0, compressible=False)
    assert quiet(contact).central_thickness == pytest.approx(moes_central(contact), rel=0.07)


def test_elastic_isoviscous_exponent():
    # h ~ M^-1/5 is exact in the limit; the constant of the fit is 2.621, ours 2.49
    film = quiet(LineContact.from_moes(1000.0, 0.0, compressible=False), tolerance=2e-3)
    exponent = film.central_slope * film.contact.load / film.central_thickness
    assert exponent == pytest.approx(-0.2, abs=0.003)
    assert film.central_moes * 1000**0.2 == pytest.approx(2.621, rel=0.06)


def test_elastic_piezoviscous_asymptote():
    film = quiet(LineContact.from_moes(200.0, 25.0, roelands_z=1.0, compressible=False))
    assert film.central_moes == pytest.approx(1.311 * 200**-0.125 * 25**0.75, rel=0.03)


def test_compressible_film_is_thinner_by_the_density():
    for M, L in [(20.0, 10.0), (100.0, 10.0)]:
        thick, thin = (quiet(LineContact.from_moes(M, L, compressible=c)) for c in (False, True))
        density = thin.contact.lubricant.density_ratio(thin.contact.peak_pressure)[0]
        ratio = thin.central_thickness / thick.central_thickness
        assert ratio * density == pytest.approx(1.0, abs=0.04)
        # the neck, at low pressure, hardly notices
        assert thin.minimum_thickness == pytest.approx(thick.minimum_thickness, rel=0.02)
