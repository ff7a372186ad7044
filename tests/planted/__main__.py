"""Plants random faults in the packages, one at a time in a copy, and counts those that a default test sees.

First the map of tests by line, which takes as long as the suite with coverage does (any pytest option may follow)::

    python -m tests.planted map -n 2

It leaves ``.coverage`` and ``map.log`` in the folder ``out/planted``. Then as many faults as wanted::

    python -m tests.planted plant --faults 300 --seed 1 --out planted.jsonl

``--among ehl fem/contact/solver.py`` draws them in these folders and files, ``--since REVISION`` in lines written
since.

A fault is seen when a test that passes without it fails, hangs or cannot be loaded. The share counts every fault that
was planted; those that change no result by more than its tolerance (hints of speed, messages) are told apart by
reading the list of survivors. After tests have been added: ``--again planted.jsonl --also tests/new.py``, with the same
map.
"""

from __future__ import annotations

import argparse
import compileall
import json
import os
import shutil
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tests.planted.covering import Map, make
from tests.planted.faults import Fault, named, sample, written_since
from tests.planted.forks import COMPILING, PATIENCE, Outcome, load_libraries, run_tests

ROOT = Path(__file__).parents[2]
PACKAGES = ("base", "gears", "meshes", "fem", "ehl", "dynamics", "flankfilm")
LEFT_OUT = (
    ".git",
    ".venv",
    "__pycache__",
    ".hypothesis",
    ".coverage*",
    ".*_cache",
    "out",
    "*.log",
    "*.egg-info",
)
COMPILING_TESTS = (
    "tests/ehl/test_kernels.py",
    "tests/dynamics/test_protocol.py",
    "tests/dynamics/test_motion_examples.py",
)
COMPILED = ("from numba", "import numba", "kernels.compiling")
"""What the sources of compiled code hold."""


@dataclass
class Field:
    """A copy of the repository in which faults are planted."""

    work: Path
    covering: Map
    seconds: float  # for the tests of one fault
    also: Sequence[str] = ()  # tests that the map does not know
    unfit: set[str] = field(default_factory=set)  # tests that fail here without a fault
    planted: int = 0

    @property
    def tree(self) -> Path:
        """Root of the copy."""
        return self.work / "tree"

    def lay_out(self) -> None:
        """Copy what has changed in the repository, with the times of its files, and compile it for Python."""
        wanted = set()
        for folder, folders, files in os.walk(ROOT):
            ignored = shutil.ignore_patterns(*LEFT_OUT)(folder, [*folders, *files])
            folders[:] = [name for name in folders if name not in ignored]
            for source in (Path(folder) / name for name in files if name not in ignored):
                copy = self.tree / source.relative_to(ROOT)
                wanted.add(copy)
                then = copy.stat() if copy.exists() else None
                if then is None or (then.st_mtime_ns, then.st_size) != (
                    source.stat().st_mtime_ns,
                    source.stat().st_size,
                ):
                    copy.parent.mkdir(parents=True, exist_ok=True)
                    shutil.copy2(source, copy)
        for copy in self.tree.rglob("*.py"):
            if copy not in wanted:
                copy.unlink()
        compileall.compile_dir(self.tree, quiet=2, maxlevels=20)

    def chosen(self, fault: Fault) -> list[str]:
        """Tests for a fault within the time: those that run its lines first of all, the fast ones before the slow."""
        groups = [
            [t for t in group if t not in self.unfit and (self.tree / t.partition("::")[0]).exists()]
            for group in self.covering.tests(fault, ROOT)
        ]
        taken: dict[str, None] = {}
        spent = 0.0
        for share, group in ((0.7, groups[0]), (0.85, groups[1]), (1.0, groups[2]), (1.0, groups[0])):
            for test in group:
                if test not in taken and spent + self.covering.cost(test) <= share * self.seconds:
                    taken[test] = None
                    spent += self.covering.cost(test)
        # tests of one file stand together, so that what they share is set up once
        ordered: list[str] = []
        for least, most in ((0.0, 0.3), (0.3, 2.0), (2.0, float("inf"))):
            of_file: dict[str, list[str]] = {}
            for test in taken:
                if least <= self.covering.cost(test) < most:
                    of_file.setdefault(test.partition("::")[0], []).append(test)
            ordered += [test for tests in of_file.values() for test in tests]
        return [*self.also, *ordered]

    def _fits(self, test: str) -> bool:
        return test not in self.unfit and (self.tree / test.partition("::")[0]).exists()

    def plant(self, fault: Fault) -> Outcome:
        """Plant a fault, run tests, and put the file right again."""
        tests = self.chosen(fault)
        if not tests:
            return Outcome("no test", "", 0, 0.0)
        file = self.tree / fault.path
        source, when = file.read_bytes(), file.stat()
        self.planted += 1
        apart = any(word in source.decode() for word in COMPILED)
        compiled = self.work / (f"numba-{self.planted}" if apart else "numba")
        try:
            file.write_bytes(fault.planted(source))
            # never the time of another version, by which Python and numba tell versions apart
            os.utime(file, (when.st_atime, when.st_mtime + self.planted))
            return self.run(tests, compiled, patient=apart, first_failure=True)[-1]
        finally:
            file.write_bytes(source)
            os.utime(file, (when.st_atime, when.st_mtime))
            if apart:
                shutil.rmtree(compiled, ignore_errors=True)

    def run(self, tests: Sequence[str], compiled: Path, patient: bool, first_failure: bool) -> list[Outcome]:
        """Run tests in a fork, with numba's code in a folder."""
        folders = {"NUMBA_CACHE_DIR": compiled, "FLANKFILM_CACHE": self.work / "cache"}
        most = 3.0 * max(self.seconds, sum(map(self.covering.cost, tests))) + 60.0
        return run_tests(
            self.tree,
            tests,
            self.covering.seconds,
            most,
            self.work / "pytest.log",
            first_failure,
            COMPILING if patient else PATIENCE,
            **{name: str(folder) for name, folder in folders.items()},
        )

    def failing(self, tests: Sequence[str]) -> set[str]:
        """Those of some tests that fail without a fault."""
        if not tests:
            return set()
        found = self.run(tests, self.work / "numba", patient=True, first_failure=False)
        return {one.test for one in found if one.end != "stopped" and one.test}

    def compile(self) -> None:
        """Have the compiled code ready, which most tests need."""
        self.run(COMPILING_TESTS, self.work / "numba", patient=True, first_failure=False)


def _stamp(file: Path) -> tuple[int, int]:
    return file.stat().st_mtime_ns, file.stat().st_size


def plant_all(field_: Field, faults: Sequence[Fault], out: Path) -> list[tuple[Fault, Outcome]]:
    """Plant one fault after another, and keep what came of each; failures that come without a fault do not count."""
    found: dict[Fault, Outcome] = {}
    todo = list(faults)
    with out.open("a", encoding="utf-8") as kept:
        while todo:
            for fault in todo:
                outcome = found[fault] = field_.plant(fault)
                line = {
                    "fault": fault.name,
                    "line": fault.line,
                    "covered": field_.covering.covered(fault, ROOT),
                }
                kept.write(json.dumps({**line, **vars(outcome)}) + "\n")
                kept.flush()
                said = (
                    f"{outcome.end:8} {outcome.seconds:5.0f} s  {fault.line:4} {fault.name}  {outcome.test}"
                )
                print(said, flush=True)
            seeing = {found[f].test for f in todo if found[f].end in ("failed", "hung") and found[f].test}
            without = field_.failing(sorted(seeing))
            field_.unfit |= without
            todo = [fault for fault in todo if found[fault].test in without]
    return list(found.items())


def main(arguments: Sequence[str] | None = None) -> int:
    """Command line."""
    parser = argparse.ArgumentParser(prog="python -m tests.planted", description=__doc__.partition("\n")[0])
    jobs = parser.add_subparsers(dest="job", required=True)
    mapping = jobs.add_parser(
        "map", help="run tests with coverage by test; further arguments are those of pytest"
    )
    planting = jobs.add_parser("plant", help="plant faults")
    add = planting.add_argument
    add("--faults", type=int, default=100, help="how many")
    add("--seed", type=int, default=None, help="of the drawing; printed")
    add("--among", nargs="+", default=PACKAGES, help="packages, folders or files in which they are planted")
    add("--since", metavar="REVISION", default=None, help="only in lines written since this one of git")
    add("--seconds", type=float, default=60.0, help="of tests for one fault, as they usually take")
    add(
        "--also", nargs="*", default=(), help="tests that run first for every fault, because the map is older"
    )
    add("--again", type=Path, default=None, help="the survivors of an earlier list instead of random faults")
    add("--work", type=Path, default=ROOT / "out" / "planted", help="folder for the copy")
    add("--out", type=Path, default=Path("planted.jsonl"), help="list to which every fault is added")
    for job in (mapping, planting):
        job.add_argument("--map", type=Path, default=ROOT / "out" / "planted", help="folder of the map")
    given, rest = parser.parse_known_args(arguments)
    if given.job == "map":
        return make(ROOT, given.map, rest)
    if rest:
        parser.error(f"unknown: {' '.join(rest)}")
    seed = given.seed if given.seed is not None else time.time_ns() % 10**6
    if given.again:
        last = {one["fault"]: one["end"] for one in map(json.loads, given.again.read_text().splitlines())}
        faults = named(ROOT, [name for name, end in last.items() if end in SURVIVED])
    else:
        print(f"seed {seed}", flush=True)
        files = [
            f for a in given.among for f in ([ROOT / a] if a.endswith(".py") else (ROOT / a).rglob("*.py"))
        ]
        lines = None if given.since is None else written_since(ROOT, given.since)
        faults = sample(ROOT, files, given.faults, seed, lines)
    load_libraries()
    ground = Field(given.work, Map.read(given.map), given.seconds, tuple(given.also))
    ground.lay_out()
    if not {fault.path.partition("/")[0] for fault in faults} <= {"base", "gears", "meshes"}:
        ground.compile()
    found = plant_all(ground, faults, given.out)
    survivors = [fault for fault, outcome in found if outcome.end in SURVIVED]
    print(
        f"\nseen: {len(found) - len(survivors)} of {len(found)} ({1 - len(survivors) / max(len(found), 1):.1%})"
    )
    for fault in survivors:
        print(f"  {fault.line:4} {fault.name}")
    return 0


SURVIVED = ("passed", "stopped", "no test")
"""Ends of a run of tests that has not seen the fault."""

if __name__ == "__main__":
    sys.exit(main())
