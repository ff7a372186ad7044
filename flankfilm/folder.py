"""The folder that results go to."""

from __future__ import annotations

from pathlib import Path

from base import InputError
from base.files import sweep_temporaries


def claim(folder: Path) -> None:
    """Make the folder and see that it can be written before anything is computed."""
    if folder.exists() and not folder.is_dir():
        raise InputError.at(folder, "", "is a file, not a folder", "Name another with --out")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / ".flankfilm-probe"
        probe.touch()
        probe.unlink(missing_ok=True)
        sweep_temporaries(folder)
    except OSError as fault:
        allowed = f"cannot be written: {fault.strerror}"
        raise InputError.at(folder, "", allowed, "Name another with --out") from fault
