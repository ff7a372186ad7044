"""Rims on webs against CalculiX: deflection under a Hertz pressure and the greatest stress at the root.

Nothing is shared but the geometry: the pressure itself on a fine mesh of the whole wheel with sections of their own
thickness, and nodal stresses that CalculiX averages, against the loads that take the singularity out, on a coarse
sector, and the influence functions of the fillets.

Skipped where ccx is not installed, unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import subprocess
from dataclasses import replace

import numpy as np
import pytest

import fem
from fem.elasticity.flamant import hertz_half_width, hertz_indentation
from fem.elasticity.line_load import flank_points
from fem.elasticity.plane_elasticity import PlaneElasticity, reduced_modulus
from fem.fields.export import write_abaqus
from fem.fields.loaded_gears import FlankForce, LoadedGear, nodal_forces
from gears import Blank, Gear, GearPair
from meshes import Sizes, gear_mesh, mesh_sector
from tests.validation.test_fem_calculix import CCX, pytestmark  # noqa: F401

M, WIDTH, LINE_LOAD = 2e-3, 0.02, 2e5


def solved_by_calculix(gear, folder):
    """Displacements (nodes, 2) and stresses (nodes, 2, 2) that ccx writes for a gear."""
    deck = write_abaqus(folder / "deck.inp", gear)
    text = deck.read_text(encoding="ascii")
    for name in ("*NODE FILE", "*EL FILE"):
        text = text.replace(name, f"{name}, OUTPUT=2D")
    deck.write_text(text, encoding="ascii")
    done = subprocess.run(
        [CCX, deck.stem], cwd=folder, capture_output=True, text=True, timeout=280, check=False
    )
    assert done.returncode == 0, done.stdout[-2000:]
    found, field = {"DISP": {}, "STRESS": {}}, None
    for line in (folder / "deck.frd").read_text(encoding="ascii").splitlines():
        if line.startswith(" -4"):
            field = found.get(line.split()[1])
        elif line.startswith(" -3"):
            field = None
        elif line.startswith(" -1") and field is not None:
            field[int(line[3:13])] = [float(line[i : i + 12]) for i in range(13, len(line.rstrip()), 12)]
    order = range(1, len(gear.mesh.points) + 1)
    moved = np.array([found["DISP"][k][:2] for k in order])
    xx, yy, _, xy = np.array([found["STRESS"][k][:4] for k in order]).T
    return moved, np.stack([xx, xy, xy, yy], axis=1).reshape(-1, 2, 2)


@pytest.mark.slow
@pytest.mark.parametrize(("rim", "web"), [(2.7, 0.3), (1.35, 0.2)], ids=["rim 1.2 depths", "rim 0.6 depths"])
def test_deflection_and_root_stress(tmp_path, rim, web):
    blank = Blank(rim * M, web * WIDTH, hub_radius=0.018)
    pair = GearPair(Gear(25), Gear(50, bore_radius=0.012, blank=blank), M, WIDTH)
    profile, rho = pair.teeth_profiles[1], pair.line_of_action - pair.points.B
    radius = pair.path_at(pair.points.B).radius
    a = float(np.ravel(hertz_half_width(LINE_LOAD, radius, reduced_modulus(pair, "strain")))[0])

    usual = mesh_sector(profile, refinements=1)
    fine = mesh_sector(profile, Sizes(flank=0.04), refinements=1)
    mesh = gear_mesh(usual, others={0: fine})
    law = PlaneElasticity.of(pair.materials[1], "strain")
    force = nodal_forces(profile, {0: fine}, mesh, [FlankForce(0, rho, LINE_LOAD, a)]) * WIDTH
    gear = LoadedGear("wheel", mesh, np.zeros(2), law, WIDTH, force)
    moved, stress = solved_by_calculix(gear, tmp_path)

    bodies = fem.compliance(pair)
    own = float(bodies.wheel.own(np.array([rho]))[0]) + hertz_indentation(a, bodies.wheel.law, M)
    at = flank_points(fine, np.array([rho]))
    nodes = mesh.nodes[0]
    there = float(at.component(moved[nodes])[0]) / LINE_LOAD
    root = np.unique(np.concatenate([fine.facets[f"{name}_left"] for name in ("root", "fillet")]))
    theirs = np.linalg.eigvalsh(stress[nodes[root]]).max() / LINE_LOAD
    mine = fem.fillets(pair, 0.005).wheel.stress(0, np.array([rho]))[0, 0].max()
    print(f"deflection {own:.6g} and {there:.6g} m/(N/m), {own / there - 1:.2e} apart")
    print(f"root stress {mine:.6g} and {theirs:.6g} 1/m, {mine / theirs - 1:.2e} apart")
    assert own == pytest.approx(there, rel=5e-4)
    assert mine == pytest.approx(theirs, rel=0.005)
    # and the web matters: a disc on the same bore is neither
    disc = replace(pair, wheel=replace(pair.wheel, blank=None))
    stiff = float(fem.compliance(disc).wheel.own(np.array([rho]))[0]) + hertz_indentation(a, law, M)
    assert there > 1.1 * stiff
