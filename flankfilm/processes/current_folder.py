"""Settings of libraries that lie in the current folder, which they would obey whoever had put them there."""

from __future__ import annotations

import sys
from contextlib import chdir, nullcontext
from pathlib import Path

from base import InputError

__all__ = ["disregard_settings", "load_matplotlib"]

OF_NUMBA = ".numba_config.yaml"
"""Read each time that numba compiles."""

OF_MATPLOTLIB = "matplotlibrc"
"""Read as matplotlib is loaded."""


def disregard_settings() -> None:
    """Refuse those of numba, and load matplotlib without its own; for a command that has one thread as yet."""
    if Path(OF_NUMBA).exists():
        why = "must not lie in the current folder: it changes how results are computed"
        raise InputError.at(OF_NUMBA, "", why, "Move it away, or work in another folder")
    if Path(OF_MATPLOTLIB).exists():
        load_matplotlib()


def load_matplotlib() -> None:
    """Load matplotlib; where the current folder has settings of it, from another folder.

    The current folder is that of all threads, which may be writing files: it is left alone where it holds no such
    file. A command that finds one loads matplotlib before it has other threads.
    """
    if "matplotlib" in sys.modules:
        return
    with chdir(Path(__file__).parent) if Path(OF_MATPLOTLIB).exists() else nullcontext():
        import matplotlib  # noqa: F401
