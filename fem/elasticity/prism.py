"""A gear as a solid of constant section, straight or twisted: functions over the section times such over z.

The section of a helical gear turns as it moves along the axis, by ``twist`` a metre. In coordinates that turn with it
u = sum U_ip N_i psi_p (v likewise) and w = sum W_iq N_i phi_q, with the triangles' shape functions N and any functions
psi and phi along the face. The derivative along the axis is

    D_z = d_z - twist T,   T(u, v) = (x d_y - y d_x)(u, v) - (-v, u),   T w = (x d_y - y d_x) w ,

and the strains 11, 22, 33, 12, 13, 23 are S0 U + S1 d_z U:

    S0 = (d_x u, d_y v, -twist T w, d_y u + d_x v, d_x w - twist (T u)_1, d_y w - twist (T u)_2) ,
    S1 = (0, 0, w, 0, u, v) .

The energy needs no more of the section than A0 = <S0, C S0>, B = <S0, C S1> and A2 = <S1, C S1>, and no more of the
face than products of its functions f, g and their derivatives:

    A0 <f g> + B <f g'> + B^T <f' g> + A2 <f' g'> .

A spur gear has no twist. There A0, A2 join u and v with themselves and w with itself, B joins u and v with w: cosines
of u, v and sines of w are apart from the others, and half the functions do. The ring of equal sectors is closed as in
the plane (``fem.elasticity.ring``), with more unknowns at a node, since T does not depend on the tooth.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record, unclocked
from fem.elasticity.condensation import Condensation, condensation
from fem.elasticity.cyclic_structure import CyclicStructure, cyclic_structure
from fem.elasticity.dissection import Dissection, dissection
from fem.elasticity.line_load import FlankPoints
from fem.elasticity.plane_elasticity import INTEGRATION, PlaneElasticity, physical_gradients
from fem.elasticity.ring import held_and_cut, polar_components
from meshes.triangle import shape

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from meshes import SectorMesh

__all__ = ["Face", "Prism", "Section", "prism", "section"]

TOGETHER = 2_000_000
"""Numbers of all triangles' matrices (16 MB) up to which these are made at once: half the time of few at a time."""


@record
class Section:
    """Integrals over a sector's triangles, per unit thickness of the body; a thinner web is softer in proportion.

    Attributes
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    twist : float
        Turn of the section along the axis [rad/m], positive for a right hand.
    still, sloped, steep : (m, 6, 3, 6, 3) arrays
        A0 [Pa], B [Pa m] and A2 [Pa m^2]: node and component of the trial function last.
    """

    mesh: SectorMesh
    law: PlaneElasticity
    twist: float
    still: Array
    sloped: Array
    steep: Array

    def elements(self, face: Face, triangles: Integers) -> Array:
        """Stiffness matrices of some triangles (k, 6 n, 6 n), n unknowns a node: pairs (u, v) of each psi, then w."""
        split, n = 2 * face.psi, 2 * face.psi + face.phi
        parts = (
            (slice(0, 2), slice(0, face.psi), slice(0, split)),
            (slice(2, 3), slice(face.psi, None), slice(split, n)),
        )
        still, sloped, steep = (table[triangles] for table in (self.still, self.sloped, self.steep))
        stiffness = np.empty((len(triangles), 6, n, 6, n))
        for component, function, row in parts:
            for other, by, column in parts:
                products = (
                    (still[:, :, component, :, other], face.mass[function, by]),
                    (sloped[:, :, component, :, other], face.mixed[function, by]),
                    (
                        np.moveaxis(sloped[:, :, other, :, component], (1, 2), (3, 4)),
                        face.mixed[by, function].T,
                    ),
                    (steep[:, :, component, :, other], face.stiffness[function, by]),
                )
                shape_ = len(triangles), 6, row.stop - row.start, 6, column.stop - column.start
                stiffness[:, :, row, :, column] = _sum_of_products(products).reshape(shape_)
        return stiffness.reshape(len(triangles), 6 * n, 6 * n)


def _sum_of_products(products: Sequence[tuple[Array, Array]]) -> Array:
    """Sum of tables of the section (k, i, a, j, b) times products over the face (p, q): (k, i, p, a, j, q, b)."""
    tables = [(table, over_face) for table, over_face in products if over_face.any() and table.any()]
    if not tables:
        (table, over_face), *_ = products
        k, i, a, j, b = table.shape
        return np.zeros((k, i, len(over_face), a, j, over_face.shape[1], b))
    section_ = np.stack([table for table, _ in tables], axis=-1)
    over_z = np.stack([over_face for _, over_face in tables])
    return np.asarray(np.einsum("kiajbt,tpq->kipajqb", section_, over_z, optimize=True))


@record
class Face:
    """Products over the face of functions: psi of u and v, then phi of w.

    Attributes
    ----------
    psi, phi : int
        How many there are.
    mass, mixed, stiffness : (psi + phi, psi + phi) arrays
        <f g> [m or -], <f g'> [- or 1/m], <f' g'> [1/m or 1/m^2].
    """

    psi: int
    phi: int
    mass: Array
    mixed: Array
    stiffness: Array

    @classmethod
    def wave(cls, wavenumber: float, twisted: bool = False) -> Face:
        """Waves over the mean of cos^2.

        Without a twist u, v ~ cos k z and w ~ sin k z; u and v alone without a wave. In a twisted solid u, v and w have
        cosine and sine; without a wave each is constant.

        Parameters
        ----------
        wavenumber : float
            k [1/m]
        twisted : bool
        """
        k, unit = float(wavenumber), np.eye(2)
        quarter = k * np.array([[0.0, 1.0], [-1.0, 0.0]])  # (cos, sin)' = k (-sin, cos)
        if twisted and k:
            return cls(2, 2, np.tile(unit, (2, 2)), np.tile(quarter, (2, 2)), np.tile(k**2 * unit, (2, 2)))
        if twisted:
            return cls(1, 1, np.ones((2, 2)), np.zeros((2, 2)), np.zeros((2, 2)))
        count = 1 + bool(k)
        return cls(1, count - 1, *(table[:count, :count] for table in (unit, quarter, k**2 * unit)))


def section(mesh: SectorMesh, law: PlaneElasticity, twist: float = 0.0) -> Section:
    """Integrate over a sector's triangles with scikit-fem's quadrature.

    Parameters
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
        In plane strain: constants of the solid.
    twist : float
        Turn of the section along the axis [rad/m], tan(beta_b)/r_b, positive for a right hand.
    """
    with unclocked():
        from skfem.quadrature import get_quadrature
        from skfem.refdom import RefTri

    (xi, eta), weight = get_quadrature(RefTri, INTEGRATION)
    gradient, determinant = physical_gradients(mesh.points, mesh.triangles, xi, eta)
    scale = determinant * weight * mesh.thickness[:, None]
    values = shape(xi, eta)
    places = np.einsum("qi,mia->mqa", values, mesh.points[mesh.triangles], optimize=True)
    still, sloped = _strains(values, gradient, places, twist)
    lam, mu = law.lame
    hooke = np.diag([2 * mu, 2 * mu, 2 * mu, mu, mu, mu])
    hooke[:3, :3] += lam
    count, unknowns = len(mesh.triangles), 18

    def product(test: Array, trial: Array) -> Array:
        stress = np.einsum("mq,st,mqtu->mqsu", scale, hooke, trial, optimize=True).reshape(
            count, -1, unknowns
        )
        by_test = np.swapaxes(test.reshape(count, -1, unknowns), 1, 2)
        return np.asarray(by_test @ stress).reshape(count, 6, 3, 6, 3)

    return Section(mesh, law, twist, product(still, still), product(still, sloped), product(sloped, sloped))


def _strains(values: Array, gradient: Array, places: Array, twist: float) -> tuple[Array, Array]:
    """S0 and S1 (m, q, 6, 18) of shape functions (q, 6), their gradients (m, q, 6, 2) and places (m, q, 2)."""
    still, sloped = np.zeros((2, *gradient.shape[:2], 6, 6, 3))
    d_x, d_y = gradient[..., 0], gradient[..., 1]
    turned = -twist * (places[..., :1] * d_y - places[..., 1:] * d_x)
    still[:, :, 0, :, 0], still[:, :, 1, :, 1] = d_x, d_y
    still[:, :, 3, :, 0], still[:, :, 3, :, 1] = d_y, d_x
    still[:, :, 2, :, 2] = turned
    still[:, :, 4, :, 2], still[:, :, 5, :, 2] = d_x, d_y
    still[:, :, 4, :, 0], still[:, :, 5, :, 1] = turned, turned
    # -twist (-J): J(u, v) = (-v, u)
    still[:, :, 4, :, 1], still[:, :, 5, :, 0] = -twist * values, twist * values
    sloped[:, :, 2, :, 2] = sloped[:, :, 4, :, 0] = sloped[:, :, 5, :, 1] = values
    return still.reshape(*still.shape[:3], 18), sloped.reshape(*sloped.shape[:3], 18)


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
