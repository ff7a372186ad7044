"""The page of licences says what the installed libraries say, of all that is needed to run."""

from __future__ import annotations

import re
from importlib.metadata import distributions

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.licences import ROOT, direct_rows, further_rows, project

PAGE = (ROOT / "docs" / "licences.md").read_text(encoding="utf-8").splitlines()

PINS = [
    Requirement(line.rstrip(" \\"))
    for line in (ROOT / "requirements.txt").read_text(encoding="utf-8").splitlines()
    if re.match(r"[A-Za-z0-9]", line)
]


def test_every_library_stands_there_with_its_versions_and_licence():
    assert [row for row in (*direct_rows(), *further_rows()) if row not in PAGE] == []


def test_no_other_library_stands_there():
    """None that was needed once; which ones are needed differs among Pythons, what may be needed is pinned."""
    names = [line.split("|")[1].strip() for line in PAGE if re.match(r"\| [a-z]", line)]
    names = [name for name in names if name != "library"]
    assert len(names) == len(set(names)) > 60
    assert {canonicalize_name(name) for name in names} <= {canonicalize_name(pin.name) for pin in PINS}
    by_name = {one.name for asked in project().values() for one in asked}
    assert by_name <= set(names)


def test_the_strictest_is_told_first():
    text = " ".join(PAGE[:12])
    assert "**gmsh is under the GNU General Public License" in text


def test_what_is_needed_with_extras_is_pinned_with_them():
    """pip resolves ``name[extra]`` apart from ``name``: with a bare pin each newer release ended the set-up."""
    extras = {canonicalize_name(pin.name): pin.extras for pin in PINS}
    asked = [
        Requirement(text)
        for one in distributions()
        if canonicalize_name(one.name) in extras
        for text in one.requires or ()
    ]
    needed = [
        one for one in asked if one.extras and (one.marker is None or one.marker.evaluate({"extra": ""}))
    ]
    assert [str(one) for one in needed if not one.extras <= extras[canonicalize_name(one.name)]] == []
    assert needed
