"""Runs a scene: its stages, then its files."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

from flankfilm.cache import results_cache
from flankfilm.folder import claim, locked
from flankfilm.manifest import conclude
from flankfilm.output.run import results_dataset, write_data
from flankfilm.progress import Progress, in_steps, silent
from flankfilm.results import Results
from flankfilm.scene import Scene
from flankfilm.stages.engine import Engine
from flankfilm.stages.goals import goals
from flankfilm.stages.vtk import write_fields


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
        Where the geometry cannot be built or the folder cannot be written.
    SolverError
        Where a solver did not reach a result that it believes.
    """
    start = time.perf_counter()
    if folder is None:
        return _computed(scene, use_cache, progress)[0]
    claim(folder)
    with locked(folder):
        found, engine = _computed(scene, use_cache, progress)
        files = engine.timed("data files", "netCDF and CSV files", lambda: write_data(folder, found.dataset))
        if "vtk" in scene.wants:
            files += engine.timed(
                "vtk files", "fields for ParaView", lambda: write_fields(folder, engine, progress)
            )
        found = replace(found, folder=folder, files=tuple(files), seconds=time.perf_counter() - start)
        if "report" in scene.wants:
            from flankfilm.report.contents import write_report

            progress("writing the report", 1, 1)
            files.append(write_report(found, folder))
        others = conclude(folder, files)
    return replace(found, files=tuple(files), others=others, seconds=time.perf_counter() - start)


def _computed(scene: Scene, use_cache: bool, progress: Progress) -> tuple[Results, Engine]:
    """Results without files, and the engine that has them."""
    start = time.perf_counter()
    wanted = goals(scene)
    announce = in_steps(progress, len(wanted) + 2)
    engine = Engine(scene, results_cache(use_cache), lambda stage: announce(stage.title))
    for stage in wanted:
        engine[stage]
    values = engine.results()
    dataset = results_dataset(scene, values)
    return Results(scene, None, values, engine.runs, (), time.perf_counter() - start, dataset), engine
