"""How the rows of a study or an optimisation are computed: one record for Python and the command line."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from base import InputError, Limit
from flankfilm.studies.executors import Kind, default_workers

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
    executor : {"processes", "dask", "mpi"}
        Where the rows are computed.
    workers : int, optional
        Processes; one for each core if left out.
    resume : bool
        Go on from the rows in the folder.
    cache : bool
        Use results of earlier runs whose inputs and code are the same.
    """

    executor: Kind = "processes"
    workers: int | None = None
    resume: bool = False
    cache: bool = True

    def __post_init__(self) -> None:
        """Refuse a number of workers that cannot be."""
        if self.workers is not None and (faults := WORKERS.faults("workers", self.workers)):
            raise InputError(faults)

    def staff(self) -> Workers:
        """Workers to compute rows with, to be used as a context."""
        from flankfilm.studies.workers import Workers

        return Workers(self.executor, self.workers or default_workers())
