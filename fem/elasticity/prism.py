"""A gear as a prism: a solid of constant section, whose displacements are functions over the section times such over z.

With the triangles' shape functions N over the section and any functions psi over the face,

    u = sum U_ip N_i psi_p   (v likewise),   w = sum W_iq N_i phi_q ,

the energy of the solid needs no more of the section than the integrals

    K_(ia)(jb) of plane strain (``fem.elasticity.plane_elasticity``), M_ij = Int N_i N_j,
    L_ij = Int grad N_i . grad N_j,  D_iaj = Int d_a N_i N_j ,

and no more of the face than products of psi, phi and their derivatives:

    (ia p)(jb q)  K_(ia)(jb) <psi_p psi_q> + mu M_ij delta_ab <psi_p' psi_q'>
    (ia p)(jw q)  lambda D_iaj <psi_p phi_q'> + mu D_jai <psi_p' phi_q>
    (iw p)(jw q)  mu L_ij <phi_p phi_q> + (lambda + 2 mu) M_ij <phi_p' phi_q'> .

The ring of equal sectors is closed as in the plane (``fem.elasticity.ring``), with more unknowns at a node.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record, unclocked
from fem.elasticity.condensation import Condensation, condensation
from fem.elasticity.cyclic_structure import CyclicStructure, cyclic_structure
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.plane_elasticity import INTEGRATION, PlaneElasticity, element_matrices, physical_gradients
from fem.elasticity.ring import held_and_cut, polar_components
from meshes.triangle import shape

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from meshes import SectorMesh

__all__ = ["Face", "Prism", "Section", "prism", "section"]


@record
class Section:
    """Integrals over a sector's triangles, per unit thickness of the body; a thinner web is softer in proportion.

    Attributes
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    plane : (m, 6, 2, 6, 2) array
        K [Pa].
    mass, laplace : (m, 6, 6) arrays
        M [m^2], L [-].
    slopes : (m, 6, 2, 6) array
        D [m].
    """

    mesh: SectorMesh
    law: PlaneElasticity
    plane: Array
    mass: Array
    laplace: Array
    slopes: Array

    def elements(self, face: Face, triangles: Integers) -> Array:
        """Stiffness matrices of some triangles (k, 6 n, 6 n), n unknowns a node: pairs (u, v) of each psi, then w."""
        lam, mu = self.law.lame
        in_plane, across = len(face.masses[0]), len(face.masses[1])
        count, n = len(triangles), 2 * in_plane + across
        stiffness = np.empty((count, 6, n, 6, n))
        plane_block = np.einsum("kiajb,pq->kipajqb", self.plane[triangles], face.masses[0], optimize=True)
        along = mu * np.einsum("kij,pq->kipjq", self.mass[triangles], face.stiffnesses[0], optimize=True)
        for a in range(2):
            plane_block[:, :, :, a, :, :, a] += along
        m = 2 * in_plane
        stiffness[:, :, :m, :, :m] = plane_block.reshape(count, 6, m, 6, m)
        mixed = lam * np.einsum("kiaj,pq->kipajq", self.slopes[triangles], face.by_across, optimize=True)
        mixed += mu * np.einsum("kjai,pq->kipajq", self.slopes[triangles], face.by_plane, optimize=True)
        coupled = mixed.reshape(count, 6, m, 6, across)
        stiffness[:, :, :m, :, m:] = coupled
        stiffness[:, :, m:, :, :m] = np.transpose(coupled, (0, 3, 4, 1, 2))
        own = mu * np.einsum("kij,pq->kipjq", self.laplace[triangles], face.masses[1], optimize=True)
        own += (lam + 2 * mu) * np.einsum(
            "kij,pq->kipjq", self.mass[triangles], face.stiffnesses[1], optimize=True
        )
        stiffness[:, :, m:, :, m:] = own
        return stiffness.reshape(count, 6 * n, 6 * n)


@record
class Face:
    """Products over the face of functions psi of u and v, and phi of w.

    Attributes
    ----------
    masses, stiffnesses : two arrays (p, p) and (q, q)
        <psi psi>, <phi phi> [m or -], <psi' psi'>, <phi' phi'> [1/m or 1/m^2].
    by_across, by_plane : (p, q) arrays
        <psi phi'>, <psi' phi>.
    """

    masses: tuple[Array, Array]
    stiffnesses: tuple[Array, Array]
    by_across: Array
    by_plane: Array

    @classmethod
    def wave(cls, wavenumber: float) -> Face:
        """Give u, v ~ cos k z and w ~ sin k z, over the mean of cos^2; u and v alone without a wave."""
        unit, k = np.ones((1, 1)), np.full((1, 1), float(wavenumber))
        if wavenumber:
            return cls((unit, unit), (k**2, k**2), k, -k)
        none, empty = np.zeros((0, 0)), np.zeros((1, 0))
        return cls((unit, none), (0.0 * unit, none), empty, empty)


def section(mesh: SectorMesh, law: PlaneElasticity) -> Section:
    """Integrate over a sector's triangles with scikit-fem's quadrature.

    Parameters
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain.
    """
    with unclocked():
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    scale = determinant * weight * mesh.thickness[:, None]
    values, count = shape(xi, eta), len(mesh.triangles)
    plane = element_matrices(mesh.points, mesh.triangles, law) * mesh.thickness[:, None, None]
    flat = np.swapaxes(gradient, 1, 2).reshape(count, 6, -1)  # (m, i, q a)
    return Section(
        mesh,
        law,
        plane.reshape(count, 6, 2, 6, 2),
        np.einsum("mq,qi,qj->mij", scale, values, values, optimize=True),
        (flat * np.repeat(scale, 2, axis=1)[:, None]) @ np.swapaxes(flat, 1, 2),
        np.einsum("mqia,mq,qj->miaj", gradient, scale, values, optimize=True),
    )


@record
class Prism:
    """A gear's annulus as a prism, factorised for some functions over the face.

    Attributes
    ----------
    mesh : SectorMesh
    psi, phi : int
        Functions of u and v, and of w.
    inner : (inner,) array of int
        Unknowns inside the sector.
    condensed : Condensation
    polar : (cut, cut) sparse matrix
        From polar to Cartesian components on the cuts.
    links : CyclicStructure
        The closed ring, in polar components.
    """

    mesh: SectorMesh
    psi: int
    phi: int
    inner: Integers
    condensed: Condensation
    polar: csc_array
    links: CyclicStructure

    def influence(self, at: FlankPoints, reach: int) -> tuple[Array, Array]:
        """Displacements along line loads psi(z) at places of tooth 0, by nodal forces that stand for the loads.

        Parameters
        ----------
        at : FlankPoints
            Places that are loaded on tooth 0 and observed on others.
        reach : int
            Neighbours that are observed.

        Returns
        -------
        own : (loads, psi, psi) array
            At each load by itself [m per N/m]: of use is only the difference from another prism of the same mesh.
        cross : (reach, loads, psi, points, psi) array
            On the neighbours on the side of growing rho [m per N/m]; first the loads, then what is observed.
        """
        count, (loads, pull) = len(at.rho), self._condensed(at)
        ends = self.links.at_ends(pull, 0).reshape(-1, count, self.psi)
        inside = loads.reshape(-1, count, self.psi)
        own = np.einsum("ulp,ulq->lpq", inside, inside, optimize=True) * self.condensed.modulus
        own += np.einsum("ulp,ulq->lpq", pull.reshape(ends.shape), ends, optimize=True)
        there = [(pull.T @ self.links.at_ends(pull, tooth)).T for tooth in range(1, reach + 1)]
        return own, np.reshape(there, (reach, count, self.psi, count, self.psi))

    def across(self, at: FlankPoints, seen: FlankPoints, teeth: Sequence[int]) -> Array:
        """Displacements at other places than the loaded ones, such as on the other side of the teeth.

        Loads and what is observed are nodal forces f_p and f_q that stand for line loads psi(z): f_q . K^-1 f_p. On the
        loaded tooth as well no place may be near a load: there nodal forces are not line loads.

        Parameters
        ----------
        at : FlankPoints
            Places that are loaded on tooth 0.
        seen : FlankPoints
            Places that are observed, along their directions.
        teeth : sequence of int
            That are observed, counted anticlockwise from the loaded one.

        Returns
        -------
        (teeth, loads, psi, points, psi) array
            [m per N/m]; first the loads, then what is observed.
        """
        loads, pull = self._condensed(at)
        points, observed = self._condensed(seen)
        moved = np.array([self.links.at_ends(pull, tooth).T @ observed for tooth in teeth])
        moved[np.asarray(teeth) % self.mesh.teeth == 0] += self.condensed.modulus * (loads.T @ points)
        return moved.reshape(len(teeth), len(at.rho), self.psi, len(seen.rho), self.psi)

    def _condensed(self, at: FlankPoints) -> tuple[Array, Array]:
        """Unit line loads psi(z) inside the sector, reduced, and on its cuts in polar components (., loads psi)."""
        reduced, on_cuts, _ = self.condensed.up(self._nodal(at))
        return reduced[self.inner], np.asarray(self.polar.T @ on_cuts)

    def displacements(self, at: FlankPoints, teeth: Sequence[int]) -> Array:
        """Displacements of all nodes of some teeth's sectors by line loads psi(z) at places of tooth 0.

        Parameters
        ----------
        at : FlankPoints
        teeth : sequence of int
            Counted as in ``influence``; each in its own tooth's frame.

        Returns
        -------
        (teeth, nodes, n, loads psi) array
            n as of ``Section.elements`` [m per N/m].
        """
        reduced, on_cuts, _ = self.condensed.up(self._nodal(at))
        pull = np.asarray(self.polar.T @ on_cuts)
        nodes, moved = len(self.mesh.points), []
        for tooth in teeth:
            cuts = np.asarray(self.polar @ self.links.at_ends(pull, tooth))
            loads = reduced if tooth % self.mesh.teeth == 0 else np.zeros_like(reduced)
            moved.append(self.condensed.down(cuts, loads).reshape(nodes, -1, reduced.shape[1]))
        return np.asarray(moved)

    def _nodal(self, at: FlankPoints) -> Array:
        """Nodal forces that stand for unit line loads psi(z) (unknowns, loads psi)."""
        count, n = len(at.rho), 2 * self.psi + self.phi
        force = np.zeros((n * len(self.mesh.points), count, self.psi))
        for p in range(self.psi):
            for a in range(2):
                rows = n * at.nodes + 2 * p + a
                np.add.at(
                    force[..., p], (rows, np.arange(count)[:, None]), at.weights * at.direction[:, a : a + 1]
                )
        return force.reshape(len(force), -1)


def prism(over: Section, face: Face) -> Prism:
    """Assemble, factorise and condense a sector, and close the ring.

    Parameters
    ----------
    over : Section
    face : Face
    """
    mesh, psi, phi = over.mesh, len(face.masses[0]), len(face.masses[1])
    n = 2 * psi + phi
    cut, hub = held_and_cut(mesh)
    condensed = condensation(
        mesh.points, mesh.triangles, lambda triangles: over.elements(face, triangles), cut, hub, n
    )
    polar = polar_components(mesh.points[cut], psi, phi)
    stiffness = polar.T @ (polar.T @ condensed.stiffness).T
    nodes = np.setdiff1d(np.arange(len(mesh.points)), np.concatenate([cut, hub]))
    inner = (n * nodes[:, None] + np.arange(n)).ravel()
    links = cyclic_structure(0.5 * (stiffness + stiffness.T), mesh.teeth)
    return Prism(mesh, psi, phi, inner, condensed, polar, links)
