"""The house: who may import whom, and which libraries load only where they are needed."""

from __future__ import annotations

import ast
import importlib
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MAY_IMPORT = {
    "base": set(),
    "gears": {"base"},
    "ehl": {"base"},
    "dynamics": {"base"},
    "meshes": {"base", "gears"},
    "fem": {"base", "gears", "meshes"},
    "flankfilm": {"base", "gears", "meshes", "fem", "ehl", "dynamics"},
}


def imported(source: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names.add(node.module.partition(".")[0])
    return names


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_imports_only_go_downwards(package: str):
    sources = sorted((ROOT / package).rglob("*.py"))
    assert sources
    climbing = {
        str(source.relative_to(ROOT)): found
        for source in sources
        if (found := imported(source) & (MAY_IMPORT.keys() - MAY_IMPORT[package] - {package}))
    }
    assert climbing == {}


def test_the_coupling_knows_no_scene_and_no_files():
    reached = set()
    for source in (ROOT / "flankfilm" / "coupling").glob("*.py"):
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("flankfilm"):
                whole = [f"{node.module}.{alias.name}" for alias in node.names]
                reached |= {name for name in whole if not name.startswith("flankfilm.coupling.")}
    assert reached == set()


@pytest.mark.parametrize("package", ["flankfilm", "flankfilm.coupling"])
def test_the_front_door_shows_public_names_alone_and_loads_nothing_before_use(package: str):
    module = importlib.import_module(package)
    assert dir(module) == sorted(module.__all__)
    assert loaded_by(f"import {package}") & (HEAVY | {"numpy", "scipy", "pydantic"}) == set()


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_no_file_holds_too_much(package: str):
    long = {s.name: n for s in (ROOT / package).rglob("*.py") if (n := len(s.read_text().splitlines())) > 500}
    assert long == {}


def loaded_by(code: str) -> set[str]:
    report = "import sys; print(' '.join({n.partition('.')[0] for n in sys.modules}))"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


HEAVY = {"gmsh", "skfem", "meshio", "pyvista", "vtkmodules", "numba", "matplotlib", "xarray"}


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_importing_a_package_loads_nothing_heavy(package: str):
    assert loaded_by(f"import {package}") & HEAVY == set()


@pytest.mark.parametrize("package", ["base", "gears"])
def test_the_lowest_floors_need_numpy_alone(package: str):
    assert loaded_by(f"import {package}") & (HEAVY | {"scipy", "pydantic"}) == set()
