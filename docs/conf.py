"""How Sphinx builds these pages into a site that needs no network to be read: ./run docs."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "_extension"))

with (HERE.parent / "pyproject.toml").open("rb") as _file:
    _project = tomllib.load(_file)["project"]

project = "flankfilm"
author = _project["authors"][0]["name"]
project_copyright = author
version = release = _project["version"]
language = "en"

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "numpydoc",
    "mathml",
    "own_names",
    "signatures",
    "key_tables",
]
exclude_patterns = ["_extension"]
nitpicky = True

# Formulas stand between dollars, as forges show them; here they become MathML, which browsers draw by themselves.
myst_enable_extensions = ["dollarmath", "attrs_block"]
myst_dmath_double_inline = True
myst_heading_anchors = 4
html_math_renderer = "mathml"
highlight_language = "none"

# Types of other libraries have no page here.
nitpick_ignore_regex = [
    (
        "py:.*",
        r"(numpy|np|npt|scipy|xarray|xr|pydantic|matplotlib|Figure$|collections|concurrent|pathlib)\b.*",
    ),
]
autosummary_generate = True
autosummary_generate_overwrite = True
# A class and a function whose names differ in case alone share a file on some systems.
autosummary_filename_map = {
    name: f"{name}_class"
    for name in (
        "dynamics.Diagram",
        "dynamics.Manifold",
        "fem.PairCompliance",
        "fem.Fillets",
        "gears.tooth.contour.Contour",
    )
}
autodoc_typehints = "signature"
autodoc_member_order = "bysource"
numpydoc_show_class_members = False
templates_path = ["_templates"]

html_theme = "furo"
html_title = f"flankfilm {version}"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sphinx = False
html_copy_source = False
html_show_sourcelink = False
