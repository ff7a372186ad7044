"""A gear as a solid of constant section, straight or twisted, for some functions over the face.

Its section and the products of functions over the face are those of ``fem.elasticity.section``. The ring of equal
sectors is closed as in the plane (``fem.elasticity.ring``), with more unknowns at a node, since T does not depend on
the tooth.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.condensation import Condensation, condensation
from fem.elasticity.cyclic_structure import CyclicStructure, cyclic_structure
from fem.elasticity.dissection import Dissection, dissection
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.ring import held_and_cut, polar_components

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from fem.elasticity.section import Face, Section
    from meshes import SectorMesh

__all__ = ["Prism", "prism"]

TOGETHER = 2_000_000
"""Numbers of all triangles' matrices (16 MB) up to which these are made at once: half the time of few at a time."""


@record
class Prism:
    """A gear's annulus as a prism, factorised for some functions over the face.

    Attributes
    ----------
    mesh : SectorMesh
    twist : float
        Turn of the section along the axis [rad/m].
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
    twist: float
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
        # copies: a product of an array by itself would be summed in another order
        points, observed = (loads.copy(), pull.copy()) if seen is at else self._condensed(seen)
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

    def moved(self, forces: Array, loaded: Sequence[int], teeth: Sequence[int]) -> Array:
        """Displacements of all nodes of some teeth's sectors by all forces together (teeth, nodes, n).

        Parameters
        ----------
        forces : (unknowns, loads) array
            On the nodes of a sector, such as ``nodal_forces`` [N/m].
        loaded : sequence of int
            Tooth of each load, counted anticlockwise.
        teeth : sequence of int
            Counted the same way; each in its own tooth's frame.
        """
        reduced, on_cuts, _ = self.condensed.up(forces)
        pull, on_tooth = np.asarray(self.polar.T @ on_cuts), np.array(loaded)
        moved = []
        for tooth in teeth:
            each = [self.links.at_ends(pull[:, [k]], tooth - other) for k, other in enumerate(loaded)]
            own = reduced[:, (on_tooth - tooth) % self.mesh.teeth == 0].sum(axis=1, keepdims=True)
            down = self.condensed.down(np.asarray(self.polar @ np.sum(each, axis=0)), own)
            moved.append(down.reshape(len(self.mesh.points), -1))
        return np.asarray(moved)

    def nodal_forces(self, at: FlankPoints, amounts: Array) -> Array:
        """Nodal forces that stand for normal line loads, sums of psi(z), all together (unknowns,).

        Parameters
        ----------
        at : FlankPoints
            Places on tooth 0.
        amounts : (loads, psi) array
            Of every function in the load at each place.
        """
        direction, along_axis = self._directions(at)
        at_nodes = at.weights[:, :, None] * amounts[:, None, :]  # (loads, nodes, psi)
        force = np.zeros((len(self.mesh.points), 2 * self.psi + self.phi))
        functions = np.arange(self.psi)
        parts = [(2 * functions, direction[:, 0]), (2 * functions + 1, direction[:, 1])]
        if self.twist:  # without one nothing, whatever the functions of w
            parts.append((2 * self.psi + functions, along_axis))
        for column, component in parts:
            np.add.at(force, (at.nodes[:, :, None], column), at_nodes * component[:, None, None])
        return force.ravel()

    def _directions(self, at: FlankPoints) -> tuple[Array, Array]:
        """Unit normals of a helix' surface: in the section (loads, 2), and along the axis (loads,)."""
        (x, y), (d_x, d_y) = at.points.T, at.direction.T
        along_axis = -self.twist * (x * d_y - y * d_x)
        size = 1.0 / np.sqrt(1.0 + along_axis**2)
        return size[:, None] * at.direction, size * along_axis

    def _nodal(self, at: FlankPoints) -> Array:
        """Nodal forces that stand for unit line loads psi(z) (unknowns, loads psi).

        The surface of a helix leans along the axis: with d the unit vector in the section, normal to the flank there, a
        normal force has cos(beta_b) (d, -twist (x d_y - y d_x)), since the arm of d about the axis is r_b.
        """
        count, n = len(at.rho), 2 * self.psi + self.phi
        force = np.zeros((n * len(self.mesh.points), count, self.psi))
        direction, along_axis = self._directions(at)
        load = np.arange(count)[:, None]
        for p in range(self.psi):
            for a in range(2):
                rows = n * at.nodes + 2 * p + a
                np.add.at(force[..., p], (rows, load), at.weights * direction[:, a][:, None])
        # without a twist nothing, whatever the functions of w
        for p in range(min(self.psi, self.phi)):
            rows = n * at.nodes + 2 * self.psi + p
            np.add.at(force[..., p], (rows, load), at.weights * along_axis[:, None])
        return force.reshape(len(force), -1)


def prism(over: Section, face: Face) -> Prism:
    """Assemble, factorise and condense a sector, and close the ring.

    Parameters
    ----------
    over : Section
    face : Face
    """
    mesh, psi, phi = over.mesh, face.psi, face.phi
    n = 2 * psi + phi
    cut, hub = held_and_cut(mesh)

    def elements(triangles: Integers) -> Array:
        return over.elements(face, triangles)

    together = len(mesh.triangles) * (6 * n) ** 2 <= TOGETHER
    matrices = elements(np.arange(len(mesh.triangles))) if together else elements
    condensed = condensation(_dissected(mesh, n), matrices)
    polar = polar_components(mesh.points[cut], psi, phi)
    stiffness = polar.T @ (polar.T @ condensed.stiffness).T
    nodes = np.setdiff1d(np.arange(len(mesh.points)), np.concatenate([cut, hub]))
    inner = (n * nodes[:, None] + np.arange(n)).ravel()
    links = cyclic_structure(0.5 * (stiffness + stiffness.T), mesh.teeth)
    return Prism(mesh, over.twist, psi, phi, inner, condensed, polar, links)


@lru_cache(maxsize=2)
def _dissected(mesh: SectorMesh, components: int) -> Dissection:
    """Groups of a sector's elements; those of the last two, which all waves of a gear share."""
    return dissection(mesh.points, mesh.triangles, *held_and_cut(mesh), components)
