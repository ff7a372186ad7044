"""Roots inside an interval, by Bernstein coefficients: against the polynomials that they stand for."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from dynamics.kernels import roots as kernels

# as they are written: compiled, they can be called by kernels alone
bernstein, variations = kernels.bernstein.py_func, kernels.variations.py_func

NUMBERS = st.floats(-3.0, 3.0)


@settings(max_examples=50, deadline=None)
@given(st.lists(NUMBERS, min_size=2, max_size=8), st.integers(0, 2), NUMBERS, st.floats(0.1, 2.0))
def test_coefficients_are_those_of_the_polynomial(series, first, low, width):
    """sum c_(first + k) t^k at t = low + u width is sum b_k C(n, k) u^k (1 - u)^(n - k)."""
    series = [*[9.0] * first, *series]
    b = np.full(len(series), np.nan)
    n = bernstein(np.array(series), first, low, width, b)
    assert n == len(series) - 1 - first
    u = np.linspace(0.0, 1.0, 7)
    wanted = np.polynomial.polynomial.polyval(low + u * width, series[first:])
    found = sum(b[k] * comb(n, k) * u**k * (1.0 - u) ** (n - k) for k in range(n + 1))
    size = np.polynomial.polynomial.polyval(abs(low) + width, np.abs(series[first:]))
    assert found == pytest.approx(wanted, abs=1e-13 * max(1.0, float(size)))


@settings(max_examples=50, deadline=None)
@given(st.lists(st.floats(0.05, 0.95), min_size=0, max_size=4, unique=True))
def test_changes_of_sign_are_no_fewer_than_the_roots(roots):
    """Descartes: as many, or more by an even number."""
    series = np.polynomial.polynomial.polyfromroots(roots) if roots else np.ones(1)
    b = np.zeros(len(series))
    n = bernstein(series, 0, 0.0, 1.0, b)
    found = variations(b, n)
    assert found >= len(roots)
    assert (found - len(roots)) % 2 == 0
