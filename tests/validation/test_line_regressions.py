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


@pytest.mark.parametrize(("M", "L"), [(1000.0, 0.0), (20.0, 10.0), (100.0, 5.0), (500.0, 20.0), (0.05, 8.0)])
def test_long_ellipses_meet_the_line(M, L):
    # two independent fits: of ellipses and of lines
    contact = LineContact.from_moes(M, L, compressible=False)
    assert nijenbanning_line_central(contact) == pytest.approx(moes_central(contact), rel=0.03)
    shorter = nijenbanning_line_central(contact, 0.05)
    assert shorter == pytest.approx(moes_central(contact), rel=0.08)
