"""gmsh fills a polygon with triangles, without touching the polygon's own nodes."""

from __future__ import annotations

import signal
import threading
from itertools import count
from typing import Any

import numpy as np

from base import Array, Fault, InputError, Integers, unclocked
from meshes.outline import crossing

__all__ = ["triangulate"]

_one_at_a_time = threading.Lock()  # gmsh keeps one state per process
_names = count()


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
        raise InputError([Fault("outline", "nan or inf", "must have finite coordinates", remedy)])
    cut = crossing(polygon)
    if cut is not None:
        where = polygon[cut[0]]
        crossed = f"edges {cut[0]} and {cut[1]} cross near ({where[0]:g}, {where[1]:g})"
        remedy = "use smaller elements, or check the tooth's profile and the bore"
        raise InputError([Fault("outline", crossed, "must not cut itself", remedy)])
    scale = float(np.max(np.ptp(polygon, axis=0)))
    # rounded, so that gears which differ in size alone get the same triangles whatever the last bit is
    shape = np.round(polygon / scale, 9)
    with _one_at_a_time:
        points, triangles = _fill(shape)
    if not np.allclose(points[: len(polygon)], shape, rtol=0, atol=1e-13):
        allowed = "must keep its nodes in place"
        raise InputError([Fault("outline", "moved by gmsh", allowed, "use smaller elements")])
    points *= scale
    points[: len(polygon)] = polygon
    a, b, c = points[triangles[:, 0]], points[triangles[:, 1]], points[triangles[:, 2]]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    triangles[area < 0] = triangles[area < 0][:, [0, 2, 1]]
    return points, triangles


def _fill(polygon: Array) -> tuple[Array, Integers]:
    gmsh = _load_gmsh()
    began = not gmsh.isInitialized()
    if began:
        # interruptible=False: gmsh otherwise sets a signal handler, which only the main thread may do
        gmsh.initialize(readConfigFiles=False, interruptible=False)
        _keep_broken_pipes_harmless()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        gmsh.option.setNumber("Mesh.Algorithm", 6)
        gmsh.option.setNumber("Mesh.ElementOrder", 1)
        gmsh.option.setNumber("Mesh.MeshSizeExtendFromBoundary", 1)
        gmsh.option.setNumber("Mesh.MeshSizeFromPoints", 0)
        name = f"sector {next(_names)}"
        gmsh.model.add(name)
        try:
            return _mesh_polygon(gmsh, polygon)
        finally:
            gmsh.model.setCurrent(name)
            gmsh.model.remove()
    finally:
        if began:
            gmsh.finalize()


def _keep_broken_pipes_harmless() -> None:
    """Undo what gmsh does to SIGPIPE when it is first initialised: a write to a closed pipe would end the process.

    Python ignores the signal and raises BrokenPipeError instead. Handlers can be set in the main thread alone; a
    program that meshes in another one first keeps gmsh's choice.
    """
    if hasattr(signal, "SIGPIPE") and threading.current_thread() is threading.main_thread():
        handler = signal.getsignal(signal.SIGPIPE)
        if handler is not None:
            signal.signal(signal.SIGPIPE, handler)


def _load_gmsh() -> Any:
    """Load gmsh; where its shared libraries are missing say which, and what installs them."""
    try:
        with unclocked():
            import gmsh
    except OSError as fault:
        packages = "libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"
        remedy = f"on Debian or Ubuntu: sudo apt-get install --no-install-recommends {packages}"
        raise InputError([Fault("gmsh", str(fault), "requires shared libraries", remedy)]) from fault
    return gmsh


def _mesh_polygon(gmsh: object, polygon: Array) -> tuple[Array, Integers]:
    model = gmsh.model  # type: ignore[attr-defined]
    geo, n = model.geo, len(polygon)
    corners = [geo.addPoint(float(x), float(y), 0.0) for x, y in polygon]
    lines = [geo.addLine(corners[i], corners[(i + 1) % n]) for i in range(n)]
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    for line in lines:
        geo.mesh.setTransfiniteCurve(line, 2)  # two nodes: the edge is kept whole
    geo.synchronize()
    model.mesh.generate(2)
    tags, coordinates, _ = model.mesh.getNodes()
    order = {int(model.mesh.getNodes(0, corner)[0][0]): i for i, corner in enumerate(corners)}
    index = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    new = n
    points = np.empty((len(tags), 2))
    for tag, xyz in zip(tags, np.reshape(coordinates, (-1, 3)), strict=True):
        place = order.get(int(tag))
        if place is None:
            place, new = new, new + 1
        index[int(tag)] = place
        points[place] = xyz[:2]
    _, nodes = model.mesh.getElementsByType(2, surface)
    return points, index[np.reshape(nodes, (-1, 3)).astype(np.int64)]
