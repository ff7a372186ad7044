"""Integrals of Flamant's tractions over second-order edges, for many loads at once.

The tractions of a load change over its distance from the edge, and its displacement is infinite at the load
itself: an edge nearer than twice its length is integrated on panels that halve towards the nearest point.
"""

from __future__ import annotations

import numpy as np

from base import Array, Booleans, Integers, record
from fem.elasticity.plane_elasticity import PlaneElasticity

__all__ = ["LineForces", "edge_points", "nodal", "traction_integrals"]

_GAUSS, _GAUSS_WEIGHT = np.polynomial.legendre.leggauss(5)
_GAUSS, _GAUSS_WEIGHT = 0.5 + 0.5 * _GAUSS, 0.5 * _GAUSS_WEIGHT

HALVINGS = 14
"""Of the panels on an edge near a load: the last one is 1e-4 of the edge."""

NEAR, BESIDE = 2.0, 0.02
"""Distance from a load over the edge's length below which the edge is integrated on panels, and below which that of the
chord no longer represents that of the curved edge."""

LEAST_PANEL = 1e-9
"""Of the edge: shorter panels, beside a load that all but stands on a node, are left out with their share."""


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


@record
class LineForces:
    """Unit line loads on a flank.

    Attributes
    ----------
    place, inward : (loads, 2) arrays
        Where they act [m], and normals of the flank into the material.
    lean : (loads,) array
        Angles of the forces from the normals [rad], anticlockwise.
    """

    place: Array
    inward: Array
    lean: Array

    def part(self, subset: Integers) -> LineForces:
        """Some of the loads, each as often as it is named."""
        return LineForces(self.place[subset], self.inward[subset], self.lean[subset])


def traction_integrals(
    points: Array, edges: Integers, loads: LineForces, law: PlaneElasticity, length: float
) -> tuple[Array, Array]:
    """Forces of Flamant's tractions on the nodes of edges, and their work on Flamant's own displacement.

    Parameters
    ----------
    points : (n, 2) array
        Nodes [m].
    edges : (k, 3) array
        First node, last node, middle; material on the left.
    loads : LineForces
    law : PlaneElasticity
    length : float
        Unit of length of the logarithm [m].

    Returns
    -------
    forces : (k, 3, 2, loads) array
        integral of phi_i sigma_s n ds over each edge, for its three nodes [N/m per N/m].
    work : (k, loads) array
        integral of u_s . sigma_s n ds over each edge [m per N/m].
    """
    nearest, apart = _nearest(points, edges, loads.place)
    near = apart < NEAR
    place, along, values = edge_points(points, edges[:, None], np.broadcast_to(_GAUSS, (len(edges), 5)))
    # outward normals, times ds
    outward = np.stack([along[..., 1], -along[..., 0]]) * _GAUSS_WEIGHT
    away = place[..., None] - loads.place.T
    pull, work = _densities(
        away[:, :, 0], away[:, :, 1], outward[..., None], loads, law, length, ~near[:, None]
    )
    lumps = np.swapaxes(values, 1, 2)[:, None] @ np.moveaxis(pull, 0, 1)
    forces, works = np.swapaxes(lumps, 1, 2), work.sum(axis=1)
    edge, load = np.nonzero(near)
    if len(edge):
        there = nearest[edge, load], apart[edge, load]
        close, its_work = _on_panels(points, edges[edge], *there, loads.part(load), law, length)
        forces[edge, :, :, load] = close
        works[edge, load] = its_work
    return forces, works


def nodal(edges: Integers, forces: Array, nodes: int) -> Array:
    """Sum forces on the edges' nodes (k, 3, 2, loads) into those on all unknowns (2 nodes, loads)."""
    from scipy.sparse import csr_array

    unknown = (2 * edges[:, :, None] + np.arange(2)).ravel()
    ones, place = np.ones(len(unknown)), np.arange(len(unknown))
    gather = csr_array((ones, (unknown, place)), shape=(2 * nodes, len(unknown)))
    return np.asarray(gather @ forces.reshape(len(unknown), -1))


def _densities(
    x: Array,
    y: Array,
    outward: Array,
    loads: LineForces,
    law: PlaneElasticity,
    length: float,
    apart: Booleans | None = None,
) -> tuple[Array, Array]:
    """Tractions (2, ...) and their work (...) on Flamant's displacement, at points away from loads by (x, y).

    The stress is radial, so the parts of the displacement that do not move a point towards the load, and equal
    parts of those that do, drop out of the work: -2/(pi E*) [cos ln(r/length) + (1 - nu*)/2 theta sin] is left.
    Where ``apart`` is false both are zero.
    """
    n_x, n_y = loads.inward.T
    along, across = x * n_x + y * n_y, y * n_x - x * n_y
    theta = np.arctan2(across, along)
    if np.any(loads.lean):
        c, s = np.cos(loads.lean), np.sin(loads.lean)
        along, across = c * along + s * across, c * across - s * along
    r2 = x**2 + y**2
    if apart is not None:
        r2 = np.where(apart, r2, np.inf)
    radial = -2 / np.pi * along * (x * outward[0] + y * outward[1]) / r2**2
    log = 0.5 * np.log(r2 / length**2)
    if apart is not None:
        log = np.where(apart, log, 0.0)
    moved = along * log + 0.5 * (1 - law.plane_poisson) * theta * across
    return np.stack([radial * x, radial * y]), -2 / (np.pi * law.plane_modulus) * radial * moved


def _nearest(points: Array, edges: Integers, loads: Array) -> tuple[Array, Array]:
    """Parameter on each edge's chord nearest to each load, and its distance over the chord's length (k, loads)."""
    ends = points[edges[:, :2]]
    chord = ends[:, 1] - ends[:, 0]
    length2 = np.sum(chord**2, axis=1)[:, None]
    x, y = (loads[:, axis] - ends[:, :1, axis] for axis in (0, 1))
    along = np.clip((x * chord[:, :1] + y * chord[:, 1:]) / length2, 0.0, 1.0)
    apart2 = (along * chord[:, :1] - x) ** 2 + (along * chord[:, 1:] - y) ** 2
    return along, np.sqrt(apart2 / length2)


def _on_panels(
    points: Array,
    edges: Integers,
    centre: Array,
    apart: Array,
    loads: LineForces,
    law: PlaneElasticity,
    length: float,
) -> tuple[Array, Array]:
    """Forces (pairs, 3, 2) and work (pairs,) on an edge and of a load each, by panels halving to the nearest point.

    Panels beside that point are no longer than half its distance from the load, ``apart`` over the edge's length.
    """
    enough = 1 + np.log2(2 / np.where(apart < BESIDE, 1e-300, apart))
    number = np.arange(HALVINGS)
    halves = np.where(number < np.minimum(enough[:, None], HALVINGS - 1), 0.5**number, 0.0)
    centre = centre[:, None]
    start = np.concatenate([centre - centre * halves, centre + (1 - centre) * halves[:, :0:-1]], axis=1)
    width = np.diff(start, axis=1, append=1.0)
    which, panel = np.nonzero(width > LEAST_PANEL)
    start, width = start[which, panel, None], width[which, panel, None]
    t = (start + width * _GAUSS).ravel()
    weight = (width * _GAUSS_WEIGHT).ravel()
    of = np.repeat(which, len(_GAUSS))
    place, along, values = edge_points(points, edges[of], t)
    outward = np.stack([along[:, 1], -along[:, 0]]) * weight
    own = loads.part(of)
    x, y = (place - own.place).T
    pull, work = _densities(x, y, outward, own, law, length)
    lumps = values[:, :, None] * pull.T[:, None, :]
    first = np.flatnonzero(np.diff(of, prepend=-1))
    return np.add.reduceat(lumps, first, axis=0), np.add.reduceat(work, first)
