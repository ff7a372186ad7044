"""Files of data: netCDF, CSV and text, each replaced as a whole; and what says how they were made."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from base import replacing

if TYPE_CHECKING:
    import xarray as xr


def write_netcdf(path: Path, dataset: xr.Dataset) -> None:
    """Replace the file `path` by the dataset.

    It is made in memory first: HDF5 does not survive a disk that fills while it writes. `Dataset.to_netcdf` would do
    the same, but asks dask for its scheduler, which loads `distributed` where that is installed.

    Attributes of the file come last: written first, as xarray does, HDF5 2.0 loses what it has cached where they are of
    some lengths (16 in a row, of one dataset of 322 variables), and ends with "Read only entry modified".
    """
    import h5netcdf
    from xarray.backends import H5NetCDFStore

    content = io.BytesIO()
    with h5netcdf.File(content, "w") as file:
        dataset.drop_attrs(deep=False).dump_to_store(H5NetCDFStore(file))
        file.attrs.update(dataset.attrs)
    with replacing(path) as beside:
        beside.write_bytes(content.getbuffer())


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
