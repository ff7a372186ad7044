"""Closed surface of one tooth with its sector, as triangles, from the cells of a gear's grid.

All teeth of a gear are copies, so one surface serves them all. Sectors of the plane become prisms over the face width;
wedges of solids keep their own section and some of their layers. Triangles are oriented outwards.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial import cKDTree

from base import Array, Integers, record

if TYPE_CHECKING:
    import pyvista

__all__ = ["ToothSurface", "tooth_surface", "turned_to"]

LAYERS = 7
"""Layers of a solid that are drawn."""

SAME = 1e-6
"""Distance within which points are one, in radii of the gear: coordinates are in single precision."""

Corners = tuple[int, int, int]


@record
class ToothSurface:
    """Surface of a tooth and its sector, the tooth along +y and the gear's axis at the origin.

    Attributes
    ----------
    points : (points, 3) array
        [m]
    triangles : (triangles, 3) array of int
        Corners, anticlockwise seen from outside.
    value : (points,) array of int
        Which value of the tooth each point has: of a prism both ends have the same.
    places : (values, 3) array
        Where the values belong [m], in the section at z = 0 of a prism.
    source : (values,) array of int
        Points of a tooth's grid that have these values, where a tooth has as many points as the one drawn.
    size : int
        Points of the grid of that tooth.
    """

    points: Array
    triangles: Integers
    value: Integers
    places: Array
    source: Integers
    size: int

    def sources(self, points: Array, angle: float) -> Integers:
        """Points (values,) of a tooth's grid that have the values.

        Parameters
        ----------
        points : (n, 3) array
            Of the tooth, the gear's axis at the origin [m]. Teeth with a contact have more and smaller cells; their
            nearest points are taken.
        angle : float
            Of the tooth [rad], 0 along +y.
        """
        if len(points) == self.size:
            return self.source
        own = turned_to(points, -angle)
        return np.asarray(cKDTree(own, compact_nodes=False, balanced_tree=False).query(self.places)[1])


def turned_to(points: Array, angle: float) -> Array:
    """Points (..., 3) turned about the z axis."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = np.moveaxis(points, -1, 0)
    return np.stack([c * x - s * y, s * x + c * y, z], axis=-1)


def tooth_surface(grid: pyvista.UnstructuredGrid, centre: Array, width: float) -> ToothSurface:
    """Surface of the tooth of a grid with the fewest cells, which has no contact.

    Parameters
    ----------
    grid : pyvista.UnstructuredGrid
        Block ``pinion`` or ``wheel`` of `fem.fields.vtk.field_blocks`.
    centre : (2,) array
        Axis of the gear [m].
    width : float
        Face width of prisms [m].
    """
    cells = grid.cell_connectivity.reshape(grid.n_cells, -1)
    tooth = np.asarray(grid["tooth"])
    names, counts = np.unique(tooth, return_counts=True)
    nodes, local = np.unique(cells[tooth == names[np.argmin(counts)]], return_inverse=True)
    points = np.asarray(grid.points, dtype=float)[nodes] - np.append(centre, 0.0)
    points = turned_to(points, -lean(points))
    local = local.reshape(-1, cells.shape[1])
    if np.ptp(points[:, 2]) == 0.0:
        return _prism(points, local, width)
    return _solid(points, local)


def lean(points: Array) -> float:
    """Angle of the middle of points from the y axis [rad]."""
    x, y, _ = points.mean(axis=0)
    return float(np.arctan2(-x, y))


def _prism(points: Array, cells: Integers, width: float) -> ToothSurface:
    """Prism over a section of second-order triangles."""
    first, same = _merged(points)
    used, triangles = np.unique(conforming(points[first], same[cells]), return_inverse=True)
    source = first[used]
    flat, triangles = points[source], _anticlockwise(points[source], triangles.reshape(-1, 3))
    n = len(source)
    half = np.array([0.0, 0.0, 0.5 * width])
    return ToothSurface(
        np.concatenate([flat - half, flat + half]),
        np.concatenate([triangles[:, ::-1], triangles + n, _walls(outline(triangles), 0, n)]),
        np.tile(np.arange(n), 2),
        flat,
        source,
        len(points),
    )


def _solid(points: Array, wedges: Integers) -> ToothSurface:
    """Ends, and walls along the outline, of layers of wedges."""
    section = int(np.sum(np.abs(points[:, 2] - points[0, 2]) < SAME * np.ptp(points[:, 2])))
    layers = len(points) // section
    triangles = _anticlockwise(points[:section], wedges[: len(wedges) // (layers - 1), :3])
    rim = outline(triangles)
    shown = np.unique(np.rint(np.linspace(0, layers - 1, min(LAYERS, layers))).astype(int)) * section
    surface = np.concatenate(
        [
            triangles[:, ::-1] + shown[0],
            triangles + shown[-1],
            *(_walls(rim, low, high) for low, high in pairwise(shown.tolist())),
        ]
    )
    source, surface = np.unique(surface, return_inverse=True)
    places = points[source]
    return ToothSurface(places, surface.reshape(-1, 3), np.arange(len(source)), places, source, len(points))


def _merged(points: Array) -> tuple[Integers, Integers]:
    """First of all points that are at one place, by the number of the place, and the place of each point."""
    near = cKDTree(points).query_pairs(SAME * float(np.abs(points).max()), output_type="ndarray")
    same = np.arange(len(points))
    for a, b in near[np.argsort(near[:, 0], kind="stable")].tolist() if len(near) else ():
        same[b] = same[a]
    first, place = np.unique(same, return_inverse=True)
    return first, place


def conforming(points: Array, cells: Integers) -> Integers:
    """Triangles (n, 3) of second-order triangles of several sizes, each at the points of its neighbours on its edges.

    Every cell is divided in four or more parts; a cell beside smaller ones has their points too.

    Parameters
    ----------
    points : (p, 3) array
        Each place once.
    cells : (m, 6) array of int
        Three corners, then the middles of the edges from the first to the second corner and so on.
    """
    tree, tolerance = cKDTree(points), SAME * float(np.abs(points).max())
    middle: dict[frozenset[int], int | None] = {}
    for a, b, c, ab, bc, ca in cells.tolist():
        middle |= {frozenset((a, b)): ab, frozenset((b, c)): bc, frozenset((c, a)): ca}
    whole: list[Corners] = []
    waiting: list[Corners] = [(a, b, c) for a, b, c in cells[:, :3].tolist()]
    while waiting:
        # an edge beside a cell that was divided twice has a point half-way, which no cell names as its middle
        if unknown := list({edge for corners in waiting for edge in _edges(corners)} - middle.keys()):
            half_way = points[[tuple(edge) for edge in unknown]].mean(axis=1)
            away, nearest = map(np.asarray, tree.query(half_way))
            at = [int(i) if distance < tolerance else None for i, distance in zip(nearest, away, strict=True)]
            middle.update(zip(unknown, at, strict=True))
        divided: list[Corners] = []
        for corners in waiting:
            parts = _divided(corners, [middle[edge] for edge in _edges(corners)])
            (divided if len(parts) > 1 else whole).extend(parts)
        waiting = divided
    return np.array(whole)


def _edges(corners: Corners) -> list[frozenset[int]]:
    """Edges of a triangle, the first one from its first to its second corner."""
    a, b, c = corners
    return [frozenset((a, b)), frozenset((b, c)), frozenset((c, a))]


def _divided(corners: Corners, middles: list[int | None]) -> list[Corners]:
    """Parts of a triangle by the points in the middles of its edges; the triangle itself where there are none."""
    (a, b, c), (ab, bc, ca) = corners, middles
    if ab is not None and bc is not None and ca is not None:
        return [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    if ab is not None and bc is not None:
        return [(ab, b, bc), (a, ab, bc), (a, bc, c)]
    if ab is not None and ca is None:
        return [(a, ab, c), (ab, b, c)]
    return [corners] if ab is bc is ca is None else _divided((b, c, a), [bc, ca, ab])


def _anticlockwise(points: Array, triangles: Integers) -> Integers:
    """Triangles of a section whose area is above 0."""
    p, q, r = (points[triangles[:, k], :2] for k in range(3))
    (ux, uy), (vx, vy) = (q - p).T, (r - p).T
    back = ux * vy - uy * vx < 0.0
    turned = triangles.copy()
    turned[back] = turned[back, ::-1]
    return turned


def outline(triangles: Integers) -> Integers:
    """Edges (n, 2) that one triangle alone has, in its sense."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    _, which, count = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(edges[count[which.ravel()] == 1])


def _walls(rim: Integers, low: int, high: int) -> Integers:
    """Two triangles for each edge of an outline between two layers, whose points begin at `low` and `high`."""
    a, b = rim.T
    return np.concatenate(
        [np.column_stack([a + low, b + low, b + high]), np.column_stack([a + low, b + high, a + high])]
    )
