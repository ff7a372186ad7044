"""Loads on three lines of contact of a helical pair, with both bodies solved by CalculiX in three dimensions.

Equal gears of 12 teeth, a helix of 30 degrees, 8 modules wide, in the position that is its own mirror: one line through
the pitch point at mid-face, one that enters and one that leaves. Every cell of the three lines is loaded in turn on
15-node wedges in space (``tests/validation/helical_solid.py``) and the displacements of all cells along the common
normal are observed. In this position the wheel is the pinion turned end for end, so that one solid serves both. What
nodal forces lack beside their line is that of the same mesh in the plane, the local law is Hertz's; nothing of waves
and free ends is used. Our own compliance and that of the solids go into the same contact problem.

Elements of 0.8 by 1 mm do not resolve a load of 1.2 to 2 mm at itself: what nodal forces lack is known for even loads
alone, not beside the end of a cell or of the face. So loads are given with the solids' answer everywhere, with ours for
a cell at itself, and with ours for its neighbours too.

Run from the root with

    PYTHONPATH=. python benchmarks/studies/helix_three_lines.py FILE.npz

(a quarter of an hour of processor time and 3 GB; needs ccx). What is solved is kept in FILE.npz, and a study that was
cut off goes on there.
"""

from __future__ import annotations

import argparse
import tempfile
from math import radians
from pathlib import Path

import numpy as np
from scipy.optimize import root

from base import Array
from fem import PairCompliance, compliance
from fem.contact.contact_sides import one_side
from fem.contact.line_contact import LineContact, lines_compliance
from fem.contact.loaded_flanks import loaded_flanks
from fem.contact.solver import solve_contact
from fem.influence.gear_face import section_of
from fem.influence.helix_lines import ContactLine
from fem.laws.corner_laws import CornerLaws
from fem.laws.line_candidates import LineCells
from fem.laws.mesh_setup import MeshSetup
from fem.pair.face_setting import FaceSetting, face_setting
from fem.pair.line_compliance import gear_lines
from gears import Gear, GearPair
from meshes import Sizes
from tests.even_helices import of_half_space
from tests.validation.helical_solid import HelicalSolid

PAIR = GearPair(*2 * [Gear(12, profile_shift=0.4, bore_radius=6e-3)], 2e-3, 0.016, helix_angle=radians(30.0))
CELLS, LAYERS, LOADS = 8, 16, (20e3, 100e3, 300e3)
"""Cells on the whole face, layers of wedges, forces per face width [N/m]."""

WITHIN = 16
"""Places of a cell at which nodal forces are compared with those of the plane: it crosses several edges of the mesh."""

SIZES = Sizes(flank=0.4, fillet=0.5, root=0.6, corner=0.5, top=2.0, rim=2.0, layer_growth=2.0)


def in_contact(bodies: PairCompliance, face: FaceSetting, force: Array) -> tuple[LineContact, Array]:
    """The contact in the position that is its own mirror, and the forces on its cells (loads, n) [N]."""
    position = 0.5 * PAIR.contact_ratio % 1.0
    setup = MeshSetup(PAIR, 1, False, face=face).at(np.array([position]))
    state = solve_contact(setup, bodies, force, None)
    flanks = loaded_flanks(setup, bodies, None, 0.6, CornerLaws(setup, bodies))
    over = LineContact(bodies, force[:, None, None], one_side(setup, flanks))
    cells = over.lines.divided(face.cells)
    return over, state.contacts.forces.reshape(len(force), -1)[:, cells.used[0].ravel()]


def by_solids(over: LineContact, bodies: PairCompliance, cells: LineCells, file: Path) -> Array:
    """Compliance of both bodies between the cells (n, n) [m/N], but for the local law."""
    offset = over.sides.flanks[0].candidates.offset
    module, used = PAIR.module, [np.flatnonzero(row) for row in cells.used[0]]
    lines = [
        ContactLine(
            int(offset[i]),
            cells.z[0, i, row] / module,
            cells.rho[0, 0, i, row] / module,
            float(cells.length[0, i]) / module,
        )
        for i, row in enumerate(used)
        if len(row)
    ]
    law, twist = bodies.pinion.law, over.lines.slope / PAIR.base_radii[0]
    solid = HelicalSolid(PAIR.teeth_profiles[0], law, SIZES, module, PAIR.face_width, twist, LAYERS)
    places = [(line, i) for line in lines for i in range(len(line.z))]
    moved = np.load(file)["moved"] if file.exists() else np.full((len(places), len(places)), np.nan)
    for row, place in enumerate(places):
        if np.isnan(moved[row]).any():
            with tempfile.TemporaryDirectory() as folder:
                answer = solid.answer(Path(folder), solid.cell(*place))
            moved[row] = [np.sum(answer * solid.cell(*other)) for other in places]
            np.savez(file, moved=moved)
            print(f"{row + 1} of {len(places)} cells", flush=True)
    print(f"not reciprocal by {np.abs(moved - moved.T).max() / moved.max():.1e} of the largest")
    over_section = section_of(bodies.meshed[0], SIZES, 0, twist * module)
    inside = np.polynomial.legendre.leggauss(WITHIN)
    lacking = [
        sum(
            0.5 * share * of_half_space(over_section, bodies.meshed[0].shape, float(line.rho[i] + at))
            for at, share in zip(0.5 * over.lines.slope * line.length * inside[0], inside[1], strict=True)
        )
        / (law.plane_modulus * module * line.length)
        for line, i in places
    ]
    pinion = 0.5 * (moved + moved.T) + np.diag(lacking)
    return np.asarray(pinion + pinion[::-1, ::-1])


def shared(compliance_of: Array, over: LineContact, face: FaceSetting, whole: float) -> Array:
    """Forces on cells that touch all over under one compliance (n,) [N], by a root search of scipy."""
    used = over.lines.divided(face.cells).used[0].ravel()
    laws, count = over.laws(face), int(used.sum())
    cosine = PAIR.helix.base_cosine

    def rest(unknown: Array) -> Array:
        forces = np.zeros(len(used))
        forces[used] = np.abs(unknown[:-1]) * whole / count
        local = laws.value_and_slope(forces[None])[0][0][used]
        apart = (compliance_of @ forces[used] + local) / (whole / count) - unknown[-1] * 1e-8
        return np.append(apart / 1e-8, np.sum(forces) * cosine / whole - 1.0)

    start = np.append(np.ones(count), 1.0)
    found = root(rest, start, tol=1e-12)
    assert found.success, found.message
    assert np.all(found.x[:-1] > 0.0)
    return np.asarray(found.x[:-1] * whole / count)


def size(mine: Array, theirs: Array) -> float:
    """Root mean square difference over the mean [%]."""
    return 100.0 * float(np.sqrt(np.mean((mine - theirs) ** 2)) / theirs.mean())


def main(file: Path) -> None:
    bodies = compliance(PAIR, tolerance=0.01)
    face = face_setting(PAIR, None, CELLS, "free-ends", (None, None))
    assert face is not None
    force = np.array(LOADS) * PAIR.face_width
    over, product = in_contact(bodies, face, force)
    cells = over.lines.divided(face.cells)
    gears = gear_lines(bodies, over.lines.slope)
    offset = over.sides.flanks[0].candidates.offset.tolist()
    print("cells on each line:", cells.count[0].tolist(), "overlap", PAIR.overlap_ratio)
    ours = lines_compliance(bodies, gears, offset, cells, 0, 0.0)
    theirs = by_solids(over, bodies, cells, file)
    off, away = 1e9 * (ours - theirs), np.abs(np.subtract.outer(*2 * [np.arange(len(ours))]))
    print(
        f"beyond neighbours compliances differ by {off[away > 1].min():.3f} to {off[away > 1].max():.3f} nm/N"
    )
    for load, solved in zip(force.tolist(), product, strict=True):
        mine = shared(ours, over, face, load)
        assert size(mine, solved) < 1e-6
        print(
            f"{load / PAIR.face_width / 1e3:.0f} N/mm: root mean square difference of loads over their mean"
        )
        for name, reach in (("all by solids", -1), ("own cell by ours", 0), ("neighbours by ours too", 1)):
            solids = shared(np.where(away <= reach, ours, theirs), over, face, load)
            print(f"   {name}: {size(mine, solids):.2f} %")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("file", type=Path)
    main(parser.parse_args().file)
