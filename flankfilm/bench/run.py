"""Measures the solvers that were asked for."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from base import Faults, InputError
from flankfilm.bench.case import Case
from flankfilm.bench.catalogue import SOLVERS
from flankfilm.bench.first_call import FirstCall, first_call
from flankfilm.bench.machine import Machine, load, this_machine
from flankfilm.bench.measuring import CaseResult, measure, quiet, steps
from flankfilm.bench.peers import MAIN, PeerRow, ask
from flankfilm.files.folder import claim
from flankfilm.processes.progress import Progress, in_steps, silent

REPEAT = {False: 3, True: 2}
"""Timed runs of each level, in full and quick."""

MOST_REPEATS = 100

COMPILED = ("film", "motion")
"""Solvers with compiled kernels."""

PEERED = ("compliance", "motion")
"""Solvers whose work other programs can do."""


@dataclass(frozen=True)
class Bench:
    """All that was measured.

    Attributes
    ----------
    machine : Machine
        What it ran on.
    load_after : float
        The machine's load when it ended; NaN where unknown.
    quick : bool
        Whether few and coarse levels were asked for.
    repeat : int
        Timed runs of each level, at least.
    cases : tuple of CaseResult
        In the order of the catalogue.
    first_calls : tuple of FirstCall
        One for each solver.
    peers : tuple of PeerRow
        Empty where none were asked for.
    seconds : float
        Wall time of the whole [s].
    """

    machine: Machine
    load_after: float
    quick: bool
    repeat: int
    cases: tuple[CaseResult, ...]
    first_calls: tuple[FirstCall, ...]
    peers: tuple[PeerRow, ...]
    seconds: float


def bench(
    folder: Path,
    only: Sequence[str] = (),
    *,
    quick: bool = False,
    repeat: int | None = None,
    against: str | None = None,
    progress: Progress = silent,
) -> Bench:
    """Measure error and cost of solvers on this machine.

    Parameters
    ----------
    folder : Path
        Where the files will go; made, and seen to be writable, before anything is measured.
    only : sequence of str
        Names of the catalogue; all if empty.
    quick : bool
        Few and coarse levels, and no compilation from nothing.
    repeat : int, optional
        Timed runs of each level, 1 to 100; `REPEAT` unless given.
    against : str, optional
        Interpreter of the environment that peers are installed in.
    progress : callable
        Called with what is being done, steps done, and steps in all.

    Raises
    ------
    InputError
        Names that are not in the catalogue, an interpreter that is not there, a folder that cannot be written.
    """
    python = _checked(folder, only, repeat, against)
    began = perf_counter()
    times = repeat if repeat is not None else REPEAT[quick]
    machine = this_machine()
    names = [name for name in SOLVERS if name in only or not only]
    cases: list[tuple[str, Case]] = []
    for name in names:
        progress(f"preparing {name}", 0, len(names))
        with quiet():
            cases += [(name, case) for case in SOLVERS[name](quick)]
    asked = [case for _, case in cases if case.peers] if python is not None else []
    total = sum(steps(case) for _, case in cases) + len(asked) + len(names)
    announce = in_steps(progress, total)
    results = tuple(measure(name, case, times, announce) for name, case in cases)
    peers: list[PeerRow] = []
    for case in asked:
        announce(f"{case.title}: peers")
        assert python is not None
        peers += ask(python, case, times)
    calls = []
    for name in names:
        announce(f"first call: {name}")
        calls.append(first_call(name, name in COMPILED and not quick))
    seconds = perf_counter() - began
    return Bench(machine, load(), quick, times, results, tuple(calls), tuple(peers), seconds)


def _checked(folder: Path, only: Sequence[str], repeat: int | None, against: str | None) -> Path | None:
    """Claim the folder and return the peers' interpreter, or raise with every fault."""
    python = None if against is None else shutil.which(against)
    with Faults() as faults:
        for name in (name for name in only if name not in SOLVERS):
            allowed = f"must be one of {', '.join(SOLVERS)}"
            faults.add("--only", name, allowed, "Leave it out to measure all")
        if repeat is not None and not 1 <= repeat <= MOST_REPEATS:
            faults.add("--repeat", repeat, f"must be from 1 to {MOST_REPEATS}", "3 is usual")
        if against is not None and python is None:
            allowed = "must be an interpreter that can be run"
            faults.add("--against", against, allowed, "Such as ENVIRONMENT/bin/python")
        if against is not None and not MAIN.is_file():
            allowed = "needs the scripts of the other programs, which are in a checkout and in no wheel"
            faults.add("--against", against, allowed, "Run it from a checkout, or leave --against out")
        if against is not None and only and not set(only) & set(PEERED):
            allowed = f"other programs know the work of {' and '.join(PEERED)} alone"
            faults.add("--against", against, allowed, "Leave it out, or name one of these with --only")
        if not faults.found or folder.exists():
            # a folder is made only if all else is right
            try:
                claim(folder)
            except InputError as error:
                faults.extend(error.faults)
    # absolute, but not resolved: the link in an environment is what makes it one
    return None if python is None else Path(python).absolute()
