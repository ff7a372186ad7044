"""First calls in a fresh process, with kernels kept on disk and with none; what another process prints.

Run as ``python -m flankfilm.bench.first_call SOLVER``; prints the processor time of both calls as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from pathlib import Path
from time import process_time
from typing import Any

from flankfilm.processes.worker_processes import module, python

LONGEST = 300.0
"""Seconds after which a process is stopped."""


@dataclass(frozen=True)
class FirstCall:
    """Processor time of a solver's coarsest work of every case, in a separate process.

    Attributes
    ----------
    solver : str
        Its name.
    kept : float
        First call [s], start of Python, imports and preparation of the cases included, with compiled kernels on
        disk as any but the very first run has them.
    nothing_kept : float
        First call [s] when all kernels are compiled; NaN where that was not measured or nothing is compiled.
    again : float
        Second call [s].
    failure : str
        Why there are no figures; empty where there are.
    """

    solver: str
    kept: float
    nothing_kept: float
    again: float
    failure: str = ""


def first_call(solver: str, compiles: bool) -> FirstCall:
    """Measure the first calls of a solver.

    Parameters
    ----------
    solver : str
        Its name in the catalogue.
    compiles : bool
        Whether to measure a call with nothing kept as well; takes as long as the kernels compile.
    """
    kept = _in_fresh_process(solver)
    if isinstance(kept, str):
        return FirstCall(solver, nan, nan, nan, kept)
    first, again = kept
    if not compiles:
        return FirstCall(solver, first, nan, again)
    with tempfile.TemporaryDirectory(prefix="flankfilm-") as empty:
        bare = _in_fresh_process(solver, NUMBA_CACHE_DIR=empty)
    if isinstance(bare, str):
        return FirstCall(solver, first, nan, again, bare)
    return FirstCall(solver, first, bare[0], again)


def _in_fresh_process(solver: str, **environment: str) -> list[float] | str:
    command = python("-W", "ignore", *module("flankfilm.bench.first_call", solver))
    printed = output_of(command, env={**os.environ, **environment})
    return printed if isinstance(printed, str) else [float(time) for time in json.loads(printed[-1])]


def _main(solver: str) -> None:
    """Print the processor time of both calls, the first from the start of the process."""
    from flankfilm.bench.catalogue import SOLVERS

    cases = SOLVERS[solver](True)
    works = [series.levels[0].work for case in cases for series in case.series]
    seconds, began = [], 0.0
    for _ in range(2):
        for work in works:
            work()
        seconds.append(process_time() - began)
        began = process_time()
    print(json.dumps(seconds))


def output_of(command: Sequence[str], longest: float = LONGEST, **how: Any) -> list[str] | str:
    """Lines that a command prints, or the reason why it failed; `how` are further arguments of `subprocess.run`."""
    how |= {"capture_output": True, "text": True, "timeout": longest, "check": False}
    try:
        done: subprocess.CompletedProcess[str] = subprocess.run(command, **how)
    except subprocess.TimeoutExpired:
        return f"took longer than {longest:g} s"
    except OSError as error:
        return f"{Path(command[0]).name} does not run: {error.strerror or error}"
    if done.returncode:
        return (done.stderr.strip().splitlines() or [f"exit status {done.returncode}"])[-1]
    return done.stdout.splitlines()


if __name__ == "__main__":
    _main(sys.argv[1])
