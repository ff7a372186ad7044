"""What the columns of a study's rows err by, for every display: the page, ``study.nc`` and ``columns.csv``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from base.results import EXACT
from base.units import unit_of
from flankfilm.output.files import write_csv
from flankfilm.studies.outputs import ERROR_OF, OUTPUTS

__all__ = ["COLUMNS", "SECONDS", "error_attributes", "write_columns"]

COLUMNS = "columns.csv"

SECONDS = "measured: it depends on the machine and on what else it does"
"""Why the cost of a row has no error."""


def error_attributes(name: str, outputs: Sequence[str]) -> dict[str, str]:
    """What a variable says of the error of an output, as those of ``results.nc`` do.

    Parameters
    ----------
    name : str
        Of the output.
    outputs : sequence of str
        All of the rows.

    Returns
    -------
    dict
        ``error_variable``, the output that holds it where that is among them, or ``error_note``.

    Examples
    --------
    >>> error_attributes("transmission_error_um", ["transmission_error_um", "transmission_error_error"])
    {'error_variable': 'transmission_error_error'}
    >>> error_attributes("transmission_error_um", ["transmission_error_um"])
    {'error_note': 'not asked for: the output transmission_error_error holds it'}
    >>> error_attributes("contact_ratio", ["contact_ratio"])
    {'error_note': 'exact: it follows from what is given'}
    """
    held = ERROR_OF.get(name)
    if held is None:
        return {"error_note": OUTPUTS[name].no_error}
    if held in outputs:
        return {"error_variable": held}
    return {"error_note": f"not asked for: the output {held} holds it"}


def write_columns(folder: Path, keys: Sequence[str], outputs: Sequence[str]) -> Path:
    """Write ``columns.csv``: what the columns of rows are, and the column with their error or why they have none.

    Parameters
    ----------
    folder : Path
    keys : sequence of str
        Of the scene, which vary.
    outputs : sequence of str
    """
    said = [error_attributes(name, outputs) for name in outputs]
    rows = [
        *((key, f"key {key} of the scene", unit_of(key), "", EXACT) for key in keys),
        *(
            (name, OUTPUTS[name].meaning, OUTPUTS[name].unit, *_ends(about))
            for name, about in zip(outputs, said, strict=True)
        ),
        ("seconds", "cost of the row", "s", "", SECONDS),
    ]
    heads = ("column", "meaning", "unit", "error_column", "error_note")
    cells = zip(*rows, strict=True)
    table = {head: np.array(column, dtype=np.object_) for head, column in zip(heads, cells, strict=True)}
    write_csv(folder / COLUMNS, table)
    return folder / COLUMNS


def _ends(about: dict[str, str]) -> tuple[str, str]:
    return about.get("error_variable", ""), about.get("error_note", "")
