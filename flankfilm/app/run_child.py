"""Process that runs a scene for the page: progress as messages, all else as the command line prints it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path

from flankfilm.app.messages import own_output, send
from flankfilm.processes.exit_status import guarded, open_streams
from flankfilm.processes.progress import Progress, compiling_line

__all__ = ["main"]


def main() -> None:
    """Run the scene that standard input holds into a folder; arguments: root, the scene's folder, folder of results."""
    open_streams()
    output = own_output()
    root, folder, out = map(Path, sys.argv[1:4])
    text = sys.stdin.read()

    def progress(what: str, done: int, total: int) -> None:
        send(output, {"what": what, "done": done, "total": total})

    def foresee(seconds: Mapping[str, float | None]) -> None:
        send(output, {"foreseen": seconds})

    sys.exit(guarded(lambda: _run(text, root, folder, out, progress, foresee)))


def _run(
    text: str,
    root: Path,
    folder: Path,
    out: Path,
    progress: Progress,
    foresee: Callable[[Mapping[str, float | None]], None],
) -> int:
    """Run a scene; its exit status."""
    from base import FlankfilmError, InputError, heard_compiling, printable
    from flankfilm.app.checking import Place, checked
    from flankfilm.app.document import Document
    from flankfilm.files.cache import keep_compiled_code

    keep_compiled_code()
    judged = checked(Document.read(text), Place(root, folder))
    if judged.scene is None:
        raise InputError(judged.faults)
    from flankfilm.app.time_left import foreseen
    from flankfilm.runs.run_scene import run_outcome

    with suppress(FlankfilmError):  # which the run says
        foresee(foreseen(judged.scene))
    with heard_compiling(lambda module: progress(compiling_line(module), 0, 1)):
        outcome = run_outcome(judged.scene, out, progress=progress)
    for line in (*outcome.lines, *outcome.faults):
        print(printable(str(line)))
    return outcome.status


if __name__ == "__main__":
    main()
