"""Rows on the disk: one CSV file that only grows, so that a study killed at any moment goes on from it.

A row is appended by a single write and forced to the disk, and ends with its checksum. What a power cut may leave is a
last line without its end, which is cut off when the study is taken up again; any other line that does not fit its
checksum was changed by somebody, and is refused.
"""

from __future__ import annotations

import csv
import io
import math
import os
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from base import Faults, InputError, printable
from base.files import replacing
from flankfilm.output.files import cell
from flankfilm.studies.row import RowResult

ROWS = "rows.csv"

ANOTHER_FOLDER = "Name another folder with --out"
WITHOUT_IT = "Delete the line, and its row is computed again"


@dataclass(frozen=True)
class Columns:
    """Columns of a table of rows: row, the varied keys, the outputs, cost, fault, and the checksum of these.

    Attributes
    ----------
    keys, outputs : tuple of str
    """

    keys: tuple[str, ...]
    outputs: tuple[str, ...]

    @property
    def header(self) -> list[str]:
        """Names of all columns."""
        return ["row", *self.keys, *self.outputs, "seconds", "fault", "crc32"]


@dataclass(frozen=True)
class Line:
    """A row as it stands in the table: its result, and the values of its keys as text."""

    result: RowResult
    values: tuple[str, ...]


def read_lines(path: Path, columns: Columns) -> list[Line]:
    """Read the rows that are there, and cut off a last line without its end.

    Raises
    ------
    InputError
        Where the file holds something else.
    """
    if not path.exists():
        return []
    data = path.read_bytes()
    whole = data[: data.rfind(b"\n") + 1]
    if len(whole) < len(data):
        with path.open("rb+") as file:
            file.truncate(len(whole))
    try:
        lines = list(csv.reader(io.StringIO(whole.decode("utf-8"))))
    except (UnicodeDecodeError, csv.Error) as fault:
        raise InputError.at(path, "", f"must be a table of rows: {fault}", ANOTHER_FOLDER) from fault
    if lines and lines[0] != columns.header:
        raise InputError.at(path, "", "must hold the columns of this study", ANOTHER_FOLDER)
    with Faults() as faults:
        for number, line in enumerate(lines[1:], start=2):
            if len(line) != len(columns.header) or _checksum(line[:-1]) != line[-1]:
                faults.add(f"{path}, line {number}", "", "was changed since it was written", WITHOUT_IT)
    first, last = 1 + len(columns.keys), 1 + len(columns.keys) + len(columns.outputs)
    rows: list[Line] = []
    seen: set[int] = set()
    with Faults() as faults:
        for number, line in enumerate(lines[1:], start=2):
            try:
                values = tuple(float(text) for text in line[first:last])
                index, spent = int(line[0]), float(line[last])
            except ValueError:
                faults.add(f"{path}, line {number}", "", "holds a text where a number belongs", WITHOUT_IT)
                continue
            if index < 0 or index in seen or not 0.0 <= spent < math.inf:
                faults.add(f"{path}, line {number}", "", "holds a row that no run wrote", WITHOUT_IT)
            seen.add(index)
            rows.append(
                Line(RowResult(index, values, spent, printable(line[last + 1])), tuple(line[1:first]))
            )
    return rows


def _written(rows: Sequence[Sequence[object]]) -> str:
    """Rows as they stand in the file."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _checksum(line: Sequence[object]) -> str:
    return f"{zlib.crc32(_written([line]).encode('utf-8')):08x}"


def forget(path: Path, columns: Columns, lines: Sequence[Line]) -> None:
    """Keep these lines alone: the file is replaced as a whole."""
    rows: list[Sequence[object]] = [columns.header]
    rows += [_row(line.values, line.result) for line in lines]
    with replacing(path) as beside:
        beside.write_text(_written(rows), encoding="utf-8")


def _row(values: Sequence[object], result: RowResult) -> list[object]:
    """Cells of a row, its checksum last."""
    line = [result.index, *map(cell, values), *result.values, result.seconds, cell(result.fault)]
    return [*line, _checksum(line)]


def append(path: Path, columns: Columns, values: Sequence[object], result: RowResult) -> None:
    """Add a row with the values of its keys; floats are written so that they read back to the last digit."""
    rows: list[Sequence[object]] = [] if path.exists() and path.stat().st_size else [columns.header]
    rows.append(_row(values, result))
    handle = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
    try:
        data = _written(rows).encode("utf-8")
        written = os.write(handle, data)
        if written < len(data):  # a full disk: leave no torn line behind
            os.ftruncate(handle, os.fstat(handle).st_size - written)
            raise OSError(28, "No space left on device", str(path))
        os.fsync(handle)
    finally:
        os.close(handle)
