"""Places across the film and the matrices that differentiate and integrate there: Gauss-Lobatto collocation."""

from __future__ import annotations

from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from base import Array
from ehl.discrete.method import METHOD


class Collocation(NamedTuple):
    """Collocation over zeta from -1/2 to 1/2."""

    zeta: Array  # (m,)
    weights: Array  # (m,)
    derive: Array  # (m, m)
    stiffness: Array  # (m, m): integral of products of the derivatives
    sum_up: Array  # (m, m): integral from -1/2 to each place


@cache
def lobatto(points: int = METHOD.points_across) -> Collocation:
    """Return the places and matrices of as many points."""
    order = points - 1
    top = np.zeros(points)
    top[order] = 1.0
    s = np.concatenate([[-1.0], np.sort(legendre.legroots(legendre.legder(top)).real), [1.0]])
    values = legendre.legvander(s, order)
    weights = 2.0 / (order * points * values[:, order] ** 2)
    unit = np.eye(points)
    slopes = np.array([legendre.legval(s, legendre.legder(row)) for row in unit]).T
    sums = np.array([legendre.legval(s, legendre.legint(row, lbnd=-1)) for row in unit]).T
    back = np.linalg.inv(values)
    derive = 2.0 * slopes @ back
    stiffness = derive.T @ (0.5 * weights[:, None] * derive)
    return Collocation(0.5 * s, 0.5 * weights, derive, stiffness, 0.5 * sums @ back)
