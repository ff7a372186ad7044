"""A study on a dask cluster: here two workers of this machine, elsewhere as many as there are."""

from __future__ import annotations

import logging
import os
import tempfile
from pathlib import Path

import xarray as xr
from dask.distributed import LocalCluster
from matplotlib.figure import Figure
from page import picture

import flankfilm as ff
from flankfilm.studies.execution import Execution

STUDY = Path(__file__).parents[1] / "studies" / "web.toml"
HERE = {
    "n_workers": 2,
    "threads_per_worker": 1,  # rows share the cores, not threads within a row
    "preload": "flankfilm.processes.worker_processes",
    "dashboard_address": ":0",
    "silence_logs": logging.ERROR,
}


def draw() -> Figure:
    """Mesh stiffness and root stress of a wheel over the thickness of its rim and web."""
    with (
        LocalCluster(**HERE) as here,
        tempfile.TemporaryDirectory() as folder,
    ):
        os.environ["DASK_SCHEDULER_ADDRESS"] = here.scheduler_address  # of a real cluster: all that differs
        done = ff.study(STUDY, folder, Execution("dask"))
        with xr.open_dataset(Path(folder) / "study.nc", engine="h5netcdf") as dataset:
            dataset.load()
    print(f"{len(done.rows)} rows, {len(done.failures)} failed")
    stiffness, tension = (
        dataset[name].values for name in ("mean_secant_stiffness_N_per_mm_um", "root_tension_wheel_MPa")
    )
    error, root_error = (
        100 * float(dataset[name].max()) for name in ("stiffness_error", "root_stress_error")
    )
    print(f"stiffness {stiffness.min():.2f} to {stiffness.max():.2f} N/(mm um), each ± {error:.1g} %")
    print(
        f"root tension of the wheel {tension.min():.0f} to {tension.max():.0f} MPa, each ± {root_error:.1g} %"
    )
    return ff.figures.study(dataset, outputs=["mean_secant_stiffness_N_per_mm_um", "root_tension_wheel_MPa"])


if __name__ == "__main__":
    picture(draw, __file__)
