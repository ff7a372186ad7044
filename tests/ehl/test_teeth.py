"""The pressure before the spike: no teeth, an estimate that would see them, and calls that end."""

import warnings
from dataclasses import replace

import numpy as np
import pytest

from base import RangeWarning
from ehl import LineContact, Lubricant, solve
from ehl.discrete.method import METHOD
from ehl.films.result import pressure_error, teeth
from tests.ehl.films import quiet, sound
from tests.hard.random_contacts import random_contact
from tests.validation.article import PITCH, SECTION_2

GEAR = LineContact(443407.4, 2.57877, 6.4804e-3, 2.2e11, Lubricant(0.075, 19.6e-9))


@pytest.mark.parametrize("nodes", [65, 129, 257])
@pytest.mark.parametrize(
    "contact",
    [
        GEAR,
        replace(GEAR, lubricant=Lubricant(0.075, 15e-9)),
        PITCH,
        SECTION_2,
        LineContact.from_moes(20.0, 10.0),
        LineContact.from_moes(20.0, 10.0, compressible=False),
        LineContact.from_moes(100.0, 10.0),
    ],
)
def test_the_pressure_climbs_to_its_spike_without_teeth(contact, nodes):
    film = sound(quiet(contact, nodes=nodes))
    assert teeth(film.pressure) == 0.0
    assert film.errors.pressure < 0.2


def test_the_pressure_on_a_plain_grid_is_that_of_a_grid_around_the_spike():
    plain, fine = quiet(GEAR, nodes=129), quiet(GEAR, nodes=1025, spike=0.01)
    before = (plain.x > -0.9 * GEAR.half_width) & (plain.x < 0.85 * GEAR.half_width)
    exact = np.interp(plain.x, fine.x, fine.pressure)
    # a cell is 0.02 half-widths wide here; teeth were a fifth of the Hertz pressure high
    assert np.abs(plain.pressure - exact)[before].max() < 0.005 * GEAR.peak_pressure


def test_random_contacts_have_no_teeth():
    rng = np.random.default_rng(3)
    high = [
        teeth(f.pressure) / f.contact.peak_pressure for f in (quiet(random_contact(rng)) for _ in range(40))
    ]
    assert max(high) < 1e-3


VISCOUS = Lubricant(0.15644730923478653, 2.190920138042559e-08)
OILY = Lubricant(0.1705819790277453, 1.761521943412465e-08)
THICK = (
    LineContact(113112.14776427833, 9.823437028667271, 0.0037491167388096886, 2.2e11, VISCOUS),
    LineContact(193780.74843619138, 14.429070100186653, 0.00303659280935467, 2.2e11, OILY),
)


@pytest.mark.parametrize("nodes", [129, 257, 513])
@pytest.mark.parametrize("contact", THICK)
def test_thick_fast_films_have_no_teeth(contact, nodes):
    """The inlet zone of films of one to two b^2/R is wider than the contact, and the spike stands in it."""
    film = sound(quiet(contact, nodes=nodes))
    top = int(film.pressure.argmax())
    assert (np.diff(film.pressure)[:top] >= -1e-4 * contact.peak_pressure).all()
    if nodes == 129:
        fine = quiet(contact, nodes=1025)
        assert film.central_thickness == pytest.approx(fine.central_thickness, rel=film.error)
        assert film.minimum_thickness == pytest.approx(fine.minimum_thickness, rel=film.error)


def test_the_estimate_sees_teeth():
    level = quiet(GEAR, nodes=129).state.fine
    clean = pressure_error(level, level)
    assert clean == 0.0
    P = level.solution.P.copy()
    tip = int(np.flatnonzero(P > 0.7)[-1])
    P[tip - 8 : tip - 1 : 2] += 0.1
    jagged = replace(level, solution=replace(level.solution, P=P))
    assert pressure_error(level, jagged) > 0.3


def test_what_cannot_be_solved_ends_within_its_steps():
    # Barus' law and more at alpha p_H of 200 and above
    for M, L, z in ((667.0, 21.5, 1.92), (695.0, 18.1, 1.93), (1556.0, 19.7, 1.87), (5000.0, 25.0, 2.0)):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RangeWarning)
            film = solve(LineContact.from_moes(M, L, roelands_z=z))
        assert film.cost.iterations < METHOD.newton_steps + 2 * 60 * 4
        assert film.converged or np.isnan(film.central_thickness)
