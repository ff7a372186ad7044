"""Mesh as a gmsh file, format 4.1, with a physical group for each named boundary and each tooth."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from base import Integers, replacing
from meshes.annulus import GearMesh

__all__ = ["write_msh"]

LINE3, TRIANGLE6 = 8, 9
"""gmsh's numbers of second-order lines (first, last, middle) and triangles (corners, middles of 01, 12, 20)."""


def write_msh(path: Path, mesh: GearMesh) -> Path:
    """Write a gear's mesh for gmsh; coordinates to the last bit.

    The physical groups of dimension 1 are the named boundaries, those of dimension 2 ``gear`` (everything)
    and ``tooth 0`` and so on. Each tooth is a surface of its own and each boundary of a tooth a curve, so that
    gmsh can show and hide them.

    Parameters
    ----------
    path : Path
        Ends in ``.msh``.
    mesh : GearMesh

    Returns
    -------
    Path
        The file written.
    """
    teeth = np.unique(mesh.tooth).tolist()
    boundary_tag = {name: 1 + i for i, name in enumerate(mesh.facets)}
    gear_tag = 1 + len(boundary_tag)
    tooth_tag = {tooth: gear_tag + 1 + i for i, tooth in enumerate(teeth)}
    groups = [(1, tag, name) for name, tag in boundary_tag.items()]
    groups += [(2, gear_tag, "gear"), *((2, tag, f"tooth {tooth}") for tooth, tag in tooth_tag.items())]
    curves = {
        (boundary_tag[name], tooth): edges[mesh.facet_tooth[name] == tooth]
        for name, edges in mesh.facets.items()
        for tooth in np.unique(mesh.facet_tooth[name]).tolist()
    }
    surfaces = {(gear_tag, tag): mesh.triangles[mesh.tooth == tooth] for tooth, tag in tooth_tag.items()}
    lines = ["$MeshFormat", "4.1 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups))]
    lines += [f'{dimension} {tag} "{name}"' for dimension, tag, name in groups]
    lines += ["$EndPhysicalNames", *_entities(mesh, curves, surfaces), *_nodes(mesh)]
    lines += _elements(curves, surfaces)
    path = Path(path)
    with replacing(path) as beside:
        beside.write_text("\n".join(lines) + "\n", encoding="ascii")
    return path


def _entities(
    mesh: GearMesh, curves: Mapping[tuple[int, int], Integers], surfaces: Mapping[tuple[int, int], Integers]
) -> list[str]:
    """Bounding box and physical groups of each curve and surface; none names its own boundary."""

    def box(nodes: Integers) -> str:
        low, high = mesh.points[nodes.ravel()].min(axis=0), mesh.points[nodes.ravel()].max(axis=0)
        return f"{low[0]!s} {low[1]!s} 0 {high[0]!s} {high[1]!s} 0"

    lines = ["$Entities", f"0 {len(curves)} {len(surfaces)} 0"]
    for tag, ((group, _), edges) in enumerate(curves.items(), 1):
        lines.append(f"{tag} {box(edges)} 1 {group} 0")
    for tag, ((gear, tooth), triangles) in enumerate(surfaces.items(), 1):
        lines.append(f"{tag} {box(triangles)} 2 {gear} {tooth} 0")
    return [*lines, "$EndEntities"]


def _nodes(mesh: GearMesh) -> list[str]:
    """All nodes in one block, that of the first surface: an entity of nodes says nothing to a solver."""
    count = len(mesh.points)
    lines = ["$Nodes", f"1 {count} 1 {count}", f"2 1 0 {count}", *map(str, range(1, count + 1))]
    lines += [f"{x!r} {y!r} 0" for x, y in mesh.points.tolist()]
    return [*lines, "$EndNodes"]


def _elements(
    curves: Mapping[tuple[int, int], Integers], surfaces: Mapping[tuple[int, int], Integers]
) -> list[str]:
    count = sum(map(len, curves.values())) + sum(map(len, surfaces.values()))
    lines = ["$Elements", f"{len(curves) + len(surfaces)} {count} 1 {count}"]
    start = 1
    for dimension, kind, blocks in ((1, LINE3, curves), (2, TRIANGLE6, surfaces)):
        for tag, block in enumerate(blocks.values(), 1):
            lines.append(f"{dimension} {tag} {kind} {len(block)}")
            for n, nodes in enumerate((block + 1).tolist(), start):
                lines.append(f"{n} " + " ".join(map(str, nodes)))
            start += len(block)
    return [*lines, "$EndElements"]
