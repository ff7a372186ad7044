"""On several cores the numbers are those of one."""

import numpy as np
import pytest

from base import threads
from dynamics import FourierStiffness, GearOscillator, basins


def oscillator(frequency: float) -> GearOscillator:
    stiffness = FourierStiffness(1.0, (0.18,), (0.0,))
    return GearOscillator(stiffness, 0.05, 0.1, 0.2, frequency, half_backlash=0.2)


@pytest.fixture
def on(monkeypatch):
    return lambda number: monkeypatch.setattr(threads, "cores", lambda: number)


def test_basins(on):
    found = []
    for number in (1, 3):
        on(number)
        found.append(basins(oscillator(0.6), (-1, 1, 40), (-1, 1, 40)))
    np.testing.assert_array_equal(found[0].labels, found[1].labels)
    assert found[0].cost.periods == found[1].cost.periods
    assert len(set(found[0].labels.ravel().tolist())) == 2
