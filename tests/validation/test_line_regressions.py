"""Other film formulas of line contacts: Pan and Hamrock (1989), Nijenbanning, Venner and Moes (1994)."""

import pytest

from ehl import (
    LineContact,
    Lubricant,
    moes_central,
    nijenbanning_line_central,
    pan_hamrock_central,
    pan_hamrock_minimum,
)
from tests.ehl.films import quiet


def steel(W, U, G):
    """Return a contact of given Dowson-Higginson groups."""
    E, R, eta = 2.2e11, 0.01, 0.04
    return LineContact(W * E * R, U * E * R / eta, R, E, Lubricant(eta, G / E))


@pytest.mark.parametrize(("W", "U"), [(5e-5, 1e-11), (1e-4, 1e-11), (2e-4, 1e-11), (1e-4, 3e-11)])
def test_pan_and_hamrock_in_their_range(W, U):
    contact = steel(W, U, 5000.0)
    film = quiet(contact)
    assert film.minimum_thickness == pytest.approx(pan_hamrock_minimum(contact), rel=0.1)
    assert film.central_thickness == pytest.approx(
        pan_hamrock_central(contact), rel=0.13
    )  # lies below, more so at heavy loads


def test_pan_and_hamrock_by_hand():
    contact = steel(1e-4, 1e-11, 5000.0)
    # 1e-4^-0.128 = 3.2509, 1e-11^0.694 = 2.3227e-8, 5000^0.568 = 126.17
    assert pan_hamrock_minimum(contact) / contact.radius == pytest.approx(
        1.714 * 3.2509 * 2.3227e-8 * 126.17, rel=1e-3
    )
    # 1e-4^-0.166 = 4.6132, 1e-11^0.692 = 2.4434e-8, 5000^0.47 = 54.77
    assert pan_hamrock_central(contact) / contact.radius == pytest.approx(
        2.922 * 4.6132 * 2.4434e-8 * 54.77, rel=1e-3
    )


def test_nijenbanning_by_hand():
    """At D = 0.01: k = 0.0551880, ln(4/k) - 1 = 3.283305, q = 1 - 0.0276310 + 0.63 0.0719686 = 1.0177092.

    q^-0.56 = 0.9902178, q^-0.35 = 0.9938749, D^-1/15 = 1.3593564, D^-1/24 = 1.2115277.
    """
    # N = sqrt(128/9 pi 3.283305 1e9/0.01) = 1.2191703e6, N^-2/15 = 0.1543564; no piezoviscous part, s = 1.4
    contact = LineContact.from_moes(1000.0, 0.0)
    elastic = 3.18 * 0.9902178 * 1.3593564 * 0.1543564
    expected = (0.003 ** (7 / 3) + elastic ** (7 / 3)) ** (3 / 7)
    assert nijenbanning_line_central(contact) / contact.moes_film == pytest.approx(expected, rel=1e-6)
    # N = 3448.3344, N^-2/15 = 0.3375350, N^-1/12 = 0.5072233; 10^2/3 = 4.6415888, 10^3/4 = 5.6234133
    contact = LineContact.from_moes(20.0, 10.0)
    elastic = 3.18 * 0.9902178 * 1.3593564 * 0.3375350
    rigid_piezo = 1.29 * 1.00691 ** (-2 / 3) * 4.6415888
    elastic_piezo = 1.48 * 0.9938749 * 1.2115277 * 0.5072233 * 5.6234133
    expected = (0.15 ** (7 / 3) + elastic ** (7 / 3)) ** 0.6 + (
        rigid_piezo**-3.5 + elastic_piezo**-3.5
    ) ** -0.4
    found = nijenbanning_line_central(contact) / contact.moes_film
    assert found == pytest.approx(expected ** (1 / 1.4), rel=1e-6)


@pytest.mark.parametrize(("M", "L"), [(1000.0, 0.0), (20.0, 10.0), (100.0, 5.0), (500.0, 20.0), (0.05, 8.0)])
def test_long_ellipses_meet_the_line(M, L):
    # two independent fits: of ellipses and of lines
    contact = LineContact.from_moes(M, L, compressible=False)
    assert nijenbanning_line_central(contact) == pytest.approx(moes_central(contact), rel=0.03)
    shorter = nijenbanning_line_central(contact, 0.05)
    assert shorter == pytest.approx(moes_central(contact), rel=0.08)
