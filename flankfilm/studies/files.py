"""A finished study as one dataset with units, and as files, a page and lines."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from base.results import EXACT
from base.units import unit_of
from flankfilm import figures
from flankfilm.figures.studies import varied_numbers
from flankfilm.outcome.outcome import Outcome, Picture, concluded
from flankfilm.output.files import provenance
from flankfilm.output.variables import NAME
from flankfilm.processes.exit_status import PART_FAILED, SOLVER_FAULT
from flankfilm.studies.columns import SECONDS, error_attributes, write_columns
from flankfilm.studies.execution import Execution, Progress
from flankfilm.studies.kept import kept_rows
from flankfilm.studies.outputs import OUTPUTS
from flankfilm.studies.page import write_study_page
from flankfilm.studies.plan import Plan
from flankfilm.studies.quantiles import sampled, write_quantiles
from flankfilm.studies.row import RowResult
from flankfilm.studies.run import StudyResults, computed, work_of_plan
from flankfilm.studies.study_file import Value
from flankfilm.studies.table import ROWS

if TYPE_CHECKING:
    import xarray as xr


def dataset(study_results: StudyResults) -> xr.Dataset:
    """Give a study as a dataset along ``row``: varied keys as coordinates, outputs, cost and faults."""
    plan, rows = study_results.plan, study_results.rows
    attributes = {"title": plan.title, "design": plan.design, **provenance(json.dumps(plan.scene))}
    data = of_rows("row", plan.keys, plan.rows, plan.outputs, rows)
    about = {"units": "", "long_name": "why a row failed; empty where it did not", "error_note": NAME}
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
        key: (
            axis,
            np.asarray(values),
            {"units": unit_of(key), "long_name": f"key {key} of the scene", "error_note": EXACT},
        )
        for key, values in zip(keys, zip(*points, strict=True), strict=True)
    }
    columns = zip(*(row.values for row in results), strict=True)
    variables = {
        name: (
            axis,
            np.array(values),
            {
                "units": OUTPUTS[name].unit,
                "long_name": OUTPUTS[name].meaning,
                **error_attributes(name, outputs),
            },
        )
        for name, values in zip(outputs, columns, strict=True)
    }
    seconds = np.array([row.seconds for row in results])
    cost = (axis, seconds, {"units": "s", "long_name": f"cost of the {axis}", "error_note": SECONDS})
    return xr.Dataset({**variables, "seconds": cost}, varied)


@dataclass(frozen=True, eq=False)
class StudyOutcome(Outcome[StudyResults]):
    """Rows of a study, ``study.nc``, ``study.svg`` where numbers vary, and a page with all."""

    data = "study.nc"

    @cached_property
    def dataset(self) -> xr.Dataset:
        """Rows along ``row``."""
        return dataset(self.result)

    @property
    def lines(self) -> list[str]:
        """Rows, rate, the first faults, and the files."""
        rows, computed, spent = self.result.rows, self.result.computed, self.result.seconds
        rate = f", {computed / spent:.2g} rows/s" if computed else ""
        failures = self.result.failures
        lines = [f"{len(rows)} rows, {computed} of them computed in {spent:.1f} s{rate}"]
        lines += [f"row {row.index} failed: {row.fault}" for row in failures[:5]]
        if len(failures) > 5:
            lines.append(f"{len(failures)} rows failed in all; the column fault of rows.csv says why")
        return [*lines, listed(self.files)]

    @property
    def status(self) -> int:
        """Whether rows failed, or all of them with all their outputs."""
        if not self.result.failures:
            return 0
        return SOLVER_FAULT if all(row.lost for row in self.result.rows) else PART_FAILED

    def tables(self, folder: Path) -> list[Path]:
        """The rows, which are there, what their columns err by, and quantiles of sampled rows."""
        plan = self.result.plan
        tables = [folder / ROWS, write_columns(folder, plan.keys, plan.outputs)]
        if sampled(plan.design, len(plan.rows)):
            tables.append(write_quantiles(folder, self.dataset, plan.outputs))
        return tables

    @property
    def pictures(self) -> dict[str, Picture]:
        """Every output against the keys that vary, where numbers do."""
        plan = self.result.plan
        keys = plan.keys[: plan.varied]
        draw = partial(figures.study, keys=keys, outputs=plan.outputs)
        return {"study": draw} if varied_numbers(self.dataset, keys) else {}

    def page(self, folder: Path) -> Path:
        """Write the page."""
        return write_study_page(self.result, self.dataset, folder)


def study_outcome(
    plan: Plan,
    folder: Path | None,
    how: Execution = Execution(),
    progress: Progress = lambda done, total: None,
) -> StudyOutcome:
    """Compute the rows of a plan and write what is made of them; parameters as of `flankfilm.studies.run.run_study`.

    Without a folder nothing stays.
    """
    with kept_rows(folder, work_of_plan(plan), how.resume) as kept:
        return concluded(StudyOutcome(computed(plan, kept, how, progress, range(len(plan.rows)))), folder)


def listed(files: Sequence[Path]) -> str:
    """Files in a line."""
    return ", ".join(map(str, files))
