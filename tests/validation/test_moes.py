"""Moes' central film of line contacts: H. Moes, Wear 159 (1992) 57-66.

The formula is a fit for incompressible oil with Barus' viscosity; its own accuracy is a few per cent between the
regimes.
"""

import warnings

import pytest

from ehl import EhlWarning, LineContact, moes_central, solve


def quiet(contact, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", EhlWarning)
        return solve(contact, **options)


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
