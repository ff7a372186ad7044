"""Live answers as the page sees them: a process that is asked anew with each drag, and started anew where it lags."""

from __future__ import annotations

import json
import subprocess
import threading
from collections.abc import Callable
from contextlib import suppress

from flankfilm.app.checking import Place
from flankfilm.app.document import Document
from flankfilm.app.messages import Message, heard, send
from flankfilm.processes.worker_processes import module, python

__all__ = ["Live"]

LOST = (
    "the process that computes has ended, by lack of memory or by a signal; change a key to start another one"
)

PATIENCE = 3.0
"""Seconds for which a process may be busy with an older scene before it is ended."""

END = 5.0
"""Seconds in which a process ends."""


class Live:
    """Answers for the newest of the scenes that it is asked for; answers for older ones are dropped.

    Parameters
    ----------
    tell : callable
        Takes each message of `flankfilm.app.live_child` about the newest scene, in another thread.
    patience : float
        Seconds for which an older scene may keep the newest one waiting.
    """

    def __init__(self, tell: Callable[[Message], None], patience: float = PATIENCE) -> None:
        self._tell, self._patience = tell, patience
        self._lock = threading.RLock()
        self._process: subprocess.Popen[str] | None = None
        self._newest, self._begun, self._spoke = 0, 0, False
        self._request: Message | None = None
        self._timer: threading.Timer | None = None
        self._asked: dict[int, str] = {}
        self._solving = ""

    def ask(self, document: Document, place: Place) -> int:
        """Ask for a scene, in place of all before; give its number, which its answers have.

        Parameters
        ----------
        document : Document
        place : Place
        """
        with self._lock:
            self._newest += 1
            self._request = {
                "number": self._newest,
                "text": document.text,
                "root": str(place.root),
                "folder": str(place.folder),
            }
            self._asked[self._newest] = _gears(document)
            self._send()
            self._watch(self._newest)
            return self._newest

    def forget(self) -> None:
        """Drop whatever is still to be answered."""
        with self._lock:
            self._newest += 1
            self._request = None

    def close(self) -> None:
        """End the process."""
        with self._lock:
            self._newest += 1
            self._request = None
            if self._timer is not None:
                self._timer.cancel()
            self._end()

    @property
    def process(self) -> int | None:
        """Number of the process; None where none is running."""
        return None if self._process is None else self._process.pid

    def _send(self) -> None:
        if self._request is None:
            return
        if self._process is None or self._process.poll() is not None:
            self._start()
        assert self._process is not None
        assert self._process.stdin is not None
        with suppress(OSError):  # it has just ended: the timer starts another one
            send(self._process.stdin, self._request)

    def _start(self) -> None:
        self._end()
        self._spoke, self._solving = False, ""
        self._process = subprocess.Popen(
            python(*module("flankfilm.app.live_child")),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
            encoding="utf-8",
        )
        threading.Thread(target=self._listen, args=(self._process,), daemon=True).start()

    def _end(self) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        process.kill()  # it writes nothing but the cache, which is whole at any moment
        with suppress(subprocess.TimeoutExpired):
            process.wait(END)
        with suppress(OSError):
            assert process.stdin is not None
            process.stdin.close()

    def _listen(self, process: subprocess.Popen[str]) -> None:
        """Hand on what a process says of the newest scene."""
        assert process.stdout is not None
        with suppress(ValueError, OSError):
            for message in heard(process.stdout):
                if isinstance(message, str):
                    continue
                with self._lock:
                    if process is not self._process:
                        continue
                    self._spoke = True
                    begins = message["kind"] == "begun"
                    self._solving = self._asked.get(message["number"], "") if begins else ""
                    self._asked = {n: gears for n, gears in self._asked.items() if n >= message["number"]}
                    if message["number"] != self._newest:
                        continue
                    self._begun = message["number"]
                if message["kind"] != "begun":
                    self._tell(message)
        process.stdout.close()
        with suppress(subprocess.TimeoutExpired):
            process.wait(END)
        with self._lock:
            lost = process is self._process and self._request is not None
            number = self._newest
        if lost:
            self._tell({"number": number, "kind": "fault", "seconds": 0.0, "text": LOST})

    def _watch(self, number: int) -> None:
        """Look again whether the process is at a scene after all."""
        if self._timer is not None:
            self._timer.cancel()
        self._timer = threading.Timer(self._patience, self._look, (number,))
        self._timer.daemon = True
        self._timer.start()

    def _look(self, number: int) -> None:
        with self._lock:
            if number != self._newest or self._request is None or self._begun >= number:
                return
            # one that has said nothing yet is starting, and one that solves the same gears does what is wanted
            if self._spoke and self._solving != self._asked[number]:
                self._end()
                self._send()
            self._watch(number)


def _gears(document: Document) -> str:
    """What the gears of a scene depend on: all but its load."""
    return json.dumps({**document.raw, "operating": None}, sort_keys=True, default=str)
