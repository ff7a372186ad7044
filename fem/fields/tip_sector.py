"""A loaded sector by itself, meshed finely at its tip corner: fields where a corner presses or cuts off a pressure.

Near a free corner a half-plane's field is wrong, and its correction varies over less than the elements of the ring.
So the strips' pressure is put on a separate sector as it is, with no singularity taken out; its cuts move as the
ring has them move under the same resultant, and its bore is held.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from base import Array, Integers, record
from fem.elasticity.line_load import FlankPoints, flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.elasticity.recovery import nodal_stress
from fem.laws.tip_pressure import TipPressure
from meshes import SectorMesh, Sizes, mesh_sector

if TYPE_CHECKING:
    from gears import ToothProfile

__all__ = ["TipSector", "carried", "tip_sector"]

GAUSS_POINTS = 3
"""Of each strip."""

CORNER, GROWTH, LEAST = 0.1, 0.2, 1e-3
"""Edge length at the corner over the contact's extent, its growth away from there, and its smallest size [modules]."""


@record
class TipSector:
    """A tooth with its pressure.

    Attributes
    ----------
    mesh : SectorMesh
    pressure : TipPressure
    """

    mesh: SectorMesh
    pressure: TipPressure

    def solved(self, law: PlaneElasticity, ring: SectorMesh, moved_by_ring: Array) -> tuple[Array, Array]:
        """Displacement (n, 2) [m] and stress (n, 3) [Pa] at the nodes.

        Parameters
        ----------
        law : PlaneElasticity
        ring : SectorMesh
            The ring's mesh of this sector.
        moved_by_ring : (nodes, 2) array
            Displacements of its nodes, those of the cuts alone being asked for [m].
        """
        from scipy.sparse.linalg import splu

        mesh = self.mesh
        moved, held = np.zeros((len(mesh.points), 2)), np.zeros(len(mesh.points), dtype=bool)
        held[np.unique(mesh.facets["bore"])] = True
        for side in ("right", "left"):
            nodes = mesh.side_nodes(side)
            moved[nodes], held[nodes] = carried(moved_by_ring, ring, mesh, side), True
        stiffness = stiffness_matrix(mesh.points, mesh.triangles, law, mesh.thickness)
        force = self._forces().ravel() - stiffness @ moved.ravel()
        free = np.flatnonzero(~np.repeat(held, 2))
        inner = stiffness[free][:, free].tocsc()
        factor = splu(
            inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )
        whole = moved.ravel()
        whole[free] = factor.solve(force[free])
        recovery = nodal_stress(mesh, law)
        stress = (recovery.matrix @ whole).reshape(-1, 3)
        on_flank = recovery.curves["flank_left"]
        pull = np.zeros_like(recovery.tangents)
        pull[on_flank] = self._tractions(recovery.nodes[on_flank])
        stress += recovery.by_tractions(len(mesh.points), pull, law)
        return whole.reshape(-1, 2), stress

    def _places(self, distance: Array) -> FlankPoints:
        end = float(np.max(self.mesh.parameters["flank_left"]))
        return flank_points(self.mesh, np.sqrt(2 * self.mesh.base_radius * (end - distance)))

    def _forces(self) -> Array:
        """Consistent nodal forces (n, 2) [N/m]."""
        strips = self.pressure
        place, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
        at = self._places((strips.distance[:, None] + 0.5 * strips.width[:, None] * place).ravel())
        lean = np.repeat(strips.lean, GAUSS_POINTS)[:, None]
        direction = np.cos(lean) * at.inward - np.sin(lean) * at.towards_tip().direction
        size = (strips.loads[:, None] * 0.5 * weight).ravel()
        forces = np.zeros((len(self.mesh.points), 2))
        np.add.at(forces, at.nodes, (size[:, None] * at.weights)[..., None] * direction[:, None])
        return forces

    def _tractions(self, nodes: Integers) -> Array:
        """Tractions (k, 2) [Pa] at nodes of the flank: means over half the way to the next ones on either side."""
        strips, base = self.pressure, self.mesh.base_radius
        end = float(np.max(self.mesh.parameters["flank_left"]))
        distance = end - 0.5 * (np.sum(self.mesh.points[nodes] ** 2, axis=1) - base**2) / base
        order = np.argsort(distance)
        s = np.maximum(distance[order], 0.0)
        middle = np.concatenate([s[:1], 0.5 * (s[1:] + s[:-1]), s[-1:]])
        edges = np.append(strips.distance - 0.5 * strips.width, strips.extent)
        borne = np.diff(np.interp(middle, edges, np.append(0.0, np.cumsum(strips.loads))))
        pressure = np.empty_like(s)
        pressure[order] = borne / np.diff(middle)
        at = self._places(np.maximum(distance, 0.0))
        lean = np.interp(distance, strips.distance, strips.lean)[:, None]
        direction = np.cos(lean) * at.inward - np.sin(lean) * at.towards_tip().direction
        return np.asarray(pressure[:, None] * direction)


def carried(values: Array, known: SectorMesh, asked: SectorMesh, side: str) -> Array:
    """Values at a cut's nodes (side, k) of one mesh from those at the nodes (n, k) of another one of the sector."""
    from scipy.interpolate import PchipInterpolator

    there, here = known.side_nodes(side), asked.side_nodes(side)
    radius = np.linalg.norm(known.points[there], axis=1)
    return np.asarray(
        PchipInterpolator(radius, values[there])(
            np.clip(np.linalg.norm(asked.points[here], axis=1), radius[0], radius[-1])
        )
    )


def tip_sector(profile: ToothProfile, sizes: Sizes, refinements: int, pressure: TipPressure) -> TipSector:
    """Mesh the sector of a tooth as finely at its tip corner as a pressure asks for.

    Parameters
    ----------
    profile : gears.ToothProfile
        Held at the same radius as the ring.
    sizes : Sizes
        Of the ring's mesh.
    refinements : int
        Of the ring's mesh.
    pressure : TipPressure
    """
    wished = max(CORNER * pressure.extent / profile.module, LEAST)
    fine = replace(sizes, corner=min(sizes.corner, wished), growth=min(sizes.growth, GROWTH))
    return TipSector(mesh_sector(profile, fine, refinements), pressure)
