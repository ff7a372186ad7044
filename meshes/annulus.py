"""The whole gear: copies of a sector turned round the axis and joined along their cuts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

import numpy as np

from base import Array, InputError, Integers, record
from gears.tooth.rotation import turned
from meshes.sector import SectorMesh


@record
class GearMesh:
    """A gear, or some successive teeth of it, in curved second-order triangles.

    Attributes
    ----------
    points : (n, 2) array
        Nodes [m], gear axis at the origin, tooth 0 along +y, teeth counted anticlockwise.
    triangles : (m, 6) array
        Corners 0 1 2 anticlockwise, middles of 01, 12 and 20.
    tooth : (m,) array
        Tooth to whose sector a triangle belongs.
    thickness : (m,) array
        Of a triangle, over the face width.
    facets : mapping of str to (k, 3) array
        Edges of each named boundary, material on the left: first node, last node, middle.
    facet_tooth : mapping of str to (k,) array
        Tooth of each of those edges.
    nodes : mapping of int to (sector nodes,) array
        For each tooth, the node of this mesh that each node of its sector became.
    """

    points: Array
    triangles: Integers
    tooth: Integers
    thickness: Array
    facets: Mapping[str, Integers]
    facet_tooth: Mapping[str, Integers]
    nodes: Mapping[int, Integers]

    @property
    def teeth(self) -> list[int]:
        """Numbers of the teeth, growing."""
        numbers: list[int] = np.unique(self.tooth).tolist()
        return numbers


def gear_mesh(
    sector: SectorMesh,
    teeth: Sequence[int] | None = None,
    others: Mapping[int, SectorMesh] | None = None,
) -> GearMesh:
    """Join copies of a sector to a whole annulus.

    Parameters
    ----------
    sector : SectorMesh
    teeth : sequence of int, optional
        Only these successive teeth (negative numbers count clockwise); all of them unless given.
    others : mapping of int to SectorMesh, optional
        Sectors that replace the usual one at some teeth; their cuts must have the same nodes.

    Returns
    -------
    GearMesh

    Raises
    ------
    base.InputError
        When the cuts of neighbouring sectors do not fit.

    Examples
    --------
    >>> from gears import Gear, GearPair
    >>> from meshes import gear_mesh, mesh_sector
    >>> pair = GearPair(Gear(teeth=36), Gear(teeth=40), module=2e-3, face_width=40e-3)
    >>> gear_mesh(mesh_sector(pair.teeth_profiles[0]), teeth=range(-1, 2)).teeth
    [-1, 0, 1]
    """
    z = sector.teeth
    wanted = range(z) if teeth is None else teeth
    others = others or {}
    points: list[Array] = []
    triangles, tooth, thickness, nodes = [], [], [], {}
    facets: dict[str, list[Integers]] = {}
    owners: dict[str, list[Integers]] = {}
    start = 0
    left_of: dict[int, Integers] = {}  # joined node numbers of a sector's left cut
    right_of: dict[int, Integers] = {}
    for k in wanted:
        mesh = others.get(k, sector)
        place = turned(mesh.points, k * 2 * np.pi / z)
        number = np.full(len(place), -1, dtype=np.int64)
        for mine, theirs in (("right", left_of.get((k - 1) % z)), ("left", right_of.get((k + 1) % z))):
            if theirs is None:
                continue
            side = mesh.side_nodes(mine)
            already = np.concatenate(points)[theirs] if len(side) == len(theirs) else np.empty((0, 2))
            if len(already) == 0 or not np.allclose(place[side], already, rtol=0, atol=1e-9 * mesh.module):
                raise InputError.at(
                    f"tooth {k}", "cut of other nodes", "must have matching cuts", "use equal sizes"
                )
            number[side] = theirs
        fresh = np.flatnonzero(number < 0)
        number[fresh] = start + np.arange(len(fresh))
        start += len(fresh)
        points.append(place[fresh])
        left_of[k % z], right_of[k % z] = number[mesh.side_nodes("left")], number[mesh.side_nodes("right")]
        nodes[k] = number
        triangles.append(number[mesh.triangles])
        tooth.append(np.full(len(mesh.triangles), k))
        thickness.append(mesh.thickness)
        for name, edges in mesh.facets.items():
            if not name.startswith("side"):
                facets.setdefault(name, []).append(number[edges])
                owners.setdefault(name, []).append(np.full(len(edges), k))
    return GearMesh(
        np.concatenate(points),
        np.concatenate(triangles),
        np.concatenate(tooth),
        np.concatenate(thickness),
        MappingProxyType({name: np.concatenate(parts) for name, parts in facets.items()}),
        MappingProxyType({name: np.concatenate(parts) for name, parts in owners.items()}),
        MappingProxyType(nodes),
    )
