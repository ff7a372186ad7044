"""Compiled code and stopwatches: loading numba, compiling and loading what was compiled are not computing."""

from __future__ import annotations

from functools import cache
from typing import Any

from base.cost import ASIDE, unclocked


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

        def on_start(self, _event: Any) -> None:
            ASIDE.open()

        def on_end(self, _event: Any) -> None:
            ASIDE.close()

    event.register("numba:compiler_lock", Listener())
