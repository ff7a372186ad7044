r"""Chebyshev series through samples of a curve on an arc, and what they leave out.

A series of degree n through n + 1 Chebyshev points has taken every coefficient :math:`a_k` of the curve beyond n for
one of degree 2n - k (L. N. Trefethen, Approximation Theory and Approximation Practice, 2013, theorem 4.1,
doi:10.1137/1.9781611975949), so that it is off by

.. math:: \sum_{k=n+1}^{2n} a_k \, (T_k - T_{2n-k}),

and by less from beyond 2n. The sizes of these coefficients follow from those that are known: they are taken to go on
falling by the power of k by which they have fallen from the middle of the series to its end. A geometric series falls
faster, one that has met a corner of the curve, which no degree follows, hardly at all. Their signs are not known: what
each of them changes of a figure is added as squares.

Towards an end where a contact begins they are known: coefficients of a singularity at an end follow one another, so
that their sum changes a figure by far less than each of them. There the series of half the degree, through every other
point, shows what it leaves out itself: the same sum with n/2 for n. If coefficients fall as :math:`k^{-p}` that sum
falls as :math:`n^{1-p}`: from there to n it is reduced half as much as these.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from base import Array

__all__ = ["OVERSHOOT", "ceiling", "gauss", "greatest_of", "left_out", "lobatto", "to_series"]

OVERSHOOT = 3.0
"""Largest error of a maximum value between nodes, over what it exceeds theirs by."""


@lru_cache(maxsize=64)
def lobatto(degree: int) -> Array:
    """Chebyshev points of a degree from -1 to 1, both ends included (degree + 1,)."""
    points = -np.cos(np.pi * np.arange(degree + 1) / degree)
    points.setflags(write=False)
    return np.asarray(points)


@lru_cache(maxsize=16)
def to_series(degree: int) -> Array:
    """Matrix from values at Chebyshev points to Chebyshev coefficients."""
    matrix = np.linalg.inv(chebyshev.chebvander(lobatto(degree), degree))
    matrix.setflags(write=False)
    return np.asarray(matrix)


@lru_cache(maxsize=64)
def gauss(count: int) -> tuple[Array, Array]:
    """Gauss's nodes and weights from -1 to 1."""
    t, weight = np.polynomial.legendre.leggauss(count)
    return np.asarray(t), np.asarray(weight)


def left_out(series: Array, t: Array, weight: Array, crowded: bool = False) -> Array:
    """What the coefficients beyond a series change of a figure.

    Parameters
    ----------
    series : (n + 1,) array
        Chebyshev coefficients through n + 1 Chebyshev points, n at least 4 and even.
    t : (m,) array
        Arguments, -1 to 1.
    weight : (..., m) array
        What the figure changes by per change of the curve there.
    crowded : bool
        Whether the curve is singular at an end, towards which the points crowd.

    Returns
    -------
    (..., n or 1) array
        By each of the coefficients n + 1 to 2n without their signs; crowded by all together.
    """
    degree, coefficients = len(series) - 1, np.abs(series)
    block, middle = max(2, degree // 4), degree // 2 + 1
    after = float(np.max(coefficients[-block:]))
    before = float(np.max(coefficients[max(1, middle - block) : middle]))
    fall = after / before if before > 0.0 else 1.0
    sizes = after * min(fall, 1.0) ** np.log2(np.arange(degree + 1, 2 * degree + 1) / degree)
    each = np.asarray((weight @ _aliased(t, degree)) * sizes)
    if not crowded:
        return each
    shown = np.asarray(min(2.0 * fall, 1.0) * (weight @ (_aliased(t, degree // 2) @ series[middle:])))
    most, size = np.linalg.norm(each, axis=-1), np.abs(shown)
    # waves that half the degree does not follow, but all of it, would be taken for what is left out
    return np.asarray(shown * np.divide(most, size, out=np.ones_like(size), where=size > most))[..., None]


def _aliased(t: Array, degree: int) -> Array:
    """What a series is off by for a coefficient of each degree n + 1 to 2n that it has not (m, n)."""
    return _aliased_at(np.ascontiguousarray(t, dtype=float).tobytes(), degree)


@lru_cache(maxsize=256)
def _aliased_at(t: bytes, degree: int) -> Array:
    """`_aliased` at the same arguments: curves by the dozen are asked on the same arcs."""
    polynomials = chebyshev.chebvander(np.frombuffer(t), 2 * degree)
    aliased = polynomials[:, degree + 1 :] - polynomials[:, degree - 1 :: -1]
    aliased.setflags(write=False)
    return np.asarray(aliased)


def ceiling(series: Array) -> float:
    """What `greatest_of` gives at most, with its error: |T_k| is at most 1."""
    nodes = float(np.max(chebyshev.chebval(lobatto(len(series) - 1), series)))
    most = float(series[0] + np.abs(series[1:]).sum())
    return nodes + (1.0 + OVERSHOOT) * max(most - nodes, 0.0)


def greatest_of(series: Array, crowded: bool = False) -> tuple[float, float]:
    """Maximum value of a Chebyshev series between -1 and 1, and its error; 0 at an end.

    The error is what the series leaves out there, and no more than ``OVERSHOOT`` times what the maximum value exceeds
    those at the nodes by: these are exact, and a series may wave between them.
    """
    nodes = chebyshev.chebval(lobatto(len(series) - 1), series)
    ends = float(max(nodes[0], nodes[-1]))
    slope = np.trim_zeros(chebyshev.chebder(series), "b")
    if len(slope) < 2:
        return ends, 0.0
    roots = chebyshev.chebroots(slope)
    real = roots.real[(np.abs(roots.imag) < 1e-6) & (np.abs(roots.real) < 1.0)]
    values = chebyshev.chebval(real, series)
    if values.size == 0 or values.max() <= ends:
        return ends, 0.0
    place = real[[int(np.argmax(values))]]
    off = float(np.linalg.norm(left_out(series, place, np.ones(1), crowded)))
    return float(values.max()), min(off, OVERSHOOT * max(float(values.max() - nodes.max()), 0.0))
