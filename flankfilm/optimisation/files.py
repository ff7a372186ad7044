"""An optimum as a table, a scene that can be run, and a figure."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.optimisation.run import Optimum
from flankfilm.output.files import provenance, write_csv, write_netcdf, write_text
from flankfilm.scene.toml import toml_lines
from flankfilm.studies.files import of_rows

if TYPE_CHECKING:
    import xarray as xr


def summary(found: Optimum) -> list[str]:
    """Lines for the terminal."""
    task = found.task
    lines = [
        f"{len(found.evaluations)} points, {found.computed} of them computed in {found.seconds:.1f} s, at tolerances "
        f"{task.tolerances[0]:g} and then {task.tolerances[1]:g}"
    ]
    if (both := phases(found)) is not None:
        coarse, fine, saved = both
        lines.append(
            f"a point took {coarse:.3g} s at the first tolerance and {fine:.3g} s at the second: {100 * saved:.0f} % "
            "less in all than with every point at the second"
        )
    if len(found.best) > 1:
        lines.append(f"{len(found.best)} points on the front, from the least {task.objectives[0]}:")
    for place in found.best[:10]:
        point = found.evaluations[place]
        keys = ", ".join(f"{k} = {v:.6g}" for k, v in zip(task.keys, point.values, strict=True))
        outputs = ", ".join(f"{n} = {v:.5g}" for n, v in zip(task.outputs, point.result.values, strict=True))
        lines.append(f"{keys}: {outputs}")
    if len(found.best) > 10:
        lines.append(f"{len(found.best) - 10} more in optimum.csv")
    return lines


def phases(found: Optimum) -> tuple[float, float, float] | None:
    """Mean cost of a point in either phase [s], and the part that the first one saved; None without both.

    Points that failed are left out: what ends early says nothing of tolerances.
    """
    done = [(e.tolerance, e.result.seconds) for e in found.evaluations if not e.result.fault]
    coarse, fine = (np.array([s for t, s in done if t == phase]) for phase in found.task.tolerances)
    if not coarse.size or not fine.size:
        return None
    whole = fine.mean() * (coarse.size + fine.size)
    return float(coarse.mean()), float(fine.mean()), float(1.0 - (coarse.sum() + fine.sum()) / whole)


def dataset(found: Optimum) -> xr.Dataset:
    """Give every point of an optimisation along ``point``: keys as coordinates, outputs, and which are best."""
    task, points = found.task, found.evaluations
    best = np.isin(np.arange(len(points)), found.best).astype(np.int8)
    fine = np.array([point.tolerance == task.tolerances[1] for point in points], dtype=np.int8)
    scene = json.dumps(task.raw_scene(points[found.best[0]].values, task.tolerances[1]))
    attributes = {
        "title": task.asked.title,
        "objectives_json": json.dumps(task.objectives),
        **provenance(scene),
    }
    values, results = [point.values for point in points], [point.result for point in points]
    return (
        of_rows("point", task.keys, values, task.outputs, results)
        .assign(
            best=("point", best, {"units": "1", "long_name": "1 for the optimum, or for the front"}),
            fine=("point", fine, {"units": "1", "long_name": "1 at the scene's own tolerance"}),
        )
        .assign_attrs(attributes)
    )


def write_optimum(found: Optimum, folder: Path) -> list[Path]:
    """Write all points, the front, the first one's scene, the figure, and a page with all; return the files."""
    from flankfilm.figures import optimum
    from flankfilm.figures.style import save
    from flankfilm.report.other_pages import write_optimum_page

    task = found.task
    chosen = [found.evaluations[place] for place in found.best]
    table, scene, points, picture = (folder / f"optimum.{suffix}" for suffix in ("csv", "toml", "nc", "svg"))
    rows = zip(*((*point.values, *point.result.values) for point in chosen), strict=True)
    write_csv(table, dict(zip((*task.keys, *task.outputs), rows, strict=True)))
    raw = task.raw_scene(chosen[0].values, task.tolerances[1])
    write_text(scene, "\n".join(toml_lines(raw)) + "\n")
    held = dataset(found)
    write_netcdf(points, held)
    save(optimum(held), picture)
    return [table, scene, points, picture, write_optimum_page(found, held, folder)]
