"""Runs one peer's work in the peer's environment, with nothing of ours: ``python main.py PEER PARENT``.

The file PEER.py beside this one imports the program and holds

- ``PEER``, ``VERSION`` and ``NOTE``: the program, its version, and what must be known about its times,
- ``settings(given)``, which yields for each setting its name, the first call (which gives the values), the call that
  is timed, and how many times the timed call the work is.

The work is read as JSON from standard input; what was found is printed as JSON.
"""

import ctypes
import json
import os
import signal
import sys
import time
from collections.abc import Callable
from importlib import import_module
from typing import Any


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """Result of a call and its processor time [s]."""
    began = time.process_time()
    result = call()
    return result, time.process_time() - began


def end_with(parent: int) -> None:
    """End this process when its parent has died, which is what the 1 stands for; on Linux alone."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)
        if os.getppid() != parent:
            sys.exit("its parent has ended")


def main(name: str) -> None:
    """Read the work as JSON, print what was found as JSON."""
    inputs = json.load(sys.stdin)
    try:
        peer = import_module(name)
    except ImportError as error:
        print(json.dumps({"missing": str(error)}))
        return
    runs = []
    for level, first_call, call, times in peer.settings(inputs):
        values, first = timed(first_call)
        seconds = times * min(timed(call)[1] for _ in range(inputs["repeat"]))
        runs.append({"level": level, "seconds": seconds, "first": first, "values": values})
    print(json.dumps({"peer": peer.PEER, "version": peer.VERSION, "runs": runs, "note": peer.NOTE}))


if __name__ == "__main__":
    end_with(int(sys.argv[2]))
    main(sys.argv[1])
