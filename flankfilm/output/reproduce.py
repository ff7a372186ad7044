"""The scene that made a results file, and what differs between the code that made it and this one."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from base import InputError, shorten
from flankfilm.files.folder import readable, refuse_missing
from flankfilm.scene import Scene, read_scene
from flankfilm.scene.reader import bounded, reread

SUFFIX = ".nc"

LARGEST_SCENE = 100_000_000
"""Characters of a scene in a results file: it holds the curves of the files that it named."""


def scene_in(path: Path) -> tuple[Scene, tuple[str, ...]]:
    """Scene of a scene file, or the one that made a results file.

    Parameters
    ----------
    path : Path
        A scene (TOML), or a file ``results.nc`` of an earlier run.

    Returns
    -------
    (Scene, tuple of str)
        The scene; what differs from the code and the libraries that made the file, empty for a scene file.

    Raises
    ------
    InputError
        With every fault of the file.
    """
    if path.suffix != SUFFIX:
        return read_scene(path), ()
    held = _attributes(path)
    if "design" in held:
        raise InputError.at(path, "", "holds a study", "Run its study file, or a results.nc")
    if not held.get("scene_json"):
        raise InputError.at(path, "", "holds no scene", "Name a results.nc that flankfilm wrote")
    return _scene(held["scene_json"], str(path)), _differences(held)


def _attributes(path: Path) -> dict[str, str]:
    """Text attributes of a netCDF file."""
    refuse_missing(path, "Name a scene or a results.nc")
    import h5py

    with readable(path, "Name a scene or a results.nc"), h5py.File(path, "r") as file:
        names = ("scene_json", "versions_json", "code_sha256", "design")
        held = {name: file.attrs[name] for name in names if name in file.attrs}
    # netCDF has characters of ASCII, which HDF5 gives as bytes, and text of other letters
    texts = {
        name: x.decode("utf-8", "replace") if isinstance(x, bytes) else str(x) for name, x in held.items()
    }
    return {name: text[: LARGEST_SCENE + 1] for name, text in texts.items()}


def _scene(text: str, name: str) -> Scene:
    try:
        raw = json.loads(text)
    except (ValueError, RecursionError) as fault:
        raise InputError.at(name, "", "holds a damaged scene", "Name the scene file") from fault
    if not isinstance(raw, dict):
        raise InputError.at(name, shorten(raw), "holds a damaged scene", "Name the scene file")
    bounded(raw, name)
    return reread(raw)


def _differences(held: Mapping[str, str]) -> tuple[str, ...]:
    from flankfilm.output.files import provenance

    here = provenance("")
    differences = []
    try:
        theirs: dict[str, Any] = json.loads(held.get("versions_json", "{}"))
        own: dict[str, Any] = json.loads(here["versions_json"])
    except (ValueError, RecursionError):
        theirs = own = {}
    if not isinstance(theirs, dict):
        theirs = {}
    changed = [f"{n} {theirs.get(n, '?')}, here {v}" for n, v in own.items() if theirs.get(n) != v]
    if changed:
        differences.append(f"made with {'; '.join(changed)}")
    if held.get("code_sha256") != here["code_sha256"]:
        differences.append("made by other source code of flankfilm: numbers may differ")
    return tuple(differences)
