"""Draws the pictures of the README and of docs/howto/report.md from examples/article.toml: python docs/pictures.py."""

from __future__ import annotations

import tempfile
from pathlib import Path

import xarray as xr
from runs import EXAMPLES, IMAGES, keep_compiled_code, save

from flankfilm import figures


def main() -> None:
    """Write docs/images/teeth.png, stiffness.png, tooth.webp and mesh_cycle.webp."""
    keep_compiled_code()
    from flankfilm.runs.run_scene import run_scene
    from flankfilm.scene import read_scene

    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "article"
        run_scene(read_scene(EXAMPLES / "article.toml"), folder)
        with xr.open_dataset(folder / "results.nc", engine="h5netcdf") as results:
            save({"teeth": figures.tooth_stress(results), "stiffness": figures.mesh_stiffness(results)})
        figures.tooth_picture(folder, IMAGES / "tooth.webp", frame=figures.Frame(size=(960, 640)))
        figures.animate_cycle(folder, IMAGES / "mesh_cycle.webp", frame=figures.Frame(size=(390, 260)))


if __name__ == "__main__":
    main()
