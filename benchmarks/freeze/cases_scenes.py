"""Every example scene through the command line: dataset, tables, page, files."""

from __future__ import annotations

import json
import subprocess
import sys
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from .case import Cases, Room
from .folders import folder_arrays

EXAMPLES: dict[str, dict[str, Any]] = {
    "independent_pairs": {},
    "oscillator": {"dynamics.sweep.points": 120},
    "auto": {},
    "drive": {"dynamics.sweep.points": 8},
    "face_width": {},
    "helical": {},
    "rating": {"dynamics.sweep.points": 9, "alignment.face_model": "walls"},
    "starved": {},
    "losses": {},
    "real_flanks": {},
    "worn_flanks": {},
    "article": {"dynamics.sweep.points": 100},
    "motion/branches": {"dynamics.diagram.frequency": [0.6, 0.9], "dynamics.diagram.max_period": 1},
}
"""Scenes of ``examples/`` with the keys that make them shorter here."""

QUICK = ("independent_pairs", "oscillator")

case = Cases("scenes")


def toml(values: Mapping[str, Any]) -> str:
    """Text of a TOML file, tables inline.

    Examples
    --------
    >>> print(toml({"title": "A", "pair": {"teeth": [36, 40], "tight": False}}))
    "title" = "A"
    "pair" = {"teeth" = [36, 40], "tight" = false}
    """
    return "\n".join(f"{json.dumps(key)} = {_value(value)}" for key, value in values.items())


def _value(value: Any) -> str:
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_value(part)}" for key, part in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    return repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False)


def changed(values: Mapping[str, Any], key: str, value: Any) -> dict[str, Any]:
    """A file's values with one key changed, by its path with points."""
    first, _, rest = key.partition(".")
    return {**values, first: changed(values.get(first, {}), rest, value) if rest else value}


def shortened(source: Path, changes: Mapping[str, Any]) -> Path:
    """A file beside another with some keys changed, so that its paths still hold; the other itself without changes."""
    if not changes:
        return source
    values: dict[str, Any] = tomllib.loads(source.read_text(encoding="utf-8"))
    for key, value in changes.items():
        values = changed(values, key, value)
    beside = source.with_name(f"{source.stem}-shortened.toml")
    beside.write_text(toml(values), encoding="utf-8")
    return beside


def command(room: Room, *arguments: str) -> dict[str, Any]:
    """Run flankfilm and take what it leaves in ``out`` of the folder.

    Raises
    ------
    RuntimeError
        Where the command fails, with the last line of what it says.
    """
    line = [sys.executable, "-P", "-m", "flankfilm", *arguments, "--out", str(room.folder / "out")]
    done = subprocess.run(line, capture_output=True, text=True, check=False, cwd=room.folder)
    if done.returncode:
        said = [words.strip() for words in done.stderr.splitlines() if words.strip()] or ["nothing said"]
        raise RuntimeError(f"status {done.returncode}: {said[-1]}")
    return dict(folder_arrays(room.folder / "out"))


def scene(room: Room, name: str) -> dict[str, Any]:
    """Results of an example and the text of its scene."""
    source = room.tree / "examples" / f"{name}.toml"
    results = command(room, "run", str(shortened(source, EXAMPLES[name])))
    return {**results, "scene": np.array(source.read_text(encoding="utf-8").splitlines())}


for _name in EXAMPLES:
    case.add(_name, lambda room, name=_name: scene(room, name), quick=_name in QUICK)  # type: ignore[misc]
