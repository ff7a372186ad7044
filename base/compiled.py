"""Compiled code and stopwatches: loading numba, compiling and loading what was compiled are not computing."""

from __future__ import annotations

import threading
from contextlib import AbstractContextManager
from functools import cache
from typing import Any

from base.cost import unclocked


@cache
def hide_compilation() -> None:
    """Hide from the stopwatches what numba does under its compiler's lock, from now on; loads numba.

    Examples
    --------
    >>> from base import Stopwatch
    >>> hide_compilation()
    >>> watch = Stopwatch()
    >>> from numba import njit
    >>> njit(lambda x: x + 1.0)(1.0)
    2.0
    >>> watch.seconds < 0.05
    True
    """
    with unclocked():
        from numba.core import event

    class Listener(event.Listener):  # type: ignore[misc,unused-ignore]
        """Opens an unclocked stretch when the lock is taken, closes it when the lock is let go."""

        def __init__(self) -> None:
            self._of_thread = threading.local()

        def on_start(self, _event: Any) -> None:
            hidden = unclocked()
            hidden.__enter__()
            self._held().append(hidden)

        def on_end(self, _event: Any) -> None:
            self._held().pop().__exit__(None, None, None)

        def _held(self) -> list[AbstractContextManager[None]]:
            if not hasattr(self._of_thread, "held"):
                self._of_thread.held = []
            held: list[AbstractContextManager[None]] = self._of_thread.held
            return held

    event.register("numba:compiler_lock", Listener())
