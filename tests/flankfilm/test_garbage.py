"""Processes of a command look seldom for objects that refer to each other, and still find them."""

from __future__ import annotations

import gc
import os
import subprocess
import sys
import weakref

import pytest

from flankfilm import __main__ as program
from flankfilm import cli
from flankfilm.processes.garbage import RARELY, collect_rarely
from flankfilm.processes.worker_processes import module, python


@pytest.fixture
def thresholds():
    before = gc.get_threshold()
    gc.set_threshold(700, 10, 10)
    yield
    gc.set_threshold(*before)


class Ring:
    """Refers to itself."""

    def __init__(self) -> None:
        self.next = self


def test_rings_of_objects_go_all_the_same(thresholds):
    collect_rarely()
    gc.collect()
    rings = [weakref.ref(Ring()) for _ in range(3 * RARELY[0])]
    assert sum(ring() is not None for ring in rings) <= RARELY[0]


def test_the_program_looks_rarely_before_it_loads_its_commands(thresholds, monkeypatch):
    seen = []
    monkeypatch.setattr(cli, "main", lambda: seen.append(gc.get_threshold()))
    for name in ("MPLBACKEND", "OPENBLAS_NUM_THREADS"):
        monkeypatch.setenv(name, os.environ.get(name, "1"))
    program.main()
    assert seen == [RARELY]


def test_modules_that_a_command_runs_beside_itself_look_rarely(tmp_path):
    (tmp_path / "asked.py").write_text("import gc; print(gc.get_threshold())", encoding="utf-8")
    done = subprocess.run(
        python(*module("asked")),
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), *filter(None, sys.path)])},
    )
    assert done.stdout.strip() == str(RARELY)


AT_THE_END = """
from flankfilm.processes.garbage import collect_rarely
collect_rarely()
class Ring:
    def __init__(self): self.next = self
    def __del__(self): print("looked at")
kept = Ring()
"""


def test_nothing_is_looked_at_when_the_process_ends():
    done = subprocess.run(python("-c", AT_THE_END), capture_output=True, text=True, check=True)
    assert done.stdout == ""
