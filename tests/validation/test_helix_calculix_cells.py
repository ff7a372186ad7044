"""Cells of oblique lines of contact on a helical gear with free ends, against CalculiX in three dimensions.

One cell is loaded; what the other cells of its line and those of lines on both neighbours yield is observed. Our
answer is that of waves along an endless body and of what free ends add; CalculiX has 15-node wedges on a mesh of its
sector, turned layer by layer. The loaded cell and those beside it are left out: there the wedges are too coarse.

Skipped where ccx is not installed (Debian: apt-get install calculix-ccx), unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import numpy as np
import pytest

from fem.elasticity.flank_samples import sample_places
from fem.influence.gear_shape import MeshedShape, shapes
from fem.influence.helix_ends import helix_ends
from fem.influence.helix_lines import ContactLine, along_line, between_lines
from fem.influence.helix_waves import helix_harmonics
from meshes import Sizes
from tests.even_helices import in_plane
from tests.validation.helical_solid import HelicalSolid
from tests.validation.test_helix_calculix import LAW, MODULE, PAIR
from tests.validation.wedges import CCX, REQUIRED

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
    solid = HelicalSolid(PAIR.teeth_profiles[0], LAW, SIZES, MODULE, WIDTH, twist, LAYERS)
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
