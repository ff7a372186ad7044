"""The least film lies between films and beyond the last ones: against curves that are known everywhere."""

from __future__ import annotations

import numpy as np
import pytest

from flankfilm.coupling.films.least_film import least_of, parts_of

STEPS = 40
MIDDLES = (np.arange(STEPS) + 0.5) / STEPS


@pytest.mark.parametrize("place", [0.31, 0.5, 0.612])
def test_a_least_film_between_two_of_them(place: float):
    least, off = least_of(1.0 + (MIDDLES - place) ** 2, np.ones(STEPS))
    assert least == pytest.approx(1.0, abs=1e-12)
    assert 1.0 + np.min((MIDDLES - place) ** 2) - least <= off + 1e-15


@pytest.mark.parametrize(
    "curve", [lambda x: np.exp(0.8 * x), lambda x: np.exp(0.8 * (1 - x)), lambda x: np.sqrt(x + 0.05)]
)
def test_a_least_film_at_an_end_of_the_path(curve):
    true = min(curve(0.0), curve(1.0))
    film = curve(MIDDLES)
    least, off = least_of(film, np.ones(STEPS))
    assert abs(least - true) < 0.1 * abs(film.min() - true)
    assert abs(least - true) < off < abs(film.min() - true)


def test_a_step_of_the_load_parts_the_path_and_a_ramp_does_not():
    load = np.where(MIDDLES < 0.3, 1.0, 2.0)
    assert [part.start for part in parts_of(load)] == [0, 12]
    assert len(parts_of(0.05 + MIDDLES)) == 1
    film = np.where(MIDDLES < 0.3, 1.2 + MIDDLES, 0.9 + MIDDLES)
    least, _ = least_of(film, load)
    assert least == pytest.approx(1.2, abs=1e-12)
    lower = np.where(MIDDLES < 0.3, 1.2 + MIDDLES, 0.7 + MIDDLES)
    assert least_of(lower, load)[0] == pytest.approx(1.0, abs=1e-12)
