"""Free ends of a twisted solid: the body as it is against the same body lengthened beyond its ends.

A helix has no plane of symmetry at mid-face, and no wall that leaves its waves alone. What free ends add to the
answer of a body without ends is

    E = C(free) - C(lengthened)

of loads on the face, on the same mesh and with the same polynomials over the same pieces of the face
(``fem.elasticity.free_ends``). Both lack the same of the load's own neighbourhood, so that E is smooth and dies off
from the ends inwards. Waves in place of the lengthened body would leave in E what the pieces do not show of them.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import legendre

from base import Array, Integers, record
from fem.elasticity.free_ends import ORDER, piece_values, pieces_between
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section

__all__ = ["FacePieces", "answers"]


@record
class FacePieces:
    """Continuous piecewise polynomials along a face, by their values at nodes.

    Attributes
    ----------
    ends : (pieces + 1,) array
        Where pieces end, growing [m].
    """

    ends: Array

    @property
    def functions(self) -> int:
        """How many there are."""
        return ORDER * (len(self.ends) - 1) + 1

    def lengthened(self, before: Array, beyond: Array) -> FacePieces:
        """Further pieces outside, by their lengths from either end outwards [m]."""
        low = self.ends[0] - np.cumsum(before)[::-1]
        return FacePieces(np.concatenate([low, self.ends, self.ends[-1] + np.cumsum(beyond)]))

    def face(self) -> Face:
        """Products of the functions, all for each of u, v and w."""
        count, whole = self.functions, pieces_between(self.ends)
        functions = np.ix_(*2 * [np.tile(np.arange(count), 2)])
        return Face(count, count, *(table[functions] for table in (whole.mass, whole.mixed, whole.stiffness)))

    def values(self, z: Array) -> Array:
        """Every function at places on the pieces (places, functions).

        Parameters
        ----------
        z : (places,) array
            [m]
        """
        piece = np.clip(np.searchsorted(self.ends, z) - 1, 0, len(self.ends) - 2)
        local = 2.0 * (z - self.ends[piece]) / np.diff(self.ends)[piece] - 1.0
        values = np.zeros((len(z), self.functions))
        columns = ORDER * piece[:, None] + np.arange(ORDER + 1)
        values[np.arange(len(z))[:, None], columns] = piece_values(local)
        return values

    def means(self, middle: Array, length: float) -> Array:
        """Means of every function over cells (cells, functions), exact; outside the pieces all vanish.

        Parameters
        ----------
        middle : (cells,) array
            [m]
        length : float
            Of each cell [m].
        """
        s, weight = _quadrature()
        low, high = self.ends[:-1], self.ends[1:]
        # of each cell (rows) what is on each piece (columns)
        start = np.clip((middle - 0.5 * length)[:, None], low, high)
        half = 0.5 * (np.clip((middle + 0.5 * length)[:, None], low, high) - start)
        cell, piece = np.nonzero(half > 0.0)
        start, half = start[cell, piece], half[cell, piece]
        place = start[:, None] + half[:, None] * (1.0 + s)
        local = 2.0 * (place - low[piece, None]) / (high - low)[piece, None] - 1.0
        values = weight @ piece_values(local.ravel()).reshape(len(cell), ORDER + 1, ORDER + 1)
        means = np.zeros((len(middle), self.functions))
        columns = ORDER * piece[:, None] + np.arange(ORDER + 1)
        np.add.at(means, (cell[:, None], columns), values * (half / length)[:, None])
        return means


@cache
def _quadrature() -> tuple[Array, Array]:
    """Places and weights by which a piece's functions are integrated exactly."""
    s, weight = legendre.leggauss(ORDER + 1)
    return np.asarray(s, dtype=float), np.asarray(weight, dtype=float)


def answers(over: Section, body: FacePieces, seen: FacePieces, at: FlankPoints, teeth: Integers) -> Array:
    """Displacements by loads on the functions of a part of a body, seen there (teeth, loads, psi, points, psi).

    Parameters
    ----------
    over : Section
    body : FacePieces
        The whole body, with free ends.
    seen : FacePieces
        Pieces of it that stand side by side.
    at : FlankPoints
        Places that are loaded on tooth 0, and observed on each tooth.
    teeth : (teeth,) array of int
        As of ``Prism.across``.
    """
    first = ORDER * int(np.searchsorted(body.ends, seen.ends[0]))
    part = slice(first, first + seen.functions)
    return prism(over, body.face()).across(at, at, teeth.tolist())[:, :, part, :, part]
