"""Measured maps of flanks from CSV files: rows of place along the face, position on the profile, material.

Read as `trace_files` reads its files. The first row names the columns: ``z_mm``, a position (``roll_deg``,
``diameter_mm``, ``roll_length_mm``) and ``material_um``; the rows, in any order, have each place with each
position once.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from base import Faults, InputError, shorten
from flankfilm.scene.sections.curve_sections import POSITIONS
from flankfilm.scene.tables.trace_files import VALUES, TableRow, table_rows

__all__ = ["read_map"]

ALONG = "z_mm"


def read_map(path: Path, key: str) -> dict[str, Any]:
    """Read a map as the keys of a scene have it.

    Parameters
    ----------
    path : Path
    key : str
        Key that names the file, for faults.

    Returns
    -------
    dict
        ``z_mm`` and the positions, rising, and ``material_um``, a row for each position.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    rows = table_rows(path, key)
    head = [cell.strip().lower() for cell in rows[0].cells]
    by = [column for column in head if column in POSITIONS]
    value = [column for column in head if column in VALUES["material_um"]]
    if len(by) != 1 or len(value) != 1 or head.count(ALONG) != 1 or len(head) != 3:
        allowed = f"must have the columns {ALONG}, {' or '.join(POSITIONS)}, and material_um"
        remedy = "name each column so in the first row, and leave out others"
        raise InputError.at(key, f"{path.name}: {shorten(', '.join(head))}", allowed, remedy)
    columns = [head.index(name) for name in (ALONG, by[0], value[0])]
    with Faults() as faults:
        heights = _heights(faults, key, path.name, rows[1:], columns)
        along, over = (sorted({place[k] for place in heights}) for k in (0, 1))
        # every combination is a place of the map, so that none is listed: scattered points have millions of them
        lacking = len(along) * len(over) - len(heights)
        if lacking or len(along) < 2 or len(over) < 2:
            value_ = "a single row or column"
            if lacking:
                z, at = next((z, at) for z in along for at in over if (z, at) not in heights)
                value_ = f"no value at {ALONG} = {z:g}, {by[0]} = {at:g}, and {lacking - 1} more"
            allowed = f"must have every {ALONG} with every {by[0]}, at least 2 of each"
            faults.add(key, f"{path.name}: {value_}", allowed, "Give a full grid")
    return {ALONG: along, by[0]: over, "material_um": [[heights[z, at] for z in along] for at in over]}


def _heights(
    faults: Faults, key: str, name: str, rows: Sequence[TableRow], columns: Sequence[int]
) -> dict[tuple[float, float], float]:
    """Material at place along the face and position; rows without a number, and doubles, are noted."""
    heights: dict[tuple[float, float], float] = {}
    gaps, doubles = [], []
    for row in rows:
        z, at, height = (row.number(column) for column in columns)
        if not all(map(math.isfinite, (z, at, height))):
            gaps.append(row.line)
        elif (z, at) in heights:
            doubles.append(row.line)
        else:
            heights[z, at] = height
    for lines, allowed, remedy in (
        (gaps, "must have three numbers in each row", "measure the gap again, or leave the place out"),
        (doubles, "must have each place once", "leave one of the rows out"),
    ):
        if lines:
            more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
            faults.add(key, f"{name}: line {lines[0]}{more}", allowed, remedy)
    return heights
