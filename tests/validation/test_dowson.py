"""Dowson's minimum film (1968) and Dowson and Toyoda's central film (1979) of line contacts."""

import warnings

import pytest

from base import RangeWarning
from ehl import (
    dowson,
    dowson_higginson_minimum,
    dowson_toyoda_central,
    solve,
)
from tests.validation.article import PITCH


def test_formulas_by_hand():
    U = 0.075 * 2.579 / (2.2e11 * 6.48e-3)
    W = 4.434e5 / (2.2e11 * 6.48e-3)
    G = 19.6e-9 * 2.2e11
    assert dowson_higginson_minimum(PITCH) == pytest.approx(2.65 * U**0.7 * G**0.54 * W**-0.13 * 6.48e-3)
    assert dowson_toyoda_central(PITCH) == pytest.approx(3.06 * U**0.69 * G**0.56 * W**-0.1 * 6.48e-3)


def test_the_formulas_come_near_the_solver_in_their_range():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        film = solve(PITCH)
    formula = dowson(PITCH)
    assert formula.central_thickness == pytest.approx(film.central_thickness, rel=0.25)
    assert formula.minimum_thickness == pytest.approx(film.minimum_thickness, rel=0.2)
