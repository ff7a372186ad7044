"""Stress along a fillet of a prism: its surface is free, so that three strains along it give all of its stress.

With t the tangent of the fillet in the section, z along the face and w the displacement along z,

    sigma_t = E* (eps_t + nu eps_z),   sigma_z = E* (eps_z + nu eps_t),   tau = G (d(u . t)/dz + dw/dt),

E* = E/(1 - nu^2), since no stress acts on the surface. Displacements are functions of the section times such of z
(``fem.elasticity.prism``): u and v times psi, w times phi.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.fillet import GAUSS, FilletLine, edge_strain_matrix, fillet_edges
from meshes import SectorMesh

if TYPE_CHECKING:
    from scipy.sparse import csr_array

    from gears import ToothProfile

__all__ = ["SIDES", "FilletStrain", "fillet_strains", "von_mises"]

SIDES = ("left", "right")
"""The fillet under the loaded flank first."""


@record
class FilletStrain:
    """Matrices from nodal values of a sector to what makes the stress at the samples of one of its fillets.

    Attributes
    ----------
    along : (samples, 2 nodes) sparse matrix
        eps_t of u and v.
    moved : (samples, 2 nodes) sparse matrix
        u . t.
    value, slope : (samples, nodes) sparse matrices
        w, and its derivative along t.
    """

    along: csr_array
    moved: csr_array
    value: csr_array
    slope: csr_array


def fillet_strains(mesh: SectorMesh, profile: ToothProfile, line: FilletLine) -> tuple[FilletStrain, ...]:
    """Recovery on both fillets of a tooth, as of ``fem.elasticity.fillet``.

    Parameters
    ----------
    mesh : meshes.SectorMesh
    profile : gears.ToothProfile
    line : FilletLine
    """
    return tuple(_of_side(mesh, profile, line, side) for side in SIDES)


def _of_side(mesh: SectorMesh, profile: ToothProfile, line: FilletLine, side: str) -> FilletStrain:
    from scipy.sparse import csr_array, diags_array, kron

    edges, count = fillet_edges(mesh, profile, line, side), len(mesh.points)
    weights = csr_array(edges.weights)
    values = np.stack(
        [(1 - GAUSS) * (1 - 2 * GAUSS), GAUSS * (2 * GAUSS - 1), 4 * GAUSS * (1 - GAUSS)], axis=-1
    )
    rises = np.stack([4 * GAUSS - 3, 4 * GAUSS - 1, 4 - 8 * GAUSS], axis=-1)
    speed = np.linalg.norm(np.einsum("qk,eka->eqa", rises, mesh.points[edges.nodes]), axis=2)
    slopes = rises * (edges.outward[:, None] / speed)[..., None]
    value, slope = (
        csr_array(weights @ _scattered(edges.nodes, factors, count))
        for factors in (np.broadcast_to(values, slopes.shape), slopes)
    )
    tangents = line.side(side == "left")[1]
    moved = sum(
        diags_array(tangents[:, a]) @ kron(value, np.eye(2)[a : a + 1], format="csr") for a in range(2)
    )
    along = csr_array(weights @ edge_strain_matrix(mesh.points, edges.nodes))
    return FilletStrain(along, csr_array(moved), value, slope)


def _scattered(nodes: Integers, values: Array, count: int) -> csr_array:
    """Matrix (2 edges, nodes) of values (edges, 2, 3) at the Gauss points of edges."""
    from scipy.sparse import coo_array

    rows = np.broadcast_to(np.arange(2 * len(nodes)).reshape(-1, 2, 1), values.shape)
    columns = np.broadcast_to(nodes[:, None, :], values.shape)
    return coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=(2 * len(nodes), count)).tocsr()


def von_mises(along: Array, across: Array, shear: Array) -> Array:
    """Von Mises stress of a free surface by sigma_t, sigma_z and tau."""
    return np.asarray(np.sqrt(along**2 - along * across + across**2 + 3 * shear**2))
