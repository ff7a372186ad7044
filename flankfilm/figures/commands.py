"""Commands that draw."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter, validators


def animate(
    results: Path,
    /,
    *,
    out: Annotated[
        Path | None, Parameter(help="File to write, .gif or .webp; mesh_cycle.gif in RESULTS if left out.")
    ] = None,
    seconds: Annotated[float, Parameter(validator=validators.Number(gte=0.1, lte=600))] = 2.0,
    width: Annotated[int, Parameter(validator=validators.Number(gte=120, lte=4000))] = 720,
) -> int:
    """Draw the mesh cycle in the folder RESULTS as an animation: stress on the deformed teeth.

    Parameters
    ----------
    results : Path
        Folder of a run that wants vtk.
    seconds : float
        Length of the animation.
    width : int
        Of the picture [pixels]; the height is two thirds of it.
    """
    from flankfilm.figures.animation import animate_cycle

    target = results / "mesh_cycle.gif" if out is None else out
    animate_cycle(results, target, seconds=seconds, size=(width, 2 * width // 3))
    print(f"{target}: {target.stat().st_size / 1e3:.0f} kB")
    return 0
