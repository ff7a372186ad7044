"""Reads a scene file and lists everything that is wrong with it at once."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError
from pydantic_core import to_jsonable_python

from base import Fault, InputError, shorten
from flankfilm.files.folder import content_of
from flankfilm.scene.explain import explain_all, model_in
from flankfilm.scene.needs import faults_between_sections
from flankfilm.scene.schema import Scene
from flankfilm.scene.tables.flank_files import read_flank_files

LARGEST_FILE = 1_000_000
"""Bytes; a scene is a few kilobytes, and a larger file is something else."""

DEEPEST = 12
"""Levels of tables and lists inside each other; a scene has four, a study with its scene in it one more."""

MOST_SQUARED_DOTS = 50_000_000
"""Sum over lines of squared numbers of dots: one list of 7,000 numbers, or any number of short lines."""

LONGEST_LIST = 10_000
"""Entries of a list in a scene: the pitches of a gear with the most teeth."""


def read_scene(path: Path | str) -> Scene:
    """Read and check a scene file.

    Parameters
    ----------
    path : Path or str
        The TOML file.

    Returns
    -------
    Scene
        Checked key by key and section by section; the geometry is checked by `flankfilm.building.pair`.

    Raises
    ------
    InputError
        With every fault of the file.

    Examples
    --------
    >>> from flankfilm.scene import template
    >>> _ = Path("pair.toml").write_text(template(), encoding="utf-8")
    >>> read_scene("pair.toml").tolerance
    0.005
    """
    if not isinstance(path, str | Path):
        raise InputError.at(
            "path", shorten(path), "must be the path of a scene file", "give the text to parse_scene"
        )
    path = Path(path)
    return parse_scene(read_text(path), name=str(path), folder=path.parent)


def parse_scene(text: str, name: str = "scene", folder: Path = Path()) -> Scene:
    """Check the text of a scene file, which names other files from a folder; see `read_scene`.

    Examples
    --------
    >>> from flankfilm.scene import template
    >>> parse_scene(template()).operating.pinion_torque_Nm
    600.0
    """
    raw = parse_toml(text, name)
    refuse_long_lists(raw)
    return validated(raw, read_flank_files(raw, folder))


def parse_toml(
    text: str, name: str, start: str = "'flankfilm new' writes a scene to start from"
) -> dict[str, Any]:
    """Read TOML; `name` is what a fault calls the file, `start` says where one to begin with is."""
    # the parser keeps every beginning of a dotted key, and looks each up from its first part
    if sum(line.count(".") ** 2 for line in text.split("\n")) > MOST_SQUARED_DOTS:
        allowed = "has a line with thousands of dots"
        raise InputError.at(name, "", allowed, "Break long lists into lines; no key has that many parts")
    try:
        raw = tomllib.loads(text)
    except ValueError as fault:  # also a number of more digits than Python reads
        raise InputError.at(name, "", f"must be TOML: {fault}", start) from fault
    except RecursionError as fault:
        raise _too_deep(name) from fault
    bounded(raw, name)
    return raw


def bounded(raw: dict[str, Any], name: str) -> None:
    """Refuse tables inside tables without end, and whole numbers that TOML leaves to the reader."""
    level: list[Any] = [raw]
    for _ in range(DEEPEST):
        inside = [v for table in level for v in (table.values() if isinstance(table, dict) else table)]
        for value in inside:
            if isinstance(value, int) and not -(2**63) <= value < 2**63:
                raise InputError.at(name, "", "holds a whole number of more than 64 bits", "Check it")
        level = [value for value in inside if isinstance(value, dict | list)]
        if not level:
            return
    raise _too_deep(name)


def _too_deep(name: str) -> InputError:
    return InputError.at(name, "", "is nested too deeply", "a scene has four levels at most")


def read_text(path: Path, remedy: str = "name a scene file, or write one: flankfilm new FILE") -> str:
    """Read a scene or study file as text; the remedy is for one that is missing."""
    try:
        return content_of(path, LARGEST_FILE, remedy, "a scene or study is a few kilobytes").decode("utf-8")
    except UnicodeDecodeError as fault:
        raise InputError.at(path, "", "is not a text file (TOML in UTF-8)") from fault


def validated(raw: dict[str, Any], faults: Sequence[Fault] = ()) -> Scene:
    """Check the keys of a scene in which other files have been found faulty; see `read_scene`."""
    refuse_long_lists(raw)
    between = [*faults, *faults_between_sections(raw)]
    try:
        scene = Scene.model_validate(raw)
    except ValidationError as error:
        raise InputError([*explain_all(error.errors(), Scene), *between]) from error
    if between:
        raise InputError(between)
    return scene


def reread(raw: Mapping[str, Any]) -> Scene:
    """Check a scene that was written with all its defaults, of which the rules between sections must not hear.

    Raises
    ------
    InputError
        With every fault; a scene that was checked before has none.
    """
    return validated(_as_given(raw, Scene))


def _as_given(raw: Mapping[str, Any], model: type[BaseModel]) -> dict[str, Any]:
    """Keys of a table whose values are not the defaults."""
    kept = {}
    for name, value in raw.items():
        field = model.model_fields.get(name)
        inner = None if field is None else model_in(field.annotation)
        default = None if field is None or field.is_required() else to_jsonable_python(field.default)
        if value is not None and value != default:
            kept[name] = _as_given(value, inner) if inner and isinstance(value, dict) else value
    return kept


def refuse_long_lists(raw: Any, path: str = "") -> None:
    """Refuse lists of thousands before each of their entries is judged."""
    if isinstance(raw, list) and len(raw) > LONGEST_LIST:
        allowed = f"must have at most {LONGEST_LIST} entries"
        raise InputError.at(path or "the scene", f"{len(raw):,} entries", allowed, "Shorten it")
    if isinstance(raw, dict):
        for key, value in raw.items():
            refuse_long_lists(value, f"{path}.{key}"[:200] if path else str(key)[:200])
