"""Files for other programs: gmsh's own reading of its format, and the text of an Abaqus deck read back."""

from __future__ import annotations

from dataclasses import replace

import gmsh
import meshio
import numpy as np
import pytest

from meshes import gear_mesh, mesh_sector
from meshes.abaqus import mesh_text, number, set_names
from meshes.msh import write_msh

SIDES = {1: (0, 1, 3), 2: (1, 2, 4), 3: (2, 0, 5)}


@pytest.fixture(scope="module")
def some_teeth(article_profile):
    return gear_mesh(mesh_sector(article_profile), teeth=range(-1, 2))


def sections(text):
    """Keyword lines and the rows of numbers or words after each."""
    found = []
    for line in text.splitlines():
        if line.startswith("*"):
            found.append((line, []))
        else:
            found[-1][1].append([part.strip() for part in line.split(",") if part.strip()])
    return dict(found)


def test_deck_reads_back_to_the_last_digit_that_a_deck_holds(some_teeth):
    found = sections(mesh_text({"": some_teeth}))
    nodes = np.array(found["*NODE"], dtype=float)
    np.testing.assert_array_equal(nodes[:, 0], 1 + np.arange(len(some_teeth.points)))
    np.testing.assert_allclose(nodes[:, 1:3], some_teeth.points, rtol=1e-13, atol=1e-30)
    elements = np.array(found["*ELEMENT, TYPE=CPE6"], dtype=int)
    np.testing.assert_array_equal(elements[:, 1:] - 1, some_teeth.triangles)


def test_deck_names_sets_and_surfaces(some_teeth):
    """Of two gears in one deck the second is numbered after the first."""
    found = sections(mesh_text({"W_": some_teeth, "P_": some_teeth}, "CPS6"))
    node, element = 1 + len(some_teeth.points), 1 + len(some_teeth.triangles)
    elements = np.array(found["*ELEMENT, TYPE=CPS6"], dtype=int)[element - 1 :]
    assert elements[0, 0] == element
    corners = dict(zip(elements[:, 0].tolist(), elements[:, 1:].tolist(), strict=True))
    names = set_names(some_teeth, "P_")
    assert {"P_FLANK_LEFT", "P_FLANK_LEFT_0", "P_FLANK_LEFT_MINUS_1", "P_TOP_1", "P_BORE"} <= names.keys()
    for name, (boundary, tooth) in names.items():
        edges = some_teeth.facets[boundary]
        if tooth is not None:
            edges = edges[some_teeth.facet_tooth[boundary] == tooth]
        # a surface names the same edges, first node, last node and middle in this order
        surface = [
            [corners[int(e)][k] - node for k in SIDES[int(side[1])]]
            for e, side in found[f"*SURFACE, NAME={name}, TYPE=ELEMENT"]
        ]
        np.testing.assert_array_equal(surface, edges)
        members = np.concatenate([np.array(row, dtype=int) for row in found[f"*NSET, NSET={name}"]])
        np.testing.assert_array_equal(members - node, np.unique(edges))
    teeth = np.concatenate([np.array(row, dtype=int) for row in found["*ELSET, ELSET=P_TOOTH_MINUS_1"]])
    np.testing.assert_array_equal(teeth - element, np.flatnonzero(some_teeth.tooth == -1))
    assert all(len(row) <= 16 for rows in found.values() for row in rows)


@pytest.mark.parametrize("value", [-1.234567890123456e-30, 2.06e11, 0.0, -1e-300, -9.876543210987654e98])
def test_numbers_fit_what_calculix_reads(value):
    assert len(number(value)) <= 20
    assert float(number(value)) == pytest.approx(value, rel=1e-13, abs=1e-99)


def test_gmsh_opens_its_mesh_with_names_and_the_same_bits(tmp_path, some_teeth):
    path = write_msh(tmp_path / "gear.msh", some_teeth)
    assert [p.name for p in tmp_path.iterdir()] == ["gear.msh"]
    gmsh.initialize(readConfigFiles=False, interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(path))
        model = gmsh.model
        groups = {model.getPhysicalName(*group): group for group in model.getPhysicalGroups()}
        tags, places, _ = model.mesh.getNodes()
        np.testing.assert_array_equal(tags, 1 + np.arange(len(some_teeth.points)))
        np.testing.assert_array_equal(places.reshape(-1, 3)[:, :2], some_teeth.points)
        assert groups.keys() == {*some_teeth.facets, "gear", "tooth -1", "tooth 0", "tooth 1"}

        def elements(name):
            found = [
                model.mesh.getElements(groups[name][0], e)
                for e in model.getEntitiesForPhysicalGroup(*groups[name])
            ]
            width = {1: 3, 2: 6}[groups[name][0]]
            return np.concatenate([nodes[0] for _, _, nodes in found]).astype(int).reshape(-1, width) - 1

        np.testing.assert_array_equal(elements("gear"), some_teeth.triangles)
        np.testing.assert_array_equal(elements("tooth 1"), some_teeth.triangles[some_teeth.tooth == 1])
        for name, edges in some_teeth.facets.items():
            assert {tuple(e) for e in elements(name)} == {tuple(e) for e in edges}
        # gmsh takes the middles where we put them: no element is worse than the flattest of ours
        quality = model.mesh.getElementQualities(model.mesh.getElementsByType(9)[0], "minDetJac")
        assert min(quality) > 0
    finally:
        gmsh.finalize()


def test_other_readers_agree(tmp_path, some_teeth):
    back = meshio.read(write_msh(tmp_path / "gear.msh", some_teeth))
    np.testing.assert_array_equal(back.points[:, :2], some_teeth.points)
    np.testing.assert_array_equal(back.get_cells_type("triangle6"), some_teeth.triangles)
    assert {"flank_left", "bore", "tooth 0"} <= back.field_data.keys()


def test_a_mesh_with_one_boundary_still_writes(tmp_path, some_teeth):
    facets = {"bore": some_teeth.facets["bore"]}
    only = replace(some_teeth, facets=facets, facet_tooth={"bore": some_teeth.facet_tooth["bore"]})
    assert set_names(only) == {"BORE": ("bore", None)}
    assert write_msh(tmp_path / "bare.msh", only).exists()
