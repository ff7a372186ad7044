"""Where the film is computed: the domain and its nodes, in half-widths of the dry contact."""

from __future__ import annotations

import math

import numpy as np

from base import Array

_NECK_SHARE = 1.5  # nodes at the outlet for one at the inlet: the neck converges last
_SPIKE_SHARE = 0.6  # nodes at a spike for one at the inlet: more of them starve the inlet on coarse grids
_UPSTREAM = 0.7  # more costs accuracy at the neck, less leaves teeth
_INLET_END = 1.5  # where the inlet ends, behind the edge of the dry contact, over the width of its zone
_INLET_BLUR = 0.5  # over which it ends, likewise
_INLET_WIDEST = (
    0.8  # width of the zone that counts there [half-widths]: of thick films it reaches over the spike,
)
_NO_SPIKE = 4.0  # and from this H_c on no spike stands there


def default_domain(H_c: float, reach: float = 40.0) -> tuple[float, float]:
    """Inlet and outlet of a fully flooded contact [half-widths].

    The inlet lies at -(1 + reach sqrt(H_c)): the pressure that builds up farther out lowers the film by a
    share that falls with the square of the reach. The outlet lies well beyond the film's end, which a rigid
    cylinder has at 0.67 sqrt(H_c).
    """
    root = math.sqrt(H_c)
    return -(1.0 + reach * root), 1.0 + 1.5 * root


def clusters(H_c: float) -> tuple[float, float, float]:
    """Width of the inlet zone, width and centre of the outlet zone [half-widths].

    Both scale as H_c^(2/3) in a Hertzian contact and as H_c^(1/2) for a rigid cylinder.
    """
    inlet = min((1.06 * H_c) ** (2.0 / 3.0), math.sqrt(1.06 * H_c))
    return inlet, 0.6 * inlet, 1.0 - 0.2 * inlet


def graded_nodes(
    H_c: float,
    n: int,
    domain: tuple[float, float],
    spike: tuple[float, float] | None = None,
    start: Array | None = None,
) -> Array:
    """Nodes crowded towards the inlet zone and towards the pressure spike.

    The density of nodes is c + 1/sqrt((X+1)^2 + s^2) + 1.5/sqrt((X-1+0.2s)^2 + (0.6 s)^2), s the width of the
    inlet zone, and 0.6/sqrt((X-X_s)^2 + w^2) more where a spike was found at X_s. Its integral is known, so that
    the nodes of n and of 2n-1 are nested.

    Parameters
    ----------
    H_c : float
        Expected h R/b^2 at the centre.
    n : int
        Number of nodes.
    domain : tuple of float
        Inlet and outlet [half-widths].
    spike : tuple of float, optional
        Position X_s and width w of a pressure spike [half-widths].
    start : ndarray (n,), optional
        Nodes close to the wanted ones, which saves a table.
    """
    s_in, s_out, neck = clusters(H_c)
    left, right = domain
    ahead = -1.0 - left  # a near meniscus pumps the pressure up over the distance it leaves
    s_in = min(s_in, ahead) if ahead > 0.0 else s_in
    crowds = [(-1.0, s_in, 1.0), (neck, s_out, _NECK_SHARE)]
    if spike is not None:
        crowds.append((spike[0], spike[1], _SPIKE_SHARE))
    c = 2.0 / (right - left)

    def count(X: Array) -> Array:
        total: Array = c * X
        for at, width, share in crowds:
            total = total + share * np.arcsinh((X - at) / width)
        return total

    def density(X: Array) -> Array:
        value: Array = np.full_like(X, c)
        for at, width, share in crowds:
            value += share / np.hypot(X - at, width)
        return value

    ends = np.array([left, right])
    low, high = count(ends)
    want = np.linspace(low, high, n)
    rounds = 2 if start is not None else 4
    if start is None:
        # a coarse table gives the start, Newton the rest: interpolation alone would leave uneven spacings
        rays = np.sinh(np.linspace(-17, 17, 341))
        sample = np.concatenate([ends, *(at + width * rays for at, width, _ in crowds)])
        sample = np.unique(np.clip(sample, left, right))
        start = np.interp(want, count(sample), sample)
    X: Array = start
    for _ in range(rounds):
        change = (count(X) - want) / density(X)
        X = np.clip(X - change, left, right)
    X[0], X[-1] = left, right
    return X


def upstream_share(nodes: Array, H_c: float) -> Array:
    """Share of each cell's wedge term that is carried on from upstream instead of averaged over the cell.

    Where oil is so viscous that the pressure's slope moves none of it, rho H is the same at all nodes but for
    teeth that the spike excites: the cell's mean alone lets teeth (-1.7)^i stand, of which each is 0.6 times as
    high as its neighbour downstream. With this share the factor is 0.09. Upstream of the dry contact the share
    is 0, since the mean is of higher order there; it rises behind the inlet zone, by the place alone, so that the
    flux stays as smooth in pressures and gaps as it was.

    Parameters
    ----------
    nodes : ndarray (n,)
        X [half-widths].
    H_c : float
        Expected h R/b^2 at the centre.
    """
    inlet = min(clusters(H_c)[0], _INLET_WIDEST * max(1.0, H_c / _NO_SPIKE) ** 2)
    behind = 0.5 * (nodes[1:] + nodes[:-1]) + 1.0 - _INLET_END * inlet
    share: Array = 0.5 * _UPSTREAM * (1.0 + np.tanh(behind / (_INLET_BLUR * inlet)))
    return share


def face_weights(nodes: Array, *, upwind: bool = False) -> Array:
    """Weights that take nodal values to the middle of each cell, from the nodes f-1, f, f+1.

    ``upwind=True`` takes the upstream value (first order, very stable); otherwise the parabola through the
    three nodes (Leonard's QUICK on uneven nodes, third order), linear in the first cell.
    """
    weights = np.zeros((nodes.size - 1, 3))
    if upwind:
        weights[:, 1] = 1.0
        return weights
    a, b, c = nodes[:-2], nodes[1:-1], nodes[2:]
    m = 0.5 * (b + c)
    weights[1:, 0] = (m - b) * (m - c) / ((a - b) * (a - c))
    weights[1:, 1] = (m - a) * (m - c) / ((b - a) * (b - c))
    weights[1:, 2] = (m - a) * (m - b) / ((c - a) * (c - b))
    weights[0, 1:] = 0.5
    return weights


def hat_weights(nodes: Array) -> Array:
    """Integral of the hat function of each node: the trapezoidal rule."""
    h = np.diff(nodes)
    weights = np.zeros(nodes.size)
    weights[:-1] += 0.5 * h
    weights[1:] += 0.5 * h
    return weights


def middle_weights(nodes: Array) -> Array:
    """Weights of the nodes whose sum of values is the one at X = 0, by the cubic through the four nearest.

    Gaps are those of the film at the nodes alone: between them straight pressures leave a bump of the third power of
    the cell, as large as thin films in the wide cells of the middle.
    """
    first = min(max(int(np.searchsorted(nodes, 0.0)) - 2, 0), nodes.size - 4)
    near = nodes[first : first + 4]
    others = near[np.array([[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]])]
    weights = np.zeros(nodes.size)
    weights[first : first + 4] = np.prod(others / (others - near[:, None]), axis=1)
    return weights
