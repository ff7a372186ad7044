"""Meshes as the text of an Abaqus or CalculiX input file: nodes, elements and sets by meshio, surfaces by us.

Both programs number from 1, take the nodes of a six-node triangle as we do (corners anticlockwise, then the
middles of 12, 23 and 31) and call its edges S1 (12), S2 (23) and S3 (31). CalculiX reads at most 20 characters
of a number, which leaves 14 significant digits.
"""

from __future__ import annotations

from collections.abc import Mapping
from io import StringIO

import numpy as np

from base import Integers
from meshes.annulus import GearMesh

DIGITS = ".13e"


def number(value: float) -> str:
    """Write a number below 1e100 in at most 20 characters, 14 significant digits; below 1e-99 it is zero."""
    return f"{value if abs(value) >= 1e-99 else 0.0:{DIGITS}}"


def set_names(mesh: GearMesh, prefix: str = "") -> dict[str, tuple[str, int | None]]:
    """Names of the sets of a boundary's edges, with the boundary and the tooth (None: all teeth).

    Parameters
    ----------
    mesh : GearMesh
    prefix : str
        Put before every name, so that several gears fit in one file.

    Returns
    -------
    dict of str to (str, int or None)
        ``FLANK_LEFT`` and so on for every boundary, ``FLANK_LEFT_0`` for that of one tooth; teeth with
        negative numbers are ``..._MINUS_1``. The bore has no teeth.
    """
    names: dict[str, tuple[str, int | None]] = {}
    for boundary, teeth in mesh.facet_tooth.items():
        names[f"{prefix}{boundary.upper()}"] = boundary, None
        if boundary.startswith(("flank", "fillet", "chamfer", "top")):
            for tooth in np.unique(teeth):
                names[f"{prefix}{boundary.upper()}_{_signed(int(tooth))}"] = boundary, int(tooth)
    return names


def mesh_text(gears: Mapping[str, GearMesh], element: str = "CPE6") -> str:
    """Nodes, elements, sets and surfaces of gears, numbered one gear after the other.

    Parameters
    ----------
    gears : mapping of str to GearMesh
        By the prefix of the names of their sets, empty for one gear alone.
    element : str
        ``CPE6`` (plane strain) or ``CPS6`` (plane stress).

    Returns
    -------
    str
        Sets of nodes and elements ``GEAR``, sets of elements ``TOOTH_0`` and so on, ``WEB`` and ``RIM_AND_HUB`` where
        there is a web; for each name of ``set_names`` a set of nodes and, with the same name, a surface of element
        edges.
    """
    import meshio

    points, triangles, nodes, elements, surfaces = [], [], {}, {}, []
    node = first = 0
    for prefix, mesh in gears.items():
        points.append(mesh.points)
        triangles.append(mesh.triangles + node)
        nodes[f"{prefix}GEAR"] = np.arange(node, node + len(mesh.points))
        elements[f"{prefix}GEAR"] = [np.arange(first, first + len(mesh.triangles))]
        if np.any(mesh.thickness < 1.0):
            for name, inside in (("WEB", mesh.thickness < 1.0), ("RIM_AND_HUB", mesh.thickness == 1.0)):
                elements[f"{prefix}{name}"] = [first + np.flatnonzero(inside)]
        for tooth in mesh.teeth:
            elements[f"{prefix}TOOTH_{_signed(tooth)}"] = [first + np.flatnonzero(mesh.tooth == tooth)]
        middles = mesh.triangles[:, 3:].ravel()
        order = np.argsort(middles, kind="stable")
        for name, (boundary, tooth_or_all) in set_names(mesh, prefix).items():
            edges = mesh.facets[boundary]
            if tooth_or_all is not None:
                edges = edges[mesh.facet_tooth[boundary] == tooth_or_all]
            nodes[name] = node + np.unique(edges)
            owner, side = _sides(middles, order, edges)
            surfaces.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
            surfaces += [f"{e + first + 1}, S{s}" for e, s in zip(owner, side, strict=True)]
        node, first = node + len(mesh.points), first + len(mesh.triangles)
    places = np.concatenate(points)
    places = np.column_stack([np.where(np.abs(places) < 1e-99, 0.0, places), np.zeros(len(places))])
    whole = meshio.Mesh(
        places, [("triangle6", np.concatenate(triangles))], point_sets=nodes, cell_sets=elements
    )
    text = StringIO()
    # under its own name, since meshio's translation of six-node triangles is a shell
    meshio.abaqus.write(text, whole, float_fmt=DIGITS, translate_cell_names=False)
    deck = text.getvalue().replace("TYPE=triangle6", f"TYPE={element}", 1).replace(",\n", "\n")
    return deck[deck.index("*NODE") :] + "\n".join(surfaces) + "\n"


def _signed(tooth: int) -> str:
    return str(tooth) if tooth >= 0 else f"MINUS_{-tooth}"


def _sides(middles: Integers, order: Integers, edges: Integers) -> tuple[list[int], list[int]]:
    """Element of each edge and which of its sides (1, 2, 3) it is, by the node in the edge's middle.

    ``middles`` are those of all elements, three each; ``order`` sorts them.
    """
    place = order[np.searchsorted(middles, edges[:, 2], sorter=order)]
    return (place // 3).tolist(), (place % 3 + 1).tolist()
