"""The state of ParaView beside the time series: what it opens, colours and looks at; by ParaView itself where it is."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import types
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

import fem
from fem.fields.paraview_state import STATE, fillet_stress
from fem.fields.stress_fields import loaded_fields
from fem.fields.vtk import write_vtk_series

ROWS = [5, 20, 38]


@pytest.fixture(scope="module")
def series(tmp_path_factory, article_pair, article_bodies):
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    folder = tmp_path_factory.mktemp("a folder")
    write_vtk_series(folder, article_pair, cycle, article_bodies, ROWS)
    return folder, cycle


def run_with(simple: MagicMock, path: Path, monkeypatch) -> dict:
    """Run a state with a stand-in for ParaView; return its names."""
    package = types.ModuleType("paraview")
    package.simple = simple
    monkeypatch.setitem(sys.modules, "paraview", package)
    monkeypatch.setattr(sys, "argv", [""])  # as in ParaView's window
    names = {"__file__": str(path)}
    exec(compile(path.read_text(encoding="utf-8"), path, "exec"), names)
    return names


def test_it_opens_the_blocks_of_the_series_by_their_names(series, monkeypatch):
    folder, _ = series
    simple = MagicMock()
    run_with(simple, folder / STATE, monkeypatch)
    opened = simple.PVDReader.call_args.kwargs["FileName"]
    assert Path(opened) == folder.resolve() / "mesh_cycle.pvd"
    blocks = {call.kwargs["Selectors"][0].lstrip("/") for call in simple.ExtractBlock.call_args_list}
    assert blocks == set(re.findall(r'name="(\w+)"', Path(opened).read_text(encoding="utf-8")))
    simple.SaveScreenshot.assert_not_called()


def test_colours_end_at_the_fillets_and_the_view_holds_the_mesh(series, monkeypatch, article_pair):
    pyvista = pytest.importorskip("pyvista")
    folder, cycle = series
    simple = MagicMock()
    names = run_with(simple, folder / STATE, monkeypatch)
    low, high = simple.GetColorTransferFunction.return_value.RescaleTransferFunction.call_args.args
    assert low == 0.0
    grid = pyvista.read(folder / "vtk" / "wheel_0020.vtu")
    fillet = np.unique(grid.cells.reshape(-1, 7)[grid["region"] == 1, 1:])
    whole, roots = (1e-6 * grid["von_mises_Pa"][some].max() for some in (slice(None), fillet))
    assert 0.8 * roots < high < 1.3 * roots < whole
    view = names["view"]
    middle = np.array(view.CameraFocalPoint[:2])
    contacts = pyvista.read(folder / "vtk" / "contacts_0020.vtu").points[:, :2]
    assert np.all(np.abs(contacts - middle) < view.CameraParallelScale)
    assert 3.0 < view.CameraParallelScale / article_pair.module < 6.0
    assert view.ViewTime in [pytest.approx(cycle.position[row], rel=1e-8) for row in ROWS]


def test_a_contact_above_a_fillet_does_not_set_the_colours(article_pair, article_bodies):
    """Near A the mate's tip presses just above the wheel's or pinion's fillet: a third more than at mid-pitch."""
    cycle = fem.mesh_cycle(article_pair, 600.0, 40, article_bodies)
    near, middle = (
        max(map(fillet_stress, loaded_fields(article_pair, cycle, row, article_bodies))) for row in (34, 20)
    )
    assert near > 1.15 * middle


@pytest.mark.slow
def test_paraview_draws_it(series, tmp_path):
    """With the picture's middle in the stress's colours and not in the background's."""
    tools = [shutil.which(name) for name in ("xvfb-run", "pvpython")]
    if None in tools:
        pytest.skip("no ParaView (apt-get install paraview python3-paraview xvfb xauth)")
    picture = tmp_path / "mesh.png"
    command = [*tools[:1], "-a", *tools[1:], series[0] / STATE, picture]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    pixels = pytest.importorskip("PIL.Image").open(picture).convert("RGB").getcolors(1 << 21)
    assert pixels is not None
    yellow = sum(count for count, (r, g, b) in pixels if r > 180 and g > 150 and b < 110)
    assert sum(count for count, _ in pixels) == 1200 * 750
    assert yellow > 300  # at fillets and contacts: the scale ends there
