"""A finished study as one dataset with units, and as a figure."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base.units import FACTORS, suffix
from flankfilm.dataset import Quantity, provenance, to_dataset, write_netcdf
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.run import StudyResults

if TYPE_CHECKING:
    import xarray as xr


def dataset(found: StudyResults) -> xr.Dataset:
    """Give a study as a dataset along ``row``: varied keys as coordinates, outputs, cost and faults."""
    plan = found.plan
    columns = {key: np.asarray([row[i] for row in plan.rows]) for i, key in enumerate(plan.keys)}
    quantities = {
        key: Quantity(("row",), values, unit_of(key), f"key {key} of the scene")
        for key, values in columns.items()
    }
    for i, name in enumerate(plan.outputs):
        output = OUTPUTS[name]
        values = np.array([row.values[i] for row in found.rows])
        quantities[name] = Quantity(("row",), values, output.unit, output.meaning)
    seconds = np.array([row.seconds for row in found.rows])
    quantities["seconds"] = Quantity(("row",), seconds, "s", "cost of the row")
    faults = np.asarray([row.fault for row in found.rows], dtype=object)
    quantities["fault"] = Quantity(("row",), faults, "1", "why a row failed; empty where it did not")
    attributes = {"title": plan.title, "design": plan.design, **provenance(json.dumps(plan.scene))}
    return to_dataset(quantities, attributes).set_coords(list(plan.keys))


def unit_of(key: str) -> str:
    """Unit that a scene's key ends in, "1" where it carries none."""
    endings = ((suffix(unit), unit) for unit in sorted(FACTORS, key=len, reverse=True))
    last = key.rpartition(".")[2]
    return next((unit for ending, unit in endings if ending and last.endswith(f"_{ending}")), "1")


def write_study(found: StudyResults, folder: Path) -> list[Path]:
    """Write ``study.nc``, ``study.svg`` where numbers vary, and a page with all; return the files."""
    from flankfilm.figures import study
    from flankfilm.figures.studies import varied_numbers
    from flankfilm.figures.style import save
    from flankfilm.report.other_pages import write_study_page

    files = [folder / "study.nc"]
    content = dataset(found)
    write_netcdf(files[0], content)
    keys = found.plan.keys[: found.plan.varied]
    if varied_numbers(content, keys):
        files.append(folder / "study.svg")
        save(study(content, keys, found.plan.outputs), files[-1])
    return [*files, write_study_page(found, content, folder)]


def summary(found: StudyResults) -> list[str]:
    """Lines for the terminal: rows, rate, and the first faults."""
    rate = f", {found.computed / found.seconds:.2g} rows/s" if found.computed else ""
    lines = [f"{len(found.rows)} rows, {found.computed} of them computed in {found.seconds:.1f} s{rate}"]
    lines += [f"row {row.index} failed: {row.fault}" for row in found.failures[:5]]
    if len(found.failures) > 5:
        lines.append(f"{len(found.failures)} rows failed in all; the column fault of rows.csv says why")
    return lines
