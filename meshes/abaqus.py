"""Mesh as the text of an Abaqus or CalculiX input file: nodes, elements, named sets and surfaces.

Both programs number from 1, take the nodes of a six-node triangle as we do (corners anticlockwise, then the
middles of 12, 23 and 31) and call its edges S1 (12), S2 (23) and S3 (31). CalculiX reads at most 20 characters
of a number, which leaves 14 significant digits.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from base import Integers
from meshes.annulus import GearMesh

__all__ = ["mesh_text", "number", "set_names"]


def number(value: float) -> str:
    """Write a number below 1e100 in at most 20 characters, 14 significant digits; below 1e-99 it is zero."""
    return f"{value if abs(value) >= 1e-99 else 0.0:.13e}"


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


def mesh_text(
    mesh: GearMesh, element: str = "CPE6", prefix: str = "", first_node: int = 1, first_element: int = 1
) -> str:
    """Nodes, elements, sets and surfaces of a gear.

    Parameters
    ----------
    mesh : GearMesh
    element : str
        ``CPE6`` (plane strain) or ``CPS6`` (plane stress).
    prefix : str
        Put before the names of all sets.
    first_node, first_element : int
        Numbers of the first node and element.

    Returns
    -------
    str
        Sets of nodes and elements ``GEAR``, sets of elements ``TOOTH_0`` and so on; for each name of
        ``set_names`` a set of nodes and, with the same name, a surface of element edges.
    """
    lines = [f"*NODE, NSET={prefix}GEAR"]
    for n, (x, y) in enumerate(mesh.points.tolist(), first_node):
        lines.append(f"{n}, {number(x)}, {number(y)}, 0.")
    lines.append(f"*ELEMENT, TYPE={element}, ELSET={prefix}GEAR")
    for n, nodes in enumerate((mesh.triangles + first_node).tolist(), first_element):
        lines.append(f"{n}, " + ", ".join(map(str, nodes)))
    for tooth in np.unique(mesh.tooth):
        members = np.flatnonzero(mesh.tooth == tooth) + first_element
        lines += [f"*ELSET, ELSET={prefix}TOOTH_{_signed(int(tooth))}", *_members(members)]
    for name, (boundary, tooth_or_all) in set_names(mesh, prefix).items():
        edges = mesh.facets[boundary]
        if tooth_or_all is not None:
            edges = edges[mesh.facet_tooth[boundary] == tooth_or_all]
        lines += [f"*NSET, NSET={name}", *_members(np.unique(edges) + first_node)]
        lines.append(f"*SURFACE, NAME={name}, TYPE=ELEMENT")
        owner, side = _sides(mesh, edges)
        lines += [f"{e}, S{s}" for e, s in zip((owner + first_element).tolist(), side.tolist(), strict=True)]
    return "\n".join(lines) + "\n"


def _signed(tooth: int) -> str:
    return str(tooth) if tooth >= 0 else f"MINUS_{-tooth}"


def _members(numbers: Integers) -> Iterator[str]:
    """Sixteen numbers a line, as many as Abaqus takes."""
    for start in range(0, len(numbers), 16):
        yield ", ".join(map(str, numbers[start : start + 16].tolist()))


def _sides(mesh: GearMesh, edges: Integers) -> tuple[Integers, Integers]:
    """Element of each edge and which of its sides (1, 2, 3) it is, by the node in the edge's middle."""
    middles = mesh.triangles[:, 3:].ravel()
    order = np.argsort(middles, kind="stable")
    place = order[np.searchsorted(middles, edges[:, 2], sorter=order)]
    return place // 3, place % 3 + 1
