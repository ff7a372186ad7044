"""The mesh of a pair as one table for programs that vibrate shafts: CSV in the units that people read, npz in SI."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from base import InputError
from base.results import quantities
from flankfilm.output.files import write_bytes, write_csv
from flankfilm.output.tables import columns
from flankfilm.output.variables import of_record

if TYPE_CHECKING:
    from flankfilm.coupling import MeshTable

CURVES = ("angle", "tangent_stiffness", "secant_stiffness", "transmission_error")
"""Columns that change with the angle."""

CONSTANTS = (
    "relative_error",
    "mean_tangent_stiffness",
    "mean_secant_stiffness",
    "force",
    "backlash",
    "equivalent_mass",
    "inertias",
    "base_radii",
    "teeth",
    "pressure_angle",
    "face_width",
)
"""Columns that are the same in every row, so that a table needs nothing beside it."""

FORMATS = (".csv", ".npz")


def write_table(path: Path, table: MeshTable) -> None:
    """Write a table by the ending of the file's name.

    Parameters
    ----------
    path : Path
        ``.csv``: a row for each angle, units in the names of the columns. ``.npz``: arrays by the names of the
        record, in SI.
    table : MeshTable

    Raises
    ------
    InputError
        Where the name ends otherwise.
    """
    refuse_others(path)
    if path.suffix == ".csv":
        write_csv(path, columns(of_record("mesh", table), "mesh", (*CURVES, *CONSTANTS)))
        return
    content = BytesIO()
    arrays: dict[str, Any] = {
        name: np.asarray(quantity.value) for name, quantity in quantities(table).items()
    }
    np.savez(content, **arrays)
    write_bytes(path, content.getvalue())


def refuse_others(path: Path) -> None:
    """Refuse names of files that end in no format of a table."""
    if path.suffix not in FORMATS:
        raise InputError.at("--out", str(path), f"must end in {' or '.join(FORMATS)}")
