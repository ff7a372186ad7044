"""An optimum as a dataset, as files, a page and lines."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flankfilm import figures
from flankfilm.figures.optima import can_be_mapped
from flankfilm.optimisation.optimum import Optimum
from flankfilm.optimisation.page import write_optimum_page
from flankfilm.optimisation.run import searched, work_of_task
from flankfilm.optimisation.task import Task
from flankfilm.optimisation.words import claims
from flankfilm.outcome.outcome import Outcome, Picture, concluded
from flankfilm.output.files import provenance, write_csv, write_text
from flankfilm.scene.toml import toml_lines
from flankfilm.studies.columns import write_columns
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.files import listed, of_rows
from flankfilm.studies.kept import kept_rows
from flankfilm.studies.table import ROWS

if TYPE_CHECKING:
    import xarray as xr


def phases(optimum: Optimum) -> tuple[float, float, float] | None:
    """Mean cost of a point in either phase [s], and the part that the first one saved; None without both.

    Points that failed are left out: what ends early says nothing of tolerances.
    """
    done = [(e.tolerance, e.result.seconds) for e in optimum.evaluations if not e.result.fault]
    coarse, fine = (np.array([s for t, s in done if t == phase]) for phase in optimum.task.tolerances)
    if not coarse.size or not fine.size:
        return None
    whole = fine.mean() * (coarse.size + fine.size)
    return float(coarse.mean()), float(fine.mean()), float(1.0 - (coarse.sum() + fine.sum()) / whole)


FLAG = "exact for the outputs as computed: by them and their errors"
"""Why what is claimed of a point has no error."""


def dataset(optimum: Optimum) -> xr.Dataset:
    """Give every point of an optimisation along ``point``: keys as coordinates, outputs, and what may be claimed.

    The scene as it stands is held as ``start_`` with the names of keys and outputs.
    """
    task, points = optimum.task, optimum.evaluations
    fine = [point.tolerance == task.tolerances[1] for point in points]
    places = np.arange(len(points))
    scene = json.dumps(task.raw_scene(points[optimum.best[0]].values, task.tolerances[1]))
    attributes = {
        "title": task.asked.title,
        "objectives_json": json.dumps(task.objectives),
        "signs_json": json.dumps(task.signs),
        "limits_json": json.dumps(task.limits),
        "vary_json": json.dumps({key: [span.from_, span.to] for key, span in task.asked.vary.items()}),
        "converged": int(optimum.converged),
        "message": optimum.message,
        **provenance(scene),
    }
    values, results = [point.values for point in points], [point.result for point in points]
    data = of_rows("point", task.keys, values, task.outputs, results)
    flags = {
        "best": (np.isin(places, optimum.best), "1 for the optimum, or for the front"),
        "fine": (fine, "1 at the scene's own tolerance"),
        "allowed": (optimum.allowed, "1 where the limits are kept"),
        "tied": (
            np.isin(places, optimum.tied),
            "1 where no objective differs from the best by more than its error",
        ),
    }
    return (
        data.assign(
            {
                name: (
                    "point",
                    np.asarray(flag, dtype=np.int8),
                    {"units": "1", "long_name": meaning, "error_note": FLAG},
                )
                for name, (flag, meaning) in flags.items()
            }
        )
        .assign(_start(optimum, data))
        .assign_attrs(attributes)
    )


def _start(optimum: Optimum, data: xr.Dataset) -> dict[str, tuple[tuple[()], float, dict[str, str]]]:
    """The scene as it stands: its keys, nan where it has none, and its outputs."""
    if optimum.start is None:
        return {}
    names = (*optimum.task.keys, *optimum.task.outputs)
    return {
        f"start_{name}": (
            (),
            value if isinstance(value, int | float) else float("nan"),
            {
                "units": data[name].attrs["units"],
                "long_name": f"{data[name].attrs['long_name']}: scene as it stands",
                **_error_of_start(data[name].attrs),
            },
        )
        for name, value in zip(names, (*optimum.start.values, *optimum.start.result.values), strict=True)
    }


def _error_of_start(about: dict[str, str]) -> dict[str, str]:
    """What a figure of the scene as it stands says of its error: as the points do."""
    held = about.get("error_variable")
    return {"error_variable": f"start_{held}"} if held else {"error_note": about["error_note"]}


@dataclass(frozen=True, eq=False)
class OptimumOutcome(Outcome[Optimum]):
    """All points, the front as a table, the first one's scene, the pictures, and a page with all."""

    data = "optimum.nc"

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Points along ``point``."""
        return dataset(self.result)

    @property
    def lines(self) -> list[str]:
        """Points, the best of them, what may be claimed, and the files."""
        optimum, task = self.result, self.result.task
        coarse_at, fine_at = (f"{100 * tolerance:g} %" for tolerance in task.tolerances)
        lines = [
            f"{optimum.points} of at most {task.asked.evaluations} points, {optimum.computed} of them computed in "
            f"{optimum.seconds:.1f} s, at tolerances of {coarse_at} and then {fine_at}"
        ]
        if (phase_costs := phases(optimum)) is not None:
            coarse, fine, saved = phase_costs
            less = f"{100 * abs(saved):.0f} % {'less' if saved >= 0 else 'more'} in all"
            lines.append(
                f"a point took {coarse:.3g} s at the first tolerance and {fine:.3g} s at the second: "
                f"{less} than with every point at the second"
            )
        if len(optimum.best) > 1:
            lines.append(f"{len(optimum.best)} points on the front, from the minimum {task.objectives[0]}:")
        for place in optimum.best[:10]:
            point = optimum.evaluations[place]
            keys = ", ".join(f"{k} = {v:.6g}" for k, v in zip(task.keys, point.values, strict=True))
            outputs = ", ".join(
                f"{n} = {v:.5g}" for n, v in zip(task.outputs, point.result.values, strict=True)
            )
            lines.append(f"{keys}: {outputs}")
        if len(optimum.best) > 10:
            lines.append(f"{len(optimum.best) - 10} more in optimum.csv")
        return [*lines, *claims(optimum), listed(self.files)]

    def tables(self, folder: Path) -> list[Path]:
        """Write the front, and the scene of its first point; the rows are there."""
        task, points = self.result.task, self.result.evaluations
        chosen = [points[place] for place in self.result.best]
        table, scene = (folder / f"optimum.{suffix}" for suffix in ("csv", "toml"))
        rows = zip(*((*point.values, *point.result.values) for point in chosen), strict=True)
        write_csv(table, dict(zip((*task.keys, *task.outputs), rows, strict=True)))
        raw = task.raw_scene(chosen[0].values, task.tolerances[1])
        write_text(scene, "\n".join(toml_lines(raw)) + "\n")
        return [folder / ROWS, write_columns(folder, task.keys, task.outputs), table, scene]

    @property
    def pictures(self) -> dict[str, Picture]:
        """The points, and a map of two keys."""
        drawn: dict[str, Picture] = {"optimum": figures.optimum}
        return {**drawn, "optimum_map": figures.optimum_map} if can_be_mapped(self.dataset) else drawn

    def page(self, folder: Path) -> Path:
        """Write the page."""
        return write_optimum_page(self.result, self.dataset, folder)


def optimum_outcome(
    task: Task,
    folder: Path | None,
    how: Execution = Execution(),
    progress: Progress = lambda done, total: None,
) -> OptimumOutcome:
    """Search the best points of a task, and write what is made of them; every evaluation goes into ``rows.csv``.

    The search is the same whenever it runs: taken up again, it asks for the same points, finds those that are
    there, and goes on to the same end.

    Parameters
    ----------
    task : Task
    folder : Path or None
        Made when it does not exist; None leaves nothing behind.
    how : Execution
        Where points are computed, and whether a search that was begun in the folder is taken up.
    progress : callable
        Called with evaluations done and evaluations in all.

    Raises
    ------
    InputError
        Where the folder holds something else, or evaluations of this task without ``resume``.
    SolverError
        Where no point keeps the limits.
    """
    with kept_rows(folder, work_of_task(task), how.resume) as kept:
        return concluded(OptimumOutcome(searched(task, kept, how, progress)), folder)
