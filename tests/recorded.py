"""Branches that a session with coverage records: those that the packages' own tests run.

Noting branches takes up to two thirds of what the code itself takes. Tests of `UNRECORDED` ask what physics, extremes
and printed results say of whole cases: they are run and judged as all others, and the share in pyproject.toml has to be
reached without them. A session that notes which test runs which line (``--cov-context``, tests/planted) records all.
"""

from __future__ import annotations

import os
from collections.abc import Generator
from typing import Any

import pytest

UNRECORDED = (
    "tests/hard/",
    "tests/validation/",
    "tests/flankfilm/test_article_scene.py",
    "tests/flankfilm/test_documents.py",
)
"""Beginnings of the names of tests whose branches are not recorded."""

PROCESSES = "COVERAGE_PROCESS_CONFIG"
"""Variable by which processes that a test starts record their branches as well."""


def recorder(config: pytest.Config) -> Any:
    """What records branches in this process for the whole session; None where nothing does, or tests are told apart."""
    plugin = config.pluginmanager.getplugin("_cov")
    return None if plugin is None or config.option.cov_context else plugin.cov_controller


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, object, object]:
    """Let the recorder rest while a test runs that is not recorded, its setting up and its processes included."""
    control = recorder(item.config)
    if control is None or not item.nodeid.startswith(UNRECORDED):
        return (yield)
    processes = os.environ.pop(PROCESSES, None)
    control.pause()
    try:
        return (yield)
    finally:
        control.resume()
        if processes is not None:
            os.environ[PROCESSES] = processes
