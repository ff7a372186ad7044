"""A second process beside a run: tasks are done once, here or there, with the same outcome, and none remains."""

from __future__ import annotations

import os
import threading
import time
from functools import partial

import pytest

from base import InputError
from flankfilm.processes import assistant as assistants
from flankfilm.processes.assistant import Assistant, assistant
from gears import Gear, GearPair
from tests.processes import MARK, left_after, marked, new_mark

NAP = 0.5

SLOW_LINE = f"""
import time
time.sleep({NAP})
with open(path, "a") as file:
    file.write("once")
"""

DIE_THERE = f"""
import os, signal
if "{MARK}" in os.environ:
    os.kill(os.getpid(), signal.SIGKILL)
"""

NO_GEAR = partial(GearPair, Gear(teeth=20), Gear(teeth=30), module=-1.0, face_width=0.02)


@pytest.fixture
def two_cores(monkeypatch):
    monkeypatch.setattr(assistants, "cores", lambda: 2)


def ended(task, patience=60.0):
    """Wait until another process has done a task."""
    until = time.monotonic() + patience
    while time.monotonic() < until and not task.ended:
        time.sleep(0.01)
    return task


def test_without_an_assistant_tasks_are_done_where_they_are_waited_for():
    alone = Assistant()
    task = alone.submit(os.getpid)
    assert not task.ended
    assert alone.result(task) == os.getpid()
    with pytest.raises(InputError, match="module"):
        alone.result(alone.submit(NO_GEAR))


def test_an_assistant_answers_like_a_call_and_is_gone_afterwards(two_cores, monkeypatch):
    monkeypatch.setenv(MARK, mark := new_mark())
    with pytest.raises(InputError) as here:
        NO_GEAR()
    with assistant(["gears"]) as helper:
        ended(helper.submit(exec, "print('a library prints', flush=True)"))
        assert helper.result(ended(helper.submit(os.getpid))) != os.getpid()
        refused = ended(helper.submit(NO_GEAR))
        with pytest.raises(InputError) as there:
            helper.result(refused)
        assert there.value.faults == here.value.faults
        assert len(marked(mark)) == 1
    assert not left_after(mark)


def test_each_task_is_done_once_and_both_processes_take_some(two_cores, tmp_path):
    with assistant(["base"]) as helper:
        ended(helper.submit(os.getpid))  # it has loaded what it needs
        began = time.monotonic()
        files = [str(tmp_path / str(number)) for number in range(6)]
        for task in [helper.submit(exec, SLOW_LINE, {"path": file}) for file in files]:
            helper.result(task)
        took = time.monotonic() - began
    assert [file.read_text() for file in sorted(tmp_path.iterdir())] == ["once"] * 6
    assert took < 5 * NAP  # six in a row take six naps, three beside three take three


def test_the_work_of_an_assistant_that_died_is_done_here(two_cores, monkeypatch):
    monkeypatch.setenv(MARK, new_mark())
    with assistant(["base"]) as helper:
        monkeypatch.delenv(MARK)  # nothing dies here
        dying = helper.submit(exec, DIE_THERE)
        after = helper.submit(os.getpid)
        until = time.monotonic() + 60.0
        while time.monotonic() < until and helper.there:
            time.sleep(0.01)
        assert not dying.ended
        helper.result(dying)
        assert helper.result(after) == os.getpid()


@pytest.mark.parametrize(
    "argument", [threading.Lock(), lambda: 0], ids=["a lock", "a function without a name"]
)
def test_a_task_that_cannot_be_sent_is_done_here_and_the_next_there(two_cores, argument):
    with assistant(["base"]) as helper:
        here = helper.submit(id, argument)
        assert helper.result(ended(helper.submit(os.getpid))) != os.getpid()
        assert helper.result(here) == id(argument)


SAYS_WHO_READS_IT = (
    """type("Answer", (), {"__reduce__": lambda self: (__import__("threading").get_ident, ())})()"""
)


def test_answers_are_read_where_they_are_asked_for(two_cores):
    """They load modules: xarray, of which two threads that load it at once find a part."""
    with assistant(["base"]) as helper:
        assert helper.result(ended(helper.submit(eval, SAYS_WHO_READS_IT))) == threading.get_ident()


@pytest.mark.parametrize(
    "made",
    [
        "__import__('threading').Lock()",
        "type('Answer', (), {'__reduce__': lambda self: (eval, ('no_such_name',))})()",
    ],
    ids=["cannot be sent", "cannot be read"],
)
def test_what_cannot_be_sent_back_or_read_is_made_here(two_cores, made):
    with assistant(["base"]) as helper:
        ended(helper.submit(os.getpid))
        answer = helper.submit(eval, made)
        assert type(helper.result(answer)).__name__ in ("lock", "Answer")
        assert helper.result(helper.submit(os.getpid)) in (os.getpid(), helper._process.pid)


def test_the_assistant_gets_arguments_as_they_were_when_the_task_was_set(two_cores):
    values = [1, 2]
    with assistant(["base"]) as helper:
        busy = helper.submit(exec, SLOW_LINE, {"path": os.devnull})
        task = helper.submit(sum, values)
        values.append(4)
        ended(busy)
        assert helper.result(ended(task)) == 3


def test_one_core_has_no_assistant(monkeypatch):
    monkeypatch.setattr(assistants, "cores", lambda: 1)
    with assistant(["base"]) as helper:
        assert not helper.there
        assert helper.result(helper.submit(os.getpid)) == os.getpid()
