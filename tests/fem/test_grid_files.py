"""Files of grids are read as those of VTK's writer are, and are no larger than the promise."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from fem.fields import grid_files
from fem.fields.grid_files import write_grid
from fem.fields.grids import active, rounded, single_precision

pyvista = pytest.importorskip("pyvista")


@pytest.fixture
def grid():
    """Wedges and quadrangles with numbers of all kinds that fields have."""
    rng = np.random.default_rng(3)
    kinds = {
        pyvista.CellType.WEDGE: rng.integers(0, 400, (60, 6)),
        pyvista.CellType.QUAD: rng.integers(0, 400, (30, 4)),
    }
    grid = pyvista.UnstructuredGrid(kinds, rng.normal(size=(400, 3)))
    grid.point_data["displacement_m"] = rng.normal(size=(400, 3)).astype(np.float32)
    grid.point_data["stress_Pa"] = rounded(single_precision(rng.normal(size=(400, 4)), flat=True))
    for i, label in enumerate(("xx", "yy", "zz", 'x"y&')):
        grid.GetPointData().GetArray("stress_Pa").SetComponentName(i, label)
    grid.point_data["von_mises_Pa"] = rng.normal(size=400)
    grid.cell_data["tooth"] = rng.integers(-9, 9, 90).astype(np.int16)
    grid.cell_data["gear"] = np.zeros(90, dtype=np.int8)
    return active(grid, "von_mises_Pa", "displacement_m")


def labels(array):
    return [array.GetComponentName(i) for i in range(array.GetNumberOfComponents())]


@pytest.mark.parametrize("block", [1 << 22, 1000, 1600])
def test_what_is_read_is_what_was_written(tmp_path, grid, monkeypatch, block):
    """Also of arrays that take several blocks; 1600 bytes divide some of them, 1000 none."""
    monkeypatch.setattr(grid_files, "BLOCK", block)
    write_grid(tmp_path / "a.vtu", grid)
    back = pyvista.read(tmp_path / "a.vtu")
    assert back.points.dtype == grid.points.dtype
    np.testing.assert_array_equal(back.points, grid.points)
    np.testing.assert_array_equal(back.cells, grid.cells)
    np.testing.assert_array_equal(back.celltypes, grid.celltypes)
    for read, wrote in ((back.point_data, grid.point_data), (back.cell_data, grid.cell_data)):
        assert list(read) == list(wrote)
        for name in wrote:
            assert read[name].dtype == wrote[name].dtype
            np.testing.assert_array_equal(read[name], wrote[name])
    at_points = back.GetPointData()
    assert at_points.GetScalars().GetName() == "von_mises_Pa"
    assert at_points.GetVectors().GetName() == "displacement_m"
    assert labels(at_points.GetArray("stress_Pa")) == ["xx", "yy", "zz", 'x"y&']


def test_others_read_it_too(tmp_path, grid):
    write_grid(tmp_path / "a.vtu", grid)
    back = meshio.read(tmp_path / "a.vtu")
    np.testing.assert_array_equal(back.points, grid.points)
    np.testing.assert_array_equal(back.point_data["stress_Pa"], grid.point_data["stress_Pa"])
    assert sum(len(block.data) for block in back.cells) == grid.n_cells


def test_fields_take_hardly_more_room_than_by_a_search_for_what_repeats(tmp_path, monkeypatch):
    """Smooth fields with as many digits as are kept."""
    place = np.linspace(0.0, 1.0, 20000)
    points = np.column_stack([np.cos(9.0 * place), np.sin(7.0 * place), place])
    cells = np.arange(19998).reshape(-1, 3)
    grid = pyvista.UnstructuredGrid({pyvista.CellType.TRIANGLE: cells}, single_precision(points))
    grid.point_data["von_mises_Pa"] = rounded(single_precision(1e8 * np.exp(np.sin(50.0 * place))))
    write_grid(tmp_path / "fast.vtu", grid)
    monkeypatch.setattr(grid_files.zlib, "Z_RLE", grid_files.zlib.Z_DEFAULT_STRATEGY)
    write_grid(tmp_path / "small.vtu", grid)
    assert (tmp_path / "fast.vtu").stat().st_size < 1.25 * (tmp_path / "small.vtu").stat().st_size
