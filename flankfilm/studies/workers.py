"""Workers that compute rows, and outlive one of them that dies."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future
from contextlib import ExitStack
from queue import SimpleQueue
from types import TracebackType

from base import SolverError
from flankfilm.processes.worker_processes import ends_later
from flankfilm.studies.executors import Kind, Pool, executor
from flankfilm.studies.row import NOT_COMPUTED, Row, RowResult, compute_row, failed

AHEAD = 3
"""Rows for each worker that wait in the executor at most: enough to keep it busy, few to lose."""


class Workers:
    """An executor that is made anew when a process of it dies; use it as a context.

    Parameters
    ----------
    kind : {"processes", "dask", "mpi"} or Executor
    count : int
        Workers of an executor that is started here, or that the caller's has.
    """

    def __init__(self, kind: Kind | Executor, count: int) -> None:
        self.kind: Kind | Executor = kind
        self.count = count
        self._open = ExitStack()
        self._pool: Pool | None = None
        self._waiting: dict[Future[RowResult], Row] = {}

    def __enter__(self) -> Workers:
        """Processes start with the first rows."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Cancel rows that wait, and end the processes; after an error or a signal those at work too.

        An executor of the caller lives on: rows at work there are not waited for.
        """
        if isinstance(self.kind, Executor):  # one that was started here cancels them as it ends
            for future in self._waiting:
                future.cancel()
        self._open.__exit__(kind, error, trace)

    def computed(self, rows: Iterable[Row]) -> Iterator[RowResult]:
        """Compute rows, in the order in which they are done.

        Where a process dies, the rows that it may have had are computed again, each in a separate process;
        one whose process dies again has failed.

        Raises
        ------
        SolverError
            Where a process of the caller's executor died, which cannot be made anew, and rows are missing.
        """
        remaining = list(rows)
        while remaining:
            arrived: set[int] = set()
            suspects: list[Row] = []
            try:
                for result in self._in_pool(remaining):
                    arrived.add(result.index)
                    yield result
            except BrokenExecutor:
                suspects = list(self._waiting.values())
                self._waiting.clear()
                self._open.close()
                self._pool = None
            for row in suspects:
                arrived.add(row.index)
                yield _alone(row)
            remaining = [row for row in remaining if row.index not in arrived]
            if remaining and isinstance(self.kind, Executor):
                raise SolverError(
                    f"a process of the executor died, and {len(remaining)} rows are missing; give another executor, "
                    "with resume=True for the rows that are kept"
                )

    def _in_pool(self, rows: list[Row]) -> Iterator[RowResult]:
        if self._pool is None:
            self._pool = self._open.enter_context(executor(self.kind, self.count))
        ahead, waiting = iter(rows), self._waiting
        # concurrent.futures.wait holds locks of all futures: a signal within it would leave them locked for ever
        done: SimpleQueue[Future[RowResult]] = SimpleQueue()
        while True:
            room = AHEAD * max(1, self._pool.size())
            while len(waiting) < room and (row := next(ahead, None)) is not None:
                with ends_later():
                    future = self._pool.executor.submit(compute_row, row)
                    waiting[future] = row
                    future.add_done_callback(done.put)
            if not waiting:
                return
            future = done.get()
            result = _result(waiting[future], future)
            del waiting[future]
            yield result


def _result(row: Row, future: Future[RowResult]) -> RowResult:
    fault = future.exception()
    if fault is None:
        return future.result()
    if isinstance(fault, BrokenExecutor):
        raise fault
    return failed(row, f"{type(fault).__name__}: {fault}")


def _alone(row: Row) -> RowResult:
    """Compute a row in a separate process."""
    with executor("processes", 1) as pool:
        try:
            return pool.executor.submit(compute_row, row).result()
        except BrokenExecutor:
            return failed(row, f"{NOT_COMPUTED}its process died twice, perhaps for want of memory")
