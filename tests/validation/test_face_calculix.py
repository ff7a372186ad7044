"""Loads that vary along the face of a whole gear with free ends, solved by CalculiX in three dimensions.

CalculiX knows nothing of waves, rings and free ends: our plane mesh is extruded into 15-node wedges over half the face,
mid-face a plane of symmetry for loads that are equal on both halves, and of antisymmetry for opposite ones. A line load
q(z) stands on one line of nodes of a flank, as an elastic contact's does. Under it the displacement is singular, in
the section's plane strain as in three dimensions, so that

    u(z) = c q(z) + more(z),

with c the displacement by unit line load of the same plane mesh, leaves what the face adds: ``more``, which is what
``fem.contact.cell_matrix`` gives to a contact.

Skipped where ccx is not installed (Debian: apt-get install calculix-ccx), unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.sparse.linalg import splu

from fem import compliance
from fem.contact.cell_matrix import cell_matrix
from fem.contact.face_errors import ENDS_ERROR
from fem.elasticity.plane_elasticity import PlaneElasticity, stiffness_matrix
from fem.pair.face_setting import FaceSetting
from gears import STEEL, Gear, GearPair
from meshes import Sizes, gear_mesh, mesh_sector
from tests.validation.wedges import CCX, REQUIRED, displacements, heights_of, line_forces, wedges

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(
        CCX is None and not REQUIRED, reason="ccx is not installed: apt-get install calculix-ccx"
    ),
]

MODULE, WIDTH, TEETH, CELLS = 2e-3, 20e-3, 18, 64
GEAR = Gear(teeth=TEETH, bore_radius=7.75e-3)
PAIR = GearPair(GEAR, GEAR, MODULE, WIDTH, material=STEEL)
LAW = PlaneElasticity.of(STEEL, "strain")
COARSE = Sizes(flank=1.2, fillet=0.4, root=0.6, corner=0.6, top=2.0, rim=2.0, layer_growth=2.0)
FINE = Sizes(flank=0.4, fillet=0.4, root=0.6, corner=0.3, top=2.0, rim=2.0, layer_growth=2.0)
LAYERS = 1e-3 * np.array([3.0, 2.5, 2.0, 1.3, 0.8, 0.4])
"""Of half the face, from mid-face to the end."""


def plane_gear():
    """Mesh of the whole gear, a node near the pitch point, the inward normal there and its curvature radius."""
    profile = PAIR.teeth_profiles[0]
    plain, fine = (mesh_sector(profile, sizes) for sizes in (COARSE, FINE))
    mesh = gear_mesh(plain, range(-(TEETH // 2), TEETH - TEETH // 2), {0: fine})
    ends = np.unique(fine.facets["flank_left"][:, :2])
    radius = np.linalg.norm(fine.points[ends], axis=1)
    best = int(np.argmin(np.abs(radius - profile.reference_radius)))
    x, y = fine.points[ends[best]]
    angle = np.arctan2(x, y) + np.arccos(profile.base_radius / radius[best])
    normal = -np.array([-np.cos(angle), np.sin(angle)])
    rho = float(np.sqrt(radius[best] ** 2 - profile.base_radius**2))
    return mesh, mesh.nodes[0][ends[best]], normal, rho


def by_unit_load(mesh, loaded, normal):
    """c of the section in plane strain [m per N/m]."""
    free = np.setdiff1d(np.arange(len(mesh.points)), np.unique(mesh.facets["bore"]))
    free = np.ravel(2 * free[:, None] + np.arange(2))
    force = np.zeros_like(mesh.points)
    force[loaded] = normal
    stiffness = stiffness_matrix(mesh.points, mesh.triangles, LAW, mesh.thickness).tocsc()
    moved = splu(stiffness[free][:, free]).solve(force.ravel()[free])
    return float(force.ravel()[free] @ moved)


def calculix(mesh, loaded, normal, load, folder):
    """Displacements along the normal of the loaded line's nodes, and their z, by a load q(z) on half the face."""
    levels = np.concatenate([[0.0], np.cumsum(LAYERS)])
    count, heights = len(mesh.points), heights_of(levels)
    elements = wedges(mesh.triangles, count, len(LAYERS))
    used = np.unique(elements)
    points = np.column_stack([np.tile(mesh.points, (len(heights), 1)), np.repeat(heights, count)])
    on_line = np.arange(len(heights)) * count + loaded
    held = {
        "BORE": (used[np.isin(used % count, np.unique(mesh.facets["bore"]))], "1, 3"),
        "MIDDLE": (used[used < count], "1, 2" if load is odd else "3, 3"),
    }
    forces = line_forces(levels, load)[:, None] * np.append(normal, 0.0)
    moved = displacements(folder, load.__name__, points, elements, LAW, held, (on_line, forces))
    order = np.argsort(heights)
    return heights[order], (moved[:, :2] @ normal)[order]


def ours(rho, load, model="free-ends"):
    """What the face adds between cells by a load q(z) on the whole face, at middles of cells: z and [m]."""
    face, bodies = FaceSetting(CELLS, model=model), compliance(PAIR, 0.005)
    middles = face.middles(WIDTH)
    both = cell_matrix(face, bodies, np.full((2, 1, 1), rho), np.zeros((1, 1, 1)))[0]
    return middles, 0.5 * both @ (load(middles) * WIDTH / CELLS)


def even(z):
    return np.ones_like(z)


def odd(z):
    return 2 * z / WIDTH


def crowned(z):
    return 1.5 * (1 - (2 * z / WIDTH) ** 2)


@pytest.mark.parametrize("load", [even, odd, crowned])
def test_what_the_face_adds_to_one_gear(tmp_path, load):
    """Within what the error of free ends is said to be, and the waves' tolerance."""
    mesh, loaded, normal, rho = plane_gear()
    c = by_unit_load(mesh, loaded, normal)
    z, moved = calculix(mesh, loaded, normal, load, tmp_path)
    (middles, found), (_, walls) = ours(rho, load), ours(rho, load, "walls")
    half = middles > 0.0
    there = CubicSpline(z, moved - c * load(z))(middles[half])
    off = np.abs(found[half] - there).max()
    ends, waves = np.abs(found - walls).max(), np.abs(walls).max()
    print(
        f"{load.__name__}: the face adds {np.abs(there).max() / c:.4f} of c, free ends {ends / c:.4f}; "
        f"largest difference {off / c:.5f} of c, without free ends {np.abs(walls[half] - there).max() / c:.4f}"
    )
    assert off < ENDS_ERROR * ends + 0.005 * waves
    assert off < 0.01 * c
