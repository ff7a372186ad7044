"""How many rows are on their way: as many as the executor of the moment can take, whatever this machine has."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections import deque
from concurrent.futures import Executor, Future
from contextlib import contextmanager
from pathlib import Path

import pytest

from flankfilm.studies.executors import Pool
from flankfilm.studies.row import Row, RowResult
from flankfilm.studies.workers import AHEAD, Workers
from tests.processes import unwatched


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


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="the system has no timer that sends a signal")
def test_a_signal_while_rows_are_waited_for_leaves_no_lock_behind():
    """Inside concurrent.futures.wait it does: the pool could then not be ended, nor the study."""
    script = Path(__file__).with_name("interrupted_rows.py")
    done = subprocess.run(
        [sys.executable, str(script)],
        capture_output=True,
        text=True,
        env=unwatched(),
        timeout=120,
        check=False,
    )
    assert (done.returncode, done.stdout) == (0, "300 interrupts\n"), done.stderr
