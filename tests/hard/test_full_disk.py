"""A disk that fills at any byte of a run or a study: a message with the file and a remedy, and no torn file."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest
import xarray as xr

from flankfilm.api import run
from flankfilm.scene import parse_scene
from tests.flankfilm.scenes import ishikawa
from tests.processes import unwatched

pytest.importorskip("resource", reason="no limits of files")

SCENE = ishikawa("X", "closed-forms", "stiffness", "fourier", "report")

STUDY = """
outputs = ["contact_ratio"]
[vary]
"pair.pinion.profile_shift" = { from = -0.1, to = 0.4, steps = 30 }
[scene]
"""

LIMITED = """
import resource, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[1]),) * 2)
sys.argv = ["flankfilm", *sys.argv[2:]]
from flankfilm.cli import main
main()
"""


def limited(size: int, *arguments: object) -> subprocess.CompletedProcess[str]:
    """A command no file of which may grow beyond some bytes."""
    return subprocess.run(
        [sys.executable, "-P", "-c", LIMITED, str(size), *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=250,
        env=unwatched(),
    )


def refused(done: subprocess.CompletedProcess[str], out: Path) -> None:
    """Hold a command to what one without room has to do."""
    assert done.returncode == 2, done.stderr
    assert "Traceback" not in done.stderr
    assert f"{out}{os.sep}" in done.stderr
    assert "free some space" in done.stderr
    torn = [path for path in out.rglob(".*") if path.name != ".lock"]
    assert torn == []
    for path in out.rglob("*.nc"):
        with xr.open_dataset(path, engine="h5netcdf") as whole:
            assert whole.sizes


@pytest.mark.parametrize(
    "size", [60_000, *(pytest.param(size, marks=pytest.mark.slow) for size in (0, 100, 8192, 140_000))]
)
def test_a_run_without_room_says_so(tmp_path, size):
    scene = tmp_path / "scene.toml"
    scene.write_text(SCENE, encoding="utf-8")
    refused(limited(size, "run", scene, "--out", tmp_path / "out", "--no-cache"), tmp_path / "out")


@pytest.mark.parametrize("size", [500, *(pytest.param(size, marks=pytest.mark.slow) for size in (0, 3000))])
def test_a_study_without_room_keeps_its_rows(tmp_path, size):
    path = tmp_path / "study.toml"
    scene = SCENE.replace("[pair]", "[scene.pair]").replace("[material]", "[scene.material]")
    scene = scene.replace("[operating]", "[scene.operating]").replace("[stiffness]", "[scene.stiffness]")
    path.write_text(STUDY + scene, encoding="utf-8")
    out = tmp_path / "out"
    refused(limited(size, "study", path, "--out", out, "--workers", 1, "--no-cache"), out)
    rows = out / "rows.csv"
    assert not rows.exists() or not rows.stat().st_size or rows.read_bytes().endswith(b"\n")


@pytest.mark.slow
def test_every_write_of_a_run_may_be_the_one_that_fails(tmp_path, monkeypatch):
    """The disk is full at the first flush, the second, and so on; what was there before stays whole."""
    scene, out = parse_scene(SCENE), tmp_path / "out"
    run(scene, out, cache=False)
    before = {path: path.read_bytes() for path in out.rglob("*") if path.is_file()}
    sync, left = os.fsync, 0

    def full(handle: int) -> None:
        nonlocal left
        left -= 1
        if left < 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        sync(handle)

    monkeypatch.setattr("os.fsync", full)
    for writes in range(len(before) - 1):  # every file but the lock
        left = writes
        with pytest.raises(OSError, match="No space left") as raised:
            run(scene, out, cache=False)
        assert Path(raised.value.filename).is_relative_to(out)
        assert {path for path in out.rglob("*") if path.is_file()} == set(before)
    left = len(before) - 1
    run(scene, out, cache=False)


def test_grids_for_paraview_say_that_they_did_not_fit(tmp_path):
    code = (
        "import resource, sys, numpy as np, pyvista\n"
        "from pathlib import Path\n"
        "from fem.fields.grids import write_grid\n"
        "grid = pyvista.ImageData(dimensions=(60, 60, 2)).cast_to_unstructured_grid()\n"
        "grid.point_data['x'] = np.random.default_rng(0).random(grid.n_points)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))\n"
        "try:\n    write_grid(Path(sys.argv[1]), grid)\n"
        "except OSError as fault:\n    print(fault.errno, fault.filename)\n"
    )
    path = tmp_path / "grid.vtu"
    done = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=True, env=unwatched()
    )
    assert done.stdout.split() == [str(errno.ENOSPC), str(path)]
    assert done.stderr == ""
    assert list(tmp_path.iterdir()) == []


def test_a_new_scene_is_there_as_a_whole_or_not_at_all(tmp_path):
    done = limited(1000, "new", tmp_path / "scene.toml")
    assert done.returncode == 2
    assert f"{tmp_path / 'scene.toml'}: " in done.stderr
    assert not list(tmp_path.iterdir())
