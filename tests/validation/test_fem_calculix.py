"""The same meshes and loads solved by CalculiX (ccx), which knows nothing of our assembly.

CalculiX makes a layer of 15-node wedges of plane elements, ties their two faces, and integrates over three points
of the triangle. Our stiffness matrix with scikit-fem's three-point rule must therefore give the same displacements
to the digits that ccx prints (7). With our usual rule of higher order curved elements differ by their own error,
which is largest at the loaded nodes and falls with the mesh.

Skipped where ccx is not installed (Debian: apt-get install calculix-ccx), unless FLANKFILM_REQUIRE_CCX=1.
"""

from __future__ import annotations

import os
import shutil
import subprocess

import numpy as np
import pytest
from scipy.sparse.linalg import splu

import fem
import fem.elasticity.plane_elasticity
from fem.fields.export import write_abaqus
from fem.fields.loaded_gears import loaded_gears
from gears import Blank, Gear, GearPair

CCX = shutil.which("ccx")
REQUIRED = os.environ.get("FLANKFILM_REQUIRE_CCX") == "1"

pytestmark = pytest.mark.skipif(
    CCX is None and not REQUIRED, reason="ccx is not installed: apt-get install calculix-ccx"
)


def ours(gear):
    mesh = gear.mesh
    stiffness = fem.elasticity.plane_elasticity.stiffness_matrix(
        mesh.points, mesh.triangles, gear.law, mesh.thickness
    )
    stiffness = stiffness * gear.face_width
    free = np.ones(len(gear.mesh.points), dtype=bool)
    free[np.unique(gear.mesh.facets["bore"])] = False
    free = np.repeat(free, 2)
    solver = splu(stiffness[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    moved = np.zeros(stiffness.shape[0])
    moved[free] = solver.solve(gear.forces.ravel()[free])
    return moved.reshape(-1, 2)


def calculix(gear, folder):
    """Displacements and the bore's reactions that ccx prints for the deck of a gear."""
    assert CCX is not None, "FLANKFILM_REQUIRE_CCX=1, but there is no ccx on PATH"
    deck = write_abaqus(folder / "deck.inp", gear)
    done = subprocess.run(
        [CCX, deck.stem], cwd=folder, capture_output=True, text=True, timeout=200, check=False
    )
    assert done.returncode == 0, done.stdout[-2000:]
    assert "*ERROR" not in done.stdout, done.stdout[-2000:]
    moved = np.full((len(gear.mesh.points), 2), np.nan)
    for line in (folder / "deck.dat").read_text().splitlines():
        parts = line.split()
        if len(parts) == 4 and parts[0].isdigit():
            moved[int(parts[0]) - 1] = [float(part) for part in parts[1:3]]
        elif len(parts) == 3:
            reaction = np.array([float(part) for part in parts[:2]])
    return moved, reaction


def apart(a, b):
    """Largest difference of a component over the largest one, and the root mean square of the differences likewise."""
    largest, mean = np.abs(a - b).max() / np.abs(b).max(), float(np.linalg.norm(a - b) / np.linalg.norm(b))
    print(f"{len(a)} nodes: largest difference {largest:.1e}, root mean square {mean:.1e}")
    return largest, mean


@pytest.fixture(scope="module")
def cycles(article_pair):
    # 0.875 base pitches after A: one pair inside the path, and tip edges that touch
    cycles = {plane: fem.mesh_cycle(article_pair, 600.0, 4, plane=plane) for plane in ("strain", "stress")}
    assert np.any(cycles["strain"].forces[3][cycles["strain"].edge[3]] > 0)
    return cycles


@pytest.mark.parametrize("which", [0, pytest.param(1, marks=pytest.mark.slow)], ids=["pinion", "wheel"])
def test_whole_gear_with_the_same_quadrature(article_pair, cycles, tmp_path, monkeypatch, which):
    monkeypatch.setattr(fem.elasticity.plane_elasticity, "INTEGRATION", 2)
    gear = loaded_gears(article_pair, cycles["strain"], 3, refinements=0)[which]
    assert len(np.unique(gear.mesh.tooth)) == (36, 40)[which]
    moved, reaction = calculix(gear, tmp_path)
    largest, _ = apart(moved, ours(gear))
    assert largest < 1e-6
    np.testing.assert_allclose(reaction, -gear.forces.sum(axis=0), rtol=1e-6)


@pytest.mark.slow
def test_our_own_quadrature_differs_by_the_error_of_curved_elements(article_pair, cycles, tmp_path):
    differences = []
    for refinements in (0, 1):
        gear = loaded_gears(article_pair, cycles["strain"], 3, refinements=refinements, neighbours=2)[0]
        moved, _ = calculix(gear, tmp_path)
        differences.append(apart(moved, ours(gear)))
    (first, first_mean), (second, second_mean) = differences
    assert second < 1e-5
    assert second < 0.5 * first
    assert second_mean < 3e-6
    assert second_mean < 0.5 * first_mean


@pytest.mark.slow
def test_whole_refined_gear(article_pair, cycles, tmp_path):
    gear = loaded_gears(article_pair, cycles["strain"], 3, refinements=1)[0]
    moved, _ = calculix(gear, tmp_path)
    largest, mean = apart(moved, ours(gear))
    assert mean < 3e-6
    assert largest < 1.2e-5


def test_plane_stress(article_pair, cycles, tmp_path, monkeypatch):
    monkeypatch.setattr(fem.elasticity.plane_elasticity, "INTEGRATION", 2)
    gear = loaded_gears(article_pair, cycles["stress"], 3, refinements=0, neighbours=2)[0]
    moved, _ = calculix(gear, tmp_path)
    largest, mean = apart(moved, ours(gear))
    # its plane stress is a thin solid of free thickness, not exactly ours: 1e-4 at the load, less elsewhere
    assert largest < 5e-4
    assert mean < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize(("plane", "neighbours", "allowed"), [("strain", None, 1e-6), ("stress", 3, 5e-4)])
def test_rim_web_and_hub_by_sections_of_their_own_thickness(
    tmp_path, monkeypatch, plane, neighbours, allowed
):
    """Sets of elements with the thickness of rim, web and hub, as CalculiX makes solids of them."""
    monkeypatch.setattr(fem.elasticity.plane_elasticity, "INTEGRATION", 2)
    blank = Blank(rim_thickness=5.4e-3, web_thickness=6e-3, hub_radius=0.018)
    pair = GearPair(Gear(25), Gear(50, bore_radius=0.012, blank=blank), 2e-3, 0.02)
    cycle = fem.mesh_cycle(pair, 100.0, 4, plane=plane)
    gear = loaded_gears(pair, cycle, 1, refinements=0, neighbours=neighbours)[1]
    assert sorted(set(gear.mesh.thickness.tolist())) == [0.3, 1.0]
    moved, _ = calculix(gear, tmp_path)
    largest, _ = apart(moved, ours(gear))
    assert largest < allowed
