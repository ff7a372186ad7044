"""gmsh within this process: loaded when it is needed, one user at a time, each with a separate model."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from typing import Any

from base import InputError, unclocked

_one_at_a_time = threading.Lock()  # gmsh keeps one state per process
_names = count()


@contextmanager
def gmsh_session() -> Iterator[Any]:
    """Give the module gmsh with an empty model, which is removed afterwards; gmsh is left as it was found."""
    gmsh = _load_gmsh()
    with _one_at_a_time:
        began = not gmsh.isInitialized()
        if began:
            # interruptible=False: gmsh otherwise sets a signal handler, which only the main thread may do
            gmsh.initialize(readConfigFiles=False, interruptible=False)
            _keep_broken_pipes_harmless()
        try:
            gmsh.option.setNumber("General.Terminal", 0)
            gmsh.option.setNumber("General.NumThreads", 1)
            name = f"gear {next(_names)}"
            gmsh.model.add(name)
            try:
                yield gmsh
            finally:
                gmsh.model.setCurrent(name)
                gmsh.model.remove()
        finally:
            if began:
                gmsh.finalize()


def _keep_broken_pipes_harmless() -> None:
    """Undo what gmsh does to SIGPIPE when it is first initialised: a write to a closed pipe would end the process.

    Python ignores the signal and raises BrokenPipeError instead. Handlers can be set in the main thread alone; a
    program that meshes in another one first keeps gmsh's choice.
    """
    if hasattr(signal, "SIGPIPE") and threading.current_thread() is threading.main_thread():
        handler = signal.getsignal(signal.SIGPIPE)
        if handler is not None:
            signal.signal(signal.SIGPIPE, handler)


def _load_gmsh() -> Any:
    """Load gmsh; where its shared libraries are missing say which, and what installs them."""
    try:
        with unclocked():
            import gmsh
    except OSError as fault:
        packages = "libgl1 libglu1-mesa libxcursor1 libxft2 libxinerama1 libgomp1"
        remedy = f"on Debian or Ubuntu: sudo apt-get install --no-install-recommends {packages}"
        raise InputError.at("gmsh", str(fault), "requires shared libraries", remedy) from fault
    return gmsh
