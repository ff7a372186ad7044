"""Slow studies within a time: the longest come last, and what would begin after that time is left out."""

from __future__ import annotations

import os
import time

import pytest

MINUTES = "FLANKFILM_TEST_MINUTES"
"""Variable with the minutes after which no further test begins; all are run without it."""

BEGAN = pytest.StashKey[float]()


def pytest_sessionstart(session: pytest.Session) -> None:
    """Note when the session, or this worker of it, began."""
    session.config.stash[BEGAN] = time.monotonic()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put the longest studies behind all others, in the same order everywhere."""
    items.sort(key=lambda item: item.get_closest_marker("long") is not None)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Leave out what would begin too late."""
    minutes = os.environ.get(MINUTES)
    if minutes and time.monotonic() - item.config.stash[BEGAN] > 60.0 * float(minutes):
        pytest.skip(f"the {minutes} minutes are over: run it with `./run test --slow`")
