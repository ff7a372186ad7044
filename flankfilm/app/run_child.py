"""Process that computes for the page: progress as messages, all else as the command line prints it."""

from __future__ import annotations

import sys
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from flankfilm.app.messages import Message, own_output, send
from flankfilm.processes.exit_status import guarded, open_streams
from flankfilm.processes.progress import compiling_line

if TYPE_CHECKING:
    from flankfilm.outcome.outcome import Outcome

__all__ = ["main"]

Say = Callable[[Message], None]

COUNTED = "rows"
"""What rows of a study are called in the messages."""


def main() -> None:
    """Compute a scene that standard input holds, or a study or an optimisation of a file, into a folder.

    Arguments: "run", the root of all files, the scene's folder, and the folder of results; or "study" or "optimise",
    the root, the folder of the file, the folder of rows, the file, and "resume" where rows that are there are kept.
    """
    open_streams()
    say = partial(send, own_output())
    kind, (root, folder, out) = sys.argv[1], map(Path, sys.argv[2:5])
    text = sys.stdin.read()
    if kind == "run":
        sys.exit(guarded(lambda: _run(text, root, folder, out, say)))
    file, resume = Path(sys.argv[5]), sys.argv[6:] == ["resume"]
    sys.exit(guarded(lambda: _rows(kind, root, folder, out, file, resume, say)))


def _run(text: str, root: Path, folder: Path, out: Path, say: Say) -> int:
    """Run a scene; its exit status."""
    from base import FlankfilmError, InputError, heard_compiling
    from flankfilm.app.checking import Place, checked
    from flankfilm.app.document import Document
    from flankfilm.files.cache import keep_compiled_code

    keep_compiled_code()
    judged = checked(Document.read(text), Place(root, folder))
    if judged.scene is None:
        raise InputError(judged.faults)
    from flankfilm.app.time_left import foreseen
    from flankfilm.runs.run_scene import run_outcome

    def progress(what: str, done: int, total: int) -> None:
        say({"what": what, "done": done, "total": total})

    with suppress(FlankfilmError):  # which the run says
        say({"foreseen": foreseen(judged.scene)})
    with heard_compiling(lambda module: progress(compiling_line(module), 0, 1)):
        outcome = run_outcome(judged.scene, out, progress=progress)
    return _shown(outcome)


def _rows(kind: str, root: Path, folder: Path, out: Path, file: Path, resume: bool, say: Say) -> int:
    """Compute the rows of a study or of an optimisation; the exit status."""
    from flankfilm.app.checking import Place
    from flankfilm.app.studies import heads, refuse_outside
    from flankfilm.files.cache import keep_compiled_code
    from flankfilm.studies.execution import Execution

    keep_compiled_code()
    refuse_outside(file, Place(root, folder))
    there: list[int] = []

    def progress(done: int, total: int) -> None:
        there.append(done)
        say({"what": f"{COUNTED}: {done} of {total}", "done": done, "total": total, "there": there[0]})

    say({"foreseen": {COUNTED: None}})
    say({"what": COUNTED, "done": 0, "total": 1})
    how = Execution(resume=resume)
    if kind == "study":
        from flankfilm.studies.files import study_outcome
        from flankfilm.studies.plan import read_plan

        plan = read_plan(file)
        say({"heads": heads(plan.keys, plan.outputs)})
        return _shown(study_outcome(plan, out, how, progress))
    from flankfilm.optimisation.files import optimum_outcome
    from flankfilm.optimisation.task import read_task

    task = read_task(file)
    say({"heads": heads(("tolerance", *task.keys), task.outputs)})
    return _shown(optimum_outcome(task, out, how, progress))


def _shown(outcome: Outcome[Any]) -> int:
    """Print what an outcome says; its exit status."""
    from base import printable

    for line in (*outcome.lines, *outcome.faults):
        print(printable(str(line)))
    return outcome.status


if __name__ == "__main__":
    main()
