"""Taking up a folder of rows: a new one, or one that holds some of the same work by the same code."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

from base import Fault, InputError
from flankfilm.cache import code_digest
from flankfilm.dataset import write_text
from flankfilm.study.table import ROWS, Columns, Line, read_lines

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")

Work = Literal["study", "optimisation"]


def take_up(
    folder: Path, work: Work, title: str, identity: Mapping[str, Any], columns: Columns, resume: bool
) -> list[Line]:
    """Give the rows that a folder holds of some work, and note the work in a folder that holds none.

    Parameters
    ----------
    folder : Path
        Locked by the caller.
    work : {"study", "optimisation"}
        Names the note, ``study.json`` or ``optimisation.json``.
    title : str
        For a person who reads the note.
    identity : mapping
        What makes two of them the same, as plain values.
    columns : Columns
    resume : bool
        Whether to go on from rows that are there.

    Returns
    -------
    list of Line

    Raises
    ------
    InputError
        Where the folder holds rows of something else, of other code, or of this work without `resume`.
    """
    digest = code_digest(PACKAGES)
    note = folder / f"{work}.json"
    another = "Name another folder with --out"
    if not note.exists():
        if (folder / ROWS).exists():
            raise InputError([Fault(str(folder), "", f"holds {ROWS} without its {note.name}", another)])
        _write(note, work, title, identity, digest)
        return []
    held = json.loads(note.read_text(encoding="utf-8"))
    if held.get(work) != json.loads(json.dumps(identity)):
        told = f"holds another {work}, or this one with other keys, rows or outputs"
        raise InputError([Fault(str(folder), "", told, another)])
    rows = read_lines(folder / ROWS, columns)
    if rows and not resume:
        told = f"holds {len(rows)} rows of this {work}"
        raise InputError([Fault(str(folder), "", told, "Add --resume to go on from them")])
    if rows and held.get("code_sha256") != digest:
        told = "holds rows that other code or libraries computed"
        raise InputError([Fault(str(folder), "", told, f"{another} to start anew")])
    _write(note, work, title, identity, digest)
    return rows


def _write(note: Path, work: Work, title: str, identity: Mapping[str, Any], digest: str) -> None:
    write_text(note, json.dumps({"title": title, work: identity, "code_sha256": digest}, indent=1))
