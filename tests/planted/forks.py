"""Tests run in forks of a process that has loaded the libraries and nothing of ours: each sees the files anew."""

from __future__ import annotations

import contextlib
import importlib
import os
import select
import signal
import sys
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

LIBRARIES = (
    "pytest", "numpy", "numpy.testing", "scipy.optimize", "scipy.sparse.linalg", "scipy.interpolate", "scipy.integrate",
    "scipy.special", "numba", "numba.core.caching", "skfem", "gmsh", "xarray", "h5netcdf", "pandas", "pydantic",
    "cyclopts", "rich", "jinja2", "meshio", "matplotlib", "matplotlib.pyplot", "hypothesis", "ezdxf",
)  # fmt: skip
"""What the tests load; those that are missing are left out."""
PATIENCE = 90.0
COMPILING = 400.0
"""Seconds that loading, or a test, may take beyond ten times what it took; and where it compiles kernels anew."""


@dataclass(frozen=True)
class Outcome:
    """How a run of tests ended."""

    end: str  # "passed", "failed", "hung", "broken" (tests cannot be collected) or "stopped" (no time left)
    test: str  # that failed or hung
    ran: int  # tests that passed
    seconds: float


def load_libraries() -> None:
    """Load what the tests will need, once."""
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"):
        os.environ.setdefault(name, "1")
    for name in LIBRARIES:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)


class _Reporter:
    """Chooses the tests, and tells the parent through a pipe which one starts and which one failed."""

    def __init__(self, pipe: int, tests: Sequence[str]) -> None:
        self.pipe = pipe
        self.place = {test: n for n, test in enumerate(tests)}
        self.whole = {test for test in tests if "::" not in test}

    def pytest_collection_modifyitems(self, items: list) -> None:
        """Those that are asked for, in that order; some may be gone since the map was made."""
        of_file = {item: item.nodeid.partition("::")[0] for item in items}
        items[:] = [item for item in items if item.nodeid in self.place or of_file[item] in self.whole]
        items.sort(key=lambda item: self.place.get(item.nodeid, self.place.get(of_file[item], 0)))

    def tell(self, what: str, test: str) -> None:
        os.write(self.pipe, f"{what}\t{test}\n".encode())

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self.tell("start", nodeid)

    def pytest_runtest_logreport(self, report) -> None:
        if report.failed:
            self.tell("failed", report.nodeid)

    def pytest_collectreport(self, report) -> None:
        if report.failed:
            self.tell("broken", report.nodeid)


def run_tests(
    tree: Path, tests: Sequence[str], usual: dict[str, float], most: float, log: Path, first_failure: bool = True,
    patience: float = PATIENCE, **environment: str,
) -> list[Outcome]:  # fmt: skip
    """Run tests of a tree in a fork; the last outcome ends the run, those before are failures on the way.

    Parameters
    ----------
    tree : Path
        Root of the repository's copy.
    tests : sequence of str
        As pytest names them, in the order wanted.
    usual : dict
        Seconds that each takes.
    most : float
        Seconds for all.
    log : Path
        What pytest prints.
    first_failure : bool
        End with the first failure.
    patience : float
        Seconds that a test may take beyond ten times what it usually takes.
    """
    started = time.monotonic()
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        _child(tree, tests, log, writing, first_failure, environment)
    os.close(writing)
    found: list[Outcome] = []
    now, ran, rest = "", -1, b""
    deadline = started + patience + 60.0
    try:
        while True:
            left = min(deadline, started + most + patience) - time.monotonic()
            if left <= 0 or not select.select([reading], [], [], left)[0]:
                late = time.monotonic() >= deadline
                found.append(
                    Outcome("hung" if late else "stopped", now, max(ran, 0), time.monotonic() - started)
                )
                break
            part = os.read(reading, 1 << 16)
            *whole, rest = (rest + part).split(b"\n")
            for line in whole:
                what, _, test = line.decode().partition("\t")
                if what == "start":
                    now, ran = test, ran + 1
                    deadline = time.monotonic() + patience + 10.0 * usual.get(test, 0.0)
                else:
                    found.append(Outcome(what, test, max(ran, 0), time.monotonic() - started))
            if not part:
                break
    finally:
        os.close(reading)
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child, signal.SIGKILL)
        _, status = os.waitpid(child, 0)
    spent = time.monotonic() - started
    if found and first_failure:
        return found[:1]
    crashed = os.WIFSIGNALED(status) and not (found and found[-1].end in ("hung", "stopped"))
    if crashed or (os.WIFEXITED(status) and os.WEXITSTATUS(status) not in (0, 1, 5) and not found):
        return [*found, Outcome("broken", now, max(ran, 0), spent)]
    if found and found[-1].end in ("hung", "stopped"):
        return found
    return [*found, Outcome("passed", "", ran + 1, spent)]


def _child(
    tree: Path, tests: Sequence[str], log: Path, pipe: int, first_failure: bool, environment: dict[str, str]
) -> None:
    """Run pytest and end; never returns."""
    status = 3
    try:
        os.setsid()
        output = os.open(log, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        os.dup2(output, 1)
        os.dup2(output, 2)
        nothing = os.open(os.devnull, os.O_RDONLY)
        os.dup2(nothing, 0)
        os.chdir(tree)
        os.environ.update(environment, PYTHONPATH=str(tree), PYTHONDONTWRITEBYTECODE="1")
        sys.dont_write_bytecode = True
        ours = Path(__file__).resolve().parents[2]
        sys.path[:] = [
            str(tree),
            *(one for one in sys.path if Path(one or ".").resolve() not in (tree, ours)),
        ]
        for name in [one for one in sys.modules if one.partition(".")[0] == "tests"]:
            del sys.modules[name]
        if "numba" in sys.modules:
            sys.modules["numba.core.config"].reload_config()  # its folder of compiled code
        import pytest

        options = ["-q", "-p", "no:cacheprovider", "-p", "no:xdist", "-p", "no:cov"] + first_failure * ["-x"]
        files = dict.fromkeys(test.partition("::")[0] for test in tests)
        status = int(pytest.main([*options, *files], plugins=[_Reporter(pipe, tests)]))
    finally:
        os._exit(status)
