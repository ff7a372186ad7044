"""Files for ParaView, written beside their final name and renamed into place."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from meshes.annulus import GearMesh
from meshes.atomic import replacing

__all__ = ["write_mesh", "write_pvd", "write_vtu"]

Array = NDArray[np.float64]


def write_vtu(
    path: Path,
    points: Array,
    triangles: NDArray[np.int64],
    point_data: Mapping[str, Array],
    cell_data: Mapping[str, NDArray[np.generic]] | None = None,
) -> Path:
    """Write plane second-order triangles with their fields as an unstructured grid.

    Parameters
    ----------
    path : Path
        Ends in ``.vtu``.
    points : (n, 2) array
        [m]
    triangles : (m, 6) array
        Corners, then middles of the edges 01, 12, 20.
    point_data, cell_data : mapping of str to array
        Named fields, unit in the name; vectors (n, 2) get a zero third component. Floating-point fields are
        stored in single precision.

    Returns
    -------
    Path
        The file written.
    """
    import meshio

    def stored(values: NDArray[np.generic]) -> NDArray[np.generic]:
        if not np.issubdtype(values.dtype, np.floating):
            return values
        if values.ndim == 2 and values.shape[1] == 2:
            values = np.column_stack([values, np.zeros(len(values))])
        return values.astype(np.float32)

    mesh = meshio.Mesh(
        np.column_stack([points, np.zeros(len(points))]),
        [("triangle6", triangles)],
        point_data={name: stored(values) for name, values in point_data.items()},
        cell_data={name: [stored(values)] for name, values in (cell_data or {}).items()},
    )
    path = Path(path)
    with replacing(path) as beside:
        mesh.write(beside, file_format="vtu")
    return path


def write_mesh(path: Path, mesh: GearMesh) -> Path:
    """Write a gear's mesh with the tooth of each triangle."""
    return write_vtu(path, mesh.points, mesh.triangles, {}, {"tooth": mesh.tooth.astype(np.int32)})


def write_pvd(path: Path, steps: Sequence[tuple[float, Sequence[Path]]]) -> Path:
    """Write a time series: for each time, the files that belong to it.

    Parameters
    ----------
    path : Path
        Ends in ``.pvd``; the files are named relative to its folder.
    steps : sequence of (float, sequence of Path)
    """
    path = Path(path)
    lines = ['<?xml version="1.0"?>', '<VTKFile type="Collection" version="0.1" byte_order="LittleEndian">']
    lines.append("  <Collection>")
    for time, files in steps:
        for part, file in enumerate(files):
            name = quoteattr(os.path.relpath(file, path.parent))
            lines.append(f'    <DataSet timestep="{time:.9g}" group="" part="{part}" file={name}/>')
    lines += ["  </Collection>", "</VTKFile>", ""]
    with replacing(path) as beside:
        beside.write_text("\n".join(lines), encoding="utf-8")
    return path
