"""Meshes of gears in the formats of other programs, written by meshio and pyvista.

Formats differ in what they hold: second-order triangles or straight ones (each of ours is then four of them, with
the same nodes), edges of the boundaries or none, names or numbers. meshio drops what a format cannot hold without a
word, so that each format's abilities stand here, and each is read back by a test.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Integers, replacing
from meshes.annulus import GearMesh

if TYPE_CHECKING:
    import meshio


@dataclass(frozen=True)
class Format:
    """What a format of meshio holds of a gear.

    Attributes
    ----------
    suffix : str
        Of its files.
    curved : bool
        Whether it holds second-order triangles.
    edges : bool
        Whether it holds the edges of the boundaries.
    number : str
        Name under which meshio takes a number for each element, 0 inside and 1, 2, ... for the boundaries in
        their order; empty where the format holds none.
    fields : bool
        Whether it holds fields: then ``tooth``, and for each boundary a field of the nodes that is 1 on it.
    """

    suffix: str
    curved: bool = True
    edges: bool = True
    number: str = ""
    fields: bool = False


FORMATS: Mapping[str, Format] = {
    "ansys": Format(".ansys.msh", curved=False, edges=False),
    "avsucd": Format(".avs", curved=False, number="avsucd:material"),
    "hmf": Format(".hmf", edges=False, fields=True),
    "mdpa": Format(".mdpa"),
    "med": Format(".med", number="cell_tags"),
    "medit": Format(".mesh", curved=False, number="medit:ref"),
    "netgen": Format(".vol", curved=False, number="netgen:index"),
    "obj": Format(".obj", curved=False, edges=False),
    "off": Format(".off", curved=False, edges=False),
    "permas": Format(".post", curved=False),
    "ply": Format(".ply", curved=False),
    "stl": Format(".stl", curved=False, edges=False),
    "tecplot": Format(".dat", curved=False, edges=False, fields=True),
    "vtk": Format(".vtk", fields=True),
    "vtu": Format(".vtu", fields=True),
    "xdmf": Format(".xdmf", edges=False, fields=True),
}
"""Formats of meshio that hold plane triangles and can be read back, but for Abaqus' and gmsh's."""


def as_meshio(
    gears: Mapping[str, GearMesh], form: Format, point_data: Mapping[str, Mapping[str, Array]] | None = None
) -> meshio.Mesh:
    """Join gears into one mesh of meshio, as far as a format holds it.

    Parameters
    ----------
    gears : mapping of str to GearMesh
        By the prefix of the names of their boundaries, empty for one gear alone.
    form : Format
    point_data : mapping of str to mapping of str to array, optional
        Fields of each gear's nodes by name.
    """
    import meshio

    start = 0
    triangles, edges, numbers, tooth, edge_tooth = [], [], [], [], []
    names: list[str] = []
    nodes: dict[str, Integers] = {}
    for prefix, mesh in gears.items():
        triangles.append(mesh.triangles + start)
        tooth.append(mesh.tooth)
        for boundary, facets in mesh.facets.items():
            names.append(f"{prefix}{boundary}")
            edges.append(facets + start)
            numbers.append(np.full(len(facets), len(names)))
            edge_tooth.append(mesh.facet_tooth[boundary])
            nodes[names[-1]] = start + np.unique(facets)
        start += len(mesh.points)
    points = np.concatenate([mesh.points for mesh in gears.values()])
    kinds = ("triangle6", "line3") if form.curved else ("triangle", "line")
    inside = np.concatenate(triangles)
    blocks: list[tuple[Integers, ...]] = [(inside, np.concatenate(tooth), np.zeros(len(inside), dtype=int))]
    if form.edges:
        blocks.append((np.concatenate(edges), np.concatenate(edge_tooth), np.concatenate(numbers)))
    if not form.curved:
        blocks = [_straight(*block) for block in blocks]
    cells, teeth, tags = (list(parts) for parts in zip(*blocks, strict=True))
    made = meshio.Mesh(
        np.column_stack([points, np.zeros(len(points))]), list(zip(kinds, cells, strict=False))
    )
    if form.number:
        made.cell_data[form.number] = tags
        made.field_data = {name: np.array([k, 1]) for k, name in enumerate(names, 1)}
        made.cell_tags = {k: [name] for k, name in enumerate(names, 1)}  # med keeps the names
    if form.fields:
        made.cell_data["tooth"] = teeth
        for name, on in nodes.items():
            made.point_data[name] = np.zeros(len(points), dtype=np.int32)
            made.point_data[name][on] = 1
        for name in next(iter((point_data or {}).values()), {}):
            made.point_data[name] = np.concatenate([(point_data or {})[prefix][name] for prefix in gears])
    return made


def _straight(cells: Integers, *data: Integers) -> tuple[Integers, ...]:
    """Straight elements that stand for second-order ones, all first ones before all second ones, and their data."""
    picks = ([0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]) if cells.shape[1] == 6 else ([0, 2], [2, 1])
    pieces = np.concatenate([cells[:, pick] for pick in picks])
    return pieces, *(np.tile(cell_data, len(picks)) for cell_data in data)


def write_by_meshio(
    path: Path,
    gears: Mapping[str, GearMesh],
    form: str,
    point_data: Mapping[str, Mapping[str, Array]] | None = None,
) -> Path:
    """Write gears in one of ``FORMATS``; arguments as of `as_meshio`."""
    import meshio

    mesh = as_meshio(gears, FORMATS[form], point_data)
    if form == "xdmf":  # its arrays lie in a second file, whose name the first one holds
        path.parent.mkdir(parents=True, exist_ok=True)
        meshio.write(path, mesh, file_format=form)
        return path
    with replacing(path) as beside:
        meshio.write(beside, mesh, file_format=form)
    return path


def write_blocks(
    path: Path, gears: Mapping[str, GearMesh], point_data: Mapping[str, Mapping[str, Array]]
) -> Path:
    """Write gears as named blocks for VTK (``.vtm``, and a folder of the blocks beside it).

    Parameters
    ----------
    path : Path
    gears : mapping of str to GearMesh
        By the name of the block; each holds a block ``gear`` and one for each boundary.
    point_data : mapping of str to mapping of str to array
        Fields of each gear's nodes by name.
    """
    import pyvista

    blocks = pyvista.MultiBlock()
    for name, mesh in gears.items():
        points = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
        parts = pyvista.MultiBlock()
        parts["gear"] = _grid(pyvista.CellType.QUADRATIC_TRIANGLE, mesh.triangles, points)
        parts["gear"].cell_data["tooth"] = mesh.tooth
        for field, values in point_data[name].items():
            parts["gear"].point_data[field] = values
        for boundary, edges in mesh.facets.items():
            used, cells = np.unique(edges, return_inverse=True)
            parts[boundary] = _grid(pyvista.CellType.QUADRATIC_EDGE, cells.reshape(edges.shape), points[used])
            parts[boundary].cell_data["tooth"] = mesh.facet_tooth[boundary]
        blocks[name] = parts
    path.parent.mkdir(parents=True, exist_ok=True)
    blocks.save(path)
    return path


def _grid(kind: int, cells: Integers, points: Array) -> Any:
    import pyvista

    return pyvista.UnstructuredGrid({kind: cells}, points)
