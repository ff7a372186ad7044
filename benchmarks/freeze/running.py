"""Cases in processes of their own, one for each commit and case, and what they leave."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from .case import Case
from .comparing import Change, compare, load
from .trees import ROOT

LIMIT = 3600.0
"""Time after which a case is given up [s]."""

START = """
import sys
sys.path.insert(0, sys.argv[1])
from pathlib import Path
from benchmarks.freeze import worker
sys.path.remove(sys.argv[1])
worker.compute(sys.argv[2], *map(Path, sys.argv[3:]))
"""
"""The cases come from the tool's files, everything else from the commit's, which may hold another such tool."""

THREADS = ("OPENBLAS", "OMP", "MKL", "BLIS", "VECLIB", "NUMBA", "NUMEXPR")


@dataclass(frozen=True)
class Outcome:
    """What one case did in both commits.

    Attributes
    ----------
    case : Case
    changes : tuple of Change
        Empty where both commits have the same bits.
    faults : tuple of str
        Last line of what went wrong in either commit; "" where nothing did.
    arrays : int
        Arrays of the first commit.
    seconds : tuple of float
        Of either commit.
    """

    case: Case
    changes: tuple[Change, ...]
    faults: tuple[str, str]
    arrays: int
    seconds: tuple[float, float]


def environment(tree: Path, cache: Path, compiled: Path) -> dict[str, str]:
    """Environment of a case: packages of the tree, empty caches, one thread.

    Hashes of text stay random, so that what hangs on the order of a set is seen as a change.
    """
    values = {name: value for name, value in os.environ.items() if name != "PYTHONHASHSEED"}
    values |= {f"{name}_NUM_THREADS": "1" for name in THREADS}
    values |= {"PYTHONPATH": str(tree), "FLANKFILM_CACHE": str(cache), "NUMBA_CACHE_DIR": str(compiled)}
    return values | {"MPLBACKEND": "Agg", "PYTHONDONTWRITEBYTECODE": "1"}


class Processes:
    """Processes that run, so that all of them end with this one."""

    def __init__(self) -> None:
        self._running: set[subprocess.Popen[str]] = set()
        self._lock = threading.Lock()
        self._closed = False

    def run(self, command: Sequence[str], env: dict[str, str], cwd: Path) -> str:
        """Run a command to its end; "" or the last line of what it says of its failure."""
        with self._lock:
            if self._closed:
                return "not started"
            process = subprocess.Popen(
                command, env=env, cwd=cwd, text=True, start_new_session=True,
                stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            )  # fmt: skip
            self._running.add(process)
        try:
            _, said = process.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            end(process)
            return f"not done after {LIMIT:.0f} s"
        finally:
            with self._lock:
                self._running.discard(process)
        if process.returncode == 0:
            return ""
        return ([line for line in said.splitlines() if line.strip()] or [f"status {process.returncode}"])[-1]

    def end_all(self) -> None:
        """End every process that runs and start no other."""
        with self._lock:
            self._closed = True
            running = list(self._running)
        for process in running:
            end(process)


def end(process: subprocess.Popen[str]) -> None:
    """End a process and those that it started."""
    try:
        os.killpg(process.pid, signal.SIGKILL)
    except ProcessLookupError:
        return
    process.wait()


@contextmanager
def processes() -> Iterator[Processes]:
    """Processes that are ended on the way out."""
    running = Processes()
    try:
        yield running
    finally:
        running.end_all()


def run_cases(
    cases: Sequence[Case], trees: tuple[Path, Path], folder: Path, files: Path, at_once: int = 1
) -> Iterator[Outcome]:
    """Run cases in two trees, some at once, and compare; in the order of the cases, as they are done.

    Parameters
    ----------
    cases : sequence of Case
    trees : (Path, Path)
        Files of the commits.
    folder : Path
        For what cases write and for caches.
    files : Path
        For the arrays.
    at_once : int
        Processes.
    """
    with processes() as running:
        pool = ThreadPoolExecutor(at_once)
        try:
            jobs: list[tuple[Case, list[Future[tuple[str, float]]]]] = [
                (case, [pool.submit(_one, running, case, k, trees[k], folder, files) for k in (0, 1)])
                for case in cases
            ]
            for case, futures in jobs:
                yield _outcome(case, [future.result() for future in futures], files)
        finally:
            running.end_all()
            pool.shutdown(cancel_futures=True)


def file_of(case: Case, side: int, files: Path) -> Path:
    """File of a case's arrays in the first or second commit."""
    return files / f"{case.name.replace('/', '.')}.{('first', 'second')[side]}.npz"


def _one(
    running: Processes, case: Case, side: int, tree: Path, folder: Path, files: Path
) -> tuple[str, float]:
    """Run a case in one tree: what went wrong, and the time that it took."""
    room = folder / f"{('first', 'second')[side]}-{case.name.replace('/', '.')}"
    cache = folder / f"{room.name}-cache"
    compiled = folder / f"{('first', 'second')[side]}-compiled"
    for made in (room, compiled):
        made.mkdir(exist_ok=True)
    file = file_of(case, side, files)
    start = perf_counter()
    command = [sys.executable, "-P", "-c", START, str(ROOT), case.name, str(tree), str(room), str(file)]
    fault = running.run(command, environment(tree, cache, compiled), room)
    return fault, perf_counter() - start


def _outcome(case: Case, ended: Sequence[tuple[str, float]], files: Path) -> Outcome:
    """Compare what a case left in both commits."""
    (first, second), seconds = (ended[0][0], ended[1][0]), (ended[0][1], ended[1][1])
    if first or second:
        return Outcome(case, (), (first, second), 0, seconds)
    arrays = [load(str(file_of(case, side, files))) for side in (0, 1)]
    return Outcome(case, compare(*arrays), ("", ""), len(arrays[0]), seconds)
