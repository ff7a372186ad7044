"""The command line: run, verify, study, optimise, bench, check and new."""

from __future__ import annotations

import logging
import os
import sys
import warnings
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import App, Parameter, Token

from base import InputError, printable
from flankfilm.processes.current_folder import disregard_settings
from flankfilm.processes.exit_status import BY_SIGNAL, guarded, open_streams, say
from flankfilm.studies.execution import Execution
from flankfilm.studies.executors import Kind

if TYPE_CHECKING:
    from flankfilm.outcome.outcome import Line, Outcome
    from flankfilm.scene import Scene
    from flankfilm.stages.computed import Computed


def _version() -> str:
    from importlib import metadata  # 20 ms, which no other command has a use for

    return metadata.version("flankfilm")


app = App(
    name="flankfilm",
    help="Stiffness, oil film and motion of spur and helical gear pairs; each number with its error and its cost.",
    version=_version,
    version_flags=["--version"],
    suppress_keyboard_interrupt=False,  # it says what is kept
)


def _named(_: object, tokens: Sequence[Token]) -> Path:
    """Folder of a name that is not empty, as the value of a variable that is not set."""
    if not tokens[0].value.strip():
        raise ValueError("it must name a folder; a dot is the current one")
    return Path(tokens[0].value)


Folder = Annotated[Path, Parameter(converter=_named)]


@dataclass(frozen=True)
class SceneOptions:
    """Options of the commands that compute a scene.

    Parameters
    ----------
    out : Path, optional
        Folder for the results; SCENE-results, or SCENE-verify, beside you if left out.
    tolerance : str, optional
        Relative, such as 0.5% or 0.005; overrules the scene's tolerance.
    cache : bool
        Use results of earlier runs whose inputs and code are the same.
    """

    out: Folder | None = None
    tolerance: str | None = None
    cache: bool = True


@dataclass(frozen=True)
class RowOptions(Execution):
    """Options of the commands that compute rows: an executor is named.

    Parameters
    ----------
    executor : {"processes", "dask", "mpi"}
        Where the rows are computed.
    workers : int, optional
        Processes; one for each core if left out.
    resume : bool
        Go on from the rows in the folder.
    cache : bool
        Use results of earlier runs whose inputs and code are the same.
    """

    executor: Kind = "processes"


ForScene = Annotated[SceneOptions, Parameter(name="*")]


HowRows = Annotated[RowOptions, Parameter(name="*")]
RowsFolder = Annotated[Folder, Parameter(help="Folder for the rows and what is made of them.")]


def _prepare() -> None:
    """Say what must be said before numba is loaded."""
    from flankfilm.files.cache import keep_compiled_code

    keep_compiled_code()


def _read(scene: Path, tolerance: str | None) -> Scene:
    from flankfilm.output.reproduce import scene_in
    from flankfilm.scene import parse_tolerance

    changed = {} if tolerance is None else {"tolerance": parse_tolerance(tolerance, "--tolerance")}
    wanted, differences = scene_in(scene)
    for difference in differences:
        print(printable(f"flankfilm: {scene}: {difference}"), file=sys.stderr)
    return wanted.model_copy(update=changed)


@app.command
def run(scene: Path, /, *, options: ForScene = SceneOptions()) -> int:
    """Compute what SCENE wants and write the results and a report.

    Parameters
    ----------
    scene : Path
        The scene file (TOML), or a results.nc: the scene that made it is run again.
    """
    _prepare()
    # a scene with faults is refused before what computes it is loaded
    wanted = _read(scene, options.tolerance)
    from flankfilm.processes.progress import console_progress
    from flankfilm.runs import report
    from flankfilm.runs.run_scene import run_outcome

    # a results file is called like all others: its folder distinguishes it
    name = scene.absolute().parent.name if scene.suffix == ".nc" else scene.stem
    folder = options.out or Path(f"{name}-results")
    figures: list[str] = []

    def computed(results: Computed) -> None:
        lines = report.figure_lines(results)
        with suppress(OSError):  # a closed pipe keeps no file from being written; it shows again at the end
            _printed(lines)
            figures.extend(lines)

    with console_progress() as progress:
        outcome = run_outcome(wanted, folder, use_cache=options.cache, progress=progress, computed=computed)
    return _shown(outcome, len(figures))


@app.command
def verify(scene: Path, /, *, options: ForScene = SceneOptions()) -> int:
    """Tabulate every closed form of tooth stiffness against finite elements, with the latter's error.

    Parameters
    ----------
    scene : Path
        The scene file (TOML); its sections pair, material and operating count.
    """
    _prepare()
    wanted = _read(scene, options.tolerance)
    from flankfilm.processes.progress import console_progress
    from flankfilm.verification.run import verification_outcome

    folder = options.out or Path(f"{scene.stem}-verify")
    with console_progress() as progress:
        outcome = verification_outcome(wanted, folder, use_cache=options.cache, progress=progress)
    return _shown(outcome)


@app.command
def warm_up() -> int:
    """Compile now, on all cores, what would be compiled when it is first used."""
    _prepare()
    from flankfilm.processes.worker_processes import cores
    from flankfilm.warm_up import warm_up as compile_all

    compile_all(cores(), lambda part: print(printable(str(part)), flush=True))
    return 0


@app.command
def study(
    study: Path,
    /,
    *,
    out: RowsFolder,
    part: str | None = None,
    merge: Annotated[bool, Parameter(negative="")] = False,
    how: HowRows = RowOptions(),
) -> int:
    """Compute the rows of STUDY, each kept as it arrives, and write them as one dataset.

    Parameters
    ----------
    study : Path
        The study file (TOML): a scene, keys of it that vary, outputs.
    part : str, optional
        Compute one part of several alone, such as 3/16: jobs of a batch system need nothing but the common folder.
    merge : bool
        Gather the rows of all parts, and write the dataset.
    """
    _prepare()
    from flankfilm.processes.progress import console_rows
    from flankfilm.studies.files import study_outcome
    from flankfilm.studies.parts import Part, part_outcome
    from flankfilm.studies.parts import merge as merge_parts
    from flankfilm.studies.plan import read_plan

    if part is not None and merge:
        raise InputError.at(
            "--part", part, "does not go with --merge", "Compute all parts first, then merge them"
        )
    one_part = None if part is None else Part.read(part)
    plan = read_plan(study)
    if merge:
        return _shown(merge_parts(plan, out))
    with console_rows() as progress:
        if one_part is None:
            outcome = study_outcome(plan, out, how, progress)
        else:
            outcome = part_outcome(one_part, plan, out, how, progress)
    return _shown(outcome)


@app.command
def optimise(task: Path, /, *, out: RowsFolder, how: HowRows = RowOptions()) -> int:
    """Look for the minimum of one output, or the trade-off of several, over keys of a scene within bounds.

    Parameters
    ----------
    task : Path
        The optimisation file (TOML): a scene, ranges of its keys, outputs to minimise or maximise, limits.
    """
    _prepare()
    from flankfilm.optimisation.files import optimum_outcome
    from flankfilm.optimisation.task import read_task
    from flankfilm.processes.progress import console_rows

    asked = read_task(task)
    with console_rows() as progress:
        outcome = optimum_outcome(asked, out, how, progress)
    return _shown(outcome)


def _shown(outcome: Outcome[Any], printed: int = 0) -> int:
    """Print what a command gave, but for as many lines as were `printed` before; its exit status."""
    _printed(outcome.lines[printed:])
    for fault in outcome.faults:
        print(f"flankfilm: {printable(fault)}", file=sys.stderr)
    return outcome.status


def _printed(lines: Sequence[Line]) -> None:
    """Print sentences and tables."""
    for line in lines:
        if isinstance(line, str):
            print(printable(line), flush=True)
        else:
            from rich.console import Console

            Console(width=None if sys.stdout.isatty() else 160).print(line)


@app.command
def bench(
    *,
    out: Folder = Path("bench-results"),
    only: Annotated[list[str] | None, Parameter(consume_multiple=True, negative="")] = None,
    quick: Annotated[bool, Parameter(negative="")] = False,
    repeat: int | None = None,
    against: str | None = None,
) -> int:
    """Measure error against cost of every solver on this machine.

    Parameters
    ----------
    out : Path
        Folder for the figures, tables and the report.
    only : list of str, optional
        Solvers: gears, mesh, elements, compliance, contact, root-stress, film, motion, application.
    quick : bool
        Few and coarse levels, in half a minute.
    repeat : int, optional
        Timed runs of each level.
    against : str, optional
        Interpreter of an environment with other programs: ross-rotordynamics, scipy, heyoka.
    """
    _prepare()
    from rich.console import Console

    from flankfilm.bench.page import write_page
    from flankfilm.bench.run import bench as measured
    from flankfilm.bench.tables import remarks, terminal, write_tables
    from flankfilm.processes.progress import console_progress

    with console_progress() as progress:
        measurements = measured(
            out, only or (), quick=quick, repeat=repeat, against=against, progress=progress
        )
    files = [*write_tables(measurements, out), *write_page(measurements, out)]
    Console(width=None if sys.stdout.isatty() else 180).print(terminal(measurements))
    for line in remarks(measurements):
        print(line)
    print(f"{len(files)} files in {out} after {measurements.seconds:.0f} s; {files[-1].name} shows them all")
    return 0


@app.command
def check(scene: Path, /) -> int:
    """Check SCENE, its geometry included, and list every fault; compute nothing.

    Parameters
    ----------
    scene : Path
        The scene file (TOML).
    """
    from flankfilm.runs.check import check_scene

    for line in check_scene(_read(scene, None)):
        print(printable(line))
    return 0


@app.command
def new(scene: Path, /) -> int:
    """Write a commented scene to start from to SCENE, which must not exist yet.

    Parameters
    ----------
    scene : Path
        The file to write.
    """
    from flankfilm.files.folder import write_new
    from flankfilm.scene import template

    if scene.suffix != ".toml":
        raise InputError.at(scene, "", "must end in .toml", f"flankfilm new {scene.with_suffix('.toml')}")
    write_new(scene, template(), "Name another file")
    print(f"{scene} is written. Next: flankfilm run {scene}")
    return 0


@app.command
def completion(shell: Literal["bash", "zsh", "fish"], /) -> int:
    """Print the script that completes commands and options in SHELL.

    Parameters
    ----------
    shell : {"bash", "zsh", "fish"}
        Whose script.
    """
    print(app.generate_completion(prog_name="flankfilm", shell=shell))
    return 0


for _name, _where, _help in (
    ("import", "exchange.commands:import_gears", "Write a scene from the gear data in FILE (REXS)."),
    ("export-profile", "exchange.commands:export_profile", "Write the tooth profile of a gear of SCENE."),
    (
        "export",
        "exchange.commands:export_mesh",
        "Write both gears of SCENE, loaded as they mesh, for other programs.",
    ),
    ("export-rexs", "exchange.commands:export_rexs", "Write the pair of SCENE as a REXS file."),
    ("export-table", "exchange.commands:export_table", "Write the mesh of SCENE as a table over angle."),
    (
        "export-traction",
        "exchange.commands:export_traction",
        "Write friction of the oil of SCENE over sliding.",
    ),
    ("view", "figures.rendering.commands:view", "Show the fields in RESULTS on the deformed teeth."),
    ("animate", "figures.rendering.commands:animate", "Draw the mesh cycle in RESULTS, deformed."),
    ("app", "app.command:app", "Show a page that edits SCENE, answers while you drag, and runs it."),
):
    # the module is loaded when the command is called
    app.command(f"flankfilm.{_where}", name=_name, help=_help)


DATE = "SOURCE_DATE_EPOCH"
"""Variable with which libraries date what they write, as soon as they are loaded."""


def _commands() -> int:
    disregard_settings()
    if not (date := os.environ.get(DATE, "0")).isdecimal():
        raise InputError.at(DATE, date, "must be whole seconds since 1970", f"unset {DATE}")
    return int(app(exit_on_error=True, print_error=True) or 0)


def main() -> None:
    """Commands of the ``flankfilm`` script, whose entry is ``flankfilm.__main__``."""
    open_streams()
    warnings.showwarning = say
    status = guarded(_commands)
    if status > BY_SIGNAL:
        logging.disable()  # what libraries say of work that was broken off
    sys.exit(status)
