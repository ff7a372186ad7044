"""Pictures of the loaded teeth, and an animation of the mesh cycle, from the files that a run wrote for ParaView."""

from __future__ import annotations

import json
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array, Booleans, Faults, InputError, SolverError, shorten
from base.files import replacing
from flankfilm.figures.gear import stress_of_nearly_all
from flankfilm.figures.reading import need
from flankfilm.figures.rendering.teeth import UNREADABLE, draw, plotter_of
from flankfilm.figures.rendering.view import View, colour_steps, round_number, steps
from flankfilm.files.folder import readable
from flankfilm.files.manifest import changed
from flankfilm.processes.worker_processes import module, python

if TYPE_CHECKING:
    import xarray as xr

MOVING = (".gif", ".webp")
STILL = (".png", ".jpg", ".webp")

SHOWN = 0.12
"""What the maximum deflection is drawn as, in modules."""

STRESS, FLANKS_FIELD = "von_mises_Pa", "pressure_Pa"
"""Fields that are drawn unless one is asked for: of even loads, and of loads that vary along the face."""

EVEN, OVER_FACE = ("field_point", "pair_module"), ("path_point_place", "pair_module")
"""Variables without which there is no picture."""

IN_DEPTH, BESIDE_FACE = 0.44, 7.6
"""Half the width of a picture over the face: parts of the face width, and modules."""

PATIENCE = 600.0
"""Seconds that the drawing may take."""

NO_OPENGL = (
    "VTK needs OpenGL: install Mesa's software renderer (apt-get install libegl1 libgl1), or draw on a virtual screen "
    "(xvfb-run flankfilm animate ...), or open mesh_cycle.pvd in ParaView on another machine"
)


@dataclass(frozen=True)
class Frame:
    """How the loaded teeth are drawn.

    Parameters
    ----------
    size : tuple of int
        Width and height [pixels].
    scale : float, optional
        Factor of the displacements; chosen so that they show unless given.
    field : str, optional
        Field of the files for ParaView that gives the colours, such as ``displacement_m``; unless given the von Mises
        stress, ``von_mises_Pa``, or the pressure on the flanks, ``pressure_Pa``, where the load varies along the face.
    position : float, optional
        Base pitches from A, of the one picture or of the window's start; a pair at the pitch point unless given.
    """

    size: tuple[int, int] = (1440, 960)
    scale: float | None = None
    field: str | None = None
    position: float | None = None


def animate_cycle(
    folder: Path | str, target: Path | str, *, seconds: float = 2.0, frame: Frame = Frame(size=(720, 480))
) -> Path:
    """Draw one base pitch of the mesh cycle as an animation that repeats without a seam.

    Teeth are drawn deformed, and the pinion ahead by the transmission error, all by one factor that the picture names.

    Parameters
    ----------
    folder : Path
        Of a run that wants ``vtk``.
    target : Path
        File to write: ``.gif``, or ``.webp`` with all colours.
    seconds : float
        Length.
    frame : Frame
        Size, scale and field.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Without the run's files, with another suffix, or for a field that the files do not hold.
    SolverError
        Where the machine cannot draw; the message says what to install.
    """
    return _render(Path(folder), Path(target), MOVING, frame, seconds)


def tooth_picture(folder: Path | str, target: Path | str, *, frame: Frame = Frame()) -> Path:
    """Draw a field on the deformed teeth at one position into ``.png``, ``.jpg`` or ``.webp``.

    Parameters
    ----------
    folder, target, frame
        As of `animate_cycle`.

    Returns
    -------
    Path
        The file.
    """
    return _render(Path(folder), Path(target), STILL, frame)


def view_cycle(folder: Path | str, *, frame: Frame = Frame()) -> None:
    """Open a window with the fields of the mesh cycle, its positions under a slider; returns when it is closed.

    Parameters
    ----------
    folder, frame
        As of `animate_cycle`.
    """
    _in_a_process(replace(_view(Path(folder), frame), window=True), patience=None)


def teeth_scene(folder: Path | str, *, frame: Frame = Frame(size=(720, 480))) -> Any:
    """Loaded teeth at one position as a scene of pyvista, for notebooks: its ``show`` draws it in the cell.

    Parameters
    ----------
    folder, frame
        As of `animate_cycle`.

    Returns
    -------
    pyvista.Plotter
        VTK ends the process where OpenGL is missing.
    """
    view = _view(Path(folder), frame)
    plotter = plotter_of(view)
    draw(plotter, view, view.only)
    return plotter


def _render(
    folder: Path, target: Path, suffixes: tuple[str, ...], frame: Frame, seconds: float = 0.0
) -> Path:
    view = _view(folder, frame, target, suffixes)
    with replacing(target) as beside:
        _in_a_process(replace(view, target=str(beside.absolute()), seconds=seconds))
    return target


def check_files(folder: Path, target: Path | None, suffixes: tuple[str, ...]) -> None:
    """Refuse, all at once, what cannot lead to a picture: a folder without the files, a target of another suffix."""
    faults = Faults()
    if target is not None and target.suffix not in suffixes:
        faults.add(str(target), "", f"must end in {' or '.join(suffixes)}", "The suffix is the format")
    for name in changed(folder, "results.nc", "*.pvd", "*.vtu"):
        faults.add(
            str(folder / name), "", "is gone, or was changed since it was written", "Run the scene again"
        )
    missing = [name for name in ("results.nc", "mesh_cycle.pvd") if not (folder / name).is_file()]
    if missing:
        lacks = f"holds no {' and no '.join(missing)}"
        faults.add(str(folder), "", lacks, 'Run a scene that wants "vtk" into it')
    faults.raise_if_any()


def _view(folder: Path, frame: Frame, target: Path | None = None, suffixes: tuple[str, ...] = ()) -> View:
    """Check what is asked for, and read what the pictures of a run have in common."""
    check_files(folder, target, suffixes)
    with results_of(folder) as results:
        return _view_of(results, folder, frame)


@contextmanager
def results_of(folder: Path) -> Iterator[xr.Dataset]:
    """Open the results of a run; what libraries raise on damaged files becomes a fault of the folder."""
    import h5py
    import xarray as xr

    file = folder / "results.nc"
    with readable(folder):
        with h5py.File(file, "r") as whole:
            dict(whole.attrs)  # where this fails, h5netcdf's object would fail again as it is thrown away
        with xr.open_dataset(file, engine="h5netcdf") as results:
            yield results


def _view_of(results: xr.Dataset, folder: Path, frame: Frame) -> View:
    width = (
        float(results["pair_face_width"]) if "pinion_flanks" in next(iter(steps(folder).values())) else 0.0
    )
    need(results, 'run a scene that wants "vtk" with this version', *(OVER_FACE if width else EVEN))
    prefix = "lubricated" if "lubricated_position" in results else "dry"
    error = results[f"{prefix}_transmission_error"].values
    scale, position = frame.scale, frame.position
    if scale is None:
        scale = round_number(SHOWN * float(results["pair_module"]) / float(error.max()))
    if position is None:
        at_pitch = float(results["path_point_rho1"][2] - results["path_point_rho1"][0])
        position = at_pitch / float(results["pair_base_pitch"]) % 1.0
    names = results["path_point"].values.tolist()
    x, y = results["path_point_place"].values[names.index("C")].tolist()
    reach = (
        IN_DEPTH * width + BESIDE_FACE * float(results["pair_module"])
        if width
        else 0.8 * float(results["field_reach"])
    )
    field = frame.field or (FLANKS_FIELD if width else STRESS)
    step, ticks = _scale_of_colours(results, folder, field, over_face=width > 0.0)
    return View(
        folder=str(folder.absolute()),
        size=frame.size,
        scale=scale,
        greatest=step * ticks,
        ticks=ticks,
        centre=(x, y),
        reach=reach,
        base_radius=float(results["pair_base_radii"][0]),
        position=tuple(results[f"{prefix}_position"].values.tolist()),
        error=tuple(error.tolist()),
        only=position,
        field=field,
        face_width=width,
    )


def _scale_of_colours(results: xr.Dataset, folder: Path, field: str, *, over_face: bool) -> tuple[float, int]:
    """Step between the ticks of the scale of colours, and their number; from all but the peaks under contacts."""
    import pyvista as pv

    if field == STRESS and not over_face:
        top = max(1e6 * stress_of_nearly_all(results), _in_fillets(results, folder))
    else:
        each = list(steps(folder).values())
        chosen = each if over_face else each[:1]
        names = ("pinion_flanks",) if over_face else ("pinion", "wheel")
        grids = [pv.read(files[name]) for files in chosen for name in names]
        if missing := [grid for grid in grids if field not in grid.array_names]:
            held = ", ".join(missing[0].array_names)
            raise InputError.at("field", field, "must be a field of the files", f"Such as {held}")
        values = [np.asarray(grid[field]) for grid in grids]
        if (
            over_face and field in grids[0].cell_data
        ):  # pressures of tip edges are over widths that are assumed
            values = [pressure[grid["tip_edge"] == 0] for pressure, grid in zip(values, grids, strict=True)]
        sizes = np.abs(np.concatenate([v if v.ndim == 1 else np.linalg.norm(v, axis=1) for v in values]))
        top = float(np.nanquantile(sizes, 1.0 if over_face else 0.997)) or 1.0
    return colour_steps(top)


def _in_fillets(results: xr.Dataset, folder: Path) -> float:
    """Maximum von Mises stress below the flanks of the pictured teeth, over all positions [Pa]."""
    names = results["path_point"].values.tolist()
    pitch_point = results["path_point_place"].values[names.index("C")]
    centres = {"pinion": np.zeros(2), "wheel": results["outline_centre"].values[1]}
    # the lower half of the fillets, away from contacts at the form circle
    half_way = 0.5 * (results["pair_form_radii"].values + results["pair_root_radii"].values)
    below = dict(zip(centres, half_way.tolist(), strict=True))
    reach = float(results["field_reach"])

    def pictured(gear: str, place: Array) -> Booleans:
        near = np.linalg.norm(place - pitch_point, axis=1) < reach
        return np.asarray(near & (np.linalg.norm(place - centres[gear], axis=1) < below[gear]))

    return _stress_where(pictured, folder)


def _stress_where(wanted: Callable[[str, Array], Booleans], folder: Path) -> float:
    """Maximum von Mises stress at the places (n, 2) of either gear that are wanted, over all positions [Pa]."""
    import pyvista as pv

    largest = 0.0
    for files in steps(folder).values():
        for gear in ("pinion", "wheel"):
            grid = pv.read(files[gear])
            at = wanted(gear, np.asarray(grid.points)[:, :2])
            largest = max(largest, float(np.max(np.asarray(grid[STRESS])[at], initial=0.0)))
    return largest


def _in_a_process(view: View, patience: float | None = PATIENCE) -> None:
    """Draw in a separate process, which a missing OpenGL may kill."""
    command = python(*module("flankfilm.figures.rendering.teeth"))
    try:
        done = subprocess.run(
            command,
            input=json.dumps(asdict(view)),
            capture_output=True,
            text=True,
            timeout=patience,
            check=False,
        )
    except subprocess.TimeoutExpired as fault:
        raise SolverError(
            f"the picture was not drawn within {patience:.0f} s; ask for a smaller size"
        ) from fault
    if done.returncode == 0:
        return
    if done.returncode == UNREADABLE:
        why = done.stderr.strip().splitlines()[-1]
        raise InputError.at(
            view.folder, "", f"holds what cannot be read: {shorten(why)}", "Run the scene again"
        )
    last = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else "without a word"
    how = f"signal {-done.returncode}" if done.returncode < 0 else f"status {done.returncode}"
    raise SolverError(f"the process that draws ended with {how} ({shorten(last)}). {NO_OPENGL}")
