"""Process that answers for the loaded contact of the newest scene: an older one is dropped as soon as a newer comes.

It is started by `flankfilm.app.live`, keeps the gears that it has solved, and ends with its parent.
"""

from __future__ import annotations

import signal
import sys
import threading
import time
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.app.messages import Message, heard, own_output, send
from flankfilm.files.cache import Cache, keep_compiled_code, results_cache

if TYPE_CHECKING:
    from flankfilm.app.contact import KnownGears

__all__ = ["Newest", "answer"]


class Newest:
    """The newest request; those before it are lost."""

    def __init__(self) -> None:
        self._request: Message | None = None
        self._ended = False
        self._changed = threading.Condition()

    def put(self, request: Message | None) -> None:
        """Note a request; None where there will be no more."""
        with self._changed:
            self._request, self._ended = request, request is None
            self._changed.notify()

    def take(self) -> Message | None:
        """Wait for a request and take it; None where there will be no more."""
        with self._changed:
            while self._request is None and not self._ended:
                self._changed.wait()
            request, self._request = self._request, None
            return request

    @property
    def waits(self) -> bool:
        """Whether there is a newer request."""
        with self._changed:
            return self._request is not None


def answer(
    request: Message, tell: Callable[[Message], None], newer: Callable[[], bool], known: KnownGears
) -> None:
    """Answer for one scene, step by step; leave off where there is a newer one.

    Parameters
    ----------
    request : mapping
        Its ``number``, the ``text`` of the scene, ``root`` and ``folder`` of its place.
    tell : callable
        Takes messages of a ``kind``: "curves", "figures", "roots" or "fault".
    newer : callable
        Whether there is a newer request.
    known : KnownGears
        Gears that were solved before; changed.
    """
    from base import InputError, SolverError
    from flankfilm.app.checking import Place, checked
    from flankfilm.app.contact import answerable, curves, figures_of, has_roots, roots, solve_gears, solved
    from flankfilm.app.document import Document
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.mesh import PAIR, along_the_face

    began = time.perf_counter()

    def say(kind: str, **content: Any) -> None:
        seconds = time.perf_counter() - began
        tell({"number": request["number"], "kind": kind, "seconds": seconds, **content})

    judged = checked(Document(request["text"]), Place(Path(request["root"]), Path(request["folder"])))
    if judged.scene is None:
        return say("fault", text="")  # they stand beside the keys
    if why := answerable(judged.scene):
        return say("fault", text=why)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the check, and a run's report, say them
            # gears along the face take a minute: they are worth a place on the disk
            engine = Engine(judged.scene, results_cache() if along_the_face(judged.scene) else Cache(None))
            solve_gears(engine)
            if newer():
                return None
            cycle, face_width = solved(engine, known), engine[PAIR].face_width
            drawn = [vars(curve) for curve in curves(cycle, face_width)]
            say("curves", position=cycle.position.tolist(), curves=drawn, roots=has_roots(engine))
            if newer():
                return None
            figures = figures_of(cycle, face_width, judged.scene.tolerance)
            say("figures", figures=[vars(figure) for figure in figures])
            if newer() or not has_roots(engine):
                return None
            curve, maxima = roots(engine, cycle)
            say("roots", curve=vars(curve), figures=[vars(figure) for figure in maxima])
    except InputError as error:
        say("fault", text="; ".join(map(str, error.faults)))
    except SolverError as error:
        say("fault", text=str(error))
    except MemoryError:
        say("fault", text="out of memory: give fewer teeth or cells of the face")
    return None


def main() -> None:
    """Answer until there are no more requests."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the page's process answers it
    output, newest = own_output(), Newest()
    keep_compiled_code()

    def read() -> None:
        for request in heard(sys.stdin):
            if not isinstance(request, str):
                newest.put(request)
        newest.put(None)

    threading.Thread(target=read, daemon=True).start()
    known: KnownGears | None = None  # what it is of takes a second to load: a request is acknowledged before
    while (request := newest.take()) is not None:
        send(output, {"number": request["number"], "kind": "begun", "seconds": 0.0})
        if known is None:
            from flankfilm.app.contact import KnownGears

            known = KnownGears()
        answer(request, lambda message: send(output, message), lambda: newest.waits, known)


if __name__ == "__main__":
    main()
