"""Geometry of a pair as one table: what a drawing and an inspection sheet have."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from base.results import figures
from base.units import factor
from flankfilm.output.tables import read_in
from flankfilm.output.variables import joined, of_record
from gears.pair.pair_geometry import OF_HELICES

if TYPE_CHECKING:
    import xarray as xr

    from gears import GearPair

OF_HELICAL = {"module": "normal module", "backlash": "normal backlash", "base_pitch": "transverse base pitch"}
"""What figures are called of a pair that has two sections."""

RECORDS = ("dimensions_", "pair_", "contact_lines_", "mesh_force_")
"""Beginnings of the variables of which the table is made."""

LEFT_OUT = "_radii"
"""Ending of figures of the pair that stand in the table as diameters."""


@dataclass(frozen=True)
class Row:
    """A figure of the pair, or of both gears.

    Attributes
    ----------
    name : str
        Of the variable.
    meaning, unit : str
        What it is, and the unit that people read.
    values : tuple of float
        One of the pair, or those of pinion and wheel.
    error : str
        What the figure errs by, relative, or why it has no error.
    """

    name: str
    meaning: str
    unit: str
    values: tuple[float, ...]
    error: str


def pair_figures(prefix: str, pair: GearPair) -> xr.Dataset:
    """Variables of a pair; those of its normal and transverse sections where these differ.

    Parameters
    ----------
    prefix : str
    pair : GearPair
    """
    if not pair.helix_angle:
        return of_record(prefix, pair, figures(type(pair)).keys() - {*OF_HELICES})
    data = of_record(prefix, pair)
    for name, meaning in OF_HELICAL.items():
        data[joined(prefix, name)].attrs["long_name"] = meaning
    return data


def geometry_rows(data: xr.Dataset) -> Iterator[Row]:
    """Figures of a run's pair: of the pair itself, then of both gears; none without a pair."""
    variables = [str(name) for name in data.data_vars]
    names = [name for start in RECORDS for name in variables if name.startswith(start)]
    for dims in ((), ("gear",)):
        for name in names:
            about = data[name]
            if about.dims == dims and not name.endswith(LEFT_OUT) and np.issubdtype(about.dtype, np.number):
                unit = read_in(data, name)
                values = np.atleast_1d(
                    about.values / factor(unit) if about.attrs["units"] != unit else about.values
                )
                error = str(about.attrs.get("error", about.attrs.get("error_note", "")))
                yield Row(name, str(about.attrs["long_name"]), unit, tuple(values.tolist()), error)


def geometry_columns(data: xr.Dataset) -> dict[str, NDArray[np.object_]]:
    """Columns of ``csv/geometry.csv``: figure, unit, its value of the pair or of pinion and wheel, and its error."""
    rows = list(geometry_rows(data))
    of_pair = [row.values[0] if len(row.values) == 1 else "" for row in rows]
    pinion, wheel = ([row.values[i] if len(row.values) == 2 else "" for row in rows] for i in (0, 1))
    columns = {
        "figure": [row.meaning for row in rows],
        "unit": [row.unit for row in rows],
        "pair": of_pair,
        "pinion": pinion,
        "wheel": wheel,
        "error": [row.error for row in rows],
    }
    # of objects: cells that a figure does not have stay empty beside numbers
    return {name: np.array(cells, dtype=np.object_) for name, cells in columns.items()}
