"""Signatures name types as the module does that defines the object; here such names become whole ones.

Two packages may each have a MeshCycle, and a module may import its own for type checkers alone, so that Sphinx sees a
bare name. Where the module takes it from is read from its source.
"""

from __future__ import annotations

import ast
import inspect
from functools import cache
from importlib import import_module
from typing import Any

from docutils.nodes import document
from pydantic import BaseModel
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")


@cache
def _imported(module: str) -> dict[str, str]:
    """Whole names of what a module imports from the project, and of its own classes."""
    tree = ast.parse(inspect.getsource(import_module(module)))
    whole = {node.name: f"{module}.{node.name}" for node in tree.body if isinstance(node, ast.ClassDef)}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").partition(".")[0] in PACKAGES:
            whole |= {alias.asname or alias.name: f"{node.module}.{alias.name}" for alias in node.names}
    return whole


def _home(page: str) -> str:
    """Module that defines the object of a generated page, or empty."""
    package, _, name = page.rpartition("/")[2].removesuffix("_class").rpartition(".")
    if not page.startswith("api/generated/") or not package:
        return ""
    return str(getattr(getattr(import_module(package), name, None), "__module__", ""))


def _whole_names(app: Sphinx, tree: document) -> None:
    home = _home(app.env.docname)
    if home.partition(".")[0] not in PACKAGES:
        return
    whole = _imported(home)
    for node in tree.findall(pending_xref):
        if node.get("refdomain") == "py" and node["reftarget"] in whole:
            node["reftarget"] = whole[node["reftarget"]]


def _without_keys(
    app: Sphinx, what: str, name: str, value: Any, options: Any, signature: str, returns: str
) -> tuple[str, str] | None:
    """A file's sections and their bounds have a page of their own."""
    return ("(**sections)", "") if isinstance(value, type) and issubclass(value, BaseModel) else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Look at every page and signature."""
    app.connect("doctree-read", _whole_names)
    app.connect("autodoc-process-signature", _without_keys)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
