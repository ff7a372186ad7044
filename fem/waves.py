"""Loads that go as a wave along the face: a gear's answer to cos k z, on the plane mesh.

A gear of constant section whose ends are frictionless walls answers a load f cos(k z), k = n pi/b, with

    u, v ~ cos k z,   w ~ sin k z,

so that each wave is a plane problem with three unknowns at a node. With the triangles' shape functions N and the law
of the solid,

    K_(ia)(jb) as in plane strain (``fem.elasticity``) + k^2 mu M_ij delta_ab,
    K_(ia)(jw) = k Int (lambda d_a N_i N_j - mu N_i d_a N_j),
    K_(iw)(jw) = mu Int grad N_i . grad N_j + k^2 (lambda + 2 mu) M_ij,   M_ij = Int N_i N_j.

Without a wave this is plane strain, to the last digit. What a load on the flank itself yields is infinite as in the
plane; what it yields less than the same load spread evenly is not, and comes out on the plane mesh as a difference.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array, record, unclocked
from fem.chain import ring_of_links
from fem.condensation import condensation
from fem.elasticity import INTEGRATION, PlaneElasticity, element_matrices, physical_gradients
from fem.line_load import FlankPoints
from fem.ring import held_and_cut, polar_components
from meshes.triangle import shape

if TYPE_CHECKING:
    from meshes import SectorMesh

__all__ = ["WaveElements", "wave_answer", "wave_elements"]


@record
class WaveElements:
    """Stiffness matrices of triangles by powers of the wave number, unknown 3 i + a of node i, a = u, v, w.

    Attributes
    ----------
    constant : (m, 18, 18) array
        [Pa]
    linear : (m, 18, 18) array
        [Pa m]
    square : (m, 18, 18) array
        [Pa m^2]
    """

    constant: Array
    linear: Array
    square: Array

    def of(self, wavenumber: float) -> Array:
        """Matrices (m, 18, 18) at a wave number [1/m] [Pa]."""
        return self.constant + wavenumber * (self.linear + wavenumber * self.square)


def wave_elements(mesh: SectorMesh, law: PlaneElasticity) -> WaveElements:
    """Integrate a sector's elements, per unit thickness of the body; a thinner web is softer in proportion.

    Parameters
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    """
    with unclocked():
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    scale = determinant * weight * mesh.thickness[:, None]
    values = shape(xi, eta)
    lam, mu = law.lame
    count = len(mesh.triangles)
    constant, linear, square = (np.zeros((count, 6, 3, 6, 3)) for _ in range(3))
    plane = element_matrices(mesh.points, mesh.triangles, law) * mesh.thickness[:, None, None]
    constant[:, :, :2, :, :2] = plane.reshape(count, 6, 2, 6, 2)
    flat = np.swapaxes(gradient, 1, 2).reshape(count, 6, -1)  # (m, i, q a)
    constant[:, :, 2, :, 2] = mu * (flat * np.repeat(scale, 2, axis=1)[:, None]) @ np.swapaxes(flat, 1, 2)
    slope_value = np.einsum("mqia,mq,qj->miaj", gradient, scale, values, optimize=True)  # Int d_a N_i N_j
    coupled = lam * slope_value - mu * np.transpose(slope_value, (0, 3, 2, 1))
    linear[:, :, :2, :, 2] = coupled
    linear[:, :, 2, :, :2] = np.transpose(coupled, (0, 3, 1, 2))
    mass = np.einsum("mq,qi,qj->mij", scale, values, values, optimize=True)
    for a, modulus in enumerate((mu, mu, lam + 2 * mu)):
        square[:, :, a, :, a] = modulus * mass
    return WaveElements(*(one.reshape(count, 18, 18) for one in (constant, linear, square)))


def wave_answer(
    mesh: SectorMesh, elements: WaveElements, wavenumber: float, at: FlankPoints, reach: int
) -> tuple[Array, Array]:
    """Displacements by unit waves of line load along the face, one at a time.

    Parameters
    ----------
    mesh : SectorMesh
    elements : WaveElements
        Of this mesh.
    wavenumber : float
        k [1/m]; without a wave (0) the answer is plane strain's.
    at : FlankPoints
        Where the loads act, on tooth 0, and on other teeth the places that are observed.
    reach : int
        Neighbours that are observed.

    Returns
    -------
    own : (loads,) array
        At each load along it, by nodal forces that stand for the load [m per N/m]: of its own use is only the
        difference from another wave number on the same mesh.
    cross : (reach, loads, points) array
        On the neighbours on the side of growing rho [m per N/m].
    """
    components = 3 if wavenumber else 2
    matrices = elements.of(wavenumber)
    if components == 2:
        plane = (3 * np.arange(6)[:, None] + np.arange(2)).ravel()
        matrices = matrices[:, plane[:, None], plane]
    cut, hub = held_and_cut(mesh)
    condensed = condensation(mesh.points, mesh.triangles, matrices, cut, hub, components)
    polar = polar_components(mesh.points[cut], components)
    stiffness = polar.T @ (polar.T @ condensed.stiffness).T
    links = ring_of_links(0.5 * (stiffness + stiffness.T), mesh.teeth)
    force = np.zeros((components * len(mesh.points), len(at.rho)))
    for a in range(2):
        rows, loads = components * at.nodes + a, np.arange(len(at.rho))[:, None]
        np.add.at(force, (rows, loads), at.weights * at.direction[:, a : a + 1])
    _, on_cuts, work = condensed.up(force)
    pull = np.asarray(polar.T @ on_cuts)
    own = work + np.sum(pull * links.at_ends(pull, 0), axis=0)
    cross = [np.asarray(pull.T @ links.at_ends(pull, tooth)).T for tooth in range(1, reach + 1)]
    return own, np.array(cross)
