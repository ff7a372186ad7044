"""Slow studies within a time: order, end, and what the summary says of it."""

from __future__ import annotations

import time
from types import SimpleNamespace
from typing import Any

import pytest

from tests.time_limit import (
    BEGAN,
    LATE,
    MINUTES,
    ORDER,
    left_out,
    order_header,
    pytest_collection_modifyitems,
    pytest_runtest_setup,
    pytest_terminal_summary,
)

FILES = [f"tests/test_{name}.py" for name in "abcdefgh"]


def item(name: str, *markers: str, file: str = "tests/test_a.py", began: float = 0.0) -> Any:
    config = SimpleNamespace(stash={BEGAN: began})
    return SimpleNamespace(
        name=name,
        nodeid=f"{file}::{name}",
        config=config,
        get_closest_marker=lambda marker: marker if marker in markers else None,
    )


def in_order(items: list[Any]) -> str:
    pytest_collection_modifyitems(items)
    return " ".join(one.name for one in items)


def files_in_order(monkeypatch: pytest.MonkeyPatch, seed: str) -> list[str]:
    monkeypatch.setenv(ORDER, seed)
    items = [item("one", file=file) for file in FILES]
    pytest_collection_modifyitems(items)
    return [one.nodeid.partition("::")[0] for one in items]


def test_the_longest_come_last_and_all_others_stay_in_order(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.delenv(ORDER, raising=False)
    items = [item("a", "slow", "long"), item("b", "slow"), item("c", "slow", "long"), item("d", "slow")]
    assert in_order(items) == "b d a c"


def test_a_seed_orders_files_anew_and_keeps_each_together(monkeypatch: pytest.MonkeyPatch):
    orders = {seed: files_in_order(monkeypatch, seed) for seed in ("1f0c", "77ab", "e2d1")}
    assert len({tuple(order) for order in orders.values()}) == 3
    assert all(sorted(order) == FILES for order in orders.values())
    assert files_in_order(monkeypatch, "1f0c") == orders["1f0c"]
    # what every machine and every Python has: this order is on record
    assert "".join(path[11] for path in orders["1f0c"]) == "ahdfbecg"
    items = [
        item(name, *long, file=file)
        for file in FILES
        for name, long in (("x", ["long"]), ("y", []), ("z", []))
    ]
    assert in_order(items) == " ".join(["y", "z"] * 8 + ["x"] * 8)


def test_any_file_is_among_the_first_third_of_some_orders(monkeypatch: pytest.MonkeyPatch):
    firsts = [files_in_order(monkeypatch, f"{number:x}")[:3] for number in range(30)]
    assert {file for first in firsts for file in first} == set(FILES)


def test_what_would_begin_too_late_is_left_out(monkeypatch: pytest.MonkeyPatch):
    late = item("late", began=time.monotonic() - 61.0)
    monkeypatch.delenv(MINUTES, raising=False)
    pytest_runtest_setup(late)
    monkeypatch.setenv(MINUTES, "2")
    pytest_runtest_setup(late)
    monkeypatch.setenv(MINUTES, "1")
    with pytest.raises(pytest.skip.Exception, match="the time of 1 minutes is over"):
        pytest_runtest_setup(late)


def test_the_summary_names_the_files_left_out_with_their_number(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv(ORDER, "1f0c")
    reasons = {"tests/test_b.py::x": LATE, "tests/test_b.py::y": LATE, "tests/test_a.py::x": LATE}
    skipped: list[Any] = [
        SimpleNamespace(
            nodeid=nodeid, longrepr=("time_limit.py", 1, f"Skipped: the time of 1 minutes {reason}")
        )
        for nodeid, reason in [*reasons.items(), ("tests/test_c.py::x", "no Chromium")]
    ]
    assert left_out(skipped) == {"tests/test_a.py": 1, "tests/test_b.py": 2}
    lines: list[str] = []
    reporter: Any = SimpleNamespace(stats={"skipped": skipped}, section=lines.append, write_line=lines.append)
    pytest_terminal_summary(reporter)
    assert lines == [
        "left out for want of time: 3 tests of 2 files",
        "   1  tests/test_a.py",
        "   2  tests/test_b.py",
        "In this order once more: FLANKFILM_TEST_ORDER=1f0c ./run test --slow",
    ]
    lines.clear()
    reporter.stats = {}
    pytest_terminal_summary(reporter)
    assert lines == []


def test_the_head_names_the_order(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv(ORDER, "1f0c")
    assert order_header() == "FLANKFILM_TEST_ORDER=1f0c"
    monkeypatch.delenv(ORDER)
    assert "their paths" in order_header()
