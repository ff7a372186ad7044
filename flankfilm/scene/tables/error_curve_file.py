"""The file that a scene names for the curve of its unloaded transmission error, read into the scene."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from base import Fault, InputError
from flankfilm.scene.sections.error_curve import POINTS

__all__ = ["names_the_error", "read_error_file", "without_points"]

WHERE = "dynamics.error_curve"


def read_error_file(raw: dict[str, Any], folder: Path, keys: Sequence[str] = ()) -> list[Fault]:
    """Put the points of the file that a scene names beside its name; return what is wrong with it.

    Parameters
    ----------
    raw : dict
        Keys of the scene as read; changed: a name alone becomes a table.
    folder : Path
        From where the file is named.
    keys : sequence of str
        Dotted keys that alone are looked at, where others have been read; all unless given.
    """
    section = raw.get("dynamics")
    if not isinstance(section, dict) or (keys and not any(map(names_the_error, keys))):
        return []
    curve = section.get("error_curve")
    if isinstance(curve, str) and curve != "unloaded":
        curve = section["error_curve"] = {"file": curve}
    if not isinstance(curve, dict) or not isinstance(curve.get("file"), str):
        return []
    if clash := sorted(curve.keys() & set(POINTS)):
        return [
            Fault(f"{WHERE}.file", curve["file"], f"excludes {' and '.join(clash)}", "Leave one of them out")
        ]
    from flankfilm.scene.tables.error_files import read_error

    try:
        curve.update(read_error(folder / curve["file"], WHERE))
    except InputError as error:
        del section["error_curve"]
        return list(error.faults)
    return []


def names_the_error(key: str) -> bool:
    """Whether a dotted key of a scene names the file of the error."""
    return key in (WHERE, f"{WHERE}.file")


def without_points(raw: dict[str, Any]) -> None:
    """Take out what was read from the file, which now is another."""
    curve = raw.get("dynamics", {}).get("error_curve")
    if isinstance(curve, dict):
        for name in POINTS:
            curve.pop(name, None)
