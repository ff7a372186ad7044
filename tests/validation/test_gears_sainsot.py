"""Body deflection of Sainsot, Velex and Duverger 2004, doi:10.1115/1.1758252: the printed table of coefficients.

Rows A B C D E F of X(h, th) = A/th^2 + B h^2 + C h/th + D/th + E h + F for L*, M*, P*, Q*, as several sources print
them; each polynomial is taken out of the formula by its dependence on load height and load angle.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from gears.closed_form import sainsot_body

TABLE = {
    "L": "-5.574e-5 -1.9986e-3 -2.3015e-4 4.7702e-3 0.0271 6.8045",
    "M": "60.111e-5 28.100e-3 -83.431e-4 -9.9256e-3 0.1624 0.9086",
    "P": "-50.952e-5 185.50e-3 0.0538e-4 53.300e-3 0.2895 0.9236",
    "Q": "-6.2042e-5 9.0889e-3 -4.0964e-4 7.8297e-3 -0.1472 0.6904",
}


@pytest.mark.parametrize(("h", "th"), [(1.4, 0.01), (2.0, 0.05), (5.0, 0.1), (7.0, 0.12)])
def test_polynomials(h, th):
    root, width = 0.1, 2 * 0.1 * th
    at = [float(sainsot_body(root, root / h, th, 0.0, u * width)) for u in (0.0, 1.0, 2.0)]
    P = at[0]
    L = 0.5 * (at[2] - 2 * at[1] + at[0])
    M = at[1] - at[0] - L
    slanted = float(sainsot_body(root, root / h, th, math.pi / 4, 0.0))
    Q = 2 * slanted / P - 1
    powers = np.array([1 / th**2, h**2, h / th, 1 / th, h, 1.0])
    for name, found in zip("LMPQ", (L, M, P, Q), strict=True):
        known = np.array([float(value) for value in TABLE[name].split()]) @ powers
        assert found == pytest.approx(known, rel=1e-9)
