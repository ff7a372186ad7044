"""Which tests' branches a session with coverage records."""

from __future__ import annotations

import os
from types import SimpleNamespace
from typing import Any

import pytest

from tests.recorded import PROCESSES, pytest_runtest_protocol


def said(nodeid: str, context: str | None = None, fails: bool = False) -> list[str]:
    """What the recorder is told and whether processes record, while a test of this name runs."""
    heard: list[str] = []
    control = SimpleNamespace(pause=lambda: heard.append("rest"), resume=lambda: heard.append("record"))
    plugin = SimpleNamespace(cov_controller=control)
    config = SimpleNamespace(
        option=SimpleNamespace(cov_context=context),
        pluginmanager=SimpleNamespace(getplugin={"_cov": plugin}.get),
    )
    item: Any = SimpleNamespace(nodeid=nodeid, config=config)
    around = pytest_runtest_protocol(item)
    next(around)
    heard.append(f"test with {os.environ.get(PROCESSES)}")
    with pytest.raises((StopIteration, KeyboardInterrupt)):
        around.throw(KeyboardInterrupt()) if fails else around.send(True)
    return [*heard, f"then {os.environ.get(PROCESSES)}"]


@pytest.fixture(autouse=True)
def processes_record(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(PROCESSES, "all")


@pytest.mark.parametrize("fails", [False, True])
def test_the_recorder_rests_while_whole_cases_are_computed(fails: bool):
    rested = ["rest", "test with None", "record", "then all"]
    assert said("tests/hard/test_extremes.py::test_one[0]", fails=fails) == rested
    assert said("tests/fem/test_contact.py::test_one", fails=fails) == ["test with all", "then all"]


def test_a_map_of_tests_records_all():
    assert said("tests/hard/test_extremes.py::test_one", context="test") == ["test with all", "then all"]


def test_a_session_without_coverage_has_no_recorder():
    manager = SimpleNamespace(getplugin=lambda name: None)
    item: Any = SimpleNamespace(nodeid="tests/hard/a.py::b", config=SimpleNamespace(pluginmanager=manager))
    around = pytest_runtest_protocol(item)
    next(around)
    with pytest.raises(StopIteration):
        around.send(True)
