"""Page of an optimisation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from flankfilm import figures
from flankfilm.figures.optima import can_be_mapped
from flankfilm.figures.reading import key_words, unit_of, words
from flankfilm.optimisation.words import gained, tied
from flankfilm.report.page import Fact, Head, Headline, Part, picture, said, write_page
from flankfilm.report.run_parts import inputs_of, work_of
from flankfilm.report.text import counted, number, percent, plus_minus
from flankfilm.studies.outputs import ERROR_OF, OUTPUTS, exact
from flankfilm.studies.page import MOST_ROWS, cell, error_noted, rows_table

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.optimisation.task import Task


def write_optimum_page(optimum: Optimum, data: xr.Dataset, folder: Path) -> Path:
    """Write ``report.html`` of an optimisation and return its path.

    Parameters
    ----------
    optimum : Optimum
    data : xarray.Dataset
        What ``optimum.nc`` holds.
    folder : Path
    """
    task, points = optimum.task, optimum.evaluations
    chosen = [points[place] for place in optimum.best]
    single = len(task.objectives) == 1
    coarse, fine = (percent(tolerance) for tolerance in task.tolerances)
    settled = "converged" if optimum.converged else "not converged"
    facts = [
        Fact(counted(optimum.points, "point"), "points"),
        work_of(data),
        Fact("one optimum" if single else f"{counted(len(chosen), 'point')} on the front", "best"),
        Fact(settled, "claims"),
    ]
    drawn = [picture(figures.optimum, data, said("optimum_of_one" if single else "optimum_of_several"))]
    if can_be_mapped(data):
        drawn.insert(0, picture(figures.optimum_map, data, said("optimum_map")))
    note = said("two_tolerances", coarse=coarse, fine=fine)
    table = rows_table(
        data, task.keys, task.outputs, [(point.values, point.result) for point in chosen[:MOST_ROWS]]
    )
    parts = [
        Part(
            "claims",
            "What was found",
            (_in_words(optimum.message),),
            notes=(*gained(optimum), tied(optimum)),
            unfolded=True,
        ),
        Part("points", "Points", figures=tuple(drawn)),
        Part("best", "Optimum" if single else "Front", tables=(table,), notes=(note,), unfolded=True),
        inputs_of(data),
    ]
    return write_page(
        folder, Head(task.asked.title or "Optimisation", facts, _best_cards(optimum, data)), parts
    )


def _in_words(message: str) -> str:
    return f"{message[:1].upper()}{message[1:]}."


def _bounds(task: Task, name: str) -> str:
    limit = task.asked.limits[name]
    ends = (("at least", limit.at_least), ("at most", limit.at_most))
    return ", ".join(f"{which} {number(bound)}" for which, bound in ends if bound is not None)


def _best_cards(optimum: Optimum, data: xr.Dataset) -> list[Headline]:
    """Outputs of the best point with their errors and the gain on the start; its keys where it is the only one."""
    task, first = optimum.task, optimum.evaluations[optimum.best[0]]
    gains = {gain.objective: gain for gain in optimum.gains}
    cards = []
    for name, value in zip(task.outputs, first.result.values, strict=True):
        if name in ERROR_OF.values():
            continue
        note = []
        if name in task.objectives:
            own = plus_minus(optimum.error_of(name, first.result)) if name in ERROR_OF else ""
            note.append(own or ("exact" if exact(name) else error_noted(OUTPUTS[name].no_error)))
        else:
            note.append(f"limit: {_bounds(task, name)}")
        if (gain := gains.get(name)) is not None and len(optimum.best) == 1:
            start = f"{number(gain.start, 5)} {unit_of(data, name, '')}".strip()
            note.append(f"{start} for the scene as given")
        if len(optimum.best) > 1:
            note.append("at the best first objective")
        cards.append(Headline(words(data, name), number(value, 5), ", ".join(note), unit_of(data, name, "")))
    if len(optimum.best) > 1:
        return cards
    ties = optimum.tied_ranges()
    for key, value in zip(task.keys, first.values, strict=True):
        name, unit = key_words(key)
        low, high = ties.get(key, (value, value))
        wide = f"tied designs: {cell(low)} to {cell(high)}" if low != high else "at the optimum"
        cards.append(Headline(name, cell(value), wide, "" if unit == "-" else unit))
    return cards
