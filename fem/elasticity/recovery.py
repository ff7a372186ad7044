"""Nodal stresses of a sector: averaged inside, from tangential strain and known tractions on the free edges.

Averages of the elements' stresses are the most inaccurate on the boundary, where they matter most. There the traction
(tau_n, tau_t) is known and the tangential strain comes from the edges' Gauss points (``fem.elasticity.fillet``):

    sigma_nn = tau_n,  sigma_nt = tau_t,  sigma_tt = E* eps_t + nu* tau_n .
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity import flamant
from fem.elasticity.fillet import GAUSS, edge_strain_matrix, local_cubic
from fem.elasticity.plane_elasticity import PlaneElasticity, nodal_stress_matrix
from meshes import SectorMesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["NodalStress", "nodal_stress"]

PLACES: Array = np.array([0.0, GAUSS[0], 0.5, GAUSS[1], 1.0])


@record
class NodalStress:
    """Recovery of sigma_xx, sigma_yy, tau_xy at a sector's nodes.

    Attributes
    ----------
    matrix : (3n, 2n) sparse matrix
        From the displacements, for edges without traction.
    nodes : (k,) array
        Nodes of the free edges, once for each curve that they end or lie on.
    tangents : (k, 2) array
        Unit tangents there, material on the left.
    share : (k,) array
        One over the number of times that the node is listed.
    curves : mapping of str to slice
        Nodes of each curve in that list.
    """

    matrix: csr_array
    nodes: Integers
    tangents: Array
    share: Array
    curves: Mapping[str, slice]

    def from_tractions(self, mesh: SectorMesh, load: Array, inward: Array, law: PlaneElasticity) -> Array:
        """Part (n, 3) of u_r's stress that its tractions -sigma_s n on the free edges make [1/m]."""
        t = self.tangents
        n = np.stack([t[:, 1], -t[:, 0]], axis=1)
        pull = -flamant.traction(mesh.points[self.nodes], n, load, inward)
        return self.by_tractions(len(mesh.points), pull, law)

    def by_tractions(self, count: int, pull: Array, law: PlaneElasticity) -> Array:
        """Part (count, 3) of the stress that tractions (k, 2) on the listed nodes make."""
        t = self.tangents
        n = np.stack([t[:, 1], -t[:, 0]], axis=1)
        across, along = np.sum(pull * n, axis=1), np.sum(pull * t, axis=1)
        across, along = across * self.share, along * self.share
        tensor = (
            across[:, None, None]
            * (n[:, :, None] * n[:, None] + law.plane_poisson * t[:, :, None] * t[:, None])
        ) + along[:, None, None] * (n[:, :, None] * t[:, None] + t[:, :, None] * n[:, None])
        total = np.zeros((count, 3))
        np.add.at(total, self.nodes, tensor[:, [0, 1, 0], [0, 1, 1]])
        return total


def nodal_stress(mesh: SectorMesh, law: PlaneElasticity) -> NodalStress:
    """Set up the recovery for a sector."""
    from scipy.sparse import coo_array, csr_array, vstack

    nodes, tangents, strains, curves, first = [], [], [], {}, 0
    for name, edges in mesh.free.items():
        own, along, strain = _on_curve(mesh.points, edges)
        curves[name], first = slice(first, first + len(own)), first + len(own)
        nodes.append(own)
        tangents.append(along)
        strains.append(strain)
    listed, t = np.concatenate(nodes), np.concatenate(tangents)
    count = np.bincount(listed, minlength=len(mesh.points))
    share = 1.0 / count[listed]
    spread = law.plane_modulus * np.stack([t[:, 0] ** 2, t[:, 1] ** 2, t[:, 0] * t[:, 1]], axis=1)
    rows = 3 * listed[:, None] + np.arange(3)
    columns = np.broadcast_to(np.arange(len(listed))[:, None], rows.shape)
    to_tensor = coo_array(
        ((spread * share[:, None]).ravel(), (rows.ravel(), columns.ravel())),
        shape=(3 * len(mesh.points), len(listed)),
    )
    averaged = nodal_stress_matrix(mesh.points, mesh.triangles, law, mesh.thickness)
    averaged.data[np.repeat(count > 0, np.diff(averaged.indptr))] = 0.0  # rows of the free edges
    matrix = csr_array(averaged.tocsr() + to_tensor.tocsr() @ vstack(strains, format="csr"))
    return NodalStress(matrix, listed, t, share, curves)


def _on_curve(points: Array, edges: Integers) -> tuple[Integers, Array, csr_array]:
    """Nodes along a chain of edges, tangents there, and the matrix to their tangential strains."""
    from scipy.sparse import csr_array

    values = np.stack(
        [(1 - PLACES) * (1 - 2 * PLACES), PLACES * (2 * PLACES - 1), 4 * PLACES * (1 - PLACES)], axis=-1
    )
    place = np.einsum("qk,eka->eqa", values, points[edges])
    steps = np.linalg.norm(np.diff(place, axis=1), axis=2)
    start = np.concatenate([[0.0], np.cumsum(steps.sum(axis=1))])
    arc = start[:-1, None] + np.concatenate([np.zeros((len(edges), 1)), np.cumsum(steps, axis=1)], axis=1)
    weights = local_cubic(arc[:, [1, 3]].ravel(), np.append(arc[:, [0, 2]].ravel(), start[-1]))
    nodes = np.append(edges[:, [0, 2]].ravel(), edges[-1, 1])
    # slopes at the start and the middle of each edge, and at the end of the last one
    first, middle, last = (
        points[edges] * np.array(slope)[:, None] for slope in ((-3, -1, 4), (-1, 1, 0), (1, 3, -4))
    )
    along = np.concatenate(
        [np.stack([first.sum(axis=1), middle.sum(axis=1)], axis=1).reshape(-1, 2), last[-1:].sum(axis=1)]
    )
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    return nodes, along, csr_array(csr_array(weights) @ edge_strain_matrix(points, edges))
