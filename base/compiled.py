"""Compiled code and stopwatches: loading numba, compiling and loading what was compiled are not computing."""

from __future__ import annotations

import gc
import logging
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from threading import Lock
from typing import Any

from base.cost import ASIDE, unclocked
from base.faults import FlankfilmWarning

_HEARERS: list[Callable[[str], None]] = []
"""Called with the name of what is compiled."""
_SAID: set[str] = set()
"""Packages whose log says that they compile."""


def hide_compilation(package: str = "") -> None:
    """Hide from the stopwatches what numba does under its compiler's lock, from now on; loads numba.

    Where nobody listens, see `heard_compiling`, the log of a package that names itself here says when it compiles.

    Under that lock the collector of garbage rests: looking at all that the compiler holds, again and again, would
    take a fifth of its time.

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
    if package:
        _SAID.add(package)
    _listen()


@cache
def _listen() -> None:
    """Hear of the compiler's lock and of what is compiled."""
    with unclocked():
        from numba.core import event

    class Listener(event.Listener):  # type: ignore[misc,unused-ignore]
        """Opens an unclocked stretch when the lock is taken, closes it when the lock is let go."""

        def __init__(self) -> None:
            self.depth, self.collecting, self.one_at_a_time = 0, False, Lock()

        def on_start(self, _event: Any) -> None:
            ASIDE.open()
            with self.one_at_a_time:
                if self.depth == 0:
                    self.collecting = gc.isenabled()
                    gc.disable()
                self.depth += 1

        def on_end(self, _event: Any) -> None:
            with self.one_at_a_time:
                self.depth -= 1
                if self.depth == 0 and self.collecting:
                    gc.enable()
            ASIDE.close()

    class Herald(event.Listener):  # type: ignore[misc,unused-ignore]
        """Says that a function is compiled, which takes seconds, rather than loaded."""

        def on_start(self, about: Any) -> None:
            compiling(str(about.data["dispatcher"].py_func.__module__))

        def on_end(self, _event: Any) -> None:
            pass

    _go_on_without_a_place()
    event.register("numba:compiler_lock", Listener())
    event.register("numba:compile", Herald())


def _go_on_without_a_place() -> None:
    """Let numba go on where what it compiled cannot be kept, such as on a full disk; it would end the run."""
    from numba.core.caching import FunctionCache

    save = FunctionCache.save_overload

    def save_or_warn(self: Any, signature: Any, data: Any) -> None:
        try:
            save(self, signature, data)
        except OSError as fault:
            _warn_of_loss(fault.strerror or str(fault))

    FunctionCache.save_overload = save_or_warn


@cache
def _warn_of_loss(why: str) -> None:
    """Warn once in a process."""
    warnings.warn(
        f"compiled code is not kept ({why}); the next run compiles it again", FlankfilmWarning, stacklevel=2
    )


def compiling(what: str) -> None:
    """Say to those who listen that something is compiled, rather than loaded.

    Examples
    --------
    >>> with heard_compiling(print):
    ...     compiling("kernels of the motion")
    kernels of the motion
    """
    for hearer in tuple(_HEARERS):
        hearer(what)
    package = what.partition(".")[0]
    if not _HEARERS and package in _SAID:
        _say(package)


@cache
def _say(package: str) -> None:
    """Say once in a process that a package compiles."""
    logging.getLogger(package).warning(
        "%s: compiling, which takes seconds, once: later processes load what is kept "
        "(`flankfilm warm-up` compiles all beforehand)",
        package,
    )


@contextmanager
def heard_compiling(hearer: Callable[[str], None]) -> Iterator[None]:
    """Call `hearer` whenever a function is compiled inside; what was kept by an earlier process is only loaded.

    Parameters
    ----------
    hearer : callable
        Takes the name of the module of the function, or of what is compiled at once.

    Examples
    --------
    >>> hide_compilation()
    >>> from numba import njit
    >>> heard = []
    >>> with heard_compiling(lambda what: heard.append("compiling")):
    ...     two = njit(lambda x: x + 1.0)(1.0)
    >>> heard
    ['compiling']
    """
    _HEARERS.append(hearer)
    try:
        yield
    finally:
        _HEARERS.remove(hearer)
