"""Triangles to draw: coarse far from the contact, split again and again towards it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from base import Array, Booleans, Integers, record
from meshes import SectorMesh
from meshes.triangle import NODES, shape

__all__ = ["Picture", "picture_of"]

# corners of the four children of a triangle, in its reference coordinates (middle one last)
_CHILDREN = np.array(
    [
        [[0, 0], [0.5, 0], [0, 0.5]],
        [[0.5, 0], [1, 0], [0.5, 0.5]],
        [[0, 0.5], [0.5, 0.5], [0, 1]],
        [[0.5, 0], [0.5, 0.5], [0, 0.5]],
    ]
)
# the node at each place of a triangle in halves of its sides; beyond the long side there is none
_NODE_AT = np.full((3, 3), -1)
_NODE_AT[tuple((2 * NODES).astype(int).T)] = np.arange(6)
SPLITS = 8

LONGEST_SIDE = 0.35
"""Longest side of cells at a flank or a tip [modules]."""


@record
class Picture:
    """Points of a sector and the second-order cells that they make.

    Attributes
    ----------
    nodes, weights : (n, k) arrays
        Nodes of the sector whose values, weighted, give the value at each point.
    cells : (m, 6) array
    """

    nodes: Integers
    weights: Array
    cells: Integers

    def interpolate(self, values: Array) -> Array:
        """Values (n, ...) at the points from values at the sector's nodes."""
        return np.asarray(np.einsum("pk,pk...->p...", self.weights, values[self.nodes]))


def picture_of(mesh: SectorMesh, focus: tuple[Array, float] | None = None) -> Picture:
    """Cells of a sector for drawing.

    Parameters
    ----------
    mesh : SectorMesh
    focus : ((2,) array, float), optional
        A point, and the wished size of cells at it; the size may grow by half the distance from it. Elements
        are split until they are that small. Without a focus the cells are those of the coarsest mesh in the
        family, with the finer mesh's values at its nodes.

    In both, elements at a flank or a tip are split until programs that draw straight sides show the curve.
    """
    if focus is None:
        while mesh.coarser is not None:
            mesh = mesh.coarser
    curved = _at_curves(mesh)
    longest = LONGEST_SIDE * mesh.module

    def large(parent: Integers, place: Array) -> Booleans:
        x, y = np.moveaxis(place, -1, 0)
        side = np.hypot(x - np.roll(x, -1, axis=1), y - np.roll(y, -1, axis=1)).max(axis=1)
        to_split = curved[parent] & (side > longest)
        if focus is not None:
            away = np.hypot(x - focus[0][0], y - focus[0][1]).min(axis=1)
            to_split = to_split | (np.sqrt(np.abs(_area(x, y))) > np.maximum(focus[1], 0.5 * away))
        return np.asarray(to_split)

    return _split(mesh, large)


def _at_curves(mesh: SectorMesh) -> Booleans:
    """Elements with an edge on a flank, a chamfer or the top land."""
    names = [name for name in mesh.facets if name.startswith(("flank", "chamfer", "top"))]
    edges = np.concatenate([mesh.facets[name] for name in names])
    return np.asarray(np.isin(mesh.triangles[:, 3:], edges[:, 2]).any(axis=1))


def _split(mesh: SectorMesh, large: Callable[[Integers, Array], Booleans]) -> Picture:
    """Split elements, and what they were split into, while they are too large."""
    parent = np.arange(len(mesh.triangles))
    corners = np.broadcast_to(np.array([[0.0, 0], [1, 0], [0, 1]]), (len(parent), 3, 2))
    done_parent, done_corners = [], []
    for _ in range(SPLITS):
        split = large(parent, _places(mesh, parent, corners))
        done_parent.append(parent[~split])
        done_corners.append(corners[~split])
        old = corners[split]
        base, e1, e2 = old[:, 0], old[:, 1] - old[:, 0], old[:, 2] - old[:, 0]
        frame = np.stack([e1, e2], axis=1)
        corners = (base[:, None, None] + np.einsum("cki,mia->mcka", _CHILDREN, frame)).reshape(-1, 3, 2)
        parent = np.repeat(parent[split], 4)
    parent = np.concatenate([*done_parent, parent])
    corners = np.concatenate([*done_corners, corners])
    middles = 0.5 * (corners + np.roll(corners, -1, axis=1))
    return _merged(mesh, parent, np.concatenate([corners, middles], axis=1))


def _places(mesh: SectorMesh, parent: Integers, corners: Array) -> Array:
    """Positions of reference corners; straight sides are enough to judge sizes."""
    x = mesh.points[mesh.triangles[parent, :3]]
    weight = np.concatenate([1 - corners.sum(axis=2, keepdims=True), corners], axis=2)
    return np.asarray(np.einsum("mkc,mca->mka", weight, x))


def _area(x: Array, y: Array) -> Array:
    d, e = (x[:, 1] - x[:, 0], y[:, 1] - y[:, 0]), (x[:, 2] - x[:, 0], y[:, 2] - y[:, 0])
    return np.asarray(d[0] * e[1] - d[1] * e[0])


def _merged(mesh: SectorMesh, parent: Integers, local: Array) -> Picture:
    """Points at the same place of the same element, and points that are nodes, are shared."""
    # a key per point: its node, else its element and its place on the finest grid that splitting can make
    steps = 2 ** (SPLITS + 1)
    parent, grid = np.repeat(parent, 6), np.rint(local.reshape(-1, 2) * steps).astype(np.int64)
    halves, between = np.divmod(grid, steps // 2)
    node = np.where(between.any(axis=1), -1, _NODE_AT[tuple(halves.T)])
    inside = (parent * (steps + 1) + grid[:, 0]) * (steps + 1) + grid[:, 1]
    key = np.where(node >= 0, mesh.triangles[parent, node], len(mesh.points) + inside)
    _, first, inverse = np.unique(key, return_index=True, return_inverse=True)
    weights = shape(*local.reshape(-1, 2)[first].T)
    return Picture(mesh.triangles[parent[first]], weights, inverse.reshape(-1, 6).astype(np.int64))
