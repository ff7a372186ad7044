"""How a command ends: its exit status, and what it says of faults, interruptions and warnings."""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Callable

from base import InputError, SolverError, printable
from flankfilm.processes.worker_processes import Ended, answering_signals

USER_FAULT = 2
SOLVER_FAULT = 3
PART_FAILED = 4
"""Some rows of a study, or parts of a scene, failed; the others are there."""

FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""What the system says of a disk or quota that is full, and of a file that may not grow."""
MOST_FAULTS = 100
"""Faults that are printed."""

LONGEST = 4000
"""Characters of a fault that are printed: a file of megabytes may make one as long."""

LESS_MEMORY = "give a larger tolerance, fewer points, teeth or cells of the face, or fewer --workers"

INTERRUPTED = 130
BY_SIGNAL = 128
"""What a signal's number is added to in the exit status of a command that it ended."""


def guarded(command: Callable[[], int]) -> int:
    """Run a command; turn what it raises for the user's sake into messages and exit statuses."""
    try:
        with answering_signals():
            return command()
    except InputError as error:
        count = len(error.faults)
        _tell(
            f"flankfilm: {count} fault{'s' if count > 1 else ''}",
            *(f"  {_cut(printable(f))}" for f in error.faults[:MOST_FAULTS]),
            *([f"  and {count - MOST_FAULTS} more"] if count > MOST_FAULTS else []),
        )
        return USER_FAULT
    except SolverError as error:
        _tell(f"flankfilm: {_cut(printable(error))}")
        return SOLVER_FAULT
    except MemoryError as error:
        why = f" ({printable(error)})" if str(error) else ""
        _tell(f"flankfilm: out of memory{why}; {LESS_MEMORY}")
        return SOLVER_FAULT
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except OSError as error:
        prefix = f"{error.filename}: " if error.filename else ""
        remedy = "; free some space, or name another folder with --out" if error.errno in FULL else ""
        _tell(printable(f"flankfilm: {prefix}{error.strerror or error}{remedy}"))
        return USER_FAULT
    except (KeyboardInterrupt, Ended) as stop:
        how = f"ended by {stop}" if isinstance(stop, Ended) else "interrupted"
        _tell(f"flankfilm: {how}; files written so far are whole, and the next run resumes from the cache")
        return BY_SIGNAL + stop.signal if isinstance(stop, Ended) else INTERRUPTED


def _cut(line: str) -> str:
    return line if len(line) <= LONGEST else f"{line[:LONGEST]} ... ({len(line) - LONGEST} characters more)"


def _tell(*lines: str) -> None:
    """Say why a command ends; where nothing takes it, such as a log on a full disk, its exit status says so alone."""
    try:
        for line in lines:
            print(line, file=sys.stderr, flush=True)
    except OSError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), 2)


def open_streams() -> None:
    """Give streams that were closed a place that takes everything, lest the first file that is opened becomes one.

    Where a stream has not every character, such as with ASCII alone, the missing ones are written by their numbers.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # the lowest free number, which is this one
            stream = os.fdopen(number, "r" if number == 0 else "w", closefd=False, encoding="utf-8")
            setattr(sys, name, stream)
    for text_stream in (sys.stdout, sys.stderr):
        if isinstance(text_stream, io.TextIOWrapper):
            text_stream.reconfigure(errors="backslashreplace")


def say(message: Warning | str, category: type[Warning], *_: object, **__: object) -> None:
    """Show our own warnings as sentences; those of libraries are not for users."""
    from flankfilm.files.cache import PACKAGES

    if category.__module__.partition(".")[0] in PACKAGES:
        print(f"flankfilm: {printable(message)}", file=sys.stderr)
