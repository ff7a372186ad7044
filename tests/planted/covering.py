"""Which tests run a line, and how long each takes: read from a run of the suite with coverage by test."""

from __future__ import annotations

import ast
import difflib
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from coverage import CoverageData

from tests.planted.faults import Fault

LOG = "map.log"
DURATION = re.compile(r"^([\d.]+)s (?:setup|call|teardown)\s+(\S.*)$", re.MULTILINE)
PROCESSES = re.compile(r"\bsubprocess\b|tests\.flankfilm\.program")
SHORTEST = 0.01
"""Seconds of a test whose duration pytest does not print."""


def make(root: Path, folder: Path, arguments: Iterable[str]) -> int:
    """Run tests with coverage by test; leaves ``.coverage`` and a log with durations in a folder."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "--cov",
        "--cov-context=test",
        "--cov-report=",
        "--cov-fail-under=0",
    ]
    folder.mkdir(parents=True, exist_ok=True)
    env = {**os.environ, "COVERAGE_FILE": str(folder / ".coverage")}
    with (folder / LOG).open("w") as log:
        done = subprocess.run(
            [*command, "--durations=0", "-vv", *arguments],
            cwd=root,
            env=env,
            stdout=log,
            stderr=subprocess.STDOUT,
            check=False,
        )
    return done.returncode


@dataclass(frozen=True)
class Map:
    """Tests by line, of the tree in which they ran."""

    tree: Path
    seconds: dict[str, float]  # of each test, with what it sets up
    lines: dict[str, dict[int, frozenset[str]]] = field(default_factory=dict)  # by file and line: what ran it

    @classmethod
    def read(cls, folder: Path) -> Map:
        """Read what `make` left, or any run of pytest-cov with contexts and a log with durations."""
        seconds: dict[str, float] = defaultdict(float)
        for spent, test in DURATION.findall((folder / LOG).read_text(encoding="utf-8")):
            seconds[test] += float(spent)
        data = CoverageData(str(folder / ".coverage"))
        data.read()
        tree = next(
            Path(file).parents[1] for file in data.measured_files() if file.endswith("/base/results.py")
        )
        lines = {}
        for file in data.measured_files():
            if Path(file).is_relative_to(tree):
                path = Path(file).relative_to(tree).as_posix()
                lines[path] = {line: frozenset(by) for line, by in data.contexts_by_lineno(file).items()}
        return cls(tree, seconds, lines)

    def tests(self, fault: Fault, root: Path) -> list[list[str]]:
        """Tests that may see a fault, the likeliest first: they run its lines, set them up, or run its file.

        Lines that run when a module is loaded or in compiled code are known to no test: the tests of the places that
        name what stands there are taken for them. Lines of the application that run in processes of their own, or when
        it is loaded, may be seen by every test that starts one.
        """
        here = self._lines_then(fault, root)
        ran, prepared = self._by(fault.path, here)
        if not ran | prepared:
            ran |= self._by_name(fault)
        files = {test.partition("::")[0] for test in prepared}
        if self._ran_elsewhere(fault, here):
            files |= self._starting_processes
        beside = {test for test in self.all if test.partition("::")[0] in files}
        near = self._by(fault.path, self.lines.get(fault.path, {}))[0]
        groups = [ran | prepared, beside, near]
        own = f"tests/{fault.path.partition('/')[0]}/"  # the package's own tests say most of it
        done: set[str] = set()
        out = []
        for group in groups:
            out.append(sorted(group - done, key=lambda test: (not test.startswith(own), self.cost(test))))
            done |= group
        return out

    def covered(self, fault: Fault, root: Path) -> bool:
        """Whether any test is known to run the lines of a fault, or they were run at all."""
        mine = self.lines.get(fault.path, {})
        return any(mine.get(line) for line in self._lines_then(fault, root))

    def cost(self, test: str) -> float:
        """Seconds of a test."""
        return self.seconds.get(test, SHORTEST)

    @cached_property
    def all(self) -> frozenset[str]:
        """Every test that ran a line."""
        contexts = {by for file in self.lines.values() for some in file.values() for by in some}
        return frozenset(context.rpartition("|")[0] for context in contexts if context)

    def _ran_elsewhere(self, fault: Fault, lines: Iterable[int]) -> bool:
        """Whether lines of the application ran outside the tests' own process, or when it was loaded."""
        mine = self.lines.get(fault.path, {})
        return fault.path.startswith("flankfilm/") and any("" in mine.get(line, ()) for line in lines)

    @cached_property
    def _starting_processes(self) -> frozenset[str]:
        """Test files that start processes."""
        files = {file for test in self.all if (self.tree / (file := test.partition("::")[0])).exists()}
        return frozenset(
            file for file in files if PROCESSES.search((self.tree / file).read_text(encoding="utf-8"))
        )

    def _by(self, path: str, lines: Iterable[int]) -> tuple[set[str], set[str]]:
        """Tests that ran the lines, and tests that ran them while they were set up."""
        mine = self.lines.get(path, {})
        contexts = {context for line in lines for context in mine.get(line, ()) if context}
        split = {one.rpartition("|")[::2] for one in contexts}
        return {test for test, when in split if when == "run"}, {
            test for test, when in split if when != "run"
        }

    def _lines_then(self, fault: Fault, root: Path) -> list[int]:
        """The lines of a fault as they were numbered when the tests ran; its statement's first line counts too."""
        then, now = self.tree / fault.path, root / fault.path
        if not then.exists():
            return []
        text = now.read_text(encoding="utf-8")
        wanted = range(_statement(text, fault.line), fault.last + 1)
        old, new = then.read_text(encoding="utf-8").splitlines(), text.splitlines()
        if old == new:
            return list(wanted)
        found = []
        for i, j, n in difflib.SequenceMatcher(None, old, new, autojunk=False).get_matching_blocks():
            found += [line - j + i for line in wanted if j < line <= j + n]
        return found

    def _by_name(self, fault: Fault) -> set[str]:
        """Tests of the places, in any file, that name what the fault is in, or what names that, and so on."""
        names = {fault.place.partition(".")[0] or self._assigned(fault)}
        for _ in range(4):
            found: set[str] = set()
            more = set(names)
            for path, index in self._names.items():
                for name in names & index.keys():
                    found |= self._by(path, [line for line, _ in index[name]])[0]
                    more |= {place for _, place in index[name] if place}
            if found or more == names:
                return found
            names = more
        return set()

    def _assigned(self, fault: Fault) -> str:
        """Name that a statement at the top of a module gives a value to."""
        for node in ast.parse((self.tree / fault.path).read_text(encoding="utf-8")).body:
            if node.lineno <= fault.line <= (node.end_lineno or 0):
                for one in ast.walk(node):
                    if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store):
                        return one.id
        return ""

    @cached_property
    def _names(self) -> dict[str, dict[str, list[tuple[int, str]]]]:
        """Where names are used: by file and name, the lines, each with the function or class at the top around it."""
        found: dict[str, dict[str, list[tuple[int, str]]]] = {}
        for path in self.lines:
            index: dict[str, list[tuple[int, str]]] = defaultdict(list)
            for top in ast.parse((self.tree / path).read_text(encoding="utf-8")).body:
                around = top.name if isinstance(top, ast.FunctionDef | ast.ClassDef) else ""
                for node in ast.walk(top):
                    match node:
                        case ast.Name(id=name, ctx=ast.Load()) | ast.Attribute(attr=name):
                            index[name].append((node.lineno, around))
            found[path] = dict(index)
        return found


COMPOUND = (ast.FunctionDef, ast.ClassDef, ast.If, ast.For, ast.While, ast.With, ast.Try)


def _statement(text: str, line: int) -> int:
    """First line of the simple statement around a line."""
    for node in ast.walk(ast.parse(text)):
        simple = isinstance(node, ast.stmt) and not isinstance(node, COMPOUND)
        if simple and node.lineno <= line <= (node.end_lineno or 0):
            return node.lineno
    return line
