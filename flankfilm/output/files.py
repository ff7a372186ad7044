"""Files of data: netCDF, CSV and text, each replaced as a whole; and what says how they were made."""

from __future__ import annotations

import csv
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from base import replacing

if TYPE_CHECKING:
    import xarray as xr


ROOM = 1 << 20
"""Room beyond its values that a file of data may need [bytes]: names, units and the tree that holds them."""


def write_netcdf(path: Path, dataset: xr.Dataset) -> None:
    """Replace the file `path` by the dataset, whose variables keep their order.

    It is made in memory and written as it is closed. netCDF's C library takes a quarter of h5netcdf's time, which
    looks each of some hundred variables up by name some thirty times. `Dataset.to_netcdf` asks dask for its
    scheduler, which loads `distributed` where that is installed.
    """
    import netCDF4
    from xarray.backends import NetCDF4DataStore

    with replacing(path) as beside:
        try:
            file, values = netCDF4.Dataset(beside, "w", diskless=True, persist=True), LateWriter()
            try:
                dataset.dump_to_store(NetCDF4DataStore(file), writer=values)
                values.write()
            finally:
                file.close()
        except (OSError, RuntimeError):  # netCDF does not say why; the system does, where the disk is full
            beside.write_bytes(bytes(dataset.nbytes + ROOM))
            raise


class LateWriter:
    """Writer of xarray that keeps values until all variables of a file are defined.

    netCDF's library looks through the whole file each time that a definition follows values: with some hundred
    variables that takes more time than all the rest.
    """

    def __init__(self) -> None:
        self.kept: list[tuple[Any, Any]] = []

    def add(self, source: Any, target: Any, region: Any = None) -> None:
        """Take an array and where it goes; xarray calls this."""
        self.kept.append((source, target))

    def write(self) -> None:
        """Write all of them."""
        for source, target in self.kept:
            target[...] = source


def write_csv(path: Path, columns: Mapping[str, ArrayLike]) -> None:
    """Replace the file `path` by columns of equal length; their names carry the units.

    Parameters
    ----------
    path : Path
        The file.
    columns : mapping
        Name to values, shape (n,); numbers are written so that they read back exactly.
    """
    listed = {name: _cells(np.asarray(values)) for name, values in columns.items()}
    with replacing(path) as beside, beside.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(listed)
        writer.writerows(zip(*listed.values(), strict=True))


def _cells(values: NDArray[Any]) -> list[object]:
    """Values of the cells of a column; numbers are what they are."""
    listed: list[object] = values.tolist()
    return listed if values.dtype.kind in "biuf" else list(map(cell, listed))


def cell(value: object) -> object:
    """Value of a cell: a text that a spreadsheet would take for a formula begins with an apostrophe.

    Examples
    --------
    >>> cell("=1+1"), cell("auto"), cell(-1.0)
    ("'=1+1", 'auto', -1.0)
    """
    return (
        f"'{value}"
        if isinstance(value, str) and value.startswith(("=", "+", "-", "@", "\t", "\r"))
        else value
    )


def write_text(path: Path, text: str) -> None:
    """Replace the file `path` by `text` in UTF-8."""
    with replacing(path) as beside:
        beside.write_text(text, encoding="utf-8")


def write_bytes(path: Path, content: bytes) -> None:
    """Replace the file `path` by `content`."""
    with replacing(path) as beside:
        beside.write_bytes(content)


def provenance(scene_json: str) -> dict[str, str]:
    """Attributes that say what made a file: scene, versions, and the digest of the code."""
    import platform
    from importlib.metadata import version

    from flankfilm.files.cache import LIBRARIES, PACKAGES, code_digest

    versions = {name: version(name) for name in ("flankfilm", *LIBRARIES)}
    return {
        "scene_json": scene_json,
        "versions_json": json.dumps({"python": platform.python_version(), **versions}),
        "code_sha256": code_digest(PACKAGES),
    }
