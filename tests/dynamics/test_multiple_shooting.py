"""Newton's equations over the stretches of an orbit: the sparse elimination solves what the dense matrix does."""

from __future__ import annotations

import numpy as np
import pytest

from dynamics.orbits.multiple_shooting import newton_step


@pytest.mark.parametrize(("count", "size"), [(1, 3), (2, 2), (7, 4), (40, 12)])
def test_the_step_closes_the_gaps_of_all_stretches(count: int, size: int):
    random = np.random.default_rng(count)
    factors, gap = random.normal(size=(count, size, size)) / size, random.normal(size=(count, size))
    step = newton_step(factors, gap)
    left = np.roll(step, -1, axis=0) - np.einsum("sij,sj->si", factors, step) - gap
    assert np.max(np.abs(left)) < 1e-12 * max(1.0, np.max(np.abs(step)))


def test_stretches_that_grow_by_a_thousand_are_solved_to_rounding():
    """A product of all factors, 1e45, would lose every digit."""
    random = np.random.default_rng(1)
    factors, gap = 1e3 * random.normal(size=(15, 4, 4)), random.normal(size=(15, 4))
    step = newton_step(factors, gap)
    left = np.roll(step, -1, axis=0) - np.einsum("sij,sj->si", factors, step) - gap
    assert np.max(np.abs(left)) < 1e-10


@pytest.mark.parametrize("count", [1, 3])
def test_a_free_direction_is_singular(count: int):
    with pytest.raises(np.linalg.LinAlgError):
        newton_step(np.broadcast_to(np.eye(2), (count, 2, 2)), np.ones((count, 2)))
