"""Where rows are computed: processes of this machine, a dask cluster, MPI, or any executor of the caller."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

from base import InputError
from flankfilm.processes.worker_processes import ends_later, environment, on_its_way, work_until_told

if TYPE_CHECKING:
    from dask.distributed import Client

Kind = Literal["processes", "dask", "mpi"]
"""Executors that are started here, by their names."""

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Variables that limit the threads of libraries."""

ONE_THREAD = dict.fromkeys(THREADS, "1")
"""Cores are shared by rows, not within."""


@dataclass(frozen=True)
class Pool:
    """An executor, and how many rows it computes at once.

    Attributes
    ----------
    executor : Executor
    size : callable
        Workers at this moment: those of a cluster come and go.
    """

    executor: Executor
    size: Callable[[], int]


@contextmanager
def executor(kind: Kind | Executor, workers: int) -> Iterator[Pool]:
    """Give an executor: the caller's own as it is, or one that is started here, whose workers use one thread each.

    Parameters
    ----------
    kind : {"processes", "dask", "mpi"} or Executor
        ``dask`` connects to the scheduler that dask's own configuration names (``DASK_SCHEDULER_ADDRESS``),
        else starts workers here; ``mpi`` takes the ranks that ``mpiexec -n N python -m mpi4py.futures`` made.
        An executor of the caller is not shut down.
    workers : int
        Number of workers of an executor that is started here, or that the caller's has.

    Raises
    ------
    InputError
        Where the library for it is not installed.
    """
    if isinstance(kind, Executor):
        yield Pool(kind, lambda: workers)
    elif kind == "processes":
        yield from _processes(workers)
    elif kind == "dask":
        yield from _dask(workers)
    else:
        yield from _mpi()


class _Processes(ProcessPoolExecutor):
    """Processes that are started whole, with the rows that come first, or not at all."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Take a call; start a process for it where one is missing."""
        with ends_later():
            return super().submit(fn, *args, **kwargs)


def _processes(workers: int) -> Iterator[Pool]:
    context = multiprocessing.get_context("spawn")
    told, tell = context.Pipe(duplex=False)
    with environment(**ONE_THREAD), told, tell:
        pool = _Processes(workers, context, work_until_told, (told,))
        try:
            yield Pool(pool, lambda: workers)
        except BaseException:
            tell.close()  # whatever ended us, rows at work are not waited for
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _dask(workers: int) -> Iterator[Pool]:
    try:
        from dask import config
        from dask.distributed import Client
    except ImportError as fault:
        raise _missing("dask", "distributed") from fault
    # an address of no letters, which dask would take for one, is none
    address = os.environ.get("DASK_SCHEDULER_ADDRESS") or config.get("scheduler-address", None) or None
    with environment(**ONE_THREAD), _logging_as_before(), config.set({"scheduler-address": address}):
        here = {
            "n_workers": workers,
            "threads_per_worker": 1,
            "preload": "flankfilm.processes.worker_processes",
        }
        try:
            with Client(address) if address else Client(**here) as client:
                try:
                    yield Pool(client.get_executor(), lambda: len(client.nthreads()))
                except BaseException:
                    _end_at_once(client)
                    raise
        except BaseException:
            logging.disable()  # what dask makes, with tracebacks, of a cluster that is left half-way
            raise


def _end_at_once(client: Client) -> None:
    """Kill the workers that were started here: rows that nobody waits for any more, and what these would say."""
    logging.disable()
    on_its_way()
    for nanny in getattr(client.cluster, "workers", {}).values():
        nanny.close_gracefully()  # it starts no other worker then
        if nanny.pid:
            with suppress(ProcessLookupError):
                os.kill(nanny.pid, getattr(signal, "SIGKILL", signal.SIGTERM))


@contextmanager
def _logging_as_before() -> Iterator[None]:
    """Take back, at the end, that nothing is logged."""
    before = logging.root.manager.disable
    try:
        yield
    finally:
        logging.disable(before)


def _mpi() -> Iterator[Pool]:
    try:
        from mpi4py.futures import MPIPoolExecutor
    except (ImportError, RuntimeError) as fault:
        raise _missing("mpi", "mpi4py") from fault
    # ranks have started already: they take the settings before they load the libraries that heed them
    with MPIPoolExecutor(env=ONE_THREAD) as pool:
        try:
            yield Pool(pool, lambda: pool.num_workers)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _missing(kind: str, library: str) -> InputError:
    remedy = f"Install it: python -m pip install 'flankfilm[{kind}]'; or leave --executor out"
    return InputError.at("--executor", kind, f"needs the library {library}", remedy)
