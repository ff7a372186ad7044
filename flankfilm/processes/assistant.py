"""A second process that works beside this one: tasks wait in a queue, from which both take them.

Files of a run do not depend on each other. The assistant is started when a run begins, so that it has loaded what it
needs by the time there is something to write. Who waits for a task that has not begun does it here. A run without an
assistant, or whose assistant died, does them all; a task that cannot be sent is done here as well. The same function
with the same arguments makes the same file in either place.

The thread that speaks with the assistant passes bytes on and no more. Tasks and answers are read where the run is:
objects load their modules, and two threads that load the same library at once find parts of it missing.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import IO, Any, Generic, TypeVar, cast

from flankfilm.processes.worker_processes import cores, module, python

__all__ = ["Assistant", "Task", "assistant"]

T = TypeVar("T")

SIZE = 8
"""Bytes of the length that goes before an answer."""


@dataclass(eq=False)
class Task(Generic[T]):
    """Something to be done once, here or by the assistant.

    Attributes
    ----------
    work : callable
        That another process can import, with arguments that it can be sent.
    arguments : tuple
    packed : bytes
        Both, as they were when the task was set: what records compute and keep later would change while it is sent.
        Empty where they cannot be sent, and where nobody is to have them.
    answer : bytes
        Outcome, packed, where the assistant did it.
    outcome : tuple of bool and object, or None
        Whether it ended well, and what it gave or raised; None where that is not known here yet.
    """

    work: Callable[..., T]
    arguments: tuple[Any, ...]
    packed: bytes = b""
    answer: bytes = b""
    outcome: tuple[bool, T | Exception] | None = None

    @property
    def ended(self) -> bool:
        """Whether it has been done, in either place."""
        return bool(self.answer) or self.outcome is not None

    def do(self) -> None:
        """Do it in this process."""
        try:
            self.outcome = True, self.work(*self.arguments)
        except Exception as fault:  # noqa: BLE001 - raised where the result is asked for
            self.outcome = False, fault

    def result(self) -> T:
        """Give what it gave, or raise what it raised, once it has ended; an answer that cannot be read is made here."""
        if self.outcome is None:
            try:
                self.outcome = pickle.loads(self.answer)  # from the process started here alone
            except Exception:  # noqa: BLE001 - objects refuse to be read in ways of many kinds
                self.do()
            self.answer = b""
        well, what = cast(tuple[bool, T | Exception], self.outcome)
        if isinstance(what, Exception) and not well:
            raise what
        return cast(T, what)


class Assistant:
    """Queue of tasks, and the process that does some of them; without one, all are done where they are waited for.

    Parameters
    ----------
    process : subprocess.Popen, optional
        That runs this module.
    """

    def __init__(self, process: subprocess.Popen[bytes] | None = None) -> None:
        self._process = process
        self._queue: deque[Task[Any]] = deque()
        self._changed = threading.Condition()
        self._closed = process is None
        self._thread = threading.Thread(target=self._hand_over, daemon=True)
        if process is not None:
            self._thread.start()

    @property
    def there(self) -> bool:
        """Whether there is a process that takes tasks."""
        return not self._closed

    def submit(self, work: Callable[..., T], *arguments: Any) -> Task[T]:
        """Put a task at the end of the queue."""
        task = Task(work, arguments, _packed((work, arguments)) if self.there else b"")
        with self._changed:
            self._queue.append(task)
            self._changed.notify_all()
        return task

    def result(self, task: Task[T]) -> T:
        """Result of a task; done here if it has not begun, and raising what it raised.

        While the assistant is at it, tasks that wait behind it are done here.
        """
        while not task.ended:
            with self._changed:
                self._changed.wait_for(lambda: task.ended or self._queue)
                if task.ended:
                    break
                here = task if task in self._queue else self._queue[-1]
                self._queue.remove(here)
            here.do()
        return task.result()

    def _hand_over(self) -> None:
        """Send tasks to the assistant, one after the other, until it is dismissed or has died."""
        while (task := self._next()) is not None:
            answer = _answer(cast("subprocess.Popen[bytes]", self._process), task.packed)
            with self._changed:
                task.answer = answer
                if not answer:
                    self._closed = True
                    self._queue.appendleft(task)
                self._changed.notify_all()

    def _next(self) -> Task[Any] | None:
        """Wait for a task that can be sent, and take it; None once there is nobody to send it to."""

        def first() -> Task[Any] | None:
            return next((task for task in self._queue if task.packed), None)

        with self._changed:
            self._changed.wait_for(lambda: self._closed or first() is not None)
            if self._closed or (task := first()) is None:
                return None
            self._queue.remove(task)
        return task

    def dismiss(self) -> None:
        """End the process at once; what it writes is whole at any moment."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._thread.join()


def _answer(process: subprocess.Popen[bytes], packed: bytes) -> bytes:
    """Outcome of a task that a process did, packed; empty where it died before."""
    to, back = cast(IO[bytes], process.stdin), cast(IO[bytes], process.stdout)
    try:
        to.write(packed)
        to.flush()
        size = int.from_bytes(back.read(SIZE), "big")
        answer = back.read(size)
    except OSError:
        return b""
    return answer if len(answer) == size else b""


@contextmanager
def assistant(modules: Sequence[str]) -> Iterator[Assistant]:
    """Give an assistant that loads `modules` at once, where there is a core for it; it is gone when this is left."""
    if not modules or cores() < 2:
        yield Assistant()
        return
    command = python(*module(__name__, *modules))
    helper = Assistant(subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE))
    try:
        yield helper
    finally:
        helper.dismiss()


def _packed(content: object) -> bytes:
    """Task, or outcome, in the form in which it is sent; empty where it cannot be."""
    try:
        return pickle.dumps(content)
    except Exception:  # noqa: BLE001 - objects refuse to be sent in ways of many kinds
        return b""


def _serve(modules: Sequence[str]) -> None:
    """Load modules, then do what comes in, until nothing more does."""
    import signal
    from importlib import import_module

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is the other process's to answer
    # what libraries print must not stand among the answers
    back = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    for name in modules:
        import_module(name)
    while True:
        try:
            work, arguments = pickle.load(sys.stdin.buffer)
        except EOFError:
            return
        task = Task(work, arguments)
        task.do()
        # an outcome that cannot be sent has no length: the other process does the task again
        answer = _packed(task.outcome)
        with suppress(BrokenPipeError):
            back.write(len(answer).to_bytes(SIZE, "big") + answer)
            back.flush()


if __name__ == "__main__":
    _serve(sys.argv[1:])
