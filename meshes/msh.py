"""Mesh as a gmsh file with a physical group for each named boundary and each tooth, written by gmsh itself."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import numpy as np

from base import replacing
from meshes.annulus import GearMesh
from meshes.gmsh_session import gmsh_session

LINE3, TRIANGLE6 = 8, 9
"""gmsh's numbers of second-order lines (first, last, middle) and triangles (corners, middles of 01, 12, 20)."""


END = b"$EndElements\n"
"""With which a whole file ends."""


def write_msh(path: Path, mesh: GearMesh) -> Path:
    """Write a gear's mesh for gmsh, format 4.1, binary; coordinates to the last bit.

    The physical groups of dimension 1 are the named boundaries, those of dimension 2 ``gear`` (everything)
    and ``tooth 0`` and so on. Each tooth is a separate surface and each boundary of a tooth a curve, so that
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
    path = Path(path)
    groups: dict[tuple[int, str], list[int]] = {}
    first = 1  # number of the next element
    with gmsh_session() as gmsh, replacing(path) as beside:
        model = gmsh.model
        blocks = [(2, TRIANGLE6, "gear", tooth, mesh.triangles[mesh.tooth == tooth]) for tooth in mesh.teeth]
        blocks += [
            (1, LINE3, name, tooth, edges[mesh.facet_tooth[name] == tooth])
            for name, edges in mesh.facets.items()
            for tooth in np.unique(mesh.facet_tooth[name]).tolist()
        ]
        for tag, (dimension, kind, name, tooth, nodes) in enumerate(blocks, 1):
            model.addDiscreteEntity(dimension, tag)
            if tag == 1:  # all nodes belong to the first surface: an entity of nodes says nothing to a solver
                places = np.column_stack([mesh.points, np.zeros(len(mesh.points))])
                model.mesh.addNodes(2, tag, np.arange(1, len(places) + 1), places.ravel())
            numbers = np.arange(first, first + len(nodes))
            model.mesh.addElementsByType(tag, kind, numbers, (nodes + 1).ravel())
            first += len(nodes)
            groups.setdefault((dimension, name), []).append(tag)
            if dimension == 2:
                groups[2, f"tooth {tooth}"] = [tag]
        for (dimension, name), tags in groups.items():
            model.addPhysicalGroup(dimension, tags, name=name)
        gmsh.option.setNumber("Mesh.Binary", 1)
        gmsh.write(str(beside))
        with beside.open("rb") as file:  # gmsh does not report a full disk
            file.seek(-min(len(END), beside.stat().st_size), os.SEEK_END)
            if file.read() != END:
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))
    return path
