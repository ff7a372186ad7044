"""Processes that we start: they import nothing from the current folder, and end with the one that started them.

A child that is told to (a closed pipe, which also tells that its parent has died) ends at once, without cleaning up:
what it writes is whole at any moment.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection

ENDS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
"""Signals that ask for an end; the first is Ctrl-C."""

AGAIN = 3.0
"""Seconds after which an end is asked for once more: what is raised within a destructor or a callback is lost."""

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


def python(*arguments: str) -> list[str]:
    """Command that starts this interpreter without the current folder among the places that it imports from."""
    return [sys.executable, "-P", *arguments]


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
        if hasattr(signal, "setitimer"):
            signal.signal(signal.SIGALRM, lambda *_: stop(number))
            signal.setitimer(signal.ITIMER_REAL, AGAIN)
        stop(number)

    def stop(number: int) -> None:
        if number == signal.SIGINT:
            raise KeyboardInterrupt
        raise Ended(number)

    # a signal that is ignored, as under nohup, stays so
    before = {one: signal.getsignal(one) for one in ENDS if signal.getsignal(one) is not signal.SIG_IGN}
    for one in before:
        signal.signal(one, end)
    try:
        yield
    finally:
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for one, handler in before.items():
            signal.signal(one, handler if handler is not None else signal.SIG_DFL)


def work_until_told(told: Connection) -> None:
    """Start of a worker: Ctrl-C is the parent's to answer; end when the other end of the pipe is closed."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)

    def wait() -> None:
        with suppress(EOFError, OSError):
            told.recv_bytes()
        os._exit(1)

    threading.Thread(target=wait, daemon=True).start()


def end_with_parent() -> None:
    """Start of a child that was started as a command: end when its parent has died."""
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(LOOK)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
