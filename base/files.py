"""Files that are either the old ones or the new ones, never half-written."""

from __future__ import annotations

import os
import re
import secrets
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside `path`; rename it onto `path` when the block ends well.

    The new file is flushed to the disk before the rename, so that a power cut leaves the old
    file or the whole new one. When the block raises, the temporary file is removed; an `OSError` names `path`.

    Examples
    --------
    >>> with replacing(Path("figures.txt")) as beside:
    ...     _ = beside.write_text("14.83")
    >>> Path("figures.txt").read_text()
    '14.83'
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.stem}.{secrets.token_hex(6)}{path.suffix}")
    try:
        yield beside
        with beside.open("rb+") as written:
            os.fsync(written.fileno())
        beside.replace(path)
    except OSError as fault:
        if fault.filename is None or Path(os.fsdecode(fault.filename)) == beside:
            raise OSError(fault.errno, fault.strerror or str(fault), str(path)) from fault
        raise
    finally:
        beside.unlink(missing_ok=True)


def sweep_temporaries(folder: Path, older_than: float = 3600.0) -> None:
    """Remove what killed runs left beside their targets, once it is older than `older_than` seconds.

    Examples
    --------
    >>> sweep_temporaries(Path())
    """
    for path in folder.iterdir():
        if _TEMPORARY.fullmatch(path.name):
            with suppress(FileNotFoundError):  # another run may sweep, or rename, at the same time
                if time.time() - path.stat().st_mtime > older_than:
                    path.unlink()


_TEMPORARY = re.compile(r"\..+\.[0-9a-f]{12}(\.\w+)?")
