"""Processes that a test session or a command started, found by a mark in their environment, which children inherit."""

from __future__ import annotations

import os
import signal
import sys
import time
import uuid
from collections.abc import Iterator
from pathlib import Path

import pytest

MARK = "FLANKFILM_TEST_MARK"
"""Variable that holds the mark of a session, after those of the sessions that it was started in."""

PATIENCE = 10.0
"""Seconds within which a process that is no longer needed has to end."""

TRACKER = "multiprocessing.resource_tracker"
"""In the command of what ends by itself, last of all, once the process that it belongs to has."""


def unwatched() -> dict[str, str]:
    """Environment of a process whose branches are not recorded: coverage survives no interrupt and no full disk."""
    return {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE")}


def new_mark() -> str:
    """Mark that nobody else has."""
    return uuid.uuid4().hex


def marked(mark: str) -> dict[int, str]:
    """Processes whose environment holds a mark, with their commands; zombies and this one are left out."""
    found = {}
    for entry in Path("/proc").iterdir() if Path("/proc").is_dir() else ():
        if not entry.name.isdigit() or int(entry.name) == os.getpid():
            continue
        try:
            if mark.encode() not in (entry / "environ").read_bytes():
                continue
            status = (entry / "stat").read_text().rpartition(")")[2].split()
            command = (entry / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace").strip()
        except OSError:
            continue  # it has ended meanwhile, or is another user's
        if status[0] != "Z" and not (TRACKER in command and int(status[1]) == os.getpid()):
            found[int(entry.name)] = command
    return found


def left_after(mark: str, patience: float = PATIENCE) -> dict[int, str]:
    """Processes with a mark that are still there after a time; none as soon as there is none."""
    until = time.monotonic() + patience
    while (left := marked(mark)) and time.monotonic() < until:
        time.sleep(0.02)
    return left


def pytest_configure(config: pytest.Config) -> None:
    """Mark what the session starts; workers of a session have its mark. What it starts hears Ctrl-C.

    A shell that starts a session in the background may ignore that signal, and children would inherit it.
    """
    if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    if not hasattr(config, "workerinput"):
        config.stash[OF_SESSION] = new_mark()
        os.environ[MARK] = f"{os.environ.get(MARK, '')} {config.stash[OF_SESSION]}"


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_sessionfinish(session: pytest.Session) -> Iterator[None]:
    """Fail a session that leaves processes behind, and name them; the workers have ended by then."""
    yield
    mark = session.config.stash.get(OF_SESSION, None)
    if mark is None or not (left := left_after(mark)):
        return
    print("\nprocesses that the tests left behind:", file=sys.stderr)
    for number, command in left.items():
        print(f"  {number}: {command[:200]}", file=sys.stderr)
    session.exitstatus = session.exitstatus or pytest.ExitCode.TESTS_FAILED


OF_SESSION = pytest.StashKey[str]()
