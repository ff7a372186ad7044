"""A run, a study or an optimisation of the page: a process with its stage, log, end, and cancelling."""

from __future__ import annotations

import subprocess
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from flankfilm.app.messages import Message, heard
from flankfilm.app.studies import Growing
from flankfilm.app.time_left import Clock
from flankfilm.files.folder import PAGE
from flankfilm.processes.exit_status import PART_FAILED
from flankfilm.processes.worker_processes import module, python
from flankfilm.studies.table import ROWS

__all__ = ["Run", "RunState"]

LONGEST = 400
"""Lines of a log that are kept."""

WHOLE = (0, PART_FAILED)
"""Exit statuses with which a report is written; one that is there after others is of an earlier run."""

END = 3.0
"""Seconds in which a process that is asked to end does so; it is killed then."""


@dataclass(frozen=True)
class RunState:
    """How a run stands.

    Attributes
    ----------
    what : str
        Stage that is at work.
    done, total : int
        Stages.
    seconds : float
        Since the start.
    log : tuple of str
    status : int or None
        Exit status; None as long as it runs.
    cancelled : bool
    folder : str
        Of the results.
    report : bool
        Whether they have a report, of this run.
    left, stage_left : float or None
        Seconds left of the run and of its stage, from now; None where nothing foresees them.
    """

    what: str = "starting"
    done: int = 0
    total: int = 1
    seconds: float = 0.0
    log: tuple[str, ...] = ()
    status: int | None = None
    cancelled: bool = False
    folder: str = ""
    report: bool = False
    left: float | None = None
    stage_left: float | None = None


class Run:
    """One run in a process, which ends with this one.

    Parameters
    ----------
    kind : {"run", "study", "optimise"}
    arguments : sequence of str
        Of `flankfilm.app.run_child`, after the kind.
    folder : Path
        Of the results.
    tell : callable
        Takes each state, as "run", and new rows, as "rows" with ``first`` and ``rows``, or with ``heads``, once; in
        another thread.
    text : str
        Scene to run.
    """

    def __init__(
        self,
        kind: str,
        arguments: Sequence[str],
        folder: Path,
        tell: Callable[[str, Mapping[str, Any]], None],
        text: str = "",
    ) -> None:
        self._tell, self._folder, self._began = tell, folder, time.perf_counter()
        self._lines: list[str] = []
        self._what, self._done, self._total = "starting", 0, 1
        self._cancelled, self._clock = False, Clock()
        self._table = None if kind == "run" else Growing(folder / ROWS)
        self._process = subprocess.Popen(
            python(*module("flankfilm.app.run_child", kind, *arguments)),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            encoding="utf-8",
            errors="replace",
        )
        self._thread = threading.Thread(target=self._follow, args=(text,), daemon=True)
        self._thread.start()

    @property
    def state(self) -> RunState:
        """How it stands now."""
        status = self._process.poll() if not self._thread.is_alive() else None
        return self._state(status)

    @property
    def running(self) -> bool:
        """Whether its process is there."""
        return self._process.poll() is None

    def cancel(self) -> None:
        """End it; what it has written is whole."""
        self._cancelled = True
        if self._process.poll() is None:
            self._process.terminate()
            killing = threading.Timer(END, self._kill)
            killing.daemon = True
            killing.start()

    def close(self) -> None:
        """End it, and wait until it has ended."""
        self.cancel()
        try:
            self._process.wait(END)
        except subprocess.TimeoutExpired:
            self._kill()
            self._process.wait()

    def wait(self, seconds: float) -> RunState:
        """State once it has ended, or after a time."""
        self._thread.join(seconds)
        return self.state

    def _kill(self) -> None:
        if self._process.poll() is None:
            self._process.kill()

    def _state(self, status: int | None) -> RunState:
        left = self._clock.left(time.perf_counter()) if status is None else None
        return RunState(
            self._what,
            self._done,
            self._total,
            time.perf_counter() - self._began,
            tuple(self._lines),
            status,
            self._cancelled,
            str(self._folder),
            status in WHOLE and (self._folder / PAGE).is_file(),
            *(left or (None, None)),
        )

    def _follow(self, text: str) -> None:
        """Give the process its scene, and hand on what it says until it ends."""
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        with suppress(OSError):
            self._process.stdin.write(text)
        with suppress(OSError):
            self._process.stdin.close()
        with suppress(ValueError, OSError):
            for message in heard(self._process.stdout):
                self._take(message)
                self._hand_on(None)
        self._process.stdout.close()
        status = self._process.wait()
        if status == 0:
            self._what, self._done = "done", self._total
        self._hand_on(status)

    def _hand_on(self, status: int | None) -> None:
        """Hand on the state, and rows that are new."""
        self._tell("run", asdict(self._state(status)))
        if self._table is not None:
            first, rows = self._table.more()
            if rows:
                self._tell("rows", {"first": first, "rows": rows})

    def _take(self, message: Message | str) -> None:
        if isinstance(message, str):
            self._lines = [*self._lines[-LONGEST:], message]
        elif "foreseen" in message:
            self._clock = Clock(message["foreseen"])
        elif "heads" in message:
            self._tell("rows", {"heads": message["heads"], "rows": []})
        elif message.keys() >= {"what", "done", "total"}:
            self._what = str(message["what"])
            self._done, self._total = int(message["done"]), max(int(message["total"]), 1)
            there = int(message.get("there", 0))
            self._clock.begins(self._what, self._done, self._total, time.perf_counter(), there)
