"""Progress on standard error: a bar on a terminal, one line a stage in a log."""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import count
from typing import TextIO

from base import heard_compiling

Progress = Callable[[str, int, int], None]
"""Called with what is being done, steps done, and steps in all."""

COMPILING = "compiling{}, once: later runs load what is kept"
"""Said when code is compiled for the first time on a machine, which takes up to half a minute."""

COMPILED = {
    "dynamics.kernels.stepwise": "motions in steps",
    "dynamics.kernels.drives": "motions of drive trains",
    "dynamics.kernels.correcting": "branches of orbits",
    "dynamics.kernels": "motions with backlash",
    "ehl.kernels.shear_kernels": "films with heat",
    "ehl": "films",
}
"""What compiled functions are for, by the beginning of their module's name; the first that fits."""

PATIENCE = 5.0
"""Seconds before the rows of a stage are shown, and between two showings."""

TENTHS = 10
"""Lines that a log has of rows at least."""

PAUSE = 5.0
"""Time without a line after which the next row has one, and from which on the time left is said [s]."""


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


def rows_of(
    progress: Progress, title: str, clock: Callable[[], float] = time.perf_counter
) -> Callable[[str, int, int], None]:
    """Function of what is counted, how many are done and of how many: from 5 s on, every 5 s, with the time left.

    Examples
    --------
    >>> seconds = iter([0.0, 2.0, 10.0, 11.0, 20.0])
    >>> rows = rows_of(print, "sweep", lambda: next(seconds))
    >>> for done in range(1, 5):
    ...     rows("speeds", done, 8)
    sweep: 2 of 8 speeds, 30 s left 2 8
    sweep: 4 of 8 speeds, 20 s left 4 8
    """
    began = before = clock()
    said, counted = -math.inf, ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal began, before, said, counted
        now = clock()
        if what != counted:  # since what was counted before
            began, said, counted = before, -math.inf, what
        before = now
        if now - max(began, said) < PATIENCE:
            return
        said, remaining = now, (now - began) / max(done, 1) * (total - done)
        progress(f"{title}: {done} of {total} {what}, {remaining:.0f} s left", done, total)

    return show


def compiling_line(module: str) -> str:
    """What is said when a function of a module is compiled.

    Examples
    --------
    >>> compiling_line("ehl.kernels.film_kernels")
    'compiling for films, once: later runs load what is kept'
    """
    kinds = [kind for start, kind in COMPILED.items() if module.startswith(start)]
    return COMPILING.format(f" for {kinds[0]}" if kinds else "")


@contextmanager
def console_progress() -> Iterator[Progress]:
    """Show a bar with the time left on a terminal, and a line for each stage elsewhere."""
    with _bar("{task.description}") as advance:
        shown = advance or lines(sys.stderr)
        said: list[str] = []

        def compiling(module: str) -> None:
            line = compiling_line(module)
            if line not in said:
                said.append(line)
                shown(line, 0, 1)

        with heard_compiling(compiling):
            yield shown


@contextmanager
def console_rows() -> Iterator[Callable[[int, int], None]]:
    """Show rows done, rows per second and the time left on a terminal, and lines with rows and time left elsewhere."""
    with _bar("rows", rate=True) as advance:
        if advance is None:
            yield row_lines(lines(sys.stderr))
        else:
            yield lambda done, total: advance("rows", done, total)


def row_lines(log: Progress, clock: Callable[[], float] = time.perf_counter) -> Callable[[int, int], None]:
    """Progress of rows in a log: a line for each tenth of them, and for a row after `PAUSE` without one.

    Parameters
    ----------
    log : callable
        Writes a line.
    clock : callable
        Time in seconds.

    Examples
    --------
    >>> show = row_lines(lambda what, done, total: print(what), clock=iter([0.0, 4.0, 9.0]).__next__)
    >>> for done in (1, 2, 3):  # the first was there
    ...     show(done, 5)
    1 of 5 rows
    2 of 5 rows
    3 of 5 rows, about 9 s left
    """
    began: list[tuple[float, int]] = []
    said: list[float] = []

    def show(done: int, total: int) -> None:
        now = clock()
        if not began:
            began.append((now, done))
        start, there = began[0]
        tenths = [TENTHS * count // max(total, 1) for count in (done - 1, done)]
        if said and tenths[0] == tenths[1] and now - said[-1] < PAUSE and done < total:
            return
        said.append(now)
        text = f"{done} of {total} rows"
        if now - start >= PAUSE and there < done < total:
            text += f", about {duration((now - start) / (done - there) * (total - done))} left"
        log(text, done, total)

    return show


def duration(seconds: float) -> str:
    """Time for a reader.

    Examples
    --------
    >>> duration(14.2), duration(150.0), duration(9000.0)
    ('15 s', '3 min', '2.5 h')
    """
    if seconds < 100.0:
        return f"{math.ceil(seconds)} s"
    return f"{math.ceil(seconds / 60.0)} min" if seconds < 6000.0 else f"{seconds / 3600.0:.1f} h"


def lines(log: TextIO) -> Progress:
    """Progress that writes a line, with the seconds since now, whenever something else is being done.

    Examples
    --------
    >>> progress = lines(sys.stdout)
    >>> for what in ("geometry", "closed forms", "closed forms"):
    ...     progress(what, 0, 2)
       0.0 s  geometry
       0.0 s  closed forms
    """
    start, before = time.perf_counter(), [""]

    def show(what: str, done: int, total: int) -> None:
        if what != before[0]:
            before[0] = what
            print(f"{time.perf_counter() - start:6.1f} s  {what}", file=log, flush=True)

    return show


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
    bar = progress.Progress(
        *columns,
        console=Console(stderr=True),
        transient=True,
        redirect_stdout=sys.stdout.isatty(),  # else what is printed meanwhile would go to the terminal too
    )
    with bar:
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
