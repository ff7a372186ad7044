"""First calls in a fresh process: imports and compilation, with kernels kept on disk and with none.

Run as ``python -m flankfilm.bench.first_call SOLVER``; prints the processor time of both calls as JSON.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from dataclasses import dataclass
from math import nan
from time import process_time

from flankfilm.bench.process import output_of
from flankfilm.processes.worker_processes import module, python


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


if __name__ == "__main__":
    _main(sys.argv[1])
