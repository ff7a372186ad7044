"""A finished study as one dataset with units, and as a figure."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base.units import unit_of
from flankfilm.output.files import provenance, write_netcdf
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults
from flankfilm.studies.study_file import Value

if TYPE_CHECKING:
    import xarray as xr


def dataset(study_results: StudyResults) -> xr.Dataset:
    """Give a study as a dataset along ``row``: varied keys as coordinates, outputs, cost and faults."""
    plan, rows = study_results.plan, study_results.rows
    attributes = {"title": plan.title, "design": plan.design, **provenance(json.dumps(plan.scene))}
    data = of_rows("row", plan.keys, plan.rows, plan.outputs, rows)
    about = {"units": "", "long_name": "why a row failed; empty where it did not"}
    faults = np.array([row.fault for row in rows], dtype=object)
    return data.assign(fault=("row", faults, about)).assign_attrs(attributes)


def of_rows(
    axis: str,
    keys: Sequence[str],
    points: Sequence[Sequence[Value]],
    outputs: Sequence[str],
    results: Sequence[RowResult],
) -> xr.Dataset:
    """Rows along an axis: keys as coordinates, outputs, and what each row cost.

    Parameters
    ----------
    axis : str
    keys : sequence of str
        Of the scene, which vary.
    points : sequence of sequence
        Their values, one for each row.
    outputs : sequence of str
    results : sequence of RowResult
    """
    import xarray as xr

    varied = {
        key: (axis, np.asarray(values), {"units": unit_of(key), "long_name": f"key {key} of the scene"})
        for key, values in zip(keys, zip(*points, strict=True), strict=True)
    }
    columns = zip(*(row.values for row in results), strict=True)
    variables = {
        name: (axis, np.array(values), {"units": OUTPUTS[name].unit, "long_name": OUTPUTS[name].meaning})
        for name, values in zip(outputs, columns, strict=True)
    }
    seconds = np.array([row.seconds for row in results])
    cost = (axis, seconds, {"units": "s", "long_name": f"cost of the {axis}"})
    return xr.Dataset({**variables, "seconds": cost}, varied)


def write_study(study_results: StudyResults, folder: Path) -> list[Path]:
    """Write ``study.nc``, ``study.svg`` where numbers vary, and a page with all; return the files."""
    from flankfilm.figures import study
    from flankfilm.figures.studies import varied_numbers
    from flankfilm.figures.style import save
    from flankfilm.studies.page import write_study_page

    files = [folder / "study.nc"]
    content = dataset(study_results)
    write_netcdf(files[0], content)
    keys = study_results.plan.keys[: study_results.plan.varied]
    if varied_numbers(content, keys):
        files.append(folder / "study.svg")
        save(study(content, keys, study_results.plan.outputs), files[-1])
    return [*files, write_study_page(study_results, content, folder)]


def summary(study_results: StudyResults) -> list[str]:
    """Lines for the terminal: rows, rate, and the first faults."""
    rate = f", {study_results.computed / study_results.seconds:.2g} rows/s" if study_results.computed else ""
    lines = [
        f"{len(study_results.rows)} rows, {study_results.computed} of them computed in "
        f"{study_results.seconds:.1f} s{rate}"
    ]
    lines += [f"row {row.index} failed: {row.fault}" for row in study_results.failures[:5]]
    if len(study_results.failures) > 5:
        lines.append(
            f"{len(study_results.failures)} rows failed in all; the column fault of rows.csv says why"
        )
    return lines
