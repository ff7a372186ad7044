"""What README and docs show is run: snippets, links, commands and their options, names, and the small examples.

A block of Python is run with its page's others before it, in a folder of its own. ``<!-- run -->`` in front of it puts
it into the default tests, nothing into the slow ones, and ``<!-- not run: why -->`` takes it out. Lines for the shell
are run where ``<!-- run: slow -->`` stands in front of them.
"""

from __future__ import annotations

import importlib
import io
import os
import re
import subprocess
import sys
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import xarray as xr
from rich.console import Console

from base import Fault
from flankfilm.cli import app
from flankfilm.runs.check import check_scene
from flankfilm.scene import read_scene
from tests.flankfilm.program import EXAMPLES, SCRIPT, flankfilm
from tests.validation.article import ISHIKAWA_MEAN, PER_MM_UM

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [ROOT / "README.md", *sorted(DOCS.rglob("*.md"))]
PACKAGES = (
    "gears",
    "gears.closed_form",
    "meshes",
    "fem",
    "ehl",
    "dynamics",
    "flankfilm",
    "flankfilm.coupling",
)

BLOCK = re.compile(r"(?:<!-- ((?:not )?run[^>]*?) -->\n)?^```(\w+)\n(.*?)^```", re.DOTALL | re.MULTILINE)
SHOWN = "not run: "


def name(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def blocks(page: Path, language: str) -> list[tuple[str, str]]:
    """Mark and text of the page's blocks in a language."""
    return [
        (m, t) for m, written, t in BLOCK.findall(page.read_text(encoding="utf-8")) if written == language
    ]


def python_of(page: Path, slow: bool) -> str:
    """The page's Python up to the last block that runs in the default tests, or all of it."""
    found = [(mark, text) for mark, text in blocks(page, "python") if not mark.startswith(SHOWN)]
    last = max((i for i, (mark, _) in enumerate(found) if mark == "run"), default=-1)
    if slow:
        return "\n".join(text for _, text in found) if last < len(found) - 1 else ""
    return "\n".join(text for _, text in found[: last + 1])


def run_python(code: str, folder: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-W", "error::DeprecationWarning", "-c", code],
        check=False,
        timeout=200,
        capture_output=True,
        text=True,
        cwd=folder,
    )
    assert done.returncode == 0, done.stderr


def pages_with(slow: bool) -> list[Path]:
    return [page for page in PAGES if python_of(page, slow)]


def heavy(page: Path) -> Any:
    """The page of all calls takes as long as a hundred tests."""
    return pytest.param(page, marks=pytest.mark.slow) if page.match("howto/python.md") else page


@pytest.mark.parametrize("page", [heavy(page) for page in pages_with(slow=False)], ids=name)
def test_python_runs(page: Path, tmp_path: Path):
    run_python(python_of(page, slow=False), tmp_path)


@pytest.mark.long
@pytest.mark.slow
def test_longer_python_runs(tmp_path: Path):
    for number, page in enumerate(pages_with(slow=True)):
        folder = tmp_path / str(number)
        folder.mkdir()
        run_python(python_of(page, slow=True), folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    "page", [p for p in PAGES if any(mark == "run: slow" for mark, _ in blocks(p, "sh"))], ids=name
)
def test_shell_lines_run(page: Path, tmp_path: Path):
    lines = "\n".join(text for mark, text in blocks(page, "sh") if mark == "run: slow")
    path = f"{SCRIPT.parent}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["sh", "-eu", "-c", lines],
        check=False,
        timeout=1200,
        capture_output=True,
        text=True,
        cwd=tmp_path,
        env={**os.environ, "PATH": path, "FLANKFILM_CACHE": str(tmp_path / "cache")},
    )
    assert done.returncode == 0, done.stderr


def test_a_block_that_is_not_run_says_why():
    for page in PAGES:
        for mark, _ in blocks(page, "python"):
            assert mark in ("", "run") or len(mark) > len(SHOWN) + 5, (name(page), mark)


# ---------------------------------------------------------------- commands


@cache
def options_of(command: str) -> frozenset[str]:
    shown = io.StringIO()
    console = Console(file=shown, width=200, color_system=None)
    app.help_print([command], console=console)
    return frozenset(re.findall(r"(?<!\w)--[a-z][a-z-]*", shown.getvalue()))


def commands_in(page: Path) -> list[tuple[str, list[str]]]:
    """Every call of the program that a page shows, in a block or within a line: command and options."""
    text = page.read_text(encoding="utf-8").replace("\\\n", " ")
    within = re.findall(r"`((?:\.venv/bin/)?flankfilm [^`]+)`", text)
    lines = [
        line
        for block in re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
        for line in block.split("\n")
    ]
    lines += [line for line in text.split("\n") if line.startswith("    ")]
    called = []
    for line in [*within, *lines]:
        for call in re.findall(r"(?:^|[\s/])flankfilm ((?:[a-z-]+\b)[^;&|]*)", line.split(" #")[0]):
            command, *rest = call.split()
            called.append((command, [word.partition("=")[0] for word in rest if word.startswith("--")]))
    return called


@pytest.mark.parametrize("page", [p for p in PAGES if commands_in(p)], ids=name)
def test_commands_and_their_options_exist(page: Path):
    known = {command for command in app if not command.startswith("-")}
    for command, options in commands_in(page):
        assert command in known, f"flankfilm {command}"
        missing = [option for option in options if option not in options_of(command)]
        assert not missing, f"flankfilm {command}: {missing}"


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_files_and_jobs_that_a_page_names_exist(page: Path):
    text = page.read_text(encoding="utf-8")
    usage = (ROOT / "run").read_text(encoding="utf-8").split("TEXT")[1]
    for job in re.findall(r"(?:^|[`\s])\./run ([a-z]+)", text):
        assert f"\n  {job}" in usage, f"./run {job}"
    named = re.findall(r"(?<![\w/.])((?:tests|examples|docs)/[\w/.-]+\.(?:py|toml|md))", text)
    missing = [path for path in named if not (ROOT / path).exists()]
    assert missing == []


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_links_lead_somewhere(page: Path):
    targets = re.findall(r"\]\(([^)#]+)\)", page.read_text(encoding="utf-8"))
    missing = [t for t in targets if "://" not in t and not (page.parent / t).exists()]
    assert missing == []


# ---------------------------------------------------------------- the Python interface


def listed(page: str) -> set[str]:
    """Names in the tables of a page, with the package that the page was at."""
    found, home = set(), ""
    for line in (DOCS / "api" / f"{page}.md").read_text(encoding="utf-8").split("\n"):
        if line.startswith(".. currentmodule::"):
            home = line.split("::")[1].strip()
        elif re.fullmatch(r"   [\w.]+", line):
            found.add(f"{home}.{line.strip()}")
    return found


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_has_its_page(package: str):
    """A name that a package has from a lower one stands on the page of that one."""
    page = package.partition(".")[0]
    module = importlib.import_module(package)
    public = {n: getattr(module, n) for n in module.__all__}
    own = {n for n, value in public.items() if not isinstance(value, ModuleType) and value is not Fault}
    assert {n for n in own if not {f"{package}.{n}", f"{page}.{n}"} & listed(page)} == set()


@pytest.mark.parametrize("page", [p for p in PACKAGES if "." not in p])
def test_names_of_the_interface_exist_and_say_what_they_are(page: str):
    for full in listed(page):
        home, _, last = full.rpartition(".")
        assert getattr(importlib.import_module(home), last) is not None, full


def test_the_version_to_cite_is_this_one():
    version = re.search(
        r'^version = "(.+)"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.MULTILINE
    )
    assert version
    assert f"\nversion: {version[1]}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    assert f"version = {{{version[1]}}}" in (DOCS / "cite.md").read_text(encoding="utf-8")


# ---------------------------------------------------------------- examples


def test_all_examples_are_valid_scenes_and_studies_stand_apart():
    for scene in sorted(EXAMPLES.glob("*.toml")):
        assert " is valid." in check_scene(read_scene(scene))[0]


@pytest.mark.slow
def test_the_way_of_many_papers_runs(tmp_path):
    scene, cache = EXAMPLES / "independent_pairs.toml", str(tmp_path / "cache")
    done = flankfilm("run", scene, "--out", "out", cwd=tmp_path, FLANKFILM_CACHE=cache)
    assert "error unknown" in done.stdout
    with xr.open_dataset(tmp_path / "out" / "results.nc", engine="h5netcdf") as found:
        assert float(found.dry_secant_stiffness.mean()) / PER_MM_UM == pytest.approx(ISHIKAWA_MEAN, rel=0.005)
