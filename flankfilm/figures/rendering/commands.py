"""Commands that draw."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, validators

from base import Faults


def view(
    results: Path,
    /,
    *,
    field: str | None = None,
    position: float | None = None,
    scale: float | None = None,
    out: Path | None = None,
    html: Annotated[bool, Parameter(negative="")] = False,
) -> int:
    """Show the fields in the folder RESULTS on the deformed teeth, in a window with a slider over the mesh cycle.

    Parameters
    ----------
    results : Path
        Folder of a run that wants vtk, or its scene file, whose run is in the folder of its name.
    field : str
        Field of the files for ParaView, such as displacement_m; the von Mises stress if left out. Where the load varies
        along the face: the pressure on the flanks if left out, line_load_N_per_m, gap_m.
    position : float
        Base pitches from A; a pair at the pitch point if left out.
    scale : float
        Factor of the displacements; so that they show if left out.
    out : Path
        Write a picture, .png, .jpg or .webp, instead of opening a window.
    html : bool
        Write a page that turns the pair in any browser without a network: to the file of --out, mesh_cycle.html in
        RESULTS if left out.
    """
    results = Path(f"{results.stem}-results") if results.suffix == ".toml" else results
    if html or (out is not None and out.suffix == ".html"):
        return _page(results, out, field=field, position=position, scale=scale)
    from flankfilm.figures.rendering.animation import Frame, tooth_picture, view_cycle

    frame = Frame(field=field, position=position, scale=scale)
    if out is None:
        view_cycle(results, frame=frame)
    else:
        print(f"{tooth_picture(results, out, frame=frame)} is written.")
    return 0


def _page(
    results: Path, out: Path | None, *, field: str | None, position: float | None, scale: float | None
) -> int:
    """Write the pair that turns as a page."""
    from flankfilm.figures.rendering.turning_page import write_turning

    faults = Faults()
    for name, value in (("--field", field), ("--position", position)):
        if value is not None:
            faults.add(name, f"{value}", "does not go with a page", "Leave it out; the page has a slider")
    faults.raise_if_any()
    target = write_turning(results, results / "mesh_cycle.html" if out is None else out, scale=scale)
    print(f"{target} is written: {target.stat().st_size / 1e3:.0f} kB")
    return 0


def animate(
    results: Path,
    /,
    *,
    out: Path | None = None,
    seconds: Annotated[float, Parameter(validator=validators.Number(gte=0.1, lte=600))] = 2.0,
    width: Annotated[int, Parameter(validator=validators.Number(gte=120, lte=4000))] = 720,
) -> int:
    """Draw the mesh cycle in the folder RESULTS as an animation: stress on the deformed teeth, or pressure on flanks.

    Parameters
    ----------
    results : Path
        Folder of a run that wants vtk.
    out : Path
        File to write, .gif or .webp; mesh_cycle.gif in RESULTS if left out.
    seconds : float
        Length of the animation.
    width : int
        Of the picture [pixels]; the height is two thirds of it.
    """
    from flankfilm.figures.rendering.animation import Frame, animate_cycle

    target = results / "mesh_cycle.gif" if out is None else out
    animate_cycle(results, target, seconds=seconds, frame=Frame(size=(width, 2 * width // 3)))
    print(f"{target}: {target.stat().st_size / 1e3:.0f} kB")
    return 0
