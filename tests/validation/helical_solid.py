"""A helical gear in space: 15-node wedges on the mesh of its sector, turned layer by layer; solved by CalculiX."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from base import Array, Integers
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.influence.helix_lines import ContactLine
from gears.tooth.profile import ToothProfile
from meshes import Sizes, gear_mesh, mesh_sector
from tests.validation.wedges import displacements, heights_of, wedges

__all__ = ["HelicalSolid", "turned"]


def turned(points: Array, angle: float) -> Array:
    """Points or vectors (n, 3) turned about z."""
    cos, sin = np.cos(angle), np.sin(angle)
    return np.asarray(points @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]))


class HelicalSolid:
    """Layers of wedges, each turned by the helix, z from 0 to the face width [m].

    Parameters
    ----------
    profile : ToothProfile
        Of the transverse section.
    law : PlaneElasticity
    sizes : Sizes
        Of the section's mesh.
    module, width : float
        [m]
    twist : float
        Turn of the section over z [1/m], above 0 for a right hand.
    layers : int
    """

    def __init__(
        self,
        profile: ToothProfile,
        law: PlaneElasticity,
        sizes: Sizes,
        module: float,
        width: float,
        twist: float,
        layers: int,
    ) -> None:
        self.law, self.module, self.width, self.twist, self.layers = law, module, width, twist, layers
        self.teeth, self.base_radius = profile.teeth, profile.base_radius
        self.sector = mesh_sector(profile, sizes)
        self.mesh = gear_mesh(self.sector, range(-(self.teeth // 2), self.teeth - self.teeth // 2), {})
        self.levels = np.linspace(0.0, width, layers + 1)

    def answer(self, folder: Path, forces: Array) -> Array:
        """Displacements of all nodes by nodal forces (nodes, 3)."""
        plane, count = self.mesh.points, len(self.mesh.points)
        elements = wedges(self.mesh.triangles, count, self.layers)
        points = np.concatenate(
            [
                turned(np.column_stack([plane, np.full(count, z)]), self.twist * z)
                for z in heights_of(self.levels)
            ]
        )
        used = np.unique(elements)
        bore = used[np.isin(used % count, np.unique(self.mesh.facets["bore"]))]
        held = {"BORE": (bore, "1, 3")}
        moved = np.zeros_like(points)
        moved[used] = displacements(folder, "cells", points, elements, self.law, held, (used, forces[used]))
        return moved

    def cell(self, line: ContactLine, number: int) -> Array:
        """Nodal forces (nodes, 3) of 1 N that is even over a cell of a line, along the common normal."""
        s, weight = np.polynomial.legendre.leggauss(12)
        z = self.module * (line.z[number] + 0.5 * line.length * s) + 0.5 * self.width
        along = 0.5 * self.module * line.length * s
        rho = self.module * line.rho[number] + self.base_radius * self.twist * along
        at = flank_points(self.sector, rho)
        count = len(self.mesh.points)
        forces = np.zeros(((2 * self.layers + 1) * count, 3))
        for q, share in enumerate(0.5 * weight):
            nodes, parts = self.serendipity(self.mesh.nodes[line.tooth][at.nodes[q]], at.weights[q], z[q])
            lean = -self.twist * (at.points[q, 0] * at.inward[q, 1] - at.points[q, 1] * at.inward[q, 0])
            normal = np.array([*at.inward[q], lean]) / np.hypot(1.0, lean)
            angle = self.twist * z[q] + 2.0 * np.pi * line.tooth / self.teeth
            np.add.at(forces, nodes, share * parts[:, None] * turned(normal[None], angle))
        return forces

    def serendipity(self, edge: Integers, weights: Array, z: float) -> tuple[Integers, Array]:
        """Nodes of a wedge's side and their shape functions at a place of an edge of the section, and at z."""
        layer = min(int(np.searchsorted(self.levels, z, side="right")) - 1, self.layers - 1)
        low, high = self.levels[layer : layer + 2]
        xi, eta, count = weights[1] - weights[0], 2.0 * (z - low) / (high - low) - 1.0, len(self.mesh.points)
        nodes, parts = [], []
        for k, side in ((layer, -1.0), (layer + 1, 1.0)):
            up = 1.0 + eta * side
            for node, end in zip(edge[:2], (-1.0, 1.0), strict=True):
                nodes.append(node + k * count)
                parts.append(0.25 * (1.0 + xi * end) * up * (xi * end + eta * side - 1.0))
            nodes.append(edge[2] + k * count)
            parts.append(0.5 * (1.0 - xi**2) * up)
        for node, end in zip(edge[:2], (-1.0, 1.0), strict=True):
            nodes.append(node + (self.layers + 1 + layer) * count)
            parts.append(0.5 * (1.0 + xi * end) * (1.0 - eta**2))
        return np.array(nodes), np.array(parts)
