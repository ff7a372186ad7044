"""Where rows are computed: processes of this machine, a dask cluster, or MPI."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Literal

from base import InputError

Kind = Literal["processes", "dask", "mpi"]

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Variables that limit the threads of libraries."""


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


def default_workers() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


@contextmanager
def executor(kind: Kind, workers: int) -> Iterator[Pool]:
    """Give an executor whose workers use one thread each.

    Parameters
    ----------
    kind : {"processes", "dask", "mpi"}
        ``dask`` connects to the scheduler that dask's own configuration names (``DASK_SCHEDULER_ADDRESS``),
        else starts workers here; ``mpi`` takes the ranks that ``mpiexec -n N python -m mpi4py.futures`` made.
    workers : int
        Number of workers of an executor that is started here.

    Raises
    ------
    InputError
        Where the library for it is not installed.
    """
    if kind == "processes":
        with _single_threaded():
            pool = ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"), _leave_interrupts)
            try:
                yield Pool(pool, lambda: workers)
            finally:
                pool.shutdown(wait=True, cancel_futures=True)
    elif kind == "dask":
        yield from _dask(workers)
    else:
        yield from _mpi()


def _dask(workers: int) -> Iterator[Pool]:
    try:
        from dask.distributed import Client
    except ImportError as fault:
        raise _missing("dask", "distributed") from fault
    address = os.environ.get("DASK_SCHEDULER_ADDRESS")
    with _single_threaded():
        client = Client(address) if address else Client(n_workers=workers, threads_per_worker=1)
        with client:
            yield Pool(client.get_executor(), lambda: len(client.nthreads()))


def _mpi() -> Iterator[Pool]:
    try:
        from mpi4py.futures import MPIPoolExecutor
    except (ImportError, RuntimeError) as fault:
        raise _missing("mpi", "mpi4py") from fault
    # ranks have started already: they take the settings before they load the libraries that heed them
    with MPIPoolExecutor(env=dict.fromkeys(THREADS, "1")) as pool:
        try:
            yield Pool(pool, lambda: pool.num_workers)
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


def _missing(kind: str, library: str) -> InputError:
    remedy = f"Install it: python -m pip install 'flankfilm[{kind}]'; or leave --executor out"
    return InputError.at("--executor", kind, f"needs the library {library}", remedy)


def _leave_interrupts() -> None:
    """Let the parent alone answer Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def _single_threaded() -> Iterator[None]:
    """Have processes that are started meanwhile use one thread each: cores are shared by rows, not within."""
    before = {name: os.environ.get(name) for name in THREADS}
    os.environ.update(dict.fromkeys(THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
