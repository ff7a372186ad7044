"""Errors that films report against finer grids, on a fixed sample of gear contacts."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

from base import RangeWarning
from benchmarks.studies.film_estimates import SUPPLIES, outcomes
from ehl import solve_thermal
from tests.hard.random_contacts import random_gear_contact

TOLERANCE = 0.01
NONE = 0.1 * TOLERANCE  # errors below this count as none
SEED = 1


@pytest.fixture(autouse=True)
def _known_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RangeWarning)
        yield


@pytest.mark.slow
@pytest.mark.parametrize("hot", [False, True])
@pytest.mark.parametrize("supply", SUPPLIES)
def test_no_estimate_is_below_half_of_the_error(supply, hot):
    rows = list(outcomes(supply, hot, SEED, range(8), TOLERANCE))
    assert len(rows) >= 7
    assert [row for row in rows if row.true > max(NONE, 2.0 * row.estimate)] == []
    ratios = np.array([row.ratio for row in rows])
    assert np.mean((ratios >= 0.5) & (ratios <= 5.0)) >= 0.8
    assert np.median(ratios) < 3.0


@pytest.mark.slow
def test_gear_contacts_with_heat_reach_a_fifth_of_a_per_cent():
    rng = np.random.default_rng(3)
    films = [solve_thermal(random_gear_contact(rng), tolerance=0.002) for _ in range(20)]
    assert sum(film.converged and film.error <= 0.002 for film in films) >= 18
