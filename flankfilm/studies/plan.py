"""A study that is ready to be computed: its scene, keys, rows and outputs, every row checked."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from base import Fault, Faults, InputError
from flankfilm.scene.reader import parse_toml, read_text, validated
from flankfilm.scene.tables.flank_files import names_a_file, read_flank_files, without_curves
from flankfilm.studies.design import following, rows_of
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.study_file import StudyFile, Value, in_file, read_rows_file

MOST_CHECKED = 20_000
"""Rows whose scene is checked before anything is computed; of more rows these, spread evenly."""

MOST_FAULTS = 50
"""Faults of rows that are listed."""


@dataclass(frozen=True, eq=False)
class Plan:
    """A study, ready to be computed.

    Attributes
    ----------
    title : str
    scene : mapping
        The scene's keys as read, with what the study sets.
    outputs : tuple of str
        Names in `flankfilm.studies.outputs.OUTPUTS`.
    keys : tuple of str
        Varied keys of the scene, dotted; those that follow come last.
    rows : tuple of tuple
        Values of the keys, one tuple a row.
    design : str
    varied : int
        How many of the keys are varied by themselves.
    folder : Path
        From where values that are files are named.
    """

    title: str
    scene: Mapping[str, Any]
    outputs: tuple[str, ...]
    keys: tuple[str, ...]
    rows: tuple[tuple[Value, ...], ...]
    design: str
    varied: int
    folder: Path = Path()

    def raw_scene(self, row: int) -> dict[str, Any]:
        """Keys of a row's scene, with the curves of files that vary."""
        raw = deepcopy(dict(self.scene))
        for key, value in zip(self.keys, self.rows[row], strict=True):
            put(raw, key, value)
            if names_a_file(key):
                without_curves(raw, key)
        if files := list(filter(names_a_file, self.keys)):
            _refuse(read_flank_files(raw, self.folder, files))
        return raw

    def identity(self) -> dict[str, Any]:
        """What makes two plans the same study, as plain values."""
        rows: Sequence[Any] = self.rows
        if any(map(names_a_file, self.keys)):  # a file of the same name may hold something else
            rows = [self.raw_scene(row) for row in range(len(self.rows))]
        held = {"scene": self.scene, "outputs": self.outputs, "keys": self.keys, "rows": rows}
        plain: dict[str, Any] = json.loads(json.dumps(held))
        return plain


def read_plan(path: Path) -> Plan:
    """Read and check a study file, and every row's scene key by key.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    return plan_of(read_rows_file(path, StudyFile), path.parent)


def refuse_unknown_outputs(wanted: Mapping[str, Iterable[str]]) -> None:
    """Refuse outputs that no row has, given by the key of the file that names them, all at once."""
    with Faults() as faults:
        for key, name in ((key, name) for key, names in wanted.items() for name in names):
            if name not in OUTPUTS:
                near = difflib.get_close_matches(name, OUTPUTS, n=1)
                remedy = f"Did you mean {near[0]}?" if near else f"Allowed: {', '.join(OUTPUTS)}"
                faults.add(key, repr(name), "is not an output", remedy)


def plan_of(study: StudyFile, folder: Path) -> Plan:
    """Lay out the rows of a study whose scene file is named from `folder`."""
    refuse_unknown_outputs({"outputs": study.outputs})
    scene = base_scene(study.scene, study.set, study.outputs, folder)
    keys = (*study.vary, *study.follow)
    varied = tuple(study.vary)
    rows = rows_of(study)
    if study.follow:
        rows = [
            (
                *values,
                *(following(dict(zip(varied, values, strict=True)), rule) for rule in study.follow.values()),
            )
            for values in rows
        ]
    plan = Plan(
        study.title,
        scene,
        tuple(dict.fromkeys(study.outputs)),
        keys,
        tuple(rows),
        study.design,
        len(varied),
        folder,
    )
    _check_rows(plan, study.vary)
    return plan


def base_scene(
    scene: str | dict[str, Any], fixed: Mapping[str, Value], outputs: Iterable[str], folder: Path
) -> dict[str, Any]:
    """Keys of a scene named from `folder`, or given, with what is set and what the outputs want."""
    if isinstance(scene, str):
        path = folder / scene
        raw, beside = parse_toml(read_text(path), str(path)), path.parent
    else:
        raw, beside = deepcopy(scene), folder
    for key, value in fixed.items():
        put(raw, key, value)
    _refuse(read_flank_files(raw, beside))
    # what a row computes follows from the outputs, not from the scene's own wants
    raw["wants"] = sorted({want for name in outputs for want in OUTPUTS[name].wants})
    return raw


def _refuse(faults: Sequence[Fault]) -> None:
    """Refuse files of flanks that have faults."""
    if faults:
        raise InputError(faults)


def put(raw: dict[str, Any], key: str, value: Value) -> None:
    """Set a dotted key of a scene; tables of a list are named by their place from 0, as in faults."""
    *sections, last = key.split(".")
    here: dict[str, Any] | list[Any] = raw
    for section in sections:
        inner = here[_place(here, section, key)] if isinstance(here, list) else here.setdefault(section, {})
        if not isinstance(inner, dict | list):
            raise InputError.at(key, "", f"{section} is a value, not a section", "Name a key of the scene")
        here = inner
    if isinstance(here, list):
        here[_place(here, last, key)] = value
    else:
        here[last] = value


def _place(values: list[Any], written: str, key: str) -> int:
    """Place in a list of the scene that a key names."""
    if not (written.isascii() and written.isdecimal() and len(written) < 6) or int(written) >= len(values):
        allowed = f"{written[:20]} is no place in a list of {len(values)}"
        raise InputError.at(
            key, "", allowed, f"Count from 0 to {len(values) - 1}" if values else "Fill the list first"
        )
    return int(written)


def _check_rows(plan: Plan, vary: Mapping[str, object]) -> None:
    """Refuse a study whose keys or values the scene cannot have, each fault once, with its first row.

    Of very many rows some are checked; a row that is not and that is faulty fails by itself.
    """
    faults: dict[tuple[str, str], Fault] = {}
    for row in range(0, len(plan.rows), -(-len(plan.rows) // MOST_CHECKED)):
        try:
            validated(plan.raw_scene(row))
        except InputError as error:
            for fault in error.faults:
                of_row = replace(in_file(fault, vary), where=f"row {row}: {fault.where}")
                faults.setdefault((fault.where, fault.allowed), of_row)
            if len(faults) >= MOST_FAULTS:
                break
    if faults:
        raise InputError(list(faults.values())[:MOST_FAULTS])
