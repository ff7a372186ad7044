"""Runs beside each other on a few cores: whichever process gets to a task first, files are where they were asked for.

While files are written, answers of the second process come in, with modules that the first has not loaded yet.
"""

from __future__ import annotations

import subprocess

import pytest
import xarray as xr

from tests.flankfilm.program import SCRIPT
from tests.flankfilm.scenes import ARTICLE

pytestmark = pytest.mark.slow

BESIDE = 4

SCENE = f"""
title = "Beside others"
wants = ["closed-forms", "stiffness", "fourier", "vtk", "report"]
tolerance = 0.02
{ARTICLE}
[film]
model = "none"
"""


def test_runs_beside_each_other_write_what_one_alone_writes(tmp_path):
    runs = []
    for number in range(BESIDE):
        folder = tmp_path / str(number)
        folder.mkdir()
        (folder / "run.toml").write_text(SCENE, encoding="utf-8")
        arguments = [str(SCRIPT), "run", "run.toml", "--out", "out", "--no-cache"]
        pipes = {"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, "text": True}
        runs.append((folder, subprocess.Popen(arguments, cwd=folder, **pipes)))
    written = []
    for folder, run in runs:
        said = run.communicate(timeout=600)[1]
        assert (run.returncode, "Exception" in said) == (0, False), said
        with xr.open_dataset(folder / "out" / "results.nc", engine="h5netcdf") as found:
            values = {name: found[name].values.tolist() for name in found.variables if "seconds" not in name}
        files = sorted(path.relative_to(folder) for path in folder.rglob("*") if path.is_file())
        written.append((files, repr(values)))
    assert all(one == written[0] for one in written)
