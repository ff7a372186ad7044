"""The folder that results go to, files that a user names to be read, and files that must be new."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from base import Faults, FlankfilmError, InputError, shorten
from base.files import sweep_temporaries

DAMAGE = (OSError, RuntimeError, ValueError, LookupError, TypeError, SyntaxError, EOFError, AttributeError,
          ArithmeticError, MemoryError)  # fmt: skip
"""What libraries raise on damaged files: they follow references, sizes and exponents that are not there."""


ELSEWHERE = "Name another with --out"

REPORTS = {
    "results.nc": "a run",
    "study.nc": "a study",
    "optimum.nc": "an optimisation",
    "verify.nc": "a verification",
}
"""Files of data that have a page beside them, and of what they are: a folder holds one of them."""

PAGE = "report.html"
"""Name of that page."""

MANIFEST = "files.json"
"""Name of the list of a folder's files."""

UNFINISHED = ".unfinished."
"""Beginning of the names of folders in it for files of a run that is under way."""

AWAY = "Move it away, or name another folder with --out"


def claim(folder: Path, data: str = "", folders: Iterable[str] = ()) -> None:
    """Make the folder and see that it can be written before anything is computed.

    Parameters
    ----------
    folder : Path
    data : str
        Which of `REPORTS` will be written: no other one may be there with its report, which would be replaced.
    folders : iterable of str
        Names in it that will be folders: neither they nor the files beside them may be there as the other.
    """
    if folder.exists() and not folder.is_dir():
        raise InputError.at(folder, "", "is a file, not a folder", ELSEWHERE)
    with Faults() as faults:
        others = [name for name in REPORTS if name != data and (folder / name).exists()]
        if data and others and (folder / PAGE).exists():
            clash = f"holds {REPORTS[others[0]]} ({others[0]}), whose {PAGE} would be replaced"
            faults.add(str(folder), "", clash, ELSEWHERE)
        for path in (folder / name for name in (data, PAGE, MANIFEST) if data):
            if path.is_dir():
                faults.add(str(path), "", "is a folder, and a file of that name will be written", AWAY)
        for path in (folder / name for name in folders):
            if path.is_symlink():
                faults.add(str(path), "", "is a link, through which files elsewhere would be replaced", AWAY)
            elif os.path.lexists(path) and not path.is_dir():
                faults.add(str(path), "", "is no folder, and a folder of that name will be written", AWAY)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
        sweep_temporaries(folder)
    except OSError as fault:
        allowed = f"cannot be written: {fault.strerror}"
        raise InputError.at(folder, "", allowed, ELSEWHERE) from fault


def refuse_irregular(path: Path) -> None:
    """Refuse what is there and is no plain file: a link would have us write elsewhere, a pipe wait for ever."""
    if os.path.lexists(path) and not stat.S_ISREG(path.lstat().st_mode):
        raise InputError.at(path, "", "is a link, a pipe or a folder, and must be a plain file", AWAY)


def content_of(path: Path, largest: int, remedy: str, shorter: str) -> bytes:
    """Content of a file that somebody else wrote.

    Parameters
    ----------
    path : Path
    largest : int
        Bytes above which it is not read.
    remedy, shorter : str
        What to do where it is missing, and where it is too large.
    """
    try:
        refuse_missing(path, remedy)
        if path.stat().st_size > largest:
            raise InputError.at(path, "", f"is larger than {largest:,} bytes", shorter)
        return path.read_bytes()
    except OSError as fault:
        raise InputError.at(path, "", f"cannot be read: {fault.strerror}") from fault


@contextmanager
def readable(path: Path, remedy: str = "Run the scene again") -> Iterator[None]:
    """Turn what libraries raise on damaged files into a fault of the file; for a block that reads and does no more.

    Parameters
    ----------
    path : Path
        What is read.
    remedy : str
    """
    try:
        yield
    except FlankfilmError:
        raise
    except DAMAGE as fault:
        allowed = f"cannot be read: {shorten(f'{type(fault).__name__}: {fault}')}"
        raise InputError.at(path, "", allowed, remedy) from fault


def refuse_missing(path: Path, remedy: str) -> None:
    """Refuse what is no file."""
    if not path.is_file():
        there = "is a pipe or a device, not a file" if path.exists() else "does not exist"
        raise InputError.at(path, "", "is a folder" if path.is_dir() else there, remedy)


def write_new(path: Path, text: str, remedy: str) -> None:
    """Write a file that must not exist yet; whole, or not at all."""
    try:
        with path.open("x", encoding="utf-8") as file:
            try:
                file.write(text)
                file.flush()
            except OSError as fault:
                path.unlink()
                raise OSError(fault.errno, fault.strerror, str(path)) from fault
    except FileExistsError as fault:
        raise InputError.at(path, "", "exists already and is kept", remedy) from fault


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep a second run or study out of the folder; the lock goes with the process that holds it.

    Raises
    ------
    InputError
        Where another one is at work there.
    """
    from filelock import FileLock, Timeout

    path = folder / ".lock"
    refuse_irregular(path)
    lock = FileLock(path)
    try:
        lock.acquire(timeout=0)
    except Timeout as fault:
        allowed = "another run or study is at work there"
        raise InputError.at(folder, "", allowed, "Wait for it, or name another --out") from fault
    try:
        yield
    finally:
        lock.release()


@contextmanager
def occupied(folder: Path | None, data: str = "", folders: Iterable[str] = ()) -> Iterator[None]:
    """Claim a folder, and keep others out of it meanwhile; parameters as of `claim`. None is nobody's."""
    if folder is None:
        yield
        return
    claim(folder, data, folders)
    with locked(folder):
        yield


@contextmanager
def unfinished(folder: Path | None) -> Iterator[Path | None]:
    """Give a folder in one that is `occupied`, for files that are not to replace earlier ones before a run has ended.

    It is gone afterwards, and so is what killed runs left of theirs.
    """
    if folder is None:
        yield None
        return
    for left in folder.glob(f"{UNFINISHED}*"):
        if left.is_dir() and not left.is_symlink():
            shutil.rmtree(left, ignore_errors=True)
    with tempfile.TemporaryDirectory(prefix=UNFINISHED, dir=folder, ignore_cleanup_errors=True) as beside:
        yield Path(beside)
