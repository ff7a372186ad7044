"""How the rows of a study or an optimisation are computed: one record for Python and the command line."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, get_args

from base import InputError, Limit
from flankfilm.processes.worker_processes import cores
from flankfilm.studies.executors import Kind

if TYPE_CHECKING:
    from flankfilm.studies.workers import Workers

Progress = Callable[[int, int], None]
"""Called with the rows done and the rows in all, each time that a row arrives."""


WORKERS = Limit(1, 4096, remedy="leave it out for one worker on each core", whole=True)


@dataclass(frozen=True)
class Execution:
    """How rows are computed.

    Parameters
    ----------
    executor : {"processes", "dask", "mpi"} or concurrent.futures.Executor
        Where the rows are computed. An executor of your own is used as it is, and not shut down.
    workers : int, optional
        Processes; one for each core if left out. Of your own executor: how many rows it computes at once.
    resume : bool
        Go on from the rows in the folder.
    cache : bool
        Use results of earlier runs whose inputs and code are the same.
    """

    executor: Kind | Executor = "processes"
    workers: int | None = None
    resume: bool = False
    cache: bool = True

    def __post_init__(self) -> None:
        """Refuse an executor that is none, and a number of workers that cannot be."""
        if not isinstance(self.executor, Executor) and self.executor not in get_args(Kind):
            names = ", ".join(get_args(Kind))
            allowed = f"must be one of {names}, or a concurrent.futures.Executor"
            raise InputError.at("executor", repr(self.executor), allowed, "Such as ThreadPoolExecutor(4)")
        if self.workers is not None and (faults := WORKERS.faults("workers", self.workers)):
            raise InputError(faults)

    def staff(self) -> Workers:
        """Workers to compute rows with, to be used as a context."""
        from flankfilm.studies.workers import Workers

        return Workers(self.executor, self.workers or cores())
