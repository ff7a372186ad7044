"""Slow studies within a time: order and end."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

import pytest

from tests.time_limit import BEGAN, MINUTES, pytest_collection_modifyitems, pytest_runtest_setup


def item(name: str, *markers: str, began: float = 0.0) -> Any:
    config = SimpleNamespace(stash={BEGAN: began})
    return SimpleNamespace(
        name=name, config=config, get_closest_marker=lambda marker: marker if marker in markers else None
    )


def test_the_longest_come_last_and_all_others_stay_in_order():
    items = [item("a", "slow", "long"), item("b", "slow"), item("c", "slow", "long"), item("d", "slow")]
    pytest_collection_modifyitems(items)
    assert "".join(one.name for one in items) == "bdac"


def test_what_would_begin_too_late_is_left_out(monkeypatch: pytest.MonkeyPatch):
    late = item("late", began=time.monotonic() - 61.0)
    monkeypatch.delenv(MINUTES, raising=False)
    pytest_runtest_setup(late)
    monkeypatch.setenv(MINUTES, "2")
    pytest_runtest_setup(late)
    monkeypatch.setenv(MINUTES, "1")
    with pytest.raises(pytest.skip.Exception, match="the 1 minutes are over"):
        pytest_runtest_setup(late)
