from __future__ import annotations

import gc
import sys
from collections.abc import Generator

import pytest

from flankfilm.files.cache import keep_compiled_code
from gears import GearPair
from tests.compiled import pytest_xdist_setupnodes
from tests.processes import pytest_configure, pytest_sessionfinish
from tests.recorded import pytest_runtest_protocol
from tests.seeds import seed_header
from tests.time_limit import (
    order_header,
    pytest_collection_modifyitems,
    pytest_runtest_setup,
    pytest_sessionstart,
    pytest_terminal_summary,
)
from tests.validation.article import PAIR

__all__ = [
    "article_pair",
    "no_gear_solved",
    "pytest_collection_modifyitems",
    "pytest_configure",
    "pytest_report_header",
    "pytest_runtest_protocol",
    "pytest_runtest_setup",
    "pytest_sessionfinish",
    "pytest_sessionstart",
    "pytest_terminal_summary",
    "pytest_xdist_setupnodes",
]

# Before a test imports numba. Kernels are kept where the program keeps them, and those of `warm-up` are found: without
# this each worker, and each program with a cache of its own, would compile them anew.
keep_compiled_code()

RARELY = (10_000, 10, 50)
"""Objects after which the youngest are looked at, and how many such looks come before one at the older, and at all."""


def pytest_report_header() -> list[str]:
    """Lines of the session's head: what repeats the choices and the order of this session."""
    return [seed_header(), order_header()]


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Look for no garbage while modules are loaded: all of them stay, and looking at them takes a third of the time.

    What is there once they are loaded, a million objects, is passed over from then on: each look at all of it takes a
    second. What tests load later, libraries of pictures and compiled code, stays as well, so that all of it is looked
    at the more seldom.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.set_threshold(*RARELY)
        gc.enable()


def pytest_runtest_teardown() -> None:
    """Close figures of pyplot, which keeps each of them once a test has loaded it, and warns of the twenty-first."""
    if (pyplot := sys.modules.get("matplotlib.pyplot")) is not None:
        pyplot.close("all")


@pytest.fixture(scope="session")
def article_pair() -> GearPair:
    """The article's pair, tests/validation/article.py."""
    return PAIR


@pytest.fixture
def no_gear_solved(monkeypatch: pytest.MonkeyPatch) -> None:
    """A memory of gears for this test alone: it finds none of those that others solved, and leaves them theirs."""
    from fem.influence import gear_store

    for name in ("_RECORDS", "_SIZED", "_RINGS", "_FACES", "_DRAWINGS"):
        memory = getattr(gear_store, name)
        monkeypatch.setattr(gear_store, name, type(memory)(memory.most))
