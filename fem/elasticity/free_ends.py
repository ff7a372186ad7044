"""What free ends add to a gear between frictionless walls: one prism with functions over the face, solved with both.

Waves along the face (``fem.elasticity.prism``) hold the ends against frictionless walls, w = 0. Without walls sigma_zz
vanishes there, and the gear yields more, most at its ends. The difference does not know the load's own neighbourhood,
unless that is at the end: it is smooth, so that a coarse section and a few functions over the face give it, by

    E = C(free) - C(walls)

on the same mesh with the same functions, which leaves out what both lack. Mid-face is a plane of symmetry: loads that
are equal on both sides of it and such that are opposite are solved apart, on half the face.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache

import numpy as np
from numpy.polynomial import legendre

from base import Array, record
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, Section

__all__ = [
    "ORDER",
    "HalfFace",
    "free_ends",
    "free_ends_across",
    "half_face",
    "over_cells",
    "piece_values",
    "pieces_between",
    "unknowns_along",
]

ORDER = 3
"""Of the polynomials of one piece of the face."""

LAST, GROWTH = 0.375, 2.6
"""Length of the piece at the end [modules], and of each piece over the one nearer to the end."""


@record
class HalfFace:
    """Continuous piecewise polynomials over half a face, by their values at nodes from mid-face to the end.

    A helix has no middle: there they go over a whole face (``fem.elasticity.lengthened``).

    Attributes
    ----------
    ends : (pieces + 1,) array
        Where pieces end [m], on half a face from 0.
    mass, stiffness, mixed : (n, n) arrays
        <f g>, <f' g'>, <f g'>.
    """

    ends: Array
    mass: Array
    stiffness: Array
    mixed: Array

    def face(self, even: bool, free: bool) -> Face:
        """Products for displacements that are equal (even) or opposite on the other half, with free ends or walls."""
        n = len(self.mass)
        psi = np.arange(0 if even else 1, n)
        phi = np.arange(1 if even else 0, n if free else n - 1)
        functions = np.ix_(np.concatenate([psi, phi]), np.concatenate([psi, phi]))
        products = (self.mass, self.mixed, self.stiffness)
        return Face(len(psi), len(phi), *(table[functions] for table in products))

    def values(self, z: Array) -> Array:
        """Every function (n, k) at places (k,) of the half with z >= 0 [m]."""
        return np.asarray(self._on_pieces(z)[0])

    def slopes(self, z: Array) -> Array:
        """Their derivatives (n, k) [1/m]."""
        return np.asarray(self._on_pieces(z)[1])

    def _on_pieces(self, z: Array) -> Array:
        """Values and derivatives (2, n, k)."""
        piece = np.clip(np.searchsorted(self.ends, z) - 1, 0, len(self.ends) - 2)
        start, long = self.ends[piece], np.diff(self.ends)[piece]
        local = 2 * (z - start) / long - 1
        values_and_slopes = np.zeros((2, len(self.mass), len(z)))
        rows, columns = ORDER * piece[:, None] + np.arange(ORDER + 1), np.arange(len(z))[:, None]
        values_and_slopes[0, rows, columns] = piece_values(local)
        values_and_slopes[1, rows, columns] = _slopes(local) * (2 / long)[:, None]
        return values_and_slopes

    def means(self, edges: Array) -> tuple[Array, Array]:
        """Means over cells of every function, and of its opposite on the other half.

        Parameters
        ----------
        edges : (k + 1,) array
            Of the cells, growing, from mid-face [m].

        Returns
        -------
        two (n, k) arrays
            Of functions that are equal on both halves, and of such that change sign at mid-face.
        """
        s, weight = legendre.leggauss(ORDER + 1)
        even, odd = np.zeros((2, len(self.mass), len(edges) - 1))
        cuts = np.unique(np.concatenate([-self.ends, self.ends, edges]))
        cuts = cuts[(cuts >= edges[0]) & (cuts <= edges[-1])]
        middle, half = 0.5 * (cuts[:-1] + cuts[1:]), 0.5 * np.diff(cuts)
        side = np.sign(middle)
        piece = np.clip(np.searchsorted(self.ends, np.abs(middle)) - 1, 0, len(self.ends) - 2)
        cell = np.searchsorted(edges, middle) - 1
        start, stop = self.ends[piece], self.ends[piece + 1]
        z = np.abs(middle[:, None] + half[:, None] * s)
        local = (2 * (z - start[:, None]) / (stop - start)[:, None] - 1).ravel()
        values = weight @ piece_values(local).reshape(len(middle), ORDER + 1, ORDER + 1)
        values = values * (half / np.diff(edges)[cell])[:, None]
        rows = ORDER * piece[:, None] + np.arange(ORDER + 1)
        np.add.at(even, (rows, cell[:, None]), values)
        np.add.at(odd, (rows, cell[:, None]), side[:, None] * values)
        return even, odd


@cache
def _nodes() -> Array:
    """Gauss-Lobatto nodes of one piece (ORDER + 1,), -1 to 1."""
    inner = legendre.legroots(legendre.legder(np.eye(ORDER + 1)[ORDER])).real
    return np.concatenate([[-1.0], np.sort(inner), [1.0]])


def piece_values(s: Array) -> Array:
    """Values (k, ORDER + 1) of the functions of one piece, from -1 to 1, at places (k,) of it."""
    return np.asarray(legendre.legvander(s, ORDER) @ np.linalg.inv(legendre.legvander(_nodes(), ORDER)))


def _lengths(half_width: float, module: float, last: float, growth: float) -> list[float]:
    """Lengths of pieces from the end to mid-face, all together half the face or more [m]."""
    lengths = [last * module]
    while sum(lengths) < half_width:
        lengths.append(lengths[-1] * growth)
    return lengths


def unknowns_along(width: float) -> int:
    """Unknowns of a node of the section on half a face of some width in modules, all three directions."""
    return 3 * (ORDER * len(_lengths(0.5 * width, 1.0, LAST, GROWTH)) + 1)


def _slopes(s: Array) -> Array:
    """Derivatives (k, ORDER + 1) of a piece's functions at places (k,)."""
    rises = np.array([legendre.legval(s, legendre.legder(row)) for row in np.eye(ORDER + 1)]).T
    return np.asarray(rises @ np.linalg.inv(legendre.legvander(_nodes(), ORDER)))


def half_face(half_width: float, module: float, last: float = LAST, growth: float = GROWTH) -> HalfFace:
    """Divide half a face into pieces that shorten towards the end.

    Parameters
    ----------
    half_width, module : float
        [m]
    last, growth : float
        Length of the piece at the end [modules], and of each piece over the one nearer to the end.
    """
    lengths = _lengths(half_width, module, last, growth)
    return pieces_between(half_width * np.concatenate([[0.0], np.cumsum(lengths[::-1])]) / sum(lengths))


def pieces_between(ends: Array) -> HalfFace:
    """Polynomials over pieces of a face.

    Parameters
    ----------
    ends : (pieces + 1,) array
        Where pieces end, growing [m]; of half a face from 0, of a face without a middle from anywhere.
    """
    n = ORDER * (len(ends) - 1) + 1
    s, weight = legendre.leggauss(ORDER + 1)
    values, slopes = piece_values(s), _slopes(s)
    mass, stiffness, mixed = np.zeros((3, n, n))
    for piece, length in enumerate(np.diff(ends)):
        at = slice(ORDER * piece, ORDER * piece + ORDER + 1)
        mass[at, at] += 0.5 * length * (values.T * weight) @ values
        stiffness[at, at] += 2 / length * (slopes.T * weight) @ slopes
        mixed[at, at] += (values.T * weight) @ slopes
    return HalfFace(np.asarray(ends), mass, stiffness, mixed)


def over_cells(half: HalfFace, even: Array, odd: Array, edges: Array) -> Array:
    """Means over cells (..., cells, cells) by a unit force on a cell.

    Parameters
    ----------
    half : HalfFace
    even, odd : (..., psi, psi) arrays
        By functions over half the face.
    edges : (cells + 1,) array
        Of the cells, growing, from mid-face [m]; the face ends where they do, to the last bit.
    """
    edges = np.clip(edges, -half.ends[-1], half.ends[-1])
    same, opposite = half.means(edges)
    opposite = opposite[1:]
    return np.asarray(0.5 * (same.T @ even @ same + opposite.T @ odd @ opposite))


def free_ends(
    over: Section, half: HalfFace, at: FlankPoints, reach: int
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Solve a gear with free ends and between walls, by functions over half a face.

    Parameters
    ----------
    over : Section
        Coarse: the difference is smooth.
    half : HalfFace
    at : FlankPoints
    reach : int
        Neighbours that are observed.

    Returns
    -------
    own : two arrays (loads, psi, psi)
        What free ends add at each load, of loads that are equal and such that are opposite on both halves: [m per N] by
        a unit functional.
    cross : two arrays (reach, loads, points, psi, psi)
        On neighbours; the first function is the load's.
    """
    own, cross = [], []
    for even in (True, False):
        free, walls = (prism(over, half.face(even, ends)).influence(at, reach) for ends in (True, False))
        own.append(free[0] - walls[0])
        cross.append(np.moveaxis(free[1] - walls[1], 2, 3))
    return (own[0], own[1]), (cross[0], cross[1])


def free_ends_across(
    over: Section, half: HalfFace, at: FlankPoints, seen: FlankPoints, teeth: Sequence[int]
) -> tuple[Array, Array]:
    """Solve a gear with free ends and between walls, and look at other places than the loaded ones.

    Parameters
    ----------
    over, half
        As of ``free_ends``.
    at, seen, teeth
        As of ``Prism.across``.

    Returns
    -------
    two (teeth, loads, points, psi, psi) arrays
        What free ends add, of loads that are equal and such that are opposite on both halves: [m per N] by a unit
        functional; the first function is the load's.
    """

    def added(even: bool) -> Array:
        free, walls = (prism(over, half.face(even, ends)).across(at, seen, teeth) for ends in (True, False))
        return np.moveaxis(free - walls, 2, 3)

    return added(True), added(False)
