"""Files of data that a run, a study, an optimisation or a verification wrote, opened again."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from base import InputError
from flankfilm.files.folder import REPORTS, readable, refuse_missing

if TYPE_CHECKING:
    import xarray as xr

REMEDY = "Name a results.nc, study.nc, optimum.nc or verify.nc, or the folder of one"


def open_results(path: Path | str) -> xr.Dataset:
    """Open what a run, a study, an optimisation or a verification wrote, whole in memory.

    Parameters
    ----------
    path : Path or str
        The file, or the folder that it is in.

    Returns
    -------
    xarray.Dataset
        Variables in SI (those of studies in the units of their names) with coordinates; the attributes of each:
        ``units``, ``long_name``, ``display_units`` where people read another unit, and of its error ``error``
        (relative), ``error_variable`` or ``error_note``. What made the file is in the dataset's attributes.

    Raises
    ------
    InputError
        Where there is no such file, where it is damaged, or where flankfilm did not write it.

    Examples
    --------
    >>> data = open_results("out/article")  # doctest: +SKIP
    >>> data.dry_tangent_stiffness.units, data.dry_tangent_stiffness.error  # doctest: +SKIP
    ('N/m', 0.0013)
    """
    import xarray as xr

    file = _file(Path(path))
    with readable(file, REMEDY):
        held = xr.load_dataset(file, engine="h5netcdf")
    silent = [str(name) for name in held.variables if "units" not in held.variables[name].attrs]
    if "scene_json" not in held.attrs or silent:
        raise InputError.at(file, "", "holds no results that flankfilm wrote", REMEDY)
    return held


def _file(path: Path) -> Path:
    """The file itself, or the first of those that a folder may hold."""
    if path.is_dir():
        files = [path / name for name in REPORTS if (path / name).is_file()]
        if not files:
            raise InputError.at(path, "", f"holds none of {', '.join(REPORTS)}", REMEDY)
        return files[0]
    refuse_missing(path, REMEDY)
    return path
