"""Curves of an unloaded transmission error over a base pitch, from CSV files with the columns position and error_um."""

from __future__ import annotations

import math
from pathlib import Path

from base import InputError, shorten
from flankfilm.scene.sections.error_curve import POINTS
from flankfilm.scene.tables.trace_files import table_rows

__all__ = ["read_error"]


def read_error(path: Path, key: str) -> dict[str, list[float]]:
    """Read position [base pitches from A] and error [um] as the keys of a scene have them.

    Parameters
    ----------
    path : Path
    key : str
        Key that names the file, for faults.

    Raises
    ------
    InputError
        For a file that cannot be read, other columns, or a row without two numbers.
    """
    head, *rows = table_rows(path, key)
    names = [cell.strip().lower() for cell in head.cells]
    if sorted(names) != sorted(POINTS):
        allowed, columns = (
            f"must have the columns {' and '.join(POINTS)}",
            f"{path.name}: {shorten(', '.join(names))}",
        )
        raise InputError.at(
            key, columns, allowed, "name each column so in the first row, and leave out others"
        )
    points: dict[str, list[float]] = {name: [] for name in POINTS}
    for row in rows:
        numbers = [row.number(place) for place in range(len(names))]
        if not all(map(math.isfinite, numbers)):
            raise InputError.at(
                key, f"{path.name}, line {row.line}", "must hold two numbers", "leave the row out"
            )
        for name, number in zip(names, numbers, strict=True):
            points[name].append(number)
    return points
