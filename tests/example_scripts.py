"""Scripts of the examples as modules: each finds its neighbours as it does when it is run."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path
from types import ModuleType

FOLDER = Path(__file__).parents[1] / "examples"


def example(name: str, folder: str = "motion") -> ModuleType:
    """Module of a script."""
    home = str(FOLDER / folder)
    sys.path.insert(0, home)
    try:
        spec = importlib.util.spec_from_file_location(name, FOLDER / folder / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
        return module
    finally:
        sys.path.remove(home)
