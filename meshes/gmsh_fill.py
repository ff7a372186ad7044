"""gmsh fills a polygon with triangles, without touching the polygon's own nodes."""

from __future__ import annotations

from typing import Any

import numpy as np

from base import Array, InputError, Integers
from meshes.gmsh_session import gmsh_session
from meshes.outline import crossing


def triangulate(polygon: Array) -> tuple[Array, Integers]:
    """Triangles inside a simple closed polygon, graded by the lengths of its edges.

    Parameters
    ----------
    polygon : (n, 2) array
        Corners in anticlockwise order [any length unit].

    Returns
    -------
    points : (k, 2) array
        The first n are the polygon's corners, unchanged.
    triangles : (m, 3) array
        Anticlockwise.

    Raises
    ------
    base.InputError
        When the polygon cuts itself (gmsh could then run for ever), or gmsh does not keep its edges.
    """
    if not np.all(np.isfinite(polygon)):
        remedy = "check the tooth's profile"
        raise InputError.at("outline", "nan or inf", "must have finite coordinates", remedy)
    cut = crossing(polygon)
    if cut is not None:
        corner = polygon[cut[0]]
        crossed = f"edges {cut[0]} and {cut[1]} cross near ({corner[0]:g}, {corner[1]:g})"
        remedy = "use smaller elements, or check the tooth's profile and the bore"
        raise InputError.at("outline", crossed, "must not cut itself", remedy)
    scale = float(np.max(np.ptp(polygon, axis=0)))
    # rounded, so that gears which differ in size alone get the same triangles whatever the last bit is
    shape = np.round(polygon / scale, 9)
    points, triangles = _fill(shape)
    if not np.allclose(points[: len(polygon)], shape, rtol=0, atol=1e-13):
        allowed = "must keep its nodes in place"
        raise InputError.at("outline", "moved by gmsh", allowed, "use smaller elements")
    points *= scale
    points[: len(polygon)] = polygon
    a, b, c = points[triangles[:, 0]], points[triangles[:, 1]], points[triangles[:, 2]]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    triangles[area < 0] = triangles[area < 0][:, [0, 2, 1]]
    return points, triangles


def _fill(polygon: Array) -> tuple[Array, Integers]:
    with gmsh_session() as gmsh:
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        return _mesh_polygon(gmsh.model, polygon)


def _mesh_polygon(model: Any, polygon: Array) -> tuple[Array, Integers]:
    geo, n = model.geo, len(polygon)
    corners = [geo.addPoint(float(x), float(y), 0.0) for x, y in polygon]
    lines = [geo.addLine(corners[i], corners[(i + 1) % n]) for i in range(n)]
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    for line in lines:
        geo.mesh.setTransfiniteCurve(line, 2)  # two nodes: the edge is kept whole
    geo.synchronize()
    model.mesh.generate(2)
    tags, coordinates, _ = model.mesh.getNodes()
    ours = np.array([int(model.mesh.getNodes(0, corner)[0][0]) for corner in corners])
    ordered = np.concatenate([ours, tags[~np.isin(tags, ours)]]).astype(np.int64)
    index = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    index[ordered] = np.arange(len(ordered))
    points = np.empty((len(tags), 2))
    points[index[tags.astype(np.int64)]] = np.reshape(coordinates, (-1, 3))[:, :2]
    _, nodes = model.mesh.getElementsByType(2, surface)
    return points, index[np.reshape(nodes, (-1, 3)).astype(np.int64)]
