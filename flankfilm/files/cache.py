"""Results kept by content: the same inputs and the same code give the stored result back.

An entry is one file named by the digest of what made it. Its first line holds the digest of its name and payload, so
that flipped bits, cut and exchanged files are noticed, removed and computed again. It holds data alone
(``flankfilm.files.plain_data``): reading one runs no code. Compiled code is code, so both are kept only in folders that
belong to the user and that nobody else may write.
"""

from __future__ import annotations

import atexit
import hashlib
import json
import os
import platform
import shutil
import stat
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cache
from importlib import util
from pathlib import Path
from typing import Any

from base.files import replacing, sweep_temporaries

LIBRARIES = ("numpy", "scipy", "numba", "scikit-fem", "gmsh")
"""Libraries whose versions may change what is computed."""

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")
"""All packages of this project."""


class CacheWarning(UserWarning):
    """An entry was unreadable and is computed again, or could not be kept."""


def user_cache() -> Path:
    """Folder of the user's cache; ``FLANKFILM_CACHE`` in the environment overrules it."""
    own = os.environ.get("FLANKFILM_CACHE")
    if own:
        return Path(own)
    from platformdirs import user_cache_path

    return user_cache_path("flankfilm", appauthor=False)


def results_cache(use: bool = True) -> Cache:
    """Cache of results in the user's folder; one that holds nothing where that is not wanted, or not the user's alone.

    Warns
    -----
    CacheWarning
        Where the folder is not to be trusted, with the remedy.
    """
    if not use:
        return Cache(None)
    folder = user_cache() / "results"
    if fault := own_folder(folder):
        _warn(f"{fault}; results are computed and not kept. Name another folder by FLANKFILM_CACHE")
        return Cache(None)
    return Cache(folder)


def own_folder(folder: Path) -> str:
    """Make a folder for the user alone (0700); say what is wrong with one of another user or that others may write."""
    try:
        folder.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
        folder.mkdir(exist_ok=True, mode=0o700)
        if not hasattr(os, "getuid"):
            return ""
        for directory in (folder.parent, folder):
            status = directory.stat()
            if status.st_uid != os.getuid():
                return f"{directory} belongs to another user"
            if status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
                return f"{directory} may be written by others; chmod 700 {directory}"
        folder.chmod(0o700)
    except OSError as fault:
        return f"{folder} cannot be used: {fault.strerror}"
    return ""


@cache
def code_digest(packages: tuple[str, ...]) -> str:
    """Digest of the source files of `packages`, and of Python and the libraries' versions."""
    from importlib import metadata  # 10 ms, without which a scene is checked

    digest = hashlib.sha256(platform.python_version().encode())
    for name in LIBRARIES:
        digest.update(f"{name}=={metadata.version(name)}\n".encode())
    for package in sorted(packages):
        folder = _folder(package)
        for source in sorted(folder.rglob("*.py")):
            digest.update(source.relative_to(folder).as_posix().encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


def _folder(package: str) -> Path:
    spec = util.find_spec(package)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"package {package} is not installed")
    return Path(spec.origin).parent


def keep_compiled_code() -> None:
    """Give numba a separate cache folder, named by the code that it compiles.

    numba does not notice a changed helper in another file, and fails where site-packages cannot
    be written; a folder per digest of the sources cures both. Call it before numba is imported.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    folder = user_cache() / "compiled" / code_digest(("base", "ehl", "dynamics"))[:16]
    try:
        trusted = not own_folder(folder.parent)
        if trusted:
            folder.mkdir(exist_ok=True, mode=0o700)
            with tempfile.TemporaryFile(dir=folder):
                pass
    except OSError:
        trusted = False
    if not trusted:
        # numba gives up where it finds no folder that it can write: a private one for this run
        folder = Path(tempfile.mkdtemp(prefix="flankfilm-"))
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    os.environ["NUMBA_CACHE_DIR"] = str(folder)


@dataclass(frozen=True)
class Cache:
    """A folder of kept results; ``None`` as `folder` keeps nothing."""

    folder: Path | None

    def key(self, stage: str, inputs: Mapping[str, Any], packages: Sequence[str]) -> str:
        """Digest of a stage's name, its inputs as canonical JSON, and the code that it runs."""
        text = json.dumps(inputs, sort_keys=True, allow_nan=False)
        return hashlib.sha256(f"{stage}\n{text}\n{code_digest(tuple(packages))}".encode()).hexdigest()

    def get(self, key: str) -> Any | None:
        """Return the kept value, or None; an unreadable entry is removed with a warning."""
        if self.folder is None:
            return None
        from flankfilm.files.plain_data import NotPlainDataError, read

        path = self.folder / key
        try:
            head, _, payload = path.read_bytes().partition(b"\n")
        except FileNotFoundError:
            return None
        except OSError as fault:
            _warn(f"{path}: {fault.strerror}; computed again")
            return None
        if _digest(key, payload) == head:
            with suppress(NotPlainDataError):
                return read(payload, PACKAGES)
        path.unlink(missing_ok=True)
        _warn(f"{path.name[:12]} was damaged; computed again")
        return None

    def put(self, key: str, value: Any) -> None:
        """Keep a value; where that is not possible (full disk) warn and go on."""
        if self.folder is None:
            return
        from flankfilm.files.plain_data import NotPlainDataError, written

        try:
            payload = written(value, PACKAGES)
            with replacing(self.folder / key) as beside:
                beside.write_bytes(_digest(key, payload) + b"\n" + payload)
            sweep_temporaries(self.folder)
        except OSError as fault:
            _warn(f"not kept ({fault.strerror})")
        except NotPlainDataError as fault:
            _warn(f"not kept ({fault})")


def _digest(key: str, payload: bytes) -> bytes:
    """Digest of an entry, its name included."""
    return hashlib.sha256(key.encode() + b"\n" + payload).hexdigest().encode()


def _warn(text: str) -> None:
    warnings.warn(f"result cache: {text}", CacheWarning, stacklevel=3)
