"""Fields over the face of a scene: written for ParaView, drawn in three dimensions with what flanks bear."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista
import xarray as xr
from PIL import Image

from base import InputError
from flankfilm.figures import Frame, animate_cycle, tooth_picture
from flankfilm.figures.rendering.view import titled
from flankfilm.runs.run_scene import run_scene
from flankfilm.scene import parse_scene
from tests.flankfilm.test_report_animation import drawn

SCENE = """
wants = ["stiffness", "vtk"]
tolerance = 0.05
[pair]
module_mm = 2.0
face_width_mm = 20.0
pinion = { teeth = 20, bore_mm = 20, crowning_um = 3 }
wheel = { teeth = 30, bore_mm = 30 }
backlash_um = 100
[alignment]
in_plane_um = 40
cells = 8
face_model = "walls"
[material]
youngs_modulus_GPa = 206
poisson_ratio = 0.3
[operating]
pinion_torque_Nm = 100
[film]
model = "none"
"""

SMALL = Frame(size=(600, 400), position=0.3)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of a run."""
    folder = tmp_path_factory.mktemp("face")
    run_scene(parse_scene(SCENE), folder, use_cache=False)
    return folder


def picture(run, file, **options) -> np.ndarray:
    file = drawn(tooth_picture, run, file, frame=Frame(**{**vars(SMALL), **options}))
    return np.asarray(Image.open(file).convert("RGB"), dtype=float)


@pytest.mark.slow
def test_a_scene_writes_teeth_and_flanks_that_hold_its_forces(run):
    assert not (run / "paraview_state.py").exists()
    with xr.open_dataset(run / "results.nc", engine="h5netcdf") as results:
        forces = results["dry_forces"].values.sum(axis=1)
        position = results["dry_position"].values
    files = sorted((run / "vtk").glob("pinion_flanks_*.vtu"))
    assert len(files) == 20
    for file in files[::6]:
        flanks = pyvista.read(file)
        area = flanks.compute_cell_sizes(length=False, volume=False)["Area"]
        row = int(file.stem.rpartition("_")[2])
        assert row < len(position)
        assert float(flanks["pressure_Pa"] @ area) == pytest.approx(forces[row], rel=1e-9)


@pytest.mark.slow
def test_pictures_show_the_field_that_is_asked_for(run, tmp_path):
    pressure = picture(run, tmp_path / "pressure.png")
    load = picture(run, tmp_path / "load.png", field="line_load_N_per_m")
    gap = picture(run, tmp_path / "gap.png", field="gap_m")
    white = pressure.min(axis=2) > 240
    assert 0.2 < white.mean() < 0.9
    coloured = [float((one.max(axis=2) - one.min(axis=2) > 30.0)[60:280].mean()) for one in (pressure, load)]
    # a band is all that bears of a flank, whose cells are coloured as a whole
    assert 0.0 < coloured[0] < 0.5 * coloured[1]
    assert np.abs(gap - load).mean() > 2.0
    with pytest.raises(InputError, match=r"field = von_mises_Pa: must be a field .*pressure_Pa"):
        tooth_picture(run, tmp_path / "stress.png", frame=Frame(field="von_mises_Pa"))


@pytest.mark.slow
def test_the_animation_turns(run, tmp_path):
    file = drawn(animate_cycle, run, tmp_path / "cycle.gif", frame=Frame(size=(240, 160)))
    with Image.open(file) as moving:
        assert moving.n_frames == 20
        first = np.asarray(moving.convert("RGB"), dtype=float)
        moving.seek(10)
        assert np.abs(np.asarray(moving.convert("RGB"), dtype=float) - first).mean() > 3.0


def test_fields_are_named_in_words_with_the_unit_that_people_read():
    assert titled("line_load_N_per_m") == ("line load", " [N/mm]", 1e-3)
    assert titled("von_mises_Pa") == ("von Mises stress", " [MPa]", 1e-6)
    assert titled("gap_m") == ("gap", " [um]", 1e6)
    assert titled("tip_edge") == ("tip edge", "", 1.0)
