"""Films over time at their limits: ramps faster than oil, loads that rise from nothing and fall to it, 3 GPa."""

import math
from dataclasses import replace

import numpy as np
import pytest

from ehl import LineContact, TransientFilm, solve_transient
from tests.ehl.films import quiet
from tests.validation.article import PITCH

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::base.RangeWarning")]


def followed(contact: LineContact, first: float, last: float, times: float) -> TransientFilm:
    unit = contact.half_width / contact.entrainment

    def load(t: float) -> float:
        way = 0.5 - 0.5 * math.cos(math.pi * min(t / (times * unit), 1.0))
        return contact.load * (first + (last - first) * way)

    return solve_transient(contact, load, np.array([0.0, times, times + 15.0]) * unit, tolerance=0.05)


@pytest.mark.parametrize(
    ("contact", "first", "last", "times"),
    [
        (PITCH, 0.5, 1.0, 0.1),
        (PITCH, 1.0, 0.5, 0.1),
        (PITCH, 0.01, 1.0, 2.0),
        (PITCH, 1.0, 0.01, 2.0),
        (replace(PITCH, load=4.0 * PITCH.load), 1.0, 0.5, 2.0),
        (LineContact.from_moes(100.0, 15.0), 1.0, 0.5, 1.0),
        (LineContact.from_moes(0.05, 0.0), 1.0, 2.0, 2.0),
    ],
)
def test_hard_ramps_are_solved_and_end_in_the_steady_film(contact, first, last, times):
    film = followed(contact, first, last, times)
    assert film.converged, film.message
    assert film.error < 0.05
    assert film.balance < 1e-6
    if contact.moes_M > 1.0:  # a rigid cylinder takes longer
        new = quiet(replace(contact, load=film.load[-1]), nodes=film.x.shape[1])
        assert film.least[-1] == pytest.approx(new.minimum_thickness, rel=2e-4)


def test_a_film_that_breaks_is_refused_with_the_reason():
    film = followed(LineContact.from_moes(0.1, 0.0), 1.0, 0.1, 2.0)
    assert not film.converged
    assert "breaks" in film.message
