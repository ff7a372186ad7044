"""Every format that gears are written in is read back: nodes, elements, and what names the boundaries."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

import fem.elasticity.plane_elasticity
from base import InputError
from fem.fields import grids
from fem.fields.export import FORMATS as ALL
from fem.fields.export import write_mesh
from fem.fields.loaded_gears import LoadedGear, placed_gears
from meshes import gear_mesh, mesh_sector
from meshes.annulus import GearMesh
from meshes.exchange import FORMATS

READABLE = sorted(set(FORMATS) - {"stl"})


@pytest.fixture(scope="module")
def some_teeth(article_pair) -> GearMesh:
    return gear_mesh(mesh_sector(article_pair.teeth_profiles[0]), teeth=range(-1, 2))


@pytest.fixture(scope="module")
def gear(some_teeth) -> LoadedGear:
    forces = np.zeros_like(some_teeth.points)
    forces[7] = 3.0, -4.0
    law = fem.elasticity.plane_elasticity.PlaneElasticity("strain", 2e11, 0.3)
    return LoadedGear("pinion", some_teeth, np.zeros(2), law, 0.04, forces)


@pytest.mark.parametrize("form", READABLE)
def test_nodes_and_elements_come_back(form, gear, tmp_path):
    about, mesh = FORMATS[form], gear.mesh
    back = meshio.read(write_mesh(gear, tmp_path / f"gear{about.suffix}", form), file_format=form)
    np.testing.assert_allclose(back.points[:, :2], mesh.points, rtol=0, atol=1e-12)
    cells, edges = back.cells_dict, np.concatenate(list(mesh.facets.values()))
    if about.curved:
        np.testing.assert_array_equal(cells["triangle6"], mesh.triangles)
    else:
        assert len(cells["triangle"]) == 4 * len(mesh.triangles)
        # the four straight triangles fill each one of ours, so that none is turned or lost
        a, b, c = (mesh.points[cells["triangle"][:, k]] for k in range(3))
        d, e = b - a, c - a
        area = 0.5 * (d[:, 0] * e[:, 1] - d[:, 1] * e[:, 0])
        assert area.min() > 0
        assert len(np.unique(cells["triangle"])) == len(mesh.points)
    if about.edges:
        kind, times = ("line3", 1) if about.curved else ("line", 2)
        assert len(cells[kind]) == times * len(edges)
    else:
        assert not {"line", "line3"} & cells.keys()


@pytest.mark.parametrize("form", ["vtk", "vtu", "xdmf", "hmf"])
def test_boundaries_and_forces_are_fields(form, gear, tmp_path):
    back = meshio.read(write_mesh(gear, tmp_path / f"gear.{form}", form), file_format=form)
    for name, edges in gear.mesh.facets.items():
        np.testing.assert_array_equal(np.flatnonzero(back.point_data[name]), np.unique(edges))
    np.testing.assert_array_equal(back.point_data["force_N"][:, :2], gear.forces)
    np.testing.assert_array_equal(np.ravel(back.cell_data["tooth"][0]), gear.mesh.tooth)


@pytest.mark.parametrize("form", [name for name, about in FORMATS.items() if about.number])
def test_boundaries_are_numbers(form, gear, tmp_path):
    about = FORMATS[form]
    back = meshio.read(write_mesh(gear, tmp_path / f"gear{about.suffix}", form), file_format=form)
    kind, times = ("line3", 1) if about.curved else ("line", 2)
    found = np.concatenate(
        [
            np.ravel(tags)
            for block, tags in zip(back.cells, back.cell_data[about.number], strict=True)
            if block.type == kind
        ]
    )
    for number, edges in enumerate(gear.mesh.facets.values(), 1):
        assert np.count_nonzero(found == number) == times * len(edges)
    if form == "med":
        named = {name: tag for tag, names in back.cell_tags.items() for name in names}
        assert named == {name: k for k, name in enumerate(gear.mesh.facets, 1)}


def test_stl_is_the_surface(gear, tmp_path):
    path = write_mesh(gear, tmp_path / "gear.stl")
    with np.errstate(over="ignore"):  # meshio tries first whether the text is a binary file
        back = meshio.read(path)
    assert len(back.cells_dict["triangle"]) == 4 * len(gear.mesh.triangles)


def test_a_deck_is_read_by_meshio_with_its_sets(gear, tmp_path):
    back = meshio.read(write_mesh(gear, tmp_path / "gear.inp"))
    np.testing.assert_allclose(back.points[:, :2], gear.mesh.points, rtol=1e-13, atol=1e-30)
    np.testing.assert_array_equal(back.cells_dict["triangle6"], gear.mesh.triangles)
    for name, edges in gear.mesh.facets.items():
        np.testing.assert_array_equal(np.sort(back.point_sets[name.upper()]), np.unique(edges))
    np.testing.assert_array_equal(back.cell_sets["TOOTH_1"][0], np.flatnonzero(gear.mesh.tooth == 1))


def test_blocks_of_vtk_have_the_names(article_pair, tmp_path):
    import pyvista

    blocks = pyvista.read(write_mesh(article_pair, tmp_path / "pair.vtm"))
    assert blocks.keys() == ["pinion", "wheel"]
    for gear in placed_gears(article_pair):
        block = blocks[gear.name]
        assert set(block.keys()) == {"gear", *gear.mesh.facets}
        np.testing.assert_array_equal(block["gear"].points[:, :2], gear.mesh.points)
        assert block["flank_left"].n_cells == len(gear.mesh.facets["flank_left"])
        assert block["gear"]["force_N"].shape == (len(gear.mesh.points), 3)


def test_two_gears_in_one_deck(article_pair, tmp_path):
    path = write_mesh(article_pair, tmp_path / "pair.inp")
    back = meshio.read(path)
    first, second = placed_gears(article_pair)
    assert len(back.points) == len(first.mesh.points) + len(second.mesh.points)
    assert {"PINION_BORE", "WHEEL_BORE"} <= back.point_sets.keys()
    assert "WHEEL_BORE, 1, 2" in path.read_text().splitlines()


def test_what_is_refused(gear, tmp_path):
    with pytest.raises(InputError, match=r"(?s)format.*abaqus.*vtu"):
        write_mesh(gear, tmp_path / "gear.step")
    with pytest.raises(InputError, match="one gear"):
        write_mesh((gear, gear), tmp_path / "gear.msh")
    assert set(FORMATS) < set(ALL)


def test_mantissas_in_pictures_are_rounded_to_eleven_bits():
    """Of 23: off by at most half of the last bit that is left, and packed with the zeros behind it."""
    values = np.random.default_rng(2).uniform(1.0, 2.0, 4000).astype(np.float32)
    kept = grids.rounded(values.copy())
    off = np.abs(kept.astype(float) / values.astype(float) - 1.0).max()
    assert 2.0**-14 < off <= 2.0**-12
    assert not np.any(kept.view(np.uint32) & 0xFFF)
    assert np.any(kept.view(np.uint32) & 0x1000)
