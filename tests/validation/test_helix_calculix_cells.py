"""Cells of oblique lines of contact on a helical gear with free ends, against CalculiX in three dimensions.

One cell is loaded; what the other cells of its line and those of lines on both neighbours yield is observed. Our
answer is that of waves along an endless body and of what free ends add; CalculiX has 15-node wedges on a mesh of its
sector, turned layer by layer. The loaded cell and those beside it are left out: there the wedges are too coarse.

Skipped where ccx is not installed (Debian: apt-get install calculix-ccx), unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import numpy as np
import pytest

from base import Array, Integers
from fem.elasticity.flank_samples import sample_places
from fem.elasticity.line_load import flank_points
from fem.influence.gear_shape import MeshedShape, shapes
from fem.influence.helix_ends import helix_ends
from fem.influence.helix_lines import ContactLine, along_line, between_lines
from fem.influence.helix_waves import helix_harmonics
from meshes import Sizes, gear_mesh, mesh_sector
from tests.even_helices import in_plane
from tests.validation.test_helix_calculix import LAW, MODULE, PAIR, TEETH, turned
from tests.validation.wedges import CCX, REQUIRED, displacements, heights_of, wedges

pytestmark = [
    pytest.mark.slow,
    pytest.mark.long,
    pytest.mark.skipif(
        CCX is None and not REQUIRED, reason="ccx is not installed: apt-get install calculix-ccx"
    ),
]

WIDTH, CELLS, LAYERS = 12e-3, 8, 14
BASE_RADIUS = PAIR.teeth_profiles[0].base_radius
SIZES = Sizes(flank=0.35, fillet=0.5, root=0.6, corner=0.5, top=2.0, rim=2.0, layer_growth=2.0)


class Solid:
    """The sector's mesh in space: layers of wedges, each turned by the helix, z from 0 to the face width [m]."""

    def __init__(self, twist: float) -> None:
        self.twist = twist
        self.sector = mesh_sector(PAIR.teeth_profiles[0], SIZES)
        self.mesh = gear_mesh(self.sector, range(-(TEETH // 2), TEETH - TEETH // 2), {})
        self.levels = np.linspace(0.0, WIDTH, LAYERS + 1)

    def answer(self, folder, forces: Array) -> Array:
        """Displacements of all nodes by nodal forces (nodes, 3)."""
        plane, count = self.mesh.points, len(self.mesh.points)
        elements = wedges(self.mesh.triangles, count, LAYERS)
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
        moved[used] = displacements(folder, "cells", points, elements, LAW, held, (used, forces[used]))
        return moved

    def cell(self, line: ContactLine, number: int) -> Array:
        """Nodal forces (nodes, 3) of 1 N that is even over a cell of a line, along the common normal."""
        s, weight = np.polynomial.legendre.leggauss(12)
        z = MODULE * (line.z[number] + 0.5 * line.length * s) + 0.5 * WIDTH
        rho = MODULE * line.rho[number] + BASE_RADIUS * self.twist * 0.5 * MODULE * line.length * s
        at = flank_points(self.sector, rho)
        count = len(self.mesh.points)
        forces = np.zeros(((2 * LAYERS + 1) * count, 3))
        for q, share in enumerate(0.5 * weight):
            nodes, parts = self.serendipity(self.mesh.nodes[line.tooth][at.nodes[q]], at.weights[q], z[q])
            lean = -self.twist * (at.points[q, 0] * at.inward[q, 1] - at.points[q, 1] * at.inward[q, 0])
            normal = np.array([*at.inward[q], lean]) / np.hypot(1.0, lean)
            angle = self.twist * z[q] + 2.0 * np.pi * line.tooth / TEETH
            np.add.at(forces, nodes, share * parts[:, None] * turned(normal[None], angle))
        return forces

    def serendipity(self, edge: Integers, weights: Array, z: float) -> tuple[Integers, Array]:
        """Nodes of a wedge's side and their shape functions at a place of an edge of the section, and at z."""
        layer = min(int(np.searchsorted(self.levels, z, side="right")) - 1, LAYERS - 1)
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
            nodes.append(node + (LAYERS + 1 + layer) * count)
            parts.append(0.5 * (1.0 + xi * end) * (1.0 - eta**2))
        return np.array(nodes), np.array(parts)


def oblique(twist, span, tooth, away):
    """Cells of a line of contact, `away` from the middle of the flank at mid-face, as far as flank and face go."""
    slope = BASE_RADIUS * twist
    middle = 0.5 * (span[0] + span[1]) + away * (span[1] - span[0])
    z = np.clip(np.sort((np.array(span) - middle) / slope), -0.5 * WIDTH, 0.5 * WIDTH)
    length = (z[1] - z[0]) / CELLS
    at = z[0] + length * (np.arange(CELLS) + 0.5)
    return ContactLine(tooth, at / MODULE, (middle + slope * at) / MODULE, length / MODULE)


def ours(twist, lines, loaded):
    """Displacements of all cells by 1 N on one of the first line (lines, cells) [m]."""
    meshed = MeshedShape(shapes(PAIR, PAIR.teeth_profiles, "strain")[0], Sizes(), 1)
    waves = helix_harmonics(meshed, twist * MODULE, 1)
    ends = helix_ends(meshed, twist * MODULE, WIDTH / MODULE)
    first, moved = lines[0], []
    for line in lines:
        if line is first:
            endless = along_line(waves, meshed.shape.poisson, first, in_plane(meshed, first.rho))
        else:
            endless = between_lines(waves, first, line)
        moved.append((endless + ends.between(first, line))[loaded] / first.length)
    return np.array(moved) / (LAW.plane_modulus * MODULE)


@pytest.mark.parametrize(("degrees", "within"), [(8.0, 0.005), (25.0, 0.01)])
def test_cells_of_a_line_and_of_both_neighbours(tmp_path, degrees, within):
    loaded = 2
    twist = np.tan(np.radians(degrees)) / BASE_RADIUS
    meshed = MeshedShape(shapes(PAIR, PAIR.teeth_profiles, "strain")[0], Sizes(), 1)
    span = sample_places(meshed.shape.profile, 5)[[0, -1]] * MODULE
    lines = [oblique(twist, span, tooth, away) for tooth, away in ((0, 0.0), (1, 0.3), (-1, -0.3))]
    solid = Solid(twist)
    moved = solid.answer(tmp_path, solid.cell(lines[0], loaded))
    theirs = np.array([[np.sum(moved * solid.cell(line, i)) for i in range(CELLS)] for line in lines])
    mine = ours(twist, lines, loaded)
    apart = np.abs(np.arange(CELLS) - loaded) > 1
    largest = theirs[0, apart].max()
    off = (mine - theirs) / largest
    print(f"{degrees} degrees, % of {1e9 * largest:.4f} nm: on the line {np.round(100 * off[0, apart], 3)},")
    print(f"on neighbours {np.round(100 * off[1:], 3).tolist()}")
    assert np.abs(off[0, apart]).max() < within
    assert np.abs(off[1:]).max() < 0.002
