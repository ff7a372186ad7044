"""Integrals of Flamant's tractions over second-order edges, for many loads at once.

The tractions of a load change over its distance from the edge, and its displacement is infinite at the load
itself: an edge nearer than twice its length is integrated on panels that halve towards the nearest point.
"""

from __future__ import annotations

import numpy as np

from base import Array, Integers
from fem import flamant
from fem.elasticity import PlaneElasticity

__all__ = ["edge_points", "traction_integrals"]

_GAUSS, _GAUSS_WEIGHT = np.polynomial.legendre.leggauss(5)
_GAUSS, _GAUSS_WEIGHT = 0.5 + 0.5 * _GAUSS, 0.5 * _GAUSS_WEIGHT

HALVINGS = 14
"""Of the panels on an edge near a load: the last one is 1e-4 of the edge."""


def edge_points(points: Array, edges: Integers, t: Array) -> tuple[Array, Array, Array]:
    """Positions, derivatives by t and shape values on quadratic edges (first, last, middle)."""
    weights = np.stack([(1 - t) * (1 - 2 * t), t * (2 * t - 1), 4 * t * (1 - t)], axis=-1)
    slopes = np.stack([4 * t - 3, 4 * t - 1, 4 - 8 * t], axis=-1)
    corners = points[edges]
    return (
        np.einsum("...k,...ka->...a", weights, corners),
        np.einsum("...k,...ka->...a", slopes, corners),
        weights,
    )


def traction_integrals(
    points: Array,
    edges: Integers,
    load: Array,
    inward: Array,
    law: PlaneElasticity,
    length: float,
    lean: float = 0.0,
) -> tuple[Array, Array]:
    """Nodal forces of Flamant's tractions, and their work on Flamant's own displacement.

    Parameters
    ----------
    points : (n, 2) array
        Nodes [m].
    edges : (k, 3) array
        First node, last node, middle; material on the left.
    load, inward : (loads, 2) arrays
        Places [m] of unit line loads, and normals of the flank into the material.
    law : PlaneElasticity
    length : float
        Unit of length of the logarithm [m].
    lean : float
        Angle of the loads from the normals [rad], anticlockwise.

    Returns
    -------
    forces : (2 n, loads) array
        integral of phi_i sigma_s n ds [N/m per N/m].
    work : (loads,) array
        integral of u_s . sigma_s n ds [m per N/m].
    """
    loads = len(load)
    of, some, t, weight = _quadrature(points, edges, load)
    place, along, values = edge_points(points, edges[some], t)
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)  # outward, times ds/dt
    pull = flamant.traction(place, normal, load[of], flamant.leaning(inward, lean)[of]) * weight[:, None]
    moved = flamant.displacement(place, load[of], inward[of], law, length, lean)
    work = np.bincount(of, np.einsum("na,na->n", pull, moved), loads)
    unknown = 2 * edges[some][:, :, None] + np.arange(2)
    lumps = values[:, :, None] * pull[:, None, :]
    forces = np.bincount(
        (unknown * loads + of[:, None, None]).ravel(), lumps.ravel(), 2 * len(points) * loads
    )
    return np.asarray(forces, dtype=float).reshape(-1, loads), np.asarray(work, dtype=float)


def _quadrature(points: Array, edges: Integers, load: Array) -> tuple[Integers, Integers, Array, Array]:
    """Load, edge, t on the edge and weight of every quadrature point, for all pairs of load and edge."""
    ends = points[edges[:, :2]]
    chord = ends[:, 1] - ends[:, 0]
    length2 = np.einsum("ea,ea->e", chord, chord)
    away = load[:, None] - ends[:, 0]
    nearest = np.clip(np.einsum("lea,ea->le", away, chord) / length2, 0.0, 1.0)
    near = np.sum((nearest[..., None] * chord - away) ** 2, axis=2) < 4 * length2
    far_load, far_edge = np.nonzero(~near)
    load_, edge_ = np.nonzero(near)
    centre = nearest[load_, edge_][:, None]
    halves = 0.5 ** np.arange(HALVINGS)
    halves[-1] = 0.0
    start = np.concatenate([centre - centre * halves, centre + (1 - centre) * halves[:0:-1]], axis=1)
    width = np.diff(start, axis=1, append=1.0)
    which, panel = np.nonzero(width > 0)
    start, width = start[which, panel, None], width[which, panel, None]
    count = len(_GAUSS)
    return (
        np.repeat(np.concatenate([far_load, load_[which]]), count),
        np.repeat(np.concatenate([far_edge, edge_[which]]), count),
        np.concatenate([np.tile(_GAUSS, len(far_load)), (start + width * _GAUSS).ravel()]),
        np.concatenate([np.tile(_GAUSS_WEIGHT, len(far_load)), (width * _GAUSS_WEIGHT).ravel()]),
    )
