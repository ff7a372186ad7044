"""Names of values: words that could stand for anything are no names."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm", "benchmarks", "docs", "examples")

SCRIPTS = "benchmarks/studies/"
NO_NAMES = {"found", "one", "some", "both", "given", "where", "every"}
FIELDS = {
    ("base/faults.py", "where"),  # of a fault
    ("dynamics/inverse/report.py", "found"),  # of what was asked for
    ("dynamics/orbits/finding.py", "found"),  # of what the index demands
}
"""Fields of public records, and parameters that are named after them."""


def bound(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Names of values and functions with their lines; those of comprehensions and lambdas live for one line."""
    nodes = list(ast.walk(tree))
    short = {
        id(node)
        for part in nodes
        if isinstance(part, ast.comprehension | ast.Lambda)
        for node in ast.walk(part.target if isinstance(part, ast.comprehension) else part.args)
    }
    for node in nodes:
        if id(node) in short:
            continue
        if isinstance(node, ast.Name):
            if isinstance(node.ctx, ast.Store):
                yield node.lineno, node.id
        elif isinstance(node, ast.arg):
            yield node.lineno, node.arg
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node.lineno, node.name


@pytest.mark.parametrize("folder", FOLDERS)
def test_values_are_called_what_they_are(folder: str):
    nameless = []
    for source in sorted((ROOT / folder).rglob("*.py")):
        path = source.relative_to(ROOT).as_posix()
        if path.startswith(SCRIPTS):
            continue
        for line, name in bound(ast.parse(source.read_text(encoding="utf-8"))):
            if name in NO_NAMES and (path, name) not in FIELDS:
                nameless.append(f"{path}:{line}: {name}")
    assert nameless == []


def test_names_are_seen_where_they_are_bound():
    code = "def one(some):\n    both: int = 1\n    for found, left in pairs: pass\n    return [given for given in x]"
    assert {name for _, name in bound(ast.parse(code))} == {"one", "some", "both", "found", "left"}
