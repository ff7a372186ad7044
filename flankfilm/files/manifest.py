"""Which files of a folder a command wrote, so that the next one there leaves none of another pair beside its own."""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path, PurePosixPath

from base.files import replacing
from flankfilm.files.folder import MANIFEST, REPORTS, UNFINISHED

UNLISTED = (MANIFEST, ".lock", "study.json", "optimisation.json")
"""What belongs to the folder itself: the list, the lock, and the notes of whose rows it holds."""

LARGEST = 50_000_000
"""Bytes of a list above which it is not ours."""


def conclude(folder: Path, files: Iterable[Path]) -> tuple[str, ...]:
    """List what a run wrote, and remove what an earlier one left there.

    A file of an earlier run goes only if it is as that run wrote it; files that somebody changed, and all that no run
    wrote, are kept, and so is what an earlier study is to a run.

    Parameters
    ----------
    folder : Path
    files : iterable of Path
        What was written; what a ``.pvd`` among it refers to counts as well.

    Returns
    -------
    tuple of str
        Files in the folder that are not of this run.
    """
    written = {_name(folder, path): _digest(path) for path in _with_references(files)}
    earlier = _listed(folder)
    of_its_kind = not any(name in REPORTS and name not in written for name in earlier)
    for name, digest in earlier.items() if of_its_kind else ():
        path = folder / name
        if name not in written and path.is_file() and not path.is_symlink() and _digest(path) == digest:
            path.unlink()
            with suppress(OSError):  # it is no longer empty, or was not there
                path.parent.rmdir()
    with replacing(folder / MANIFEST) as beside:
        beside.write_text(json.dumps({"sha256": written}, indent=1), encoding="utf-8")
    names = (_name(folder, path) for path in folder.rglob("*") if path.is_file() or path.is_symlink())
    others = (name for name in names if name not in written and name not in UNLISTED)
    return tuple(sorted(name for name in others if not name.startswith(UNFINISHED)))


def changed(folder: Path, *patterns: str) -> list[str]:
    """Files of a run, of names that match, that are no longer as it wrote them; none where there is no list.

    Parameters
    ----------
    folder : Path
    *patterns : str
        Such as ``"*.nc"``.
    """
    wanted = {
        name: digest
        for name, digest in _listed(folder).items()
        if any(PurePosixPath(name).match(pattern) for pattern in patterns)
    }
    return [
        name
        for name, digest in wanted.items()
        if not (folder / name).is_file() or _digest(folder / name) != digest
    ]


def _listed(folder: Path) -> Mapping[str, str]:
    """Names and digests of an earlier run's files, those inside the folder alone; none where the list is not ours."""
    path = folder / MANIFEST
    try:
        if not path.is_file() or path.stat().st_size > LARGEST:
            return {}
        held = json.loads(path.read_text(encoding="utf-8"))["sha256"]
        return {name: digest for name, digest in held.items() if _inside(folder, name)}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
        return {}  # no earlier run, or a list that somebody changed: then nothing is removed


def _inside(folder: Path, name: str) -> bool:
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts or "\0" in name or name in UNLISTED:
        return False
    return (folder / path).parent.resolve().is_relative_to(folder.resolve())


def _with_references(files: Iterable[Path]) -> list[Path]:
    """Files, and those that a ``.pvd`` among them names."""
    paths = list(files)
    for path in [file for file in paths if file.suffix == ".pvd"]:
        paths += [
            path.parent / name for name in re.findall(r'file="([^"]+)"', path.read_text(encoding="utf-8"))
        ]
    return paths


def _name(folder: Path, path: Path) -> str:
    return path.relative_to(folder).as_posix()


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()
