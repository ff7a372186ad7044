"""A folder of rows that only grows: taken up anew, or where the same work by the same code was left."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Literal

from base import InputError
from flankfilm.files.cache import PACKAGES, code_digest
from flankfilm.files.folder import occupied, refuse_irregular
from flankfilm.output.files import write_text
from flankfilm.studies.row import RowResult
from flankfilm.studies.table import ROWS, Columns, Line, append, forget, read_lines


@dataclass(frozen=True)
class Work:
    """What the rows of a folder are of.

    Attributes
    ----------
    kind : {"study", "optimisation"}
        Names the note in the folder, ``study.json`` or ``optimisation.json``.
    title : str
        For a person who reads the note.
    identity : mapping
        What makes two of them the same, as plain values.
    columns : Columns
        Of the table of rows.
    """

    kind: Literal["study", "optimisation"]
    title: str
    identity: Mapping[str, Any]
    columns: Columns

    @property
    def data(self) -> str:
        """File of data that becomes of the rows."""
        return {"study": "study.nc", "optimisation": "optimum.nc"}[self.kind]


@dataclass(frozen=True)
class KeptRows:
    """The table of a folder, locked: rows that were there, and room for more.

    Attributes
    ----------
    path : Path
        ``rows.csv``.
    columns : Columns
    lines : tuple of Line
        Rows that were there.
    """

    path: Path
    columns: Columns
    lines: tuple[Line, ...]

    def add(self, values: Sequence[object], result: RowResult) -> None:
        """Keep a row with the values of its keys."""
        append(self.path, self.columns, values, result)


@contextmanager
def kept_rows(folder: Path | None, work: Work, resume: bool) -> Iterator[KeptRows]:
    """Take up the rows that a folder holds of some work, and note the work in a folder that holds none.

    Rows that failed for want of memory, disk or a process are forgotten, to be computed again.

    Parameters
    ----------
    folder : Path or None
        Made when it does not exist; nobody else may use it meanwhile. None: one that goes away.
    work : Work
    resume : bool
        Whether to go on from rows that are there.

    Raises
    ------
    InputError
        Where the folder cannot be written or another process works there, where it holds rows of something else or of
        other code, or of this work without `resume`.
    """
    if folder is None:
        with TemporaryDirectory(prefix="flankfilm-") as place, kept_rows(Path(place), work, resume) as kept:
            yield kept
        return
    with occupied(folder, work.data):
        for path in (folder / ROWS, _note(folder, work)):
            refuse_irregular(path)
        digest = code_digest(PACKAGES)
        lines = _rows_there(folder, work, resume, digest)
        plain = {"title": work.title, work.kind: work.identity, "code_sha256": digest}
        write_text(_note(folder, work), json.dumps(plain, indent=1))
        yield KeptRows(folder / ROWS, work.columns, tuple(lines))


def _note(folder: Path, work: Work) -> Path:
    return folder / f"{work.kind}.json"


def _rows_there(folder: Path, work: Work, resume: bool, digest: str) -> list[Line]:
    note, another = _note(folder, work), "Name another folder with --out"
    if not note.exists():
        if (folder / ROWS).exists():
            raise InputError.at(folder, "", f"holds {ROWS} without its {note.name}", another)
        return []
    try:
        held = json.loads(note.read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as fault:
        raise InputError.at(note, "", f"was changed since it was written: {fault}", another) from fault
    if not isinstance(held, dict):
        raise InputError.at(note, "", "was changed since it was written: no table of keys", another)
    if held.get(work.kind) != json.loads(json.dumps(work.identity)):
        allowed = f"holds another {work.kind}, or this one with other keys, rows or outputs"
        raise InputError.at(folder, "", allowed, another)
    rows = read_lines(folder / ROWS, work.columns)
    if rows and not resume:
        allowed = f"holds {len(rows)} rows of this {work.kind}"
        raise InputError.at(folder, "", allowed, "Add --resume to go on from them")
    if rows and held.get("code_sha256") != digest:
        allowed = "holds rows that other code or libraries computed"
        raise InputError.at(folder, "", allowed, f"{another} to start anew")
    once = [line for line in rows if not line.result.worth_another_try]
    if len(once) < len(rows):
        forget(folder / ROWS, work.columns, once)
    return once
