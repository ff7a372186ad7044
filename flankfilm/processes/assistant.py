"""A second process that works beside this one: tasks wait in a queue, from which both take them.

Files of a run do not depend on each other. The assistant is started when a run begins, so that it has loaded what it
needs by the time there is something to write. Who waits for a task that has not begun does it here. A run without an
assistant, or whose assistant died, does them all; a task that cannot be sent is done here as well. The same function
with the same arguments makes the same file in either place.
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
from dataclasses import dataclass, field
from typing import IO, Any, Generic, TypeVar, cast

from flankfilm.processes.worker_processes import cores, module, python

__all__ = ["Assistant", "Task", "assistant"]

T = TypeVar("T")


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
    ended : threading.Event
        Set when `value` or `fault` is known.
    """

    work: Callable[..., T]
    arguments: tuple[Any, ...]
    packed: bytes = b""
    ended: threading.Event = field(default_factory=threading.Event)
    value: T | None = None
    fault: Exception | None = None

    def do(self) -> None:
        """Do it in this process."""
        try:
            self.value = self.work(*self.arguments)
        except Exception as fault:  # noqa: BLE001 - raised where the result is asked for
            self.fault = fault
        self.ended.set()


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
        if process is not None:
            threading.Thread(target=self._hand_over, args=(process,), daemon=True).start()

    @property
    def there(self) -> bool:
        """Whether there is a process that takes tasks."""
        return not self._closed

    def submit(self, work: Callable[..., T], *arguments: Any) -> Task[T]:
        """Put a task at the end of the queue."""
        task = Task(work, arguments, _packed(work, arguments) if self.there else b"")
        with self._changed:
            self._queue.append(task)
            self._changed.notify()
        return task

    def result(self, task: Task[T]) -> T:
        """Result of a task; done here if it has not begun, and raising what it raised.

        While the assistant is at it, tasks that wait behind it are done here.
        """
        self._do_here(task)
        while not task.ended.is_set():
            if not self._do_here(None):
                task.ended.wait()
        if task.fault is not None:
            raise task.fault
        return cast(T, task.value)

    def _do_here(self, wanted: Task[Any] | None) -> bool:
        """Do one task of the queue here: the wanted one, or the last; False where it has gone."""
        with self._changed:
            task = (
                wanted if wanted in self._queue else self._queue[-1] if not wanted and self._queue else None
            )
            if task is None:
                return False
            self._queue.remove(task)
        task.do()
        return True

    def _hand_over(self, process: subprocess.Popen[bytes]) -> None:
        """Send tasks to the assistant, one after the other, until it is dismissed or has died."""
        to, back = cast(IO[bytes], process.stdin), cast(IO[bytes], process.stdout)
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._closed or self._queue)
                if self._closed:
                    return
                task = self._queue.popleft()
            if not task.packed:
                task.do()
                continue
            try:
                to.write(task.packed)
                to.flush()
                done, outcome = pickle.load(back)  # from the process started here alone
            except (OSError, EOFError, pickle.PickleError):
                with self._changed:
                    self._closed = True
                task.do()
                return
            task.value, task.fault = (outcome, None) if done else (None, outcome)
            task.ended.set()

    def dismiss(self) -> None:
        """End the process at once; what it writes is whole at any moment."""
        with self._changed:
            self._closed = True
            self._changed.notify_all()
        if self._process is not None:
            self._process.kill()
            self._process.wait()


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


def _packed(work: Callable[..., Any], arguments: tuple[Any, ...]) -> bytes:
    """Task as it is sent; empty where it cannot be."""
    try:
        return pickle.dumps((work, arguments))
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
        answer = (True, task.value) if task.fault is None else (False, task.fault)
        with suppress(BrokenPipeError):
            pickle.dump(answer, back)
            back.flush()


if __name__ == "__main__":
    _serve(sys.argv[1:])
