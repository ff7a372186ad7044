"""Frictionless contact of two bodies on strips: force against approach, point by point, without iteration.

The strips' pressures follow from K p + gap = D on those that touch. For a contact of known extent
x = K^-1 1 and y = K^-1 gap give p = D x - y, so F = D sum(x) - sum(y): a law is found by letting strips close
one after another.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fem.elasticity import PlaneElasticity

__all__ = ["flat_kernel", "from_the_corner", "from_the_nearest"]

Array = NDArray[np.float64]


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


def from_the_corner(kernel: Array, gaps: Array, first: Array) -> tuple[Array, Array]:
    """Law of contacts that spread from the first strip inwards, strip by strip.

    A contact that covers the first k strips has no pressure on the last of them, D = y_k/x_k.

    Parameters
    ----------
    kernel : (strips, strips) array
        Displacement of strip i by a unit line load on strip j, both bodies together [m per N/m].
    gaps : (contacts, strips) array
        [m]
    first : (contacts,) array
        Gaps at the corner, where the contact begins [m].

    Returns
    -------
    force, approach : (contacts, strips) arrays
        Growing line loads from 0 [N/m], approach [m].
    """
    lower, upper = _triangles(kernel)
    ones = np.ones(len(kernel))
    # with K = L U the leading blocks are L_k U_k, so one substitution serves every k
    both = np.linalg.solve(lower, np.column_stack([ones, gaps.T]))
    by_one, by_gap = both[:, 0], both[:, 1:]
    sums = np.linalg.solve(upper.T, ones)
    approach = (by_gap / by_one[:, None]).T
    force = approach * np.cumsum(sums * by_one) - np.cumsum(sums[:, None] * by_gap, axis=0).T
    force[:, 0], approach[:, 0] = 0.0, first
    return force, approach


def _triangles(kernel: Array) -> tuple[Array, Array]:
    """Factors L (unit diagonal) and U of a kernel, in its own order: no pivoting, it is almost symmetric."""
    lower, upper = np.eye(len(kernel)), kernel.copy()
    for k in range(len(kernel) - 1):
        lower[k + 1 :, k] = upper[k + 1 :, k] / upper[k, k]
        upper[k + 1 :, k:] -= lower[k + 1 :, k, None] * upper[k, k:]
    return lower, np.triu(upper)


def from_the_nearest(kernel: Array, gaps: Array) -> tuple[Array, Array]:
    """As ``from_the_corner`` for any gaps: with tip relief or a rounding the corner need not be nearest.

    From the nearest strip on, the approach grows until the next strip closes, and so on: each closing is a
    point of the law. Strips that have closed stay closed. The inverse of the closed strips' kernel grows by
    bordering, one row and column for each closing.
    """
    contacts, strips = gaps.shape
    rows = np.arange(contacts)
    inverse = np.zeros((contacts, strips, strips))
    closed = np.zeros((contacts, strips), dtype=bool)
    force, approach = [np.zeros(contacts)], [gaps.min(axis=1)]
    following, more = gaps.argmin(axis=1), np.ones(contacts, dtype=bool)
    for _ in range(strips - 1):
        _close(inverse, kernel, closed, rows[more], following[more])
        closed[rows[more], following[more]] = True
        x = np.einsum("cij,cj->ci", inverse, closed.astype(float))
        y = np.einsum("cij,cj->ci", inverse, np.where(closed, gaps, 0.0))
        # a strip that moves as fast as the rest never closes
        nearing = np.where(closed, 0.0, 1.0 - x @ kernel.T)
        coming = nearing > 1e-9
        closing = np.where(coming, (gaps - y @ kernel.T) / np.where(coming, nearing, 1.0), np.inf)
        # two strips that close together make one step of the law, not a vertical one
        closing = np.maximum(closing, approach[-1][:, None] + 1e-12)
        following = closing.argmin(axis=1)
        level = closing[rows, following]
        more = np.isfinite(level)  # else the same strips go on bearing
        level = np.where(more, level, 2 * approach[-1] - approach[0] + 1e-9)
        force.append(np.maximum(level * x.sum(axis=1) - y.sum(axis=1), force[-1] * (1 + 1e-12)))
        approach.append(level)
    return np.array(force).T, np.array(approach).T


def _close(
    inverse: Array,
    kernel: Array,
    closed: NDArray[np.bool_],
    rows: NDArray[np.int64],
    strip: NDArray[np.int64],
) -> None:
    """Add one closed strip to the inverse of each row; other rows and columns of the inverse are zero."""
    held = closed[rows]
    column, row = np.where(held, kernel[:, strip].T, 0.0), np.where(held, kernel[strip], 0.0)
    before = inverse[rows]
    right, left = np.einsum("cij,cj->ci", before, column), np.einsum("ci,cij->cj", row, before)
    pivot = kernel[strip, strip] - np.einsum("ci,ci->c", row, right)
    each = np.arange(len(rows))
    right[each, strip] = left[each, strip] = -1.0
    inverse[rows] = before + right[:, :, None] * (left / pivot[:, None])[:, None, :]
