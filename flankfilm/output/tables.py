"""Tables for CSV files: columns of a dataset's variables in the units that people read, which their names carry."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from base.units import factor, suffix
from flankfilm.output.variables import COMMON, joined

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

ASIDE = ("pair", "bearing", "shaft", *COMMON)
"""Axes whose entries stand beside each other as columns; all others run down the rows."""


def columns(
    data: xr.Dataset, prefix: str, names: Sequence[str] = (), axis: str = ""
) -> dict[str, NDArray[np.generic]]:
    """Columns of a record's variables, each repeated along the axes that it lacks.

    Parameters
    ----------
    data : xarray.Dataset
    prefix : str
        Of the record.
    names : sequence of str
        Figures, in the order of the columns; those that are not there are left out.
    axis : str
        Instead of them: all figures along this axis of the record.

    Returns
    -------
    dict of str to ndarray, shape (rows,)
        Called ``<figure>_<unit>``, and by the entry where several stand beside each other.
    """
    held = data.variables  # data[name] would look through all variables for the coordinates of one
    heads = list(_heads(data, prefix, names, axis))
    rows = {
        dim: data.sizes[dim]
        for _, name, _ in heads
        for dim in map(str, held[name].dims)
        if not _aside(dim, prefix)
    }
    return {
        head: _shown(data, name, held[name].isel(picked).set_dims(rows).values.ravel())
        for head, name, picked in heads
    }


def _heads(
    data: xr.Dataset, prefix: str, names: Sequence[str], axis: str
) -> Iterator[tuple[str, str, dict[str, int]]]:
    """Name of every column, its variable, and the entry that it is of those that stand beside each other."""
    held = data.variables
    wanted = [joined(prefix, name) for name in names if joined(prefix, name) in held]
    if axis:
        wanted = [n for n in map(str, held) if held[n].dims[:1] == (joined(prefix, axis),)]
    older = [n for n in map(str, held) if held[n].attrs.get("alias_of") in wanted]
    for name in [*(n for n in wanted if n not in older), *older]:
        aside = [str(dim) for dim in held[name].dims if _aside(str(dim), prefix)]
        head = spelt(name.removeprefix(f"{prefix}_"), read_in(data, name))
        for places in product(*(range(data.sizes[dim]) for dim in aside)):
            picked = dict(zip(aside, places, strict=True))
            label = "".join(f"_{_entry(data, dim, place, prefix)}" for dim, place in picked.items())
            yield head + label, name, picked


def column_errors(
    data: xr.Dataset, table: str, prefix: str, names: Sequence[str] = (), axis: str = ""
) -> list[dict[str, object]]:
    """Rows of ``csv/columns.csv`` about a table: what each column is, and what it errs by or why that is not known.

    Parameters
    ----------
    data : xarray.Dataset
    table : str
        Name of the file.
    prefix, names, axis
        As of `columns`.
    """
    held = data.variables
    return [
        {
            "table": table,
            "column": head,
            "figure": held[name].attrs["long_name"],
            "unit": read_in(data, name),
            "relative_error": held[name].attrs.get("error", ""),
            "error_variable": held[name].attrs.get("error_variable", ""),
            "error_note": held[name].attrs.get("error_note", ""),
        }
        for head, name, _ in _heads(data, prefix, names, axis)
    ]


def uncertainties(data: xr.Dataset) -> dict[str, NDArray[np.object_]]:
    """Columns of ``csv/uncertainties.csv``: single figures that have an error, with what `results.nc` says of it."""
    held = data.variables
    names = [name for name in map(str, held) if not held[name].dims and "error" in held[name].attrs]
    about = [held[name].attrs for name in names]
    columns = {
        "variable": names,
        "figure": [attributes["long_name"] for attributes in about],
        "value": [float(_shown(data, name, held[name].values)) for name in names],
        "unit": [read_in(data, name) for name in names],
        "numerical_error": [attributes["error"] for attributes in about],
        "model_error": [attributes.get("model_error", "") for attributes in about],
        "model_error_source": [attributes.get("model_error_source", "") for attributes in about],
        "total_uncertainty": [
            attributes["error"] + attributes.get("model_error", 0.0) for attributes in about
        ],
        "tolerance_met": [attributes.get("tolerance_met", "") for attributes in about],
    }
    # of objects: cells stay empty where a model error is not estimated
    return {name: np.array(cells, dtype=np.object_) for name, cells in columns.items()}


def spelt(name: str, unit: str) -> str:
    """Name of a column: the figure's with its unit at the end, once.

    Examples
    --------
    >>> spelt("transmission_error", "um"), spelt("speed_rpm", "rpm"), spelt("position", "1")
    ('transmission_error_um', 'speed_rpm', 'position')
    """
    end = suffix(unit)
    return name if not end or name.endswith(f"_{end}") else f"{name}_{end}"


def read_in(data: xr.Dataset, name: str) -> str:
    """Unit that people read a variable in."""
    about = data.variables[name].attrs
    return str(about.get("display_units", about["units"]))


def _shown(data: xr.Dataset, name: str, values: NDArray[np.generic]) -> NDArray[np.generic]:
    unit = read_in(data, name)
    return (
        values
        if unit == data.variables[name].attrs["units"]
        else np.asarray(values, dtype=np.float64) / factor(unit)
    )


def _aside(dim: str, prefix: str) -> bool:
    return dim.removeprefix(f"{prefix}_") in ASIDE


def _entry(data: xr.Dataset, dim: str, place: int, prefix: str) -> str:
    """What distinguishes an entry of an axis from the others: its name where it has one, else its place."""
    if dim in COMMON:
        return COMMON[dim][place]
    names = f"{dim}s"
    if names in data.variables:
        return str(data.variables[names].values[place]).replace(" ", "_")
    return f"{dim.removeprefix(f'{prefix}_')}_{place + 1}"
