"""Positions of the time series for ParaView and of animations are equally far apart."""

from __future__ import annotations

import numpy as np
import pytest

from flankfilm.stages.vtk import STEPS, even_rows


@pytest.mark.parametrize("positions", [21, 24, 40, 50, 64, 80, 120, 121, 240, 400])
def test_rows_are_equally_far_apart_over_one_base_pitch_and_into_the_next(positions):
    rows = np.array(even_rows(positions))
    gaps = np.diff([*rows, rows[0] + positions])
    assert STEPS / 2 <= len(rows) <= 2 * STEPS
    assert set(gaps) == {gaps[0]}
    assert 0 <= rows[0] <= rows[-1] < positions


@pytest.mark.parametrize("positions", [41, 97, 113])
def test_prime_numbers_of_positions_stay_even_within_the_base_pitch(positions):
    rows = np.array(even_rows(positions))
    assert len(set(np.diff(rows))) == 1
    assert STEPS / 2 <= len(rows) <= 2 * STEPS


def test_short_cycles_are_taken_whole():
    assert list(even_rows(7)) == list(range(7))
