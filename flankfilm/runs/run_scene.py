"""Runs a scene: its stages, then its files."""

from __future__ import annotations

import time
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from base import InputError, SolverError
from flankfilm.files.cache import results_cache
from flankfilm.files.folder import claim, locked
from flankfilm.files.manifest import MANIFEST, conclude
from flankfilm.outcome.results import Results
from flankfilm.processes.progress import Progress, silent
from flankfilm.runs.begin import begin
from flankfilm.runs.dataset import not_computed, results_dataset, write_data
from flankfilm.scene import Scene
from flankfilm.stages.computed import Computed
from flankfilm.stages.engine import Engine
from flankfilm.stages.mesh import FIELDS
from flankfilm.stages.vtk import write_fields

PREPARATIONS = {"plan", "heat"}
"""Stages that no want is for: what they give is no result of a run whose other parts failed."""


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
    start = time.perf_counter()
    if folder is None:
        return _computed(scene, use_cache, progress)[0]
    claim(folder, "results.nc", files=("results.nc", "report.html", MANIFEST), folders=("csv", "vtk"))
    with locked(folder):
        results, engine = _computed(scene, use_cache, progress)
        progress("netCDF and CSV files", 1, 1)
        files = engine.timed(
            "data files", "netCDF and CSV files", lambda: write_data(folder, results.dataset)
        )
        if "vtk" in scene.wants:
            files += _fields(folder, engine, progress)
        if len(engine.failures) > len(results.failures):
            results = replace(results, failures=tuple(engine.failures.values()))
            results = replace(results, dataset=results.dataset.assign_attrs(not_computed(results.failures)))
            write_data(folder, results.dataset)
        results = replace(results, folder=folder, files=tuple(files), seconds=time.perf_counter() - start)
        if "report" in scene.wants:
            from flankfilm.runs.report import write_report

            progress("writing the report", 1, 1)
            files.append(write_report(results, folder))
        others = conclude(folder, files)
    return replace(results, files=tuple(files), others=others, seconds=time.perf_counter() - start)


def _fields(folder: Path, engine: Engine, progress: Progress) -> list[Path]:
    """Files for ParaView; none where the fields failed, which the engine notes."""
    if FIELDS.name in engine.failures:
        return []
    try:
        return engine.timed(
            "vtk files", "fields for ParaView", lambda: write_fields(folder, engine, progress)
        )
    except (InputError, SolverError):
        return []


def _computed(scene: Scene, use_cache: bool, progress: Progress) -> tuple[Results, Engine]:
    """Results without files, and the engine that has them."""
    start = time.perf_counter()
    engine, wanted = begin(scene, results_cache(use_cache), progress)
    for stage in wanted:
        with suppress(InputError, SolverError):  # the engine keeps it, and the other stages go on
            engine[stage]
    failures = tuple(engine.failures.values())
    asked = {stage.name for stage in wanted} - PREPARATIONS
    if failures and asked <= set(engine.failures):
        raise failures[0].error
    for failure in failures:
        failure.error.with_traceback(None)  # which would keep every array of the solver
    values = engine.results()
    dataset = results_dataset(Computed(scene, values, failures))
    seconds = time.perf_counter() - start
    return Results(scene, None, values, engine.runs, (), seconds, dataset, failures=failures), engine
