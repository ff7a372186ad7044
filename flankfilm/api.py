"""What the commands do with files of scenes, studies and tasks, as functions: each writes only into its folder."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from base import PartWarning
from flankfilm.files.cache import keep_compiled_code, results_cache
from flankfilm.files.folder import claim
from flankfilm.output.reproduce import scene_in
from flankfilm.scene import Scene
from flankfilm.studies.execution import Execution

if TYPE_CHECKING:
    from flankfilm.coupling import Verification
    from flankfilm.optimisation.optimum import Optimum
    from flankfilm.optimisation.task import Task
    from flankfilm.outcome.results import Results
    from flankfilm.studies.plan import Plan
    from flankfilm.studies.run import StudyResults

SceneOrPath = Scene | Path | str


def run(scene: SceneOrPath, out: Path | str | None = None, *, cache: bool = True) -> Results:
    """Compute what a scene wants.

    Parameters
    ----------
    scene : Scene, Path or str
        A scene, its file (TOML), or a results.nc whose scene is run again.
    out : Path or str, optional
        Folder for data, fields and report; nothing is written without it.
    cache : bool
        Whether results of earlier runs with the same inputs and code may serve.

    Returns
    -------
    Results
        A part that failed beside others is in its ``failures``, and nowhere else: it has no value, and asking for its
        stage raises the reason.

    Warns
    -----
    PartWarning
        For each part that failed, with the reason and the remedy.

    Raises
    ------
    InputError
        With every fault of the scene, or of the folder.
    SolverError
        Where no wanted part could be computed.

    Examples
    --------
    >>> from flankfilm import parse_scene
    >>> scene = parse_scene(
    ...     '''
    ... wants = ["geometry"]
    ... [pair]
    ... module_mm = 2.0
    ... face_width_mm = 40.0
    ... pinion = { teeth = 36 }
    ... wheel = { teeth = 40 }
    ... '''
    ... )
    >>> results = run(scene)
    >>> round(float(results.dataset.pair_contact_ratio), 3), results.files
    (1.703, ())
    """
    keep_compiled_code()
    from flankfilm.runs.run_scene import run_scene
    from flankfilm.stages.failures import lines

    results = run_scene(_scene(scene), _folder(out), use_cache=cache)
    for line in lines(results.failures):
        warnings.warn(line, PartWarning, stacklevel=2)
    return results


def verify(scene: SceneOrPath, out: Path | str | None = None, *, cache: bool = True) -> Verification:
    """Compare every closed form of tooth stiffness with finite elements on a scene's pair; arguments as of `run`.

    Examples
    --------
    >>> from flankfilm import parse_scene
    >>> scene = parse_scene(
    ...     '''
    ... wants = ["closed-forms"]
    ... [pair]
    ... module_mm = 2.0
    ... face_width_mm = 40.0
    ... pinion = { teeth = 36 }
    ... wheel = { teeth = 40 }
    ... [material]
    ... youngs_modulus_GPa = 206
    ... poisson_ratio = 0.3
    ... [operating]
    ... pinion_torque_Nm = 600
    ... '''
    ... )
    >>> verification = verify(scene)
    >>> round(verification.difference("Ishikawa", "held to the path"), 2)
    0.09
    """
    from flankfilm.verification.run import verification_outcome

    return verification_outcome(_scene(scene), _folder(out), use_cache=cache).result


def write_vtk(scene: SceneOrPath, out: Path | str, *, cache: bool = True) -> list[Path]:
    """Write the loaded mesh cycle of a scene for ParaView.

    Returns the ``.pvd`` that names all its files, and the state of ParaView that opens it.

    Arguments are as of `run`.

    Examples
    --------
    >>> from flankfilm import read_scene
    >>> write_vtk(read_scene("article.toml"), "out/fields")  # doctest: +SKIP
    [PosixPath('out/fields/mesh_cycle.pvd'), PosixPath('out/fields/paraview_state.py')]
    """
    from flankfilm.stages.engine import Engine
    from flankfilm.stages.vtk import write_fields

    keep_compiled_code()
    folder, read = Path(out), _scene(scene)
    claim(folder)
    return write_fields(folder, Engine(read, results_cache(cache)))


def study(
    study: Plan | Path | str, out: Path | str | None = None, how: Execution = Execution()
) -> StudyResults:
    """Compute the rows of a study.

    Parameters
    ----------
    study : Plan, Path or str
        A plan, or the study's file (TOML).
    out : Path or str, optional
        Folder for the rows as they arrive and the finished study; nothing stays without it.
    how : Execution
        Where rows are computed, and whether a study that was begun in the folder is taken up.

    Examples
    --------
    >>> found = study("studies/torque.toml", "out/torque")  # doctest: +SKIP
    """
    from flankfilm.studies.files import study_outcome
    from flankfilm.studies.plan import read_plan

    plan = read_plan(Path(study)) if isinstance(study, str | Path) else study
    return study_outcome(plan, _folder(out), how).result


def optimise(task: Task | Path | str, out: Path | str | None = None, how: Execution = Execution()) -> Optimum:
    """Look for the minimum of one output, or the trade-off of several; arguments as of `study`.

    Examples
    --------
    >>> best = optimise("optimise/root_film.toml", "out/root_film")  # doctest: +SKIP
    """
    from flankfilm.optimisation.files import optimum_outcome
    from flankfilm.optimisation.task import read_task

    asked = read_task(Path(task)) if isinstance(task, str | Path) else task
    return optimum_outcome(asked, _folder(out), how).result


def _scene(source: SceneOrPath) -> Scene:
    """Scene itself, or the one that a file holds."""
    return source if isinstance(source, Scene) else scene_in(Path(source))[0]


def _folder(out: Path | str | None) -> Path | None:
    return None if out is None else Path(out)
