from __future__ import annotations

import xml.etree.ElementTree as ET

import meshio
import numpy as np
import pytest

from meshes import gear_mesh, mesh_sector
from meshes.atomic import replacing
from meshes.files import write_mesh, write_pvd, write_vtu


def test_fields_read_back(tmp_path, article_profile):
    sector = mesh_sector(article_profile)
    moved = 1e-6 * sector.points[:, ::-1]
    path = write_vtu(
        tmp_path / "a" / "gear.vtu",
        sector.points,
        sector.triangles,
        {"displacement_m": moved, "von_mises_Pa": sector.points[:, 0]},
        {"tooth": np.zeros(len(sector.triangles), dtype=np.int32)},
    )
    back = meshio.read(path)
    np.testing.assert_array_equal(back.cells_dict["triangle6"], sector.triangles)
    np.testing.assert_allclose(back.points[:, :2], sector.points, rtol=1e-12)
    np.testing.assert_allclose(back.point_data["displacement_m"][:, :2], moved, rtol=1e-6)
    assert back.point_data["displacement_m"].shape[1] == 3
    assert [p.name for p in path.parent.iterdir()] == ["gear.vtu"]


def test_mesh_alone(tmp_path, article_profile):
    gear = gear_mesh(mesh_sector(article_profile), teeth=range(3))
    back = meshio.read(write_mesh(tmp_path / "mesh.vtu", gear))
    np.testing.assert_array_equal(back.cell_data["tooth"][0], gear.tooth)


def test_time_series(tmp_path):
    files = [tmp_path / "vtk" / f"{name} & co.vtu" for name in ("pinion", "wheel")]
    path = write_pvd(tmp_path / "cycle.pvd", [(0.125, files), (0.375, files)])
    sets = ET.parse(path).getroot().findall("Collection/DataSet")
    assert [s.get("timestep") for s in sets] == ["0.125", "0.125", "0.375", "0.375"]
    assert sets[1].get("file") == "vtk/wheel & co.vtu"


def test_a_write_that_fails_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "old.vtu"
    path.write_text("old")

    def half_a_file():
        with replacing(path) as beside:
            beside.write_text("half")
            raise OSError("disk full")

    with pytest.raises(OSError, match="disk full"):
        half_a_file()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]
