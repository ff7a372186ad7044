"""Results kept by content: the same inputs and the same code give the stored result back.

An entry is one file named by the digest of what made it. Its first line holds the digest of its
payload, so that flipped bits and cut files are noticed, removed and computed again.
"""

from __future__ import annotations

import atexit
import hashlib
import json
import os
import pickle
import platform
import shutil
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import metadata, util
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
    """Cache of results in the user's folder; one that holds nothing where it is not to be used."""
    return Cache(user_cache() / "results" if use else None)


@cache
def code_digest(packages: tuple[str, ...]) -> str:
    """Digest of the source files of `packages`, and of Python and the libraries' versions."""
    digest = hashlib.sha256(platform.python_version().encode())
    for name in LIBRARIES:
        digest.update(f"{name}=={metadata.version(name)}\n".encode())
    for package in sorted(packages):
        for source in sorted(_folder(package).rglob("*.py")):
            digest.update(source.name.encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


def _folder(package: str) -> Path:
    spec = util.find_spec(package)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"package {package} is not installed")
    return Path(spec.origin).parent


def keep_compiled_code() -> None:
    """Give numba a cache folder of our own, named by the code that it compiles.

    numba does not notice a changed helper in another file, and fails where site-packages cannot
    be written; a folder per digest of the sources cures both. Call it before numba is imported.
    """
    if "NUMBA_CACHE_DIR" in os.environ:
        return
    folder = user_cache() / "compiled" / code_digest(("base", "ehl", "dynamics"))[:16]
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError:
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
        path = self.folder / key
        try:
            head, _, payload = path.read_bytes().partition(b"\n")
        except FileNotFoundError:
            return None
        except OSError as fault:
            _warn(f"{path}: {fault.strerror}; computed again")
            return None
        if hashlib.sha256(payload).hexdigest().encode() != head:
            path.unlink(missing_ok=True)
            _warn(f"{path.name[:12]} was damaged; computed again")
            return None
        return pickle.loads(payload)

    def put(self, key: str, value: Any) -> None:
        """Keep a value; where that is not possible (full disk) warn and go on."""
        if self.folder is None:
            return
        payload = pickle.dumps(value, protocol=pickle.HIGHEST_PROTOCOL)
        try:
            with replacing(self.folder / key) as beside:
                beside.write_bytes(hashlib.sha256(payload).hexdigest().encode() + b"\n" + payload)
            sweep_temporaries(self.folder)
        except OSError as fault:
            _warn(f"not kept ({fault.strerror})")


def _warn(text: str) -> None:
    warnings.warn(f"result cache: {text}", CacheWarning, stacklevel=3)
