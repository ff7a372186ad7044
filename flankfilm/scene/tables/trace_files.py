"""Measured curves over the flanks of a gear, from CSV files: positions and values, of all teeth or of each.

Rows are separated by commas, semicolons or tabs; with the latter two a comma may be the decimal sign. Lines that begin
with # are remarks. The first row names the columns: a position (``roll_deg``, ``diameter_mm``, ``roll_length_mm``), and

- ``tooth`` and a value: rows of all teeth, one below the other, each tooth with separate positions;
- a value: one curve for all teeth;
- numbers of teeth (``1``, ``tooth_1``, ``tooth_1_um``): a column for each, in micrometres, at common positions.

Teeth are numbered from 0 or from 1 in the order in which they come into mesh. Positions rise or fall.
"""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import NamedTuple

from base import Faults, InputError, shorten
from flankfilm.files.folder import content_of
from flankfilm.scene.sections.curve_sections import POSITIONS

__all__ = ["VALUES", "TableRow", "read_curves", "table_rows"]

LARGEST = 10_000_000
"""Bytes; a thousand points of a hundred teeth are a tenth of it."""

VALUES = {"material_um": ("material_um", "deviation_um"), "depth_um": ("depth_um", "wear_um")}
"""Key of the scene to the names that a column of its values may have."""

OF_A_TOOTH = re.compile(r"(?:tooth[ _]*)?(\d{1,5})(?:_um)?")

MOST_NAMED = 10
"""Teeth that are named in faults; the others are counted."""

MOST_TEETH = 100_000
"""Numbers of teeth are less."""

Curve = dict[str, list[float]]


@dataclass
class _Points:
    """Positions and values of one tooth, and the lines of the file that have none."""

    places: list[float] = field(default_factory=list)
    heights: list[float] = field(default_factory=list)
    gaps: list[int] = field(default_factory=list)

    def add(self, line: int, place: float, height: float) -> None:
        """Note a point, or that it has no value."""
        if math.isfinite(place) and math.isfinite(height):
            self.places.append(place)
            self.heights.append(height)
        else:
            self.gaps.append(line)

    def rising(self) -> tuple[list[float], list[float]]:
        """Points as they stand in a scene: those of a trace from tip to root turned round."""
        falls = len(self.places) > 1 and self.places[0] > self.places[-1]
        return (self.places[::-1], self.heights[::-1]) if falls else (self.places, self.heights)


def read_curves(
    path: Path, name: str, key: str, positions: Sequence[str] = tuple(POSITIONS)
) -> Curve | list[Curve]:
    """Read curves as the keys of a scene have them.

    Parameters
    ----------
    path : Path
    name : {"material_um", "depth_um"}
        Which values.
    key : str
        Key that names the file, for faults.
    positions : sequence of str
        Columns by one of which points are placed.

    Returns
    -------
    dict or list of dict
        One curve for all teeth, or one for each: positions under their key, and values.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    rows = table_rows(path, key)
    head = [cell.strip().lower() for cell in rows[0].cells]
    by = [column for column in head if column in positions]
    value = [column for column in head if column in VALUES[name]]
    each = {int(match[1]): place for place, cell in enumerate(head) if (match := OF_A_TOOTH.fullmatch(cell))}
    known = len(by) + len(value) + len(each) + head.count("tooth")
    one_kind = len(value) == 1 and not each if value else bool(each) and "tooth" not in head
    if len(by) != 1 or not one_kind or known != len(head) or head.count("tooth") > 1:
        allowed = f"must have the columns {' or '.join(positions)}, and {name}, tooth and {name}, or numbers of teeth"
        remedy = "name each column so in the first row, and leave out others"
        raise InputError.at(key, f"{path.name}: {shorten(', '.join(head))}", allowed, remedy)
    place = head.index(by[0])
    with Faults() as faults:
        if "tooth" in head:
            teeth = _one_below_the_other(rows[1:], head.index("tooth"), place, head.index(value[0]))
        else:
            teeth = _side_by_side(rows[1:], place, each or {0: head.index(value[0])})
        _check(faults, key, path.name, teeth)
    curves = [dict(zip((by[0], name), teeth[number].rising(), strict=True)) for number in sorted(teeth)]
    return curves if each or "tooth" in head else curves[0]


def mean_of(curves: Sequence[Curve], position: str, name: str, key: str) -> Curve:
    """Mean of the curves of teeth at common positions."""
    first = curves[0][position]
    apart = next((k for k, curve in enumerate(curves) if curve[position] != first), None)
    if apart is not None:
        allowed = f"must have the same {position} for every tooth, of which the mean is taken"
        raise InputError.at(
            key, f"curve {apart + 1} of {len(curves)}", allowed, "give a column for each tooth"
        )
    values = [sum(heights) / len(curves) for heights in zip(*(curve[name] for curve in curves), strict=True)]
    return {position: first, name: values}


class TableRow(NamedTuple):
    """Cells of a row and the number of its line."""

    line: int
    cells: list[str]

    def number(self, place: int) -> float:
        """Number in a cell; nan where there is none."""
        try:
            return float(self.cells[place])
        except (ValueError, IndexError):
            return math.nan


def table_rows(path: Path, key: str) -> list[TableRow]:
    """Rows of a file that are no remarks, at least one."""
    try:
        text = content_of(path, LARGEST, "name a CSV file beside the scene", "leave out points").decode(
            "utf-8-sig"
        )
        lines = [line for line in enumerate(text.splitlines(), start=1) if line[1].strip(" ,;\t")]
        lines = [(number, line) for number, line in lines if not line.startswith("#")]
        mark = next((mark for mark in ";\t" if lines and mark in lines[0][1]), ",")
        cells = csv.reader(
            [line if mark == "," else line.replace(",", ".") for _, line in lines], delimiter=mark
        )
        rows = [TableRow(number, row_cells) for (number, _), row_cells in zip(lines, cells, strict=True)]
    except InputError as error:
        raise InputError(replace(fault, where=key, value=fault.where) for fault in error.faults) from error
    except (UnicodeDecodeError, csv.Error, ValueError) as fault:
        raise InputError.at(key, path.name, "must be a CSV file in UTF-8", "Export it as such") from fault
    if not rows:
        raise InputError.at(key, path.name, "is empty", "Give the name of each column, and rows of numbers")
    return rows


def _side_by_side(rows: Sequence[TableRow], place: int, columns: Mapping[int, int]) -> dict[int, _Points]:
    """Teeth in columns at common positions."""
    teeth = {tooth: _Points() for tooth in columns}
    for row in rows:
        at = row.number(place)
        for tooth, column in columns.items():
            teeth[tooth].add(row.line, at, row.number(column))
    return teeth


def _one_below_the_other(rows: Sequence[TableRow], tooth: int, place: int, value: int) -> dict[int, _Points]:
    """Teeth in rows; those of which nobody says whose they are stand under -1."""
    teeth: dict[int, _Points] = {}
    for row in rows:
        of = row.number(tooth)
        number = int(of) if 0 <= of < MOST_TEETH and of == int(of) else -1
        teeth.setdefault(number, _Points()).add(row.line, row.number(place), row.number(value))
    return teeth


def _check(faults: Faults, key: str, name: str, teeth: Mapping[int, _Points]) -> None:
    """Note rows without a tooth, teeth that lack, and points without a value."""
    if -1 in teeth:
        remedy = "number teeth from 0 or from 1"
        faults.add(
            key, f"{name}: a row without a tooth", "must have a whole number in the column tooth", remedy
        )
    numbers = sorted(number for number in teeth if number >= 0)
    start = 0 if numbers[:1] == [0] else 1
    lacking = sorted(set(range(start, max(numbers, default=0))) - set(numbers))
    if lacking:
        value = f"{name}: no tooth {_listed(lacking)}"
        faults.add(key, value, "must have every tooth, numbered from 0 or from 1", "Add the teeth that lack")
    gaps = [number for number in numbers if teeth[number].gaps]
    for number in gaps[:MOST_NAMED]:
        lines = teeth[number].gaps
        more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
        value = f"{name}, tooth {number}: line {lines[0]}{more}"
        remedy = "measure the gap again, or leave out the rows of this tooth that have no value"
        faults.add(key, value, "must have a number for each position and value", remedy)
    if len(gaps) > MOST_NAMED:
        faults.add(key, f"{name}: {len(gaps) - MOST_NAMED} more teeth", "have gaps too", "Fix these first")
    if not any(points.places or points.gaps for points in teeth.values()):
        faults.add(key, name, "must have points", "Give rows of numbers")


def _listed(numbers: Sequence[int]) -> str:
    """Numbers for a message, the first few of many."""
    more = f" and {len(numbers) - MOST_NAMED} more" if len(numbers) > MOST_NAMED else ""
    return ", ".join(map(str, numbers[:MOST_NAMED])) + more
