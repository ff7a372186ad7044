"""Runs a scene: its stages, then its files."""

from __future__ import annotations

import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from base import InputError, SolverError
from flankfilm.files.cache import results_cache
from flankfilm.files.folder import occupied, unfinished
from flankfilm.outcome.outcome import Outcome, concluded
from flankfilm.outcome.results import Results
from flankfilm.processes.assistant import Assistant, Task, assistant
from flankfilm.processes.exit_status import PART_FAILED
from flankfilm.processes.progress import Progress, silent
from flankfilm.products.fields import in_space
from flankfilm.runs.ahead import Ahead
from flankfilm.runs.begin import begin
from flankfilm.runs.dataset import not_computed, results_dataset, write_data
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.failures import lines as failure_lines
from flankfilm.stages.mesh import FIELDS
from flankfilm.stages.vtk import FieldFiles, begin_fields

if TYPE_CHECKING:
    import xarray as xr

    from flankfilm.runs.report import Shown

OF_FIELDS = (
    "fem.fields.vtk",
    "pyvista",
    "vtkmodules.vtkIOXML",
    "gmsh",
    "skfem.quadrature",
    "scipy.interpolate",
)

LOADED = (*OF_FIELDS, "flankfilm.runs.report", "matplotlib.backends.backend_svg")
"""What an assistant loads while the scene is computed, also what fields load where they first need it. Fields for
ParaView alone are worth a process."""

FILES = "vtk files", "fields for ParaView"
"""Name and title of their part of the costs."""

PREPARATIONS = {"plan", "heat"}
"""Stages that no want is for: what they give is no result of a run whose other parts failed."""


@dataclass(frozen=True, eq=False)
class RunOutcome(Outcome[Results]):
    """Everything as data, a table for each curve, fields for ParaView and a report where the scene wants them.

    Attributes
    ----------
    engine : Engine
        That has the results.
    progress : callable
    helper : Assistant
        With which files are written beside each other.
    fields : FieldFiles or None
        Files for ParaView that are begun.
    of_pair : Task or None
        Draws what shows the geometry, where that is begun.
    """

    data = "results.nc"
    folders = ("csv", "vtk")
    """Names of folders beside the file of data."""

    engine: Engine = field(kw_only=True)
    progress: Progress = field(kw_only=True)
    helper: Assistant = field(kw_only=True)
    fields: FieldFiles | None = field(kw_only=True, default=None)
    of_pair: Task[Shown] | None = field(kw_only=True, default=None)

    @property
    def dataset(self) -> xr.Dataset:
        """Everything that was found."""
        return self.result.dataset

    @property
    def lines(self) -> list[str]:
        """Headline figures with errors, decisions, and the files."""
        from flankfilm.runs.report import summary

        return summary(self.result)

    @property
    def faults(self) -> list[str]:
        """Parts that could not be computed."""
        return failure_lines(self.result.failures)

    @property
    def status(self) -> int:
        """Whether parts failed."""
        return PART_FAILED if self.result.failures else 0

    def tables(self, folder: Path) -> list[Path]:
        """Write the data, and a table for each curve."""
        return write_data(folder, self.dataset)

    def page(self, folder: Path, shown: Shown | None = None) -> Path:
        """Write the report, of what is drawn already where that is given."""
        from flankfilm.runs.report import write_report

        return write_report(self.result, folder, shown)

    def written(self, folder: Path) -> RunOutcome:
        """Write all that the scene wants; fields that cannot be written are a part that failed, which the data say.

        The assistant began with the fields, and goes on with the data and pictures for phones, while the report's
        pictures are drawn here.
        """
        results, engine, began, wants = self.result, self.engine, time.perf_counter(), self.result.scene.wants
        fields = self._begun(folder) if "vtk" in wants else None
        data = self.helper.submit(write_data, folder, self.dataset)
        shown = self._drawn() if "report" in wants else None
        self.progress("netCDF and CSV files", 1, 1)
        files = engine.timed("data files", "netCDF and CSV files", lambda: self.helper.result(data))
        if fields is not None:
            files += self._fields(fields, folder)
            if shown is not None and len(engine.failures) == len(results.failures):
                turning = in_space(fields.surfaces(self.helper), self.dataset)
                shown = replace(shown, parts=(*shown.parts, *turning))
        if len(engine.failures) > len(results.failures):
            results = replace(results, failures=tuple(engine.failures.values()))
            results = replace(results, dataset=results.dataset.assign_attrs(not_computed(results.failures)))
            write_data(folder, results.dataset)
        seconds = results.seconds + time.perf_counter() - began
        outcome = replace(
            self, result=replace(results, folder=folder, files=tuple(files), seconds=seconds), folder=folder
        )
        if shown is not None:
            files.append(outcome.page(folder, shown))
        return replace(outcome, files=tuple(files))

    def _drawn(self) -> Shown:
        """Sections of the report with their pictures."""
        from flankfilm.runs.report import draw

        self.progress("writing the report", 1, 1)
        of_pair = None if self.of_pair is None else self.helper.result(self.of_pair)
        return draw(self.result, self.helper, of_pair)

    def _begun(self, folder: Path) -> FieldFiles | None:
        """Begin with the files for ParaView; None where fields failed, which the engine notes."""
        if self.fields is not None or FIELDS.name in self.engine.failures:
            return self.fields
        kept = "report" in self.result.scene.wants
        with suppress(InputError, SolverError):
            return self.engine.timed(*FILES, lambda: begin_fields(folder, self.engine, self.helper, kept))
        return None

    def _fields(self, begun: FieldFiles, folder: Path) -> list[Path]:
        """Files for ParaView; none where they cannot be written, which the engine notes."""
        with suppress(InputError, SolverError):
            return self.engine.timed(*FILES, lambda: begun.written(folder, self.helper, self.progress))
        return []


def run_outcome(
    scene: Scene,
    folder: Path | None,
    *,
    use_cache: bool = True,
    progress: Progress = silent,
    computed: Callable[[Computed], None] | None = None,
) -> RunOutcome:
    """Compute what a scene wants and write it where there is a folder; arguments and faults as of `run_scene`.

    `computed` is called with the results before they become a dataset and files.
    """
    start = time.perf_counter()
    shared = LOADED if folder is not None and "vtk" in scene.wants else ()
    with (
        occupied(folder, RunOutcome.data, RunOutcome.folders),
        unfinished(folder if shared else None) as beside,
        assistant(shared) as helper,
    ):
        outcome = concluded(_computed(scene, use_cache, progress, helper, beside, computed), folder)
    results = replace(
        outcome.result, files=outcome.files, others=outcome.others, seconds=time.perf_counter() - start
    )
    return replace(outcome, result=results)


def run_scene(
    scene: Scene, folder: Path | None, *, use_cache: bool = True, progress: Progress = silent
) -> Results:
    """Compute what a scene wants, and write it where there is a folder.

    Parameters
    ----------
    scene : Scene
        Checked scene.
    folder : Path or None
        Where the files go, made when it does not exist; None writes nothing.
    use_cache : bool
        Whether results of earlier runs with the same inputs and code may serve.
    progress : callable
        Called with what is being done, steps done, and steps in all.

    Returns
    -------
    Results
        Values, costs and files.

    Raises
    ------
    InputError
        Where the scene is refused or the folder cannot be written; nothing is computed then.
    SolverError
        Where no part that the scene wants could be computed; parts that failed beside others are in `failures`.
    """
    return run_outcome(scene, folder, use_cache=use_cache, progress=progress).result


def _computed(
    scene: Scene,
    use_cache: bool,
    progress: Progress,
    helper: Assistant,
    beside: Path | None,
    computed: Callable[[Computed], None] | None,
) -> RunOutcome:
    """Results without files, but for those that the helper writes meanwhile into a folder beside the run's."""
    start = time.perf_counter()
    engine, wanted = begin(scene, results_cache(use_cache), progress)
    ahead = None
    if FIELDS in wanted and beside is not None and helper.there:
        ahead = Ahead(engine, helper, beside)
        engine.on_end = ahead.ended
        # the helper computes them meanwhile
        wanted = (*(stage for stage in wanted if stage is not FIELDS), FIELDS)
    for stage in wanted:
        with suppress(InputError, SolverError):  # the engine keeps it, and the other stages go on
            engine[stage]
    failures = tuple(engine.failures.values())
    asked = {stage.name for stage in wanted} - PREPARATIONS
    if failures and asked <= set(engine.failures):
        raise failures[0].error
    for failure in failures:
        failure.error.with_traceback(None)  # which would keep every array of the solver
    stages = Computed(scene, engine.results(), failures, engine.runs)
    if computed is not None:
        computed(stages)
    dataset, seconds = results_dataset(stages), time.perf_counter() - start
    results = Results(scene, None, stages.values, stages.runs, (), seconds, dataset, failures=failures)
    outcome = RunOutcome(results, engine=engine, progress=progress, helper=helper)
    if ahead is None:
        return outcome
    fields = None if FIELDS.name in engine.failures else ahead.fields
    return replace(outcome, fields=fields, of_pair=ahead.of_pair)
