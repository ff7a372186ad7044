"""References to names of this project that exist but have no page of their own stand as plain text.

Signatures name types that nobody calls, such as a solver's tables. A name that exists nowhere stays a warning, and
with it a failure of the build.
"""

from __future__ import annotations

import sys
from importlib import import_module

from docutils.nodes import Element
from sphinx.addnodes import pending_xref
from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")


def _exists(name: str) -> bool:
    home, _, last = name.rpartition(".")
    if home:
        try:
            return hasattr(import_module(home), last)
        except ImportError:
            return False
    loaded = [module for path, module in list(sys.modules.items()) if path.partition(".")[0] in PACKAGES]
    return any(last in vars(module) for module in loaded)


def _as_text(app: Sphinx, env: BuildEnvironment, node: pending_xref, shown: Element) -> Element | None:
    own = node.get("refdomain") == "py" and _exists(node["reftarget"])
    return shown if own else None


def setup(app: Sphinx) -> dict[str, bool]:
    """Look at references that nothing answers."""
    app.connect("missing-reference", _as_text)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
