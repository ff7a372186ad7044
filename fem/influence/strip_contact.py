"""Frictionless contact of two bodies on strips: force against approach, point by point, without iteration.

The strips' line loads follow from K p + gap = l D on those that touch, with l_i how far strip i closes per
approach D; by virtual work the force that moves D is F = l . p. For a contact of known extent x = K^-1 l and
y = K^-1 gap give p = D x - y, so F = D l . x - l . y: a law is found by letting strips close one after another.
"""

from __future__ import annotations

import numpy as np

from base import Array, Integers, unclocked
from fem.elasticity.plane_elasticity import PlaneElasticity

__all__ = [
    "begun",
    "by_the_far_end",
    "closings",
    "flat_kernel",
    "flat_kernels",
    "from_the_corner",
    "from_the_nearest",
    "smoothed",
]


FIRST = 4
"""Point of a law by strips, counted from the corner, from which on the first strip's width does not count."""

SMALLER = 40
"""Powers of two by which levers and gaps are made smaller than compliances."""


def flat_kernel(distance: Array, width: Array, law: PlaneElasticity, length: float) -> Array:
    """Displace a half-plane's edge, at strip middles, by unit loads spread over strips.

    The mean over strip j of -2/(pi E*) [ln(|x|/length) + (1 + nu*)/2].
    """
    offset = distance[:, None] - distance[None, :]

    def integral(x: Array) -> Array:
        size = np.abs(x)
        return np.asarray(x * (np.log(np.maximum(size, 1e-300) / length) - 1.0))

    mean = (integral(offset + 0.5 * width) - integral(offset - 0.5 * width)) / width
    kernel: Array = -2 / (np.pi * law.plane_modulus) * (mean + 0.5 * (1 + law.plane_poisson))
    return kernel


def flat_kernels(distance: Array, width: Array, law: PlaneElasticity, length: float) -> tuple[Array, ...]:
    """As ``flat_kernel``, for the directions normal-normal, normal-tangential and tangential-tangential.

    The tangent points to falling distances. A load along it presses down what lies ahead and lifts what lies
    behind, by (1 - nu*)/(2 E*) everywhere; along the tangent the edge moves by -2/(pi E*) ln(|x|/length).
    """
    normal = flat_kernel(distance, width, law, length)
    ahead = np.sign(distance[None, :] - distance[:, None])
    mixed = (1 - law.plane_poisson) / (2 * law.plane_modulus) * ahead
    return normal, mixed, normal + (1 + law.plane_poisson) / (np.pi * law.plane_modulus)


def from_the_corner(kernel: Array, gaps: Array, first: Array, levers: Array) -> tuple[Array, Array]:
    """Law of contacts that spread from the first strip inwards, strip by strip.

    A contact that covers the first k strips has no load on the last of them. With K = L U the leading blocks
    are L_k U_k, so one elimination of K bordered by levers and gaps serves every k: with w = L^-1 l, y = L^-1 g
    and v = U^-T l, D_k = y_k/w_k and F_k = D_k sum v_j w_j - sum v_j y_j.

    Parameters
    ----------
    kernel : (contacts, strips, strips) or (strips, strips) array
        Displacement of strip i by a unit line load on strip j, both bodies together [m per N/m].
    gaps : (contacts, strips) array
        [m]
    first : (contacts,) array
        Approach at which the corner touches, where the contact begins [m].
    levers : (contacts, strips) array
        l, about 1.

    Returns
    -------
    force, approach : (contacts, strips) arrays
        Growing line loads from 0 [N/m], approach [m].
    """
    contacts, strips = gaps.shape
    # levers and gaps so small that they are no pivots: no factor of theirs counts
    small = 2.0 ** (np.floor(np.log2(np.min(np.abs(kernel[..., 0, 0]), initial=1.0))) - SMALLER)
    whole = np.empty((contacts, strips + 1, strips + 2))
    whole[:, :strips, :strips] = kernel
    whole[:, -1, :strips] = whole[:, :strips, -2] = small * levers
    whole[:, :strips, -1], whole[:, -1, -2:] = small * gaps, 0.0
    sums, by_lever, by_gap = (np.empty((contacts, strips)) for _ in range(3))
    for contact, matrix in enumerate(whole):
        sums[contact], by_lever[contact], by_gap[contact] = _bordered(matrix)
    approach = by_gap / by_lever
    force = (approach * np.cumsum(sums * by_lever, axis=1) - np.cumsum(sums * by_gap, axis=1)) / small**2
    force[:, 0], approach[:, 0] = 0.0, first
    return force, approach


def _bordered(matrix: Array) -> tuple[Array, Array, Array]:
    """Factors of a kernel with one row and two columns more (strips + 1, strips + 2): L's last row, U's last columns.

    The order of the rows stays: the kernel is almost symmetric and definite. LAPACK keeps it itself where
    every pivot is the largest beside it, as narrow strips yield more than wide ones; else it is done step by step. To
    LAPACK columns are rows, so that U has the unit diagonal; products of both factors do not know.
    """
    with unclocked():
        from scipy.linalg.lapack import dgetrf

    strips = len(matrix) - 1
    factors, order, _ = dgetrf(matrix.T)
    if not np.array_equal(order, np.arange(strips + 1)):
        factors = matrix.T.copy()
        for k in range(strips):
            factors[k + 1 :, k] /= factors[k, k]
            factors[k + 1 :, k + 1 :] -= factors[k + 1 :, k, None] * factors[k, k + 1 :]
    return factors[:strips, -1], factors[-2, :strips], factors[-1, :strips]


def smoothed(force: Array, approach: Array) -> Array:
    """Approach of a smooth law through the mean of a law by strips, whose points are those at which strips close.

    Between two of them the same strips bear, so that the law by strips is their chord: its points lie above any
    smooth law, first in the width of the strips, while its energy errs in a higher order. The smooth law with
    the same energy in every interval h is lower by |D''| h_0^2 h_1^2/[6 (h_0^2 + h_1^2)], exact for a parabola
    over intervals of one ratio. First and last points stay.

    Parameters
    ----------
    force, approach : (contacts, strips) arrays
        [N/m], [m]
    """
    before, after = np.diff(force)[:, :-1], np.diff(force)[:, 1:]
    secant = np.diff(approach) / np.diff(force)
    curvature = 2 * np.diff(secant) / (before + after)
    lower = np.zeros_like(approach)
    lower[:, 1:-1] = curvature * (before * after) ** 2 / (6 * (before**2 + after**2))
    return np.asarray(approach + lower)


def begun(force: Array, approach: Array) -> tuple[Array, Array]:
    """Law by strips with points in the place of its first ones, of which the strip at the corner is too wide.

    There the contact is so small that only the corner and the opening count, and what it approaches over its force is
    linear in the force's logarithm: the line through the points ``FIRST`` and the next goes on.

    Parameters
    ----------
    force, approach : (contacts, strips) arrays
        Of contacts that spread from the corner inwards [N/m], [m].
    """
    size, grown = force[:, FIRST : FIRST + 2], approach[:, FIRST : FIRST + 2] - approach[:, :1]
    step, quotient = np.log(size[:, 1:] / size[:, :1]), grown / size
    back = np.arange(1 - FIRST, 0)
    force, approach = force.copy(), approach.copy()
    force[:, 1:FIRST] = size[:, :1] * np.exp(back * step)
    approach[:, 1:FIRST] = approach[:, :1] + force[:, 1:FIRST] * (
        quotient[:, :1] + back * (quotient[:, 1:] - quotient[:, :1])
    )
    return force, approach


def from_the_nearest(kernel: Array, gaps: Array, levers: Array) -> tuple[Array, Array]:
    """As ``from_the_corner`` for any gaps: with tip relief or a rounding the corner need not be nearest.

    From the nearest strip on, the approach grows until the next strip closes, and so on: each closing is a
    point of the law. Strips that have closed stay closed. The elimination of ``from_the_corner`` takes them in the
    order of their closing; what it leaves of levers and gaps in the rows of open strips is how fast these near
    the other body, and how far away they would be without any approach.
    """
    force, approach, _ = closings(kernel, gaps, levers)
    return force, approach


def by_the_far_end(kernel: Array, gaps: Array, levers: Array) -> tuple[Array, Array]:
    """As ``from_the_nearest``, at the instants at which strips close at the end away from the corner.

    Strips at the other end, on a rounding, are so narrow that between two of these instants the law is a chord.

    Returns
    -------
    force, approach : (contacts, strips) arrays
        Line loads [N/m] and approach [m] at which each strip closes; nan for strips that close otherwise.
    """
    force, approach, strip = closings(kernel, gaps, levers)
    before = np.maximum.accumulate(strip, axis=1)[:, :-1]
    point = np.zeros(strip.shape, dtype=bool)
    point[:, 0], point[:, 1:] = True, strip[:, 1:] == before + 1
    row, column = np.nonzero(point)
    at_closing = np.full((2, *gaps.shape), np.nan)
    at_closing[:, row, strip[row, column]] = force[row, column], approach[row, column]
    return at_closing[0], at_closing[1]


def closings(kernel: Array, gaps: Array, levers: Array) -> tuple[Array, Array, Integers]:
    """Line loads and approach when strips close, and which (contacts, strips); see ``from_the_nearest``."""
    contacts, strips = gaps.shape
    rows = np.arange(contacts)
    whole = np.zeros((contacts, strips + 1, strips + 2))
    whole[:, :strips, :strips] = kernel
    whole[:, -1, :strips] = whole[:, :strips, -2] = levers
    whole[:, :strips, -1] = gaps
    closed = np.zeros((contacts, strips), dtype=bool)
    touching = gaps / levers
    force, approach = [np.zeros(contacts)], [touching.min(axis=1)]
    following, more = touching.argmin(axis=1), np.ones(contacts, dtype=bool)
    order = [following]
    for _ in range(strips - 1):
        _eliminate(whole, rows[more], following[more])
        closed[rows[more], following[more]] = True
        # a strip that moves as fast as the rest never closes
        nearing, away = whole[:, :strips, -2], whole[:, :strips, -1]
        coming = ~closed & (nearing > 1e-9)
        closing = np.where(coming, away / np.where(coming, nearing, 1.0), np.inf)
        # two strips that close together make one step of the law, not a vertical one
        closing = np.maximum(closing, approach[-1][:, None] + 1e-12)
        following = closing.argmin(axis=1)
        level = closing[rows, following]
        more = np.isfinite(level)  # else the same strips go on bearing
        level = np.where(more, level, 2 * approach[-1] - approach[0] + 1e-9)
        borne = whole[:, -1, -1] - level * whole[:, -1, -2]
        force.append(np.maximum(borne, force[-1] * (1 + 1e-12)))
        approach.append(level)
        order.append(following)
    return np.array(force).T, np.array(approach).T, np.array(order).T


def _eliminate(whole: Array, rows: Integers, strip: Integers) -> None:
    """Eliminate one strip of each row's system; nothing is left of its equation."""
    pivot = whole[rows, strip, strip]
    line, column = whole[rows, strip], whole[rows, :, strip]
    each = slice(None) if len(rows) == len(whole) else rows
    whole[each] -= (column / pivot[:, None])[:, :, None] * line[:, None, :]
