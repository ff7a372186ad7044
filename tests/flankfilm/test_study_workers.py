"""How many rows are on their way: as many as the executor of the moment can take, whatever this machine has."""

from __future__ import annotations

import signal
import threading
import time
from collections import deque
from concurrent.futures import Executor, Future
from contextlib import contextmanager

import pytest

from flankfilm.children import answering_signals
from flankfilm.studies.executors import Pool
from flankfilm.studies.row import Row, RowResult
from flankfilm.studies.workers import AHEAD, Workers


class Cluster(Executor):
    """Workers elsewhere: rows wait until one is looked for, and then the oldest is done."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Future[RowResult], Row]] = []
        self.most = 0

    def submit(self, fn, /, *args, **kwargs):
        future: Future[RowResult] = Future()
        self.waiting.append((future, args[0]))
        self.most = max(self.most, len(self.waiting))
        return future

    def work(self) -> None:
        future, row = self.waiting.pop(0)
        future.set_result(RowResult(row.index, (float(row.index),), 0.0))


def test_a_cluster_larger_than_this_machine_is_kept_busy_and_one_that_grows_too(monkeypatch):
    cluster, size = Cluster(), [8]

    @contextmanager
    def executor(kind, workers):
        yield Pool(cluster, lambda: size[0])

    class Queue(deque):
        put = deque.append

        def get(self):
            cluster.work()
            return self.popleft()

    monkeypatch.setattr("flankfilm.studies.workers.executor", executor)
    monkeypatch.setattr("flankfilm.studies.workers.SimpleQueue", Queue)
    rows = [Row(index, {}, ("contact_ratio",)) for index in range(100)]
    seen = []
    with Workers("mpi", 2) as workers:
        for result in workers.computed(rows):
            seen.append(result.index)
            if len(seen) == 1:
                assert cluster.most == AHEAD * 8
                size[0] = 20
    assert sorted(seen) == list(range(100))
    assert cluster.most == AHEAD * 20


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


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system has no timer that sends a signal")
def test_a_signal_while_rows_are_waited_for_leaves_no_lock_behind(monkeypatch):
    """Inside concurrent.futures.wait it does: the pool could then not be ended, nor the study."""
    pools: list[Busy] = []

    @contextmanager
    def executor(kind, workers):
        pools.append(Busy())
        signal.signal(signal.SIGALRM, lambda *_: signal.raise_signal(signal.SIGINT))
        signal.setitimer(signal.ITIMER_REAL, 0.001 + 1e-5 * len(pools))
        yield Pool(pools[-1], lambda: 2)

    monkeypatch.setattr("flankfilm.studies.workers.executor", executor)

    def compute() -> None:
        # as a command does: an interrupt that a destructor swallows is asked for again
        with answering_signals(), Workers("processes", 2) as workers:
            for _ in workers.computed(rows):
                pass
            time.sleep(4.0)

    before = signal.getsignal(signal.SIGALRM)
    rows = [Row(index, {}, ("contact_ratio",)) for index in range(2_000)]
    try:
        for _ in range(300):
            with pytest.raises(KeyboardInterrupt):
                compute()
            pools[-1].ended = True
            pools[-1].thread.join(2.0)
            assert not pools[-1].thread.is_alive()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
