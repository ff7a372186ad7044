"""Pictures of the loaded teeth, and the moving one; and what is reported where they cannot be drawn."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from base import InputError, SolverError
from flankfilm.figures import Frame, animate_cycle, tooth_picture
from flankfilm.figures.rendering import animation
from flankfilm.files.manifest import conclude
from tests.flankfilm.program import command


def test_colours_reach_the_maximum_stress_in_the_fillets(run):
    """They ended far below: at the stress that nearly all of the pictured area stays below."""
    fillets = max(
        float(np.max(np.asarray(grid["von_mises_Pa"])[np.linalg.norm(grid.points[:, :2], axis=1) < below]))
        for grid, below in _pinions(run)
    )
    assert animation._view(run, Frame()).greatest >= fillets > 0.0


def _pinions(run: Path):
    """Pinions of all positions, with the radius below which fillets are half as high."""
    import pyvista as pv
    import xarray as xr

    with xr.open_dataset(run / "results.nc", engine="h5netcdf") as results:
        below = 0.5 * float(results["pair_form_radii"][0] + results["pair_root_radii"][0])
    for file in sorted((run / "vtk").glob("pinion_*.vtu")):
        yield pv.read(file), below


@pytest.fixture(scope="module")
def run(run_with_fields: Path) -> Path:
    """A run's folder with three positions for ParaView."""
    return run_with_fields


def drawn(draw, *arguments, **options) -> Path:
    """Draw; a machine without OpenGL skips, or fails where FLANKFILM_REQUIRE_OPENGL is set."""
    try:
        return draw(*arguments, **options)
    except SolverError as fault:
        if os.environ.get("FLANKFILM_REQUIRE_OPENGL") or "OpenGL" not in str(fault):
            raise
        pytest.skip(str(fault))


@pytest.fixture(scope="module")
def frames(run, tmp_path_factory) -> list[np.ndarray]:
    """Frames of the animation."""
    file = tmp_path_factory.mktemp("moving") / "cycle.gif"
    drawn(animate_cycle, run, file, seconds=1.5, frame=Frame(size=(240, 160)))
    with Image.open(file) as moving:
        assert moving.n_frames == 3
        assert moving.info["duration"] == 500
        assert moving.info["loop"] == 0
        found = []
        for i in range(3):
            moving.seek(i)
            found.append(np.asarray(moving.convert("RGB"), dtype=float))
        return found


def test_the_animation_shows_stress_that_moves(frames):
    middle = frames[0][40:120, 20:220]
    bright = (
        (middle[..., 0] > 180) & (middle[..., 1] > 180) & (middle[..., 2] < 120)
    )  # the scale's end, yellow
    white = middle.min(axis=2) > 240  # gaps between teeth
    assert 0.001 < bright.mean() < 0.1
    assert 0.05 < white.mean() < 0.5
    assert np.abs(frames[1] - frames[0]).max() > 100


def test_the_picture_takes_the_position_that_is_asked_for(run, frames, tmp_path):
    file = drawn(tooth_picture, run, tmp_path / "last.png", frame=Frame(size=(240, 160), position=0.7))
    picture = np.asarray(Image.open(file), dtype=float)
    assert picture.shape == (160, 240, 3)
    apart = [np.abs(frame - picture).mean() for frame in frames]
    assert apart[2] < 0.2 * min(apart[:2])


def test_faults_are_reported_together(tmp_path):
    with pytest.raises(InputError) as caught:
        animate_cycle(tmp_path, tmp_path / "cycle.mp4")
    assert [fault.where for fault in caught.value.faults] == [str(tmp_path / "cycle.mp4"), str(tmp_path)]
    assert 'wants "vtk"' in str(caught.value)


@pytest.mark.slow
def test_other_fields_are_drawn_and_an_unknown_one_is_refused(run, tmp_path):
    frame = Frame(size=(240, 160), field="displacement_m", position=0.1)
    moved = np.asarray(
        Image.open(drawn(tooth_picture, run, tmp_path / "moved.png", frame=frame)), dtype=float
    )
    frame = replace(frame, field="von_mises_Pa")
    stress = np.asarray(
        Image.open(drawn(tooth_picture, run, tmp_path / "stress.png", frame=frame)), dtype=float
    )
    assert np.abs(moved - stress).mean() > 5
    with pytest.raises(
        InputError, match=r"field = heat: must be a field of the files. Such as .*displacement_m"
    ):
        tooth_picture(run, tmp_path / "heat.png", frame=replace(frame, field="heat"))


DRAW = """
import sys
from flankfilm.figures import Frame, teeth_scene
plotter = teeth_scene(sys.argv[1], frame=Frame(size=(240, 160)))
plotter.off_screen = True
plotter.screenshot(sys.argv[2])
"""


@pytest.mark.slow
def test_a_notebook_gets_the_same_scene(run, tmp_path):
    file = drawn(tooth_picture, run, tmp_path / "picture.png", frame=Frame(size=(240, 160)))
    # VTK in a process of its own: it ends the one that it is in where OpenGL is missing
    environment = {**os.environ, "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
    scene = [sys.executable, "-c", DRAW, str(run), str(tmp_path / "scene.png")]
    subprocess.run(scene, check=True, timeout=120, env=environment, capture_output=True)
    both = [
        np.asarray(Image.open(path).convert("RGB"), dtype=float) for path in (file, tmp_path / "scene.png")
    ]
    assert np.abs(both[0] - both[1]).mean() < 1


@pytest.mark.parametrize("end", ["import os; os.kill(os.getpid(), 11)", "raise RuntimeError('no display')"])
def test_a_machine_without_opengl_is_told_what_to_install(run, tmp_path, monkeypatch, end):
    """The process that draws dies of a signal, as VTK's does; ours lives, says so, and leaves no file."""
    real = subprocess.run
    command = [sys.executable, "-c", end]
    monkeypatch.setattr(animation.subprocess, "run", lambda _, **options: real(command, **options))
    with pytest.raises(SolverError, match=r"(signal 11|status 1 .*no display).*libegl1"):
        animate_cycle(run, tmp_path / "cycle.gif")
    assert list(tmp_path.iterdir()) == []


def test_the_command_tells_faults_without_a_traceback(tmp_path):
    done = command("animate", tmp_path, cwd=tmp_path, status=2)
    assert "mesh_cycle.pvd" in done.stderr


@pytest.mark.parametrize("listed", [True, False])
@pytest.mark.parametrize("name", ["results.nc", "mesh_cycle.pvd", "vtk/*.vtu"])
@pytest.mark.parametrize("damage", [lambda data: data[: len(data) // 2], lambda data: b"\0" * 64 + data[64:]])
def test_damaged_files_are_named(run, tmp_path, listed, name, damage):
    folder = tmp_path / "damaged"
    shutil.copytree(run, folder)
    if listed:
        conclude(folder, [path for path in folder.rglob("*") if path.is_file()])
    for path in folder.glob(name):
        path.write_bytes(damage(path.read_bytes()))
    with pytest.raises(InputError, match="changed since" if listed else "cannot be read"):
        drawn(tooth_picture, folder, tmp_path / "picture.png")
