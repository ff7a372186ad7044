"""Mathieu's equation: traces of the monodromy matrix and characteristic values, computed with mpmath at 30 digits.

With D = 0 the oscillator is a Hill equation. y'' + (a - 2 q cos 2t) y = 0 is the oscillator with mean
stiffness a, amplitude 2 q, phase pi and frequency 2; the monodromy is taken over the stiffness's period pi.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy.optimize import brentq

from dynamics import FourierStiffness, GearOscillator, period_map

TRACES = [
    (1.0, 0.5, -2.61241890662466),
    (2.5, 1.0, -0.0967523027869283),
    (10.0, 5.0, -2.52325769871579),
    (25.0, 25.0, 68.4002947420419),
]
# characteristic values for q = 1 (DLMF chapter 28 lists the expansions); even orders have trace 2, odd ones
# -2
CHARACTERISTIC = [
    ("a0", -0.455138604107413548, 2.0),
    ("b1", -0.110248816992095170, -2.0),
    ("a1", 1.85910807251436347, -2.0),
    ("b2", 3.91702477299847119, 2.0),
    ("a2", 4.37130098273508566, 2.0),
]


def monodromy(a: float, q: float) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a negative mean is what two of the values need
        stiffness = FourierStiffness(a, (2.0 * q,), (np.pi,))
    osc = GearOscillator(stiffness, 0.0, 0.0, 0.0, 2.0, half_backlash=0.0)
    return period_map(osc, (0.3, 0.1)).jacobian


@pytest.mark.parametrize(("a", "q", "trace"), TRACES)
def test_trace(a, q, trace):
    # the last digit given of 68.4 stands for 1e-13; 1e-12 relative is asked for
    assert np.trace(monodromy(a, q)) == pytest.approx(trace, rel=1e-12)
    assert np.linalg.det(monodromy(a, q)) == pytest.approx(1.0, rel=0, abs=1e-12)


@pytest.mark.parametrize(("name", "a", "trace"), CHARACTERISTIC)
def test_characteristic_value(name, a, trace):
    def off(at: float) -> float:
        return float(np.trace(monodromy(at, 1.0))) - trace

    found = brentq(off, a - 0.02, a + 0.02, xtol=1e-15, rtol=1e-15)
    assert found == pytest.approx(a, rel=0, abs=1e-12)
