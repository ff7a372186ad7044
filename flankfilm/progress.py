"""Progress on standard error, when that is a terminal."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count

Progress = Callable[[str, int, int], None]
"""Called with what is being done, steps done, and steps in all."""


def silent(what: str, done: int, total: int) -> None:
    """Show nothing."""


def in_steps(progress: Progress, total: int) -> Callable[[str], None]:
    """Function that announces one step after the other; their number is raised where there are more than `total`.

    Examples
    --------
    >>> announce = in_steps(print, 2)
    >>> for what in ("mesh", "cycle", "film"):
    ...     announce(what)
    mesh 0 2
    cycle 1 2
    film 2 3
    """
    done = count()

    def announce(what: str) -> None:
        place = next(done)
        progress(what, place, max(place + 1, total))

    return announce


@contextmanager
def console_progress() -> Iterator[Progress]:
    """Show a bar with the time left on a terminal; show nothing elsewhere."""
    with _bar("{task.description}") as advance:
        yield (lambda what, done, total: advance(what, done, total)) if advance else silent


@contextmanager
def console_rows() -> Iterator[Callable[[int, int], None]]:
    """Show rows done, rows per second and the time left on a terminal; show nothing elsewhere."""
    with _bar("rows", rate=True) as advance:
        yield lambda done, total: advance("rows", done, total) if advance else None


@contextmanager
def _bar(text: str, rate: bool = False) -> Iterator[Progress | None]:
    """Bar with what is being done, steps done, perhaps their rate, and the time left; None off the terminal."""
    if not sys.stderr.isatty():
        yield None
        return
    from rich import progress
    from rich.console import Console

    columns = [progress.TextColumn(text), progress.BarColumn(), progress.MofNCompleteColumn()]
    if rate:
        columns.append(progress.TextColumn("{task.fields[rate]}"))
    columns.append(progress.TimeRemainingColumn())
    with progress.Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting", total=None, rate="")

        def show(what: str, done: int, total: int) -> None:
            speed = bar.tasks[0].speed
            bar.update(
                task,
                description=what,
                completed=done,
                total=total,
                rate=f"{speed:.2g} rows/s" if speed else "",
            )

        yield show
