"""Processes that we start: they import nothing from the current folder, and end with the one that started them.

A child that is ordered to (by a closed pipe, also when its parent has died) ends at once, without cleaning up:
what it writes is whole at any moment. Compiled code may keep the interpreter busy for minutes; so where the system can
end a child by itself, it is asked to.

Neither `concurrent.futures` nor loky does so: of both, workers that are busy in compiled code outlive a parent that was
killed, and are waited for by one that was interrupted. From Python 3.14 on a pool can kill its workers, which would
serve the second case alone. Pools are therefore the standard ones, with `work_until_told` as the start of a worker.

A module runs as a child that ends with its parent by
``python -m flankfilm.processes.worker_processes PARENT MODULE ARGUMENTS``.
"""

from __future__ import annotations

import ctypes
import logging
import os
import runpy
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from typing import Any

from flankfilm.processes.garbage import collect_rarely

ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals that ask for an end; the first is Ctrl-C."""

ALARM = (signal.SIGALRM,) if hasattr(signal, "SIGALRM") else ()
"""Signal by which an end is asked for once more."""

AGAIN = 3.0
"""Seconds after which an end is asked for once more: a library may have swallowed what was raised within it."""

AT_ONCE = 0.02
"""The same where it surely was lost: raised within a destructor or a callback."""

DEATH_OF_PARENT = 1
"""PR_SET_PDEATHSIG of Linux's prctl: the signal that a process is sent when its parent has died."""

LOOK = 0.5
"""Seconds between two looks whether a parent is still there."""


class Ended(BaseException):
    """The process was asked to end by a signal.

    Attributes
    ----------
    signal : int
    """

    def __init__(self, number: int) -> None:
        super().__init__(signal.Signals(number).name)
        self.signal = number


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def python(*arguments: str) -> list[str]:
    """Command that starts this interpreter without the current folder among the places that it imports from."""
    return [sys.executable, "-P", *arguments]


def module(name: str, *arguments: str) -> list[str]:
    """Arguments of `python` that run a module, in a process that ends when this one has."""
    return ["-m", "flankfilm.processes.worker_processes", str(os.getpid()), name, *arguments]


@contextmanager
def environment(**values: str) -> Iterator[None]:
    """Have processes that are started meanwhile see these variables, and not import from the current folder."""
    values["PYTHONSAFEPATH"] = "1"
    before = {name: os.environ.get(name) for name in values}
    os.environ.update(values)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


@contextmanager
def answering_signals() -> Iterator[None]:
    """Turn signals that ask for an end into `Ended`, so that files are closed and workers end; main thread only."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    def end(number: int, _frame: object) -> None:
        _ask_again(AGAIN, number)
        _stop(number)

    # a signal that is ignored, as under nohup, stays so
    before = {
        signal_number: signal.getsignal(signal_number)
        for signal_number in ENDS
        if signal.getsignal(signal_number) is not signal.SIG_IGN
    }
    for signal_number in before:
        signal.signal(signal_number, end)
    note, sys.unraisablehook = sys.unraisablehook, _or_again(sys.unraisablehook)
    try:
        yield
    finally:
        sys.unraisablehook = note
        on_its_way()
        for signal_number, handler in before.items():
            signal.signal(signal_number, handler if handler is not None else signal.SIG_DFL)


@contextmanager
def ends_later() -> Iterator[None]:
    """Answer signals that ask for an end when this is left: what is started half-way could not be ended.

    A worker whose parent goes on before it has sent it work ends with a traceback. The alarm by which an end is asked
    for again waits too.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came: list[int] = []
    before = {
        signal_number: signal.getsignal(signal_number)
        for signal_number in (*ENDS, *ALARM)
        if signal.getsignal(signal_number) is not signal.SIG_IGN
    }
    for signal_number in before:
        signal.signal(signal_number, lambda number, _frame: came.append(number))
    try:
        yield
    finally:
        for signal_number, handler in before.items():
            signal.signal(signal_number, handler if handler is not None else signal.SIG_DFL)
        if came:
            signal.raise_signal(came[0])


def on_its_way() -> None:
    """Do not ask for an end once more: what closes files and ends workers is at it."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _ask_again(seconds: float, number: int) -> None:
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, lambda *_: _stop(number))
        signal.setitimer(signal.ITIMER_REAL, seconds)


def _stop(number: int) -> None:
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise Ended(number)


def _or_again(note: Callable[[Any], object]) -> Callable[[Any], object]:
    """Note of what a destructor cannot raise; an end that is asked for is no such thing, and is asked for again."""

    def swallowed(fault: Any) -> None:
        if isinstance(fault.exc_value, Ended):
            _ask_again(AT_ONCE, fault.exc_value.signal)
        elif issubclass(fault.exc_type, KeyboardInterrupt):
            _ask_again(AT_ONCE, signal.SIGINT)
        else:
            note(fault)

    return swallowed


def work_until_told(told: Connection) -> None:
    """Start of a worker: Ctrl-C is the parent's to answer; end when the other end of the pipe is closed."""
    collect_rarely()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    killed_with_parent()  # also one that is stopped, which answers no other signal
    _end_when_closed(told)

    def wait() -> None:
        with suppress(EOFError, OSError):
            told.recv_bytes()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()


def _end_when_closed(told: Connection) -> None:
    """Have the system end this process when the other end of a pipe is closed, where it can.

    It sends SIGIO then, which ends a process that does not answer it, whatever the interpreter is at.
    """
    if sys.platform != "linux":
        return
    import fcntl

    # opened anew: only one of the processes that share a file is notified
    own = os.open(f"/proc/self/fd/{told.fileno()}", os.O_RDONLY | os.O_NONBLOCK)
    fcntl.fcntl(own, fcntl.F_SETOWN, os.getpid())
    fcntl.fcntl(own, fcntl.F_SETFL, os.O_NONBLOCK | os.O_ASYNC)


def killed_with_parent() -> None:
    """Have the system kill this process when its parent has died, where it can."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(DEATH_OF_PARENT, signal.SIGKILL)


def dask_setup(_worker: Any) -> None:
    """Start of a worker of dask that we started: this module is what it loads first."""
    collect_rarely()
    killed_with_parent()
    for name in ("distributed.worker", "distributed.core"):
        logging.getLogger(name).addFilter(_is_no_lost_connection)


def _is_no_lost_connection(record: logging.LogRecord) -> bool:
    """Whether a worker's record, with its traceback, shows more than that the study has ended and gone."""
    kind = record.exc_info[0] if record.exc_info else None
    return kind is None or not issubclass(kind, OSError)


def end_with(parent: int) -> None:
    """End this process when its parent has died, at once if it is dead already."""
    killed_with_parent()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


if __name__ == "__main__":
    collect_rarely()
    end_with(int(sys.argv[1]))
    del sys.argv[:2]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
