"""Pictures of the loaded teeth, and an animation of the mesh cycle, from the files that a run wrote for ParaView."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import asdict
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from base import Fault, InputError, SolverError, shorten
from base.files import replacing
from flankfilm.figures.gear import stress_of_nearly_all
from flankfilm.figures.reading import need
from flankfilm.figures.view import View

if TYPE_CHECKING:
    import xarray as xr

MOVING = (".gif", ".webp")
STILL = (".png", ".jpg", ".webp")

SHOWN = 0.12
"""What the greatest deflection is drawn as, in modules."""

PATIENCE = 600.0
"""Seconds that the drawing may take."""

NO_OPENGL = (
    "VTK needs OpenGL: install Mesa's software renderer (apt-get install libegl1 libgl1), or draw on a virtual screen "
    "(xvfb-run flankfilm animate ...), or open mesh_cycle.pvd in ParaView on another machine"
)


def animate_cycle(
    folder: Path | str,
    target: Path | str,
    *,
    seconds: float = 2.0,
    size: tuple[int, int] = (720, 480),
    scale: float | None = None,
) -> Path:
    """Draw one base pitch of the mesh cycle as an animation that repeats without a seam.

    Colours are the von Mises stress; teeth are drawn deformed, and the pinion ahead by the transmission error,
    all by one factor that the picture tells.

    Parameters
    ----------
    folder : Path
        Of a run that wants ``vtk``.
    target : Path
        File to write: ``.gif``, or ``.webp`` with all colours.
    seconds : float
        Length.
    size : tuple of int
        Width and height [pixels].
    scale : float, optional
        Factor of the displacements; chosen so that they show unless given.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Without pyvista, without the run's files, or with another suffix.
    SolverError
        Where the machine cannot draw; the message tells what to install.
    """
    return _render(Path(folder), Path(target), MOVING, size, scale, seconds=seconds, only=0.0)


def tooth_picture(
    folder: Path | str,
    target: Path | str,
    *,
    phase: float | None = None,
    size: tuple[int, int] = (1440, 960),
    scale: float | None = None,
) -> Path:
    """Draw the von Mises stress on the deformed teeth at one position.

    Parameters
    ----------
    folder : Path
        Of a run that wants ``vtk``.
    target : Path
        File to write: ``.png``, ``.jpg`` or ``.webp``.
    phase : float, optional
        Travel after a pair is at A [base pitches]; a pair at the pitch point unless given.
    size : tuple of int
        Width and height [pixels].
    scale : float, optional
        Factor of the displacements; chosen so that they show unless given.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError, SolverError
        As `animate_cycle` does.
    """
    return _render(Path(folder), Path(target), STILL, size, scale, seconds=0.0, only=phase)


def _render(
    folder: Path,
    target: Path,
    suffixes: tuple[str, ...],
    size: tuple[int, int],
    scale: float | None,
    seconds: float,
    only: float | None,
) -> Path:
    _check(folder, target, suffixes)
    import xarray as xr

    with xr.open_dataset(folder / "results.nc", engine="h5netcdf") as results, replacing(target) as beside:
        _in_a_process(_view(results, folder, beside, size, scale, seconds, only))
    return target


def _check(folder: Path, target: Path, suffixes: tuple[str, ...]) -> None:
    """Refuse, all at once, what cannot lead to a picture."""
    faults = []
    if target.suffix not in suffixes:
        faults.append(
            Fault(str(target), "", f"must end in {' or '.join(suffixes)}", "The suffix is the format")
        )
    missing = [name for name in ("results.nc", "mesh_cycle.pvd") if not (folder / name).is_file()]
    if missing:
        told = f"holds no {' and no '.join(missing)}"
        faults.append(Fault(str(folder), "", told, 'Run a scene that wants "vtk" into it'))
    if find_spec("pyvista") is None:
        faults.append(Fault("pyvista", "", "is not installed", "pip install 'flankfilm[pictures]'"))
    if faults:
        raise InputError(faults)


def _view(
    results: xr.Dataset,
    folder: Path,
    target: Path,
    size: tuple[int, int],
    scale: float | None,
    seconds: float,
    only: float | None,
) -> View:
    need(results, 'run a scene that wants "vtk" with this version', "field_point", "module", "base_radius")
    prefix = "lubricated" if "lubricated_phase" in results else "dry"
    error = results[f"{prefix}_transmission_error"].values
    if scale is None:
        scale = _round(SHOWN * float(results["module"]) / float(error.max()))
    if only is None:
        at_pitch = float(results["path_point_rho1"][2] - results["path_point_rho1"][0])
        only = at_pitch / float(results["base_pitch"]) % 1.0
    x, y = results["field_centre"].values.tolist()
    top = stress_of_nearly_all(results)
    step = _round(top / 3)
    ticks = math.ceil(top / step)
    return View(
        folder=str(folder.absolute()),
        target=str(target.absolute()),
        size=size,
        scale=scale,
        greatest=1e6 * step * ticks,
        ticks=ticks,
        centre=(x, y),
        reach=0.8 * float(results["field_reach"]),
        base_radius=float(results["base_radius"][0]),
        phase=tuple(results[f"{prefix}_phase"].values.tolist()),
        error=tuple(error.tolist()),
        seconds=seconds,
        only=only,
    )


def _round(value: float) -> float:
    """Largest of ..., 1, 2, 5, 10, ... that is not above a value."""
    ten = 10.0 ** math.floor(math.log10(value))
    return max(ten * n for n in (1, 2, 5) if ten * n <= value)


def _in_a_process(view: View) -> None:
    """Draw in a process of its own, which a missing OpenGL may kill."""
    command = [sys.executable, "-m", "flankfilm.figures.rendering"]
    try:
        done = subprocess.run(
            command,
            input=json.dumps(asdict(view)),
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            check=False,
        )
    except subprocess.TimeoutExpired as fault:
        raise SolverError(
            f"the picture was not drawn within {PATIENCE:.0f} s; ask for a smaller size"
        ) from fault
    if done.returncode == 0:
        return
    last = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "without a word"
    how = f"signal {-done.returncode}" if done.returncode < 0 else f"status {done.returncode}"
    raise SolverError(f"the process that draws ended with {how} ({shorten(last)}). {NO_OPENGL}")
