"""A helical gear with free ends under a line load, solved by CalculiX in three dimensions.

CalculiX knows nothing of coordinates that turn: our plane mesh is placed in space layer by layer, each turned by the
helix, as 15-node wedges. The load stands on the line of one node of a flank, which turns with the section, along the
surface's normal. Both have the same mesh of the section, so that the singular displacement under the load is the same.

Skipped where ccx is not installed (Debian: apt-get install calculix-ccx), unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import legendre

from fem.elasticity.free_ends import half_face
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity
from fem.elasticity.prism import prism
from fem.elasticity.section import Face, section
from fem.influence.gear_face import section_of
from fem.influence.gear_shape import MeshedShape, shapes
from fem.influence.helix_ends import helix_ends
from fem.influence.helix_waves import helix_harmonics
from gears import STEEL, Gear, GearPair
from meshes import Sizes, gear_mesh, mesh_sector
from tests.even_helices import by_ends, of_half_space, without_ends
from tests.validation.helical_solid import turned
from tests.validation.wedges import CCX, REQUIRED, displacements, heights_of, line_forces, wedges

pytestmark = [
    pytest.mark.slow,
    pytest.mark.long,
    pytest.mark.skipif(
        CCX is None and not REQUIRED, reason="ccx is not installed: apt-get install calculix-ccx"
    ),
]

MODULE, WIDTH, TEETH = 2e-3, 8e-3, 12
GEAR = Gear(teeth=TEETH, profile_shift=0.4, bore_radius=6e-3)
PAIR = GearPair(GEAR, GEAR, MODULE, WIDTH, material=STEEL)
LAW = PlaneElasticity.of(STEEL, "strain")
SIZES = Sizes(flank=0.5, fillet=0.5, root=0.6, corner=0.8, top=2.0, rim=2.0, layer_growth=2.0)


@pytest.mark.parametrize(("degrees", "within"), [(0.0, 3e-4), (15.0, 5e-4), (-30.0, 2e-3)])
def test_a_line_load_on_a_gear_with_free_ends(tmp_path, degrees, within):
    profile = PAIR.teeth_profiles[0]
    twist = np.tan(np.radians(degrees)) / profile.base_radius
    sector = mesh_sector(profile, SIZES)
    ends = np.unique(sector.facets["flank_left"][:, :2])
    radius = np.linalg.norm(sector.points[ends], axis=1)
    best = int(np.argmin(np.abs(radius - profile.reference_radius)))
    at = flank_points(sector, np.array([np.sqrt(radius[best] ** 2 - profile.base_radius**2)]))
    mine, theirs = ours(sector, twist, at), calculix(sector, int(ends[best]), twist, at, tmp_path)
    print(f"{degrees} degrees: twice the energy {1e9 * mine:.4f} against {1e9 * theirs:.4f} nm N")
    assert mine == pytest.approx(theirs, rel=within)
    parts = without_ends_and_ends(twist, float(at.rho[0]))
    print(f"without ends {1e9 * parts[0]:.4f}, with what free ends add {1e9 * sum(parts):.4f} nm N")
    assert sum(parts) == pytest.approx(theirs, rel=0.01)


def without_ends_and_ends(twist, rho):
    """Twice the energy by 1 N/mm, of a gear without ends and what free ends add [N m]; nodal forces on this mesh."""
    meshed = MeshedShape(shapes(PAIR, PAIR.teeth_profiles, "strain")[0], Sizes(), 1)
    turn, place, width = twist * MODULE, rho / MODULE, WIDTH / MODULE
    endless = without_ends(helix_harmonics(meshed, turn), meshed, place, width)
    endless -= of_half_space(section_of(meshed, SIZES, 0, turn), meshed.shape, place)
    ends = by_ends(helix_ends(meshed, turn, width), place, width)
    unit = 1e6 * WIDTH / LAW.plane_modulus
    return unit * endless, unit * ends


def ours(sector, twist, at):
    """Twice the energy by 1 N/mm along the whole face [N m]."""
    whole = half_face(WIDTH, MODULE, last=0.5, growth=1.0)
    count = len(whole.mass)
    functions = np.ix_(*2 * [np.tile(np.arange(count), 2)])
    face = Face(count, count, *(table[functions] for table in (whole.mass, whole.mixed, whole.stiffness)))
    own, _ = prism(section(sector, LAW, twist), face).influence(at, 0)
    s, share = legendre.leggauss(4)
    middle, reach = 0.5 * (whole.ends[1:] + whole.ends[:-1]), 0.5 * np.diff(whole.ends)
    even = whole.values((middle[:, None] + reach[:, None] * s).ravel()) @ (reach[:, None] * share).ravel()
    return 1e6 * float(even @ own[0] @ even)


def calculix(sector, node, twist, at, folder):
    """The same by CalculiX."""
    mesh = gear_mesh(sector, range(-(TEETH // 2), TEETH - TEETH // 2), {})
    loaded, levels = int(mesh.nodes[0][node]), np.linspace(0.0, WIDTH, 9)
    count, heights = len(mesh.points), heights_of(levels)
    elements = wedges(mesh.triangles, count, len(levels) - 1)
    used = np.unique(elements)
    points = np.concatenate(
        [turned(np.column_stack([mesh.points, np.full(count, z)]), twist * z) for z in heights]
    )
    bore = used[np.isin(used % count, np.unique(mesh.facets["bore"]))]
    (x, y), (d_x, d_y) = mesh.points[loaded], at.inward[0]
    # across the flank's profile and the line that the helix draws
    normal = np.cross([-d_y, d_x, 0.0], [-twist * y, twist * x, 1.0])
    normal *= np.sign(normal[:2] @ at.inward[0]) / np.linalg.norm(normal)
    on_line = np.arange(len(heights)) * count + loaded

    def density(z):
        return 1e3 * np.array([turned(normal[None], twist * place)[0] for place in z])

    forces = line_forces(levels, density)
    moved = displacements(folder, "helix", points, elements, LAW, {"BORE": (bore, "1, 3")}, (on_line, forces))
    return float(np.sum(forces * moved))
