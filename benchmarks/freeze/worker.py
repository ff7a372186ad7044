"""One case in one tree: runs in a process whose packages are those of that tree."""

from __future__ import annotations

import warnings
from importlib import import_module, util
from pathlib import Path

import numpy as np

from .case import Case, Room, flat

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")
FILES = ("gears", "fem", "face", "ehl", "coupling", "dynamics", "scenes", "studies")
"""Files of cases, ``cases_NAME.py``, in the order in which they run."""


def all_cases() -> tuple[Case, ...]:
    """Every case; the pairs that they compute with are made by the packages on the path."""
    modules = [import_module(f"{__package__}.cases_{name}") for name in FILES]
    return tuple(case for module in modules for case in module.case.cases)


def compute(name: str, tree: Path, folder: Path, file: Path) -> None:
    """Compute a case with the packages of a tree and keep its arrays in a file.

    Raises
    ------
    ImportError
        Where a package does not come from the tree: the comparison would be of other code.
    """
    for package in PACKAGES:
        spec = util.find_spec(package)
        if spec is None or spec.origin is None or not Path(spec.origin).is_relative_to(tree):
            raise ImportError(f"{package} comes from {spec and spec.origin}, not from {tree}")
    case = next(case for case in all_cases() if case.name == name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        arrays = flat(case.compute(Room(tree, folder)))
    np.savez(file, **arrays)  # type: ignore[arg-type]
