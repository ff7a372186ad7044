"""How often a process looks for objects that refer to each other and that nothing else refers to.

Loading libraries and reading scenes makes hundreds of thousands of objects that all stay. Python looks at the youngest
of them after each 700 new ones, which takes a tenth of a command's start and of a short run, and finds next to
nothing: arrays go as soon as nothing refers to them, without a look. A check of a scene ends before the first look.

Before a process ends, Python looks at all objects again, modules and their functions included, which takes half a
second after a run with pictures. The system takes their memory back anyway.
"""

from __future__ import annotations

import atexit
import gc

__all__ = ["RARELY", "collect_rarely"]

RARELY = (200_000, 2, 2)
"""New objects after which the youngest are looked at, and how many such looks come before one at the older ones, and
how many of these before one at all."""


def collect_rarely() -> None:
    """Look as seldom as `RARELY` says, from now on, and not at what is there when the process ends.

    Examples
    --------
    >>> import gc
    >>> before = gc.get_threshold()
    >>> collect_rarely()
    >>> gc.get_threshold()[0]
    200000
    >>> gc.set_threshold(*before)
    """
    gc.set_threshold(*RARELY)
    atexit.register(gc.freeze)
