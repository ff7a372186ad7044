"""The whole annulus by one sector: static condensation, and a ring of equal links.

All sectors of a gear are copies of one another. The sector's stiffness matrix is factorised once, its inner
unknowns are condensed onto the two cuts to its neighbours (``fem.elasticity.condensation``), and the ring of z such
sectors, in polar components, is closed by ``fem.elasticity.cyclic_structure``. The result is that of the whole
annulus with the same elements in every sector, to rounding. Where a web is thinner than the face its elements are
softer in proportion.

Notation: sector j (counted anticlockwise) lies between interface j on its right and interface j + 1 on its
left; the hub (bore) is held.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Cost, Integers, Stopwatch, record, unclocked
from fem.elasticity.condensation import Condensation, condensation
from fem.elasticity.cyclic_structure import CyclicStructure, cyclic_structure
from fem.elasticity.dissection import dissection, unknowns_of
from fem.elasticity.plane_elasticity import PlaneElasticity, element_matrices

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from gears import GearPair, ToothProfile
    from meshes import SectorMesh, Sizes

__all__ = ["Ring", "held_and_cut", "mesh_and_factor", "polar_components", "ring_of"]


@record
class Ring:
    """A gear's annulus, factorised.

    Attributes
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
    inner, cut, hub : index arrays
        Unknowns (2 node + component) inside the sector, on the cuts (right ones first) and on the bore.
    condensed : Condensation
        Factors of the sector's stiffness.
    by_border : (unknowns, cut + hub) sparse matrix
        Columns of the sector's stiffness matrix: forces by displacements of cuts and hub.
    polar : (cut, cut) sparse matrix
        From polar to Cartesian components on the cuts.
    schur : (cut, cut) array
        Stiffness of the sector as seen from its cuts, polar components.
    links : CyclicStructure
        The closed ring, in polar components of the cuts.
    cost : Cost
        Of assembly, factorisation and condensation.
    """

    mesh: SectorMesh
    law: PlaneElasticity
    inner: Integers
    cut: Integers
    hub: Integers
    condensed: Condensation
    by_border: csc_array
    polar: csc_array
    schur: Array
    links: CyclicStructure
    cost: Cost

    @property
    def unknowns(self) -> int:
        """Unknowns of the whole annulus that this ring stands for."""
        return self.mesh.teeth * (len(self.inner) + len(self.cut) // 2)

    def scaled(self, module: float, law: PlaneElasticity) -> Ring:
        """Give a gear in modules and E* its size [m] and modulus; plane stiffness does not depend on size."""
        modulus = law.plane_modulus
        return replace(
            self,
            mesh=self.mesh.scaled(module),
            law=law,
            condensed=self.condensed.stiffer(modulus),
            by_border=self.by_border * modulus,
            schur=self.schur * modulus,
            links=self.links.stiffer(modulus),
        )

    @cached_property
    def inner_by_cut(self) -> Array:
        """K_ii^-1 K_ic (inner, cut): minus the inner displacements that unit displacements of the cuts cause."""
        return np.asarray(-self.condensed.down(np.eye(len(self.cut)))[self.inner])

    def interfaces(self, force: Array, sector: int) -> Array:
        """Displacements of both cuts of a sector when forces act on the cuts of sector 0.

        Parameters
        ----------
        force : (cut, loads) array
            Forces on the cuts of sector 0, polar components, right cut first [per unit thickness].
        sector : int

        Returns
        -------
        (cut, loads) array
            Polar components, right cut first.
        """
        return self.links.at_ends(force, sector)

    def all_interfaces(self, force: Array) -> Array:
        """As ``interfaces`` for every sector 0..z-1 and one load (cut,): (z, cut)."""
        half = len(self.cut) // 2
        on_left = np.roll(self.links.all_ends(force[half:]), 1, axis=0)
        q = self.links.all_ends(force[:half]) + on_left
        return np.concatenate([q, np.roll(q, -1, axis=0)], axis=1)


def ring_of(mesh: SectorMesh, law: PlaneElasticity) -> Ring:
    """Assemble, factorise and condense the sector, and solve the ring.

    Parameters
    ----------
    mesh : SectorMesh
    law : PlaneElasticity
    """
    watch = Stopwatch()
    elements = element_matrices(mesh.points, mesh.triangles, law) * mesh.thickness[:, None, None]
    assembled = watch.seconds
    cut_nodes, hub_nodes = held_and_cut(mesh)
    cut, hub = unknowns_of(cut_nodes), unknowns_of(hub_nodes)
    inner = np.setdiff1d(np.arange(mesh.unknowns), np.concatenate([cut, hub]))
    condensed = condensation(dissection(mesh.points, mesh.triangles, cut_nodes, hub_nodes), elements)
    factored = watch.seconds
    polar = polar_components(mesh.points[cut_nodes])
    schur = polar.T @ (polar.T @ condensed.stiffness).T
    schur = 0.5 * (schur + schur.T)
    links = cyclic_structure(schur, mesh.teeth)
    seconds = watch.seconds
    return Ring(
        mesh,
        law,
        inner,
        cut,
        hub,
        condensed,
        _columns(mesh, elements, np.concatenate([cut, hub])),
        polar,
        schur,
        links,
        Cost(
            seconds,
            len(inner) + len(cut),
            parts={"assemble": assembled, "factor": factored - assembled, "condense": seconds - factored},
        ),
    )


def held_and_cut(mesh: SectorMesh) -> tuple[Integers, Integers]:
    """Nodes on the cuts, right ones first and each side by radius, and held ones on the bore."""
    hub = np.unique(mesh.facets["bore"])
    sides = [np.setdiff1d(mesh.side_nodes(side), hub, assume_unique=True) for side in ("right", "left")]
    by_radius = [side[np.argsort(np.linalg.norm(mesh.points[side], axis=1))] for side in sides]
    return np.concatenate(by_radius), hub


def polar_components(points: Array, pairs: int = 1, others: int = 0) -> csc_array:
    """Matrix from polar to Cartesian components at points (n, 2).

    Parameters
    ----------
    points : (n, 2) array
    pairs : int
        Pairs of components in the plane at every point.
    others : int
        Further components, which stay what they are.
    """
    with unclocked():
        from scipy.sparse import csc_array

    outward = points / np.linalg.norm(points, axis=1, keepdims=True)
    components = 2 * pairs + others
    turns = np.zeros((len(points), components, components))
    turns[:, 2 * pairs :, 2 * pairs :] = np.eye(others)
    for first in range(0, 2 * pairs, 2):
        turns[:, first : first + 2, first] = outward
        turns[:, first, first + 1], turns[:, first + 1, first + 1] = -outward[:, 1], outward[:, 0]
    # one block for each node, column by column
    blocks, size = np.swapaxes(turns, 1, 2).ravel(), components * len(points)
    rows = np.repeat(np.arange(size).reshape(-1, components), components, axis=0).ravel()
    return csc_array((blocks, rows, np.arange(0, components * size + 1, components)), shape=(size, size))


def _columns(mesh: SectorMesh, elements: Array, wanted: Integers) -> csc_array:
    """Columns of the sector's stiffness matrix for some unknowns, from the elements that have them."""
    from scipy.sparse import coo_array

    number = np.full(mesh.unknowns, -1)
    number[wanted] = np.arange(len(wanted))
    unknown = (2 * mesh.triangles[:, :, None] + np.arange(2)).reshape(len(mesh.triangles), 12)
    element, column = np.nonzero(number[unknown] >= 0)
    rows = unknown[element]
    columns = np.broadcast_to(number[unknown[element, column]][:, None], rows.shape)
    values = elements[element, :, column]
    return coo_array(
        (values.ravel(), (rows.ravel(), columns.ravel())), shape=(mesh.unknowns, len(wanted))
    ).tocsc()


def mesh_and_factor(
    pair: GearPair,
    plane: str,
    sizes: Sizes,
    refinements: int,
    profiles: tuple[ToothProfile, ToothProfile] | None = None,
) -> tuple[Ring, Ring]:
    """Mesh, assemble, factorise and condense both gears.

    Parameters
    ----------
    pair : gears.GearPair
    plane : {"strain", "stress"}
    sizes : meshes.Sizes
    refinements : int
    profiles : tuple of gears.ToothProfile, optional
        Instead of the pair's own teeth: held at other radii.
    """
    from meshes import mesh_sector

    first, second = (
        ring_of(mesh_sector(profile, sizes, refinements), PlaneElasticity.of(material, plane))
        for profile, material in zip(profiles or pair.teeth_profiles, pair.materials, strict=True)
    )
    return first, second
