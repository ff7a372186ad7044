"""Slow studies within a time: files take turns, the longest tests come last, what would begin too late is left out.

A time cuts the order at the same place every time. So that it is not always the same files that are cut off, the
continuous integration orders them by a hash of path and commit; `FLANKFILM_TEST_ORDER` repeats the order of any.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections import Counter

import pytest

MINUTES = "FLANKFILM_TEST_MINUTES"
"""Variable with the minutes after which no further test begins; all are run without it."""

ORDER = "FLANKFILM_TEST_ORDER"
"""Variable with the seed of the order of files; they come in the order of their paths without it."""

LATE = "is over: run it with `./run test --slow`"
"""End of the reason of what was left out, by which the summary knows it."""

BEGAN = pytest.StashKey[float]()


def order_header() -> str:
    """Line of the session's head: what repeats the order."""
    seed = os.environ.get(ORDER)
    return f"{ORDER}={seed}" if seed else f"order of the files: their paths ({ORDER} is not set)"


def turn(path: str, seed: str) -> str:
    """Place of a file among all others, as a text that sorts: the same for a path and a seed everywhere."""
    return hashlib.sha256(f"{seed}\n{path}".encode()).hexdigest() if seed else ""


def pytest_sessionstart(session: pytest.Session) -> None:
    """Note when the session, or this worker of it, began."""
    session.config.stash[BEGAN] = time.monotonic()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put files in the order of the seed, and the longest tests behind all others, in the same order everywhere."""
    seed = os.environ.get(ORDER, "")
    items.sort(
        key=lambda item: (item.get_closest_marker("long") is not None, turn(file_of(item.nodeid), seed))
    )


def file_of(nodeid: str) -> str:
    """Path of a test's file from the root of the repository."""
    return nodeid.partition("::")[0]


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Leave out what would begin too late."""
    minutes = os.environ.get(MINUTES)
    if minutes and time.monotonic() - item.config.stash[BEGAN] > 60.0 * float(minutes):
        pytest.skip(f"the time of {minutes} minutes {LATE}")


def left_out(skipped: list[pytest.TestReport]) -> Counter[str]:
    """Files of which tests would have begun too late, with the number of these."""
    late = [report for report in skipped if LATE in str(report.longrepr)]
    return Counter(file_of(report.nodeid) for report in late)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the files of which tests were left out, with their number, and what repeats the order."""
    counts = left_out(terminalreporter.stats.get("skipped", []))
    if not counts:
        return
    terminalreporter.section(f"left out for want of time: {counts.total()} tests of {len(counts)} files")
    for path, number in sorted(counts.items()):
        terminalreporter.write_line(f"{number:4d}  {path}")
    terminalreporter.write_line(
        f"In this order once more: {ORDER}={os.environ.get(ORDER, '')} ./run test --slow"
    )
