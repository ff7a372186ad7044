"""A sector is wrong if a named edge leaves its curve, an element turns over, or the area does not converge."""

from __future__ import annotations

import subprocess
import sys
import threading
import warnings

import numpy as np
import pytest

from base import InputError
from gears import BasicRack, Gear, GearPair
from meshes import Sizes, mesh_sector, refined
from meshes.gmsh_fill import triangulate
from tests.meshes.conftest import area, exact_area


def polar(points):
    return np.linalg.norm(points, axis=-1), np.arctan2(points[..., 0], points[..., 1])


@pytest.mark.parametrize("refinements", [0, 1])
def test_every_named_edge_lies_on_its_curve(profile, refinements):
    mesh = mesh_sector(profile, refinements=refinements)
    tiny = 1e-9 * profile.module
    for name, facets in mesh.facets.items():
        points = mesh.points[facets].reshape(-1, 2)
        r, angle = polar(points)
        if name == "bore":
            np.testing.assert_allclose(r, profile.bore_radius, rtol=1e-13)
        elif name == "top":
            np.testing.assert_allclose(r, profile.tip_radius, rtol=1e-13)
            assert np.all(np.abs(angle) <= profile.tip_half_angle + 1e-12)
        elif name.startswith("root"):
            np.testing.assert_allclose(r, profile.root_radius, rtol=1e-13)
        elif name.startswith("side"):
            np.testing.assert_allclose(np.abs(angle), 0.5 * profile.pitch_angle, rtol=0, atol=1e-12)
        else:  # fillet, flank, chamfer: the profile's own polar outline, which is another formula
            inside = np.clip(r, profile.root_radius * (1 + 1e-14), profile.tip_radius * (1 - 1e-14))
            off = (np.abs(angle) - profile.boundary_angle(inside)) * r
            # close to the root circle the outline's angle changes as the root of the radius
            allowed = np.where(r < profile.root_radius * (1 + 1e-9), 1e-4 * profile.module, tiny)
            assert np.all(np.abs(off) <= allowed), name
            assert np.all(np.sign(angle) == (1 if "right" in name else -1)), name


def test_flanks_run_from_form_circle_to_the_end_and_parameters_are_arc_lengths(profile):
    mesh = mesh_sector(profile)
    for side in ("left", "right"):
        arc = mesh.parameters[f"flank_{side}"]
        ends = np.array(profile.flank_rho) ** 2 / (2 * profile.base_radius)
        np.testing.assert_allclose([arc.min(), arc.max()], ends, rtol=1e-12, atol=1e-18)
        r, _ = polar(mesh.points[mesh.facets[f"flank_{side}"][:, :2]])
        np.testing.assert_allclose(
            (r**2 / profile.base_radius - profile.base_radius) / 2, arc, rtol=1e-6, atol=1e-12
        )


def test_outline_is_closed_once_and_bounds_the_triangles(profile):
    mesh = mesh_sector(profile)
    edges = np.concatenate([facets[:, :2] for facets in mesh.facets.values()])
    np.testing.assert_array_equal(np.sort(edges[:, 0]), np.sort(edges[:, 1]))
    corners = mesh.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    directed = {tuple(edge) for edge in corners.tolist()}
    free = {edge for edge in directed if edge[::-1] not in directed}
    assert free == {tuple(edge) for edge in edges.tolist()}  # also: material on the left of each edge


def test_middles_belong_to_their_edges(profile):
    mesh = mesh_sector(profile)
    for a, b, m in ((0, 1, 3), (1, 2, 4), (2, 0, 5)):
        p, q, middle = (mesh.points[mesh.triangles[:, k]] for k in (a, b, m))
        length = np.linalg.norm(q - p, axis=1)
        assert np.all(np.linalg.norm(middle - 0.5 * (p + q), axis=1) < 0.15 * length)


def test_area_converges_with_the_fourth_order_of_curved_edges(article_profile):
    wanted = exact_area(article_profile)
    mesh = mesh_sector(article_profile)
    errors = []
    for _ in range(3):
        errors.append(abs(area(mesh.points, mesh.triangles) / wanted - 1))
        mesh = refined(mesh)
    rates = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[0] < 1e-5
    assert np.all(rates > 3.5), (errors, rates)


def test_area_of_every_gear(profile):
    mesh = mesh_sector(profile, refinements=1)
    assert area(mesh.points, mesh.triangles) == pytest.approx(exact_area(profile), rel=2e-5)


def test_both_cuts_have_the_same_radii(profile):
    mesh = mesh_sector(profile, refinements=1)
    radii = [np.linalg.norm(mesh.points[mesh.side_nodes(side)], axis=1) for side in ("left", "right")]
    np.testing.assert_allclose(radii[0], radii[1], rtol=1e-12)


def test_refinement_keeps_the_nodes_of_the_coarser_mesh(article_profile):
    coarse = mesh_sector(article_profile)
    fine = refined(coarse)
    np.testing.assert_array_equal(fine.points[: len(coarse.points)], coarse.points)
    assert len(fine.triangles) == 4 * len(coarse.triangles)
    assert fine.coarser is coarse


def test_tip_corner_of_the_working_flank_is_fine(article_profile):
    for working, idle in (("left", "right"), ("right", "left")):
        mesh = mesh_sector(article_profile, working=working)
        shortest = {
            side: np.min(np.ptp(mesh.parameters[f"flank_{side}"], axis=1)) for side in (working, idle)
        }
        assert shortest[working] < 0.05 * article_profile.module < shortest[idle]


def test_sizes_that_make_no_sense_are_all_named():
    with pytest.raises(InputError) as caught:
        Sizes(flank=-1.0, corner=float("nan"), layer_growth=0.5)
    assert [fault.where for fault in caught.value.faults] == [
        "sizes.flank",
        "sizes.corner",
        "sizes.layer_growth",
    ]


def test_polygon_that_cuts_itself_never_reaches_gmsh():
    bow = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])
    with pytest.raises(InputError, match="cross"):
        triangulate(bow)
    with pytest.raises(InputError, match="nan"):
        triangulate(np.array([[0.0, 0.0], [np.nan, 1.0], [1.0, 0.0]]))


def test_meshing_works_outside_the_main_thread_and_side_by_side(article_profile):
    found = []
    threads = [threading.Thread(target=lambda: found.append(mesh_sector(article_profile))) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 3
    for mesh in found[1:]:
        np.testing.assert_array_equal(mesh.points, found[0].points)


def test_a_session_of_gmsh_that_the_caller_has_open_is_left_open(article_profile):
    import gmsh

    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.model.add("mine")
        mesh_sector(article_profile)
        assert gmsh.isInitialized()
        assert "mine" in gmsh.model.list()
    finally:
        gmsh.finalize()


def test_importing_the_packages_loads_nothing_heavy():
    code = (
        "import sys, meshes, fem; "
        "heavy = {'gmsh', 'meshio', 'pyvista', 'skfem', 'numba', 'matplotlib'} & set(sys.modules); "
        "sys.exit(', '.join(sorted(heavy)) or None)"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_a_closed_pipe_is_an_error_after_meshing_too():
    """gmsh sets SIGPIPE back to its default, which would end the process without a word."""
    code = (
        "import os\n"
        "from gears import Gear, GearPair\n"
        "from meshes import mesh_sector\n"
        "pair = GearPair(pinion=Gear(teeth=30), wheel=Gear(teeth=30), module=1e-3, face_width=0.01)\n"
        "mesh_sector(pair.teeth_profiles[0])\n"
        "reader, writer = os.pipe()\n"
        "os.close(reader)\n"
        "try:\n"
        "    os.write(writer, b'x')\n"
        "except BrokenPipeError:\n"
        "    print('told')\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "told\n"), done.stderr


def test_middles_of_a_fillet_that_runs_unevenly_are_in_the_middle():
    """Nine teeth with a small fillet: at the mean parameter a middle is 0.13 of the edge off, and an element folds."""
    gear = Gear(9, profile_shift=0.478846, bore_radius=5.57e-3)
    rack = BasicRack(0.83725, 1.08725, 0.14175)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        pair = GearPair(gear, Gear(40, profile_shift=-0.1747, tip_alteration=-0.1), 2e-3, 0.04, rack)
    for refinements in (0, 1, 2):
        mesh = mesh_sector(pair.teeth_profiles[0], refinements=refinements)
        first, last, middle = (mesh.points[nodes] for nodes in mesh.facets["fillet_left"].T)
        chord = last - first
        off = np.sum((middle - 0.5 * (first + last)) * chord, axis=1) / np.sum(chord**2, axis=1)
        assert np.abs(off).max() <= 0.1
