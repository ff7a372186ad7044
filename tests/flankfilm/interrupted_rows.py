"""Interrupts a study's rows 300 times, each a little later, and looks whether the lock of a row is held for ever.

A process of its own, without coverage: an interrupt inside the measurement leaves coverage's own lock held.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
from concurrent.futures import Executor, Future
from contextlib import contextmanager

from flankfilm.processes.worker_processes import answering_signals
from flankfilm.studies import workers
from flankfilm.studies.executors import Pool
from flankfilm.studies.row import Row, RowResult

ROWS = [Row(index, {}, ("contact_ratio",)) for index in range(2_000)]


class Busy(Executor):
    """A thread that ends rows, which it cannot where the lock of one of them is held for ever."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Future[RowResult], Row]] = []
        self.ended = False
        self.thread = threading.Thread(target=self.work, daemon=True)
        self.thread.start()

    def submit(self, fn, /, *args, **kwargs):
        future: Future[RowResult] = Future()
        self.waiting.append((future, args[0]))
        return future

    def work(self) -> None:
        while not self.ended or self.waiting:
            if self.waiting:
                time.sleep(2e-5)
                future, row = self.waiting.pop(0)
                future.set_result(RowResult(row.index, (0.0,), 0.0))


def interrupted(delay: float) -> Busy:
    """The executor of a study that is interrupted after a while; it must end with the interrupt."""
    pools: list[Busy] = []

    @contextmanager
    def executor(kind, count):
        pools.append(Busy())
        # anew: the first interrupt of a command sets an alarm for a second one
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
        signal.setitimer(signal.ITIMER_REAL, delay)
        yield Pool(pools[0], lambda: 2)

    workers.executor = executor  # type: ignore[assignment]
    try:
        # as a command does: an interrupt that a destructor swallows is asked for again
        with answering_signals(), workers.Workers("processes", 2) as working:
            for _ in working.computed(ROWS):
                pass
            time.sleep(4.0)
    except KeyboardInterrupt:
        return pools[0]
    sys.exit("the interrupt was lost")


def main() -> None:
    """300 interrupts."""
    for count in range(300):
        busy = interrupted(0.001 + 1e-5 * (count + 1))
        busy.ended = True
        busy.thread.join(10.0)
        if busy.thread.is_alive():
            sys.exit(f"a row's lock is held for ever after interrupt {count + 1}")
    print("300 interrupts")


if __name__ == "__main__":
    main()
