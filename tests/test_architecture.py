"""The house: who may import whom, and which libraries load only where they are needed."""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
import tomllib
from collections.abc import Iterable, Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
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
    "benchmarks": {"base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm"},
}


WINGS: dict[str, list[list[str]]] = {
    "fem": [
        ["elasticity"],
        ["influence"],
        ["pair"],
        ["laws"],
        ["contact"],
        ["cycle"],
        ["stress"],
        ["fields"],
    ],
    "ehl": [["oil"], ["kernels"], ["discrete"], ["solving"], ["films"]],
    "gears": [["tooth"], ["pair"], ["sharing", "closed_form"], ["rating"]],
    "dynamics": [
        ["kernels"],
        ["model"],
        ["flow"],
        ["orbits"],
        ["branches", "motion"],
        ["attraction"],
        ["inverse"],
    ],
    "flankfilm": [
        ["coupling"],
        ["files"],
        ["processes"],
        ["scene"],
        ["building"],
        ["plan"],
        ["stages"],
        ["output"],
        ["figures"],
        ["outcome"],
        ["report"],
        ["products"],
        ["runs"],
        ["studies"],
        ["optimisation"],
        ["verification"],
        ["exchange"],
        ["bench"],
        ["app"],
    ],
    "flankfilm/coupling": [["mesh"], ["films"], ["losses"], ["vibration"], ["drive"], ["speeds"], ["rating"]],
}
"""Folders of each package from the lowest up; those on one floor know nothing of each other.

What stands in the package itself is above them all.
"""
FILES = 22
"""Modules that a folder holds at most."""


Imports = list[ast.Import | ast.ImportFrom]


def imports_in(source: Path) -> Imports:
    """All imports that a file has, in functions and under TYPE_CHECKING too."""
    tree = ast.parse(source.read_text(encoding="utf-8"))
    return [node for node in statements(tree) if isinstance(node, ast.Import | ast.ImportFrom)]


def statements(within: ast.AST) -> Iterator[ast.AST]:
    """All statements, at any depth, with the branches that hold them; no expressions, which are most of a tree."""
    for branch in ("body", "orelse", "finalbody", "handlers", "cases"):
        for node in getattr(within, branch, ()):
            yield node
            yield from statements(node)


def test_imports_are_seen_at_any_depth():
    code = (
        "import a\ntry:\n    import b\nexcept OSError:\n    import c\nelse:\n    import d\nfinally:\n    import e\n"
        "for x in y:\n    import f\nelse:\n    import g\nwith z:\n    def w():\n        import h\n"
        "class V:\n    if u:\n        import i\n    elif t:\n        from j import k\n"
        "match s:\n    case 1:\n        import l\nwhile r:\n    async def q():\n        import m\n"
    )
    found = [node for node in statements(ast.parse(code)) if isinstance(node, ast.Import | ast.ImportFrom)]
    assert len(found) == 12
    assert len(found) == sum(
        isinstance(node, ast.Import | ast.ImportFrom) for node in ast.walk(ast.parse(code))
    )


class Files:
    """Modules of a package and what each imports of the others, in functions and under TYPE_CHECKING too."""

    def __init__(self, folder: Path) -> None:
        top = folder
        while (top.parent / "__init__.py").exists():
            top = top.parent
        self.sources = {self.named(source, top): source for source in folder.rglob("*.py")}
        self.written = {name: imports_in(source) for name, source in self.sources.items()}
        self.shown = {name: self.names_of(name) for name in self.sources}
        self.imports = {name: self.reached(name) for name in self.sources}

    @staticmethod
    def named(source: Path, folder: Path) -> str:
        parts = source.relative_to(folder.parent).with_suffix("").parts
        return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)

    def packages_of(self, module: str) -> set[str]:
        """First parts of what a module imports by an absolute name."""
        names: set[str] = set()
        for node in self.written[module]:
            if isinstance(node, ast.Import):
                names |= {alias.name.partition(".")[0] for alias in node.names}
            elif node.level == 0 and node.module:
                names.add(node.module.partition(".")[0])
        return names

    def from_imports(self, module: str, written: Iterable[ast.Import | ast.ImportFrom]):
        """Absolute name of the module, name in it and name here, for every `from module import name as name`."""
        package = module if self.sources[module].name == "__init__.py" else module.rpartition(".")[0]
        for node in written:
            if isinstance(node, ast.ImportFrom):
                above = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
                start = ".".join([*above, *([node.module] if node.module else [])])
                for alias in node.names:
                    yield start, alias.name, alias.asname or alias.name

    def names_of(self, module: str) -> dict[str, tuple[str, str]]:
        """Where a package has the names from that it hands on: its stub says it, or the package itself."""
        source = self.sources[module]
        if source.name != "__init__.py":
            return {}
        stub = source.with_suffix(".pyi")
        written = imports_in(stub) if stub.exists() else self.written[module]
        return {here: (start, name) for start, name, here in self.from_imports(module, written)}

    def home(self, module: str, name: str) -> str:
        """File that holds a name which is taken from a module."""
        if f"{module}.{name}" in self.sources:
            return f"{module}.{name}"
        start, there = self.shown.get(module, {}).get(name, (module, name))
        return module if start == module or start not in self.sources else self.home(start, there)

    def reached(self, module: str) -> set[str]:
        written = self.written[module]
        found = {self.home(start, name) for start, name, _ in self.from_imports(module, written)}
        for node in written:
            if isinstance(node, ast.Import):
                found |= {alias.name for alias in node.names}
        return found & self.sources.keys()

    def circle(self) -> list[str]:
        """Modules that import each other in a circle, the first again at the end; none if there is no circle."""
        try:
            TopologicalSorter(self.imports).prepare()
        except CycleError as error:
            return list(error.args[1])
        return []


@cache
def files_of(package: str) -> Files:
    """Files of a package of this repository, read once for all that is asked of them."""
    return Files(ROOT / package)


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_imports_only_go_downwards(package: str):
    files = files_of(package)
    assert files.sources
    climbing = {
        module: found
        for module in files.sources
        if (found := files.packages_of(module) & (MAY_IMPORT.keys() - MAY_IMPORT[package] - {package}))
    }
    assert climbing == {}


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_no_files_import_each_other_in_a_circle(package: str):
    assert files_of(package).circle() == []


def test_circles_are_found_in_functions_under_type_checking_and_through_stubs(tmp_path):
    package = tmp_path / "shop"
    package.mkdir()
    (package / "__init__.py").write_text("import lazy_loader")
    (package / "__init__.pyi").write_text("from .till import Till as Till")
    (package / "till.py").write_text("def pay():\n    from .door import Door")
    (package / "door.py").write_text("if TYPE_CHECKING:\n    from shop import Till")
    (package / "shelf.py").write_text("import shop.till\nfrom shop import door")
    files = Files(package)
    assert files.imports["shop.shelf"] == {"shop.till", "shop.door"}
    assert set(files.circle()) == {"shop.till", "shop.door"}
    (package / "door.py").write_text("from math import pi")
    assert Files(package).circle() == []


class Wings:
    """Folders of a package in their order, and the imports among them, under TYPE_CHECKING too."""

    def __init__(self, folder: Path, order: list[list[str]], files: Files | None = None) -> None:
        self.files = files or Files(folder)
        self.folder = folder
        self.floors = {wing: floor for floor, wings in enumerate(order) for wing in wings}

    def wing(self, module: str) -> str:
        """Folder of the package in which a module stands; empty for the package itself."""
        parts = self.files.sources[module].relative_to(self.folder).parts
        return parts[0] if len(parts) > 1 else ""

    def floor(self, wing: str) -> int:
        return self.floors.get(wing, len(self.floors))

    def climbing(self) -> list[tuple[str, str]]:
        """Imports of what stands above, or beside on the same floor."""
        return [
            (module, other)
            for module, others in sorted(self.files.imports.items())
            for other in sorted(others)
            if (here := self.wing(module)) != (there := self.wing(other))
            and self.floor(there) >= self.floor(here)
        ]

    def circle(self) -> list[str]:
        """Folders, at any depth, that import each other in a circle."""
        graph: dict[str, set[str]] = {}
        for module, others in self.files.imports.items():
            here = self.place(module)
            graph.setdefault(here, set()).update(set(map(self.place, others)) - {here})
        try:
            TopologicalSorter(graph).prepare()
        except CycleError as error:
            return list(error.args[1])
        return []

    def place(self, module: str) -> str:
        return self.files.sources[module].parent.relative_to(self.folder.parent).as_posix()


@pytest.mark.parametrize("package", sorted(WINGS))
def test_imports_go_down_among_the_folders_of_a_package(package: str):
    wings = Wings(ROOT / package, WINGS[package], files_of(package))
    assert {wing for module in wings.files.sources if (wing := wings.wing(module))} == wings.floors.keys()
    assert wings.climbing() == []
    assert wings.circle() == []


@pytest.mark.parametrize("package", sorted(WINGS))
def test_no_folder_holds_too_many_files(package: str):
    folders = {source.parent for source in (ROOT / package).rglob("*.py")}
    held = {folder: sum(source.name != "__init__.py" for source in folder.glob("*.py")) for folder in folders}
    assert {folder: number for folder, number in held.items() if number > FILES} == {}
    assert all(
        (folder / "__init__.py").read_text(encoding="utf-8").lstrip("r").startswith('"""')
        for folder in folders
    )


@pytest.mark.parametrize("package", sorted(WINGS))
def test_the_page_of_the_structure_lists_the_folders_in_order(package: str):
    page = (ROOT / "docs" / "api" / "structure.md").read_text(encoding="utf-8")
    rows = re.findall(rf"^\| `({package}/\w+)` \| (.+) \|$", page, re.MULTILINE)
    wings = [f"{package}/{wing}" for floor in WINGS[package] for wing in floor]
    sources = [(ROOT / wing / "__init__.py").read_text(encoding="utf-8") for wing in wings]
    docs = [ast.get_docstring(ast.parse(source)) or "" for source in sources]
    assert rows == [(wing, doc.partition("\n")[0]) for wing, doc in zip(wings, docs, strict=True)]


@pytest.mark.parametrize("package", sorted(WINGS))
def test_folders_name_what_is_public_of_them(package: str):
    stub = (ROOT / package / "__init__.pyi").read_text(encoding="utf-8")
    shown = re.findall(r"^from \.(\w+)\.[\w.]+ import (\w+) as \2$", stub, re.MULTILINE)
    for wing in (wing for floor in WINGS[package] for wing in floor):
        doc = ast.get_docstring(
            ast.parse((ROOT / package / wing / "__init__.py").read_text(encoding="utf-8"))
        )
        named = (doc or "").partition(f"Public, in `{package.replace('/', '.')}`:")[2]
        assert re.findall(r"`(\w+)`", named) == [name for folder, name in shown if folder == wing]


def test_imports_that_climb_or_go_round_are_found_among_folders(tmp_path):
    package = tmp_path / "shop"
    for wing in ("", "cellar", "sales", "office", "cellar/box"):
        (package / wing).mkdir()
        (package / wing / "__init__.py").write_text("")
    (package / "cellar" / "shelf.py").write_text("if TYPE_CHECKING:\n    from shop.sales.till import Till")
    (package / "cellar" / "lamp.py").write_text("from shop.cellar.box.lid import Lid")
    (package / "cellar" / "box" / "lid.py").write_text("from shop.cellar import floor")
    (package / "cellar" / "floor.py").write_text("")
    (package / "sales" / "till.py").write_text("from shop.cellar import floor")
    (package / "office" / "desk.py").write_text("import shop.sales.till")
    order = [["cellar"], ["sales", "office"]]
    wings = Wings(package, order)
    assert wings.climbing() == [
        ("shop.cellar.shelf", "shop.sales.till"),
        ("shop.office.desk", "shop.sales.till"),
    ]
    assert wings.circle()
    (package / "cellar" / "shelf.py").write_text("")
    (package / "cellar" / "lamp.py").write_text("")
    wings = Wings(package, [["cellar"], ["sales"], ["office"]])
    assert (wings.climbing(), wings.circle()) == ([], [])


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


def test_comparisons_use_public_names_alone():
    """They run in both of two commits, between which files move."""
    reached = set()
    for source in (ROOT / "benchmarks" / "freeze").rglob("*.py"):
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and not node.level and node.module:
                reached |= {node.module} if "." in node.module else set()
            elif isinstance(node, ast.Import):
                reached |= {alias.name for alias in node.names if "." in alias.name}
    assert {name for name in reached if name.partition(".")[0] in MAY_IMPORT} == set()


def test_comparisons_are_not_in_the_wheel():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert set(project["tool"]["hatch"]["build"]["targets"]["wheel"]["packages"]) == MAY_IMPORT.keys() - {
        "benchmarks"
    }


def loaded_by(code: str) -> set[str]:
    return {name.partition(".")[0] for name in modules_loaded_by(code)}


def modules_loaded_by(code: str) -> set[str]:
    report = "import sys; print(' '.join(sys.modules))"
    done = subprocess.run(
        [sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, check=True
    )
    return set(done.stdout.split())


HEAVY = {"gmsh", "skfem", "meshio", "pyvista", "vtkmodules", "numba", "matplotlib", "xarray"}


@pytest.mark.parametrize("package", sorted(MAY_IMPORT))
def test_importing_a_package_loads_nothing_heavy(package: str):
    assert loaded_by(f"import {package}") & HEAVY == set()


def test_a_scene_is_read_and_checked_without_what_computes_it():
    assert loaded_by("import flankfilm.runs.check, flankfilm.runs.run_scene") & (HEAVY | {"scipy"}) == set()


@pytest.mark.parametrize(
    ("module", "other"),
    [
        ("flankfilm.runs.check", "fem.laws.tip_contact"),
        ("flankfilm.runs.check", "flankfilm.coupling.mesh.loaded_teeth"),
        ("flankfilm.output.files", "flankfilm.products"),
    ],
)
def test_what_starts_often_loads_no_laws_of_teeth_and_what_writes_files_no_products(module: str, other: str):
    assert other not in modules_loaded_by(f"import {module}")


@pytest.mark.parametrize("package", ["base", "gears"])
def test_the_lowest_floors_need_numpy_alone(package: str):
    assert loaded_by(f"import {package}") & (HEAVY | {"scipy", "pydantic"}) == set()
