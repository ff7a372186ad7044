"""The loaded pair that turns in a browser: a part of a report, or a page by itself, without a network."""

from __future__ import annotations

import json
from dataclasses import replace
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from base.files import replacing
from flankfilm.figures.rendering.animation import check_files, results_of
from flankfilm.figures.rendering.turning import Turning, turning
from flankfilm.figures.rendering.view import steps

if TYPE_CHECKING:
    import xarray as xr

__all__ = ["from_files", "inset", "page", "write_turning"]

FILES = resources.files("flankfilm.figures.rendering")
"""Templates and scripts."""

STRESS = (
    "Von Mises stress; the last colour is for all above the end of the scale, such as under the contacts."
)
DISPLACEMENT = "Size of the displacement, since stress is not found where the load varies along the face."
"""What the colours show."""


def inset(shown: Turning) -> str:
    """HTML of the view, for a page that has the report's colours; it begins when a fold around it is opened."""
    head = shown.head
    names = ("turning.js", "turning_controls.js")
    return _filled(
        "turning.html.j2",
        title=head["field"],
        head=head,
        colours=STRESS if head["stress"] > 0.0 else DISPLACEMENT,
        load=f"{1e-3 * head['loads']['largest']:.3g} N/mm",
        head_json=json.dumps(head, separators=(",", ":")),
        packed=shown.packed,
        script="".join(FILES.joinpath(name).read_text(encoding="utf-8") for name in names),
    )


def _filled(template: str, **words: Any) -> str:
    import jinja2

    house = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return str(house.from_string(FILES.joinpath(template).read_text(encoding="utf-8")).render(**words))


def page(shown: Turning, title: str) -> str:
    """HTML of a page that holds the view alone."""
    return _filled("turning_page.html.j2", title=title, inset=inset(shown))


def write_turning(folder: Path | str, target: Path | str, *, scale: float | None = None) -> Path:
    """Write a page on which the loaded pair of a run turns over its mesh cycle; a browser shows it without a network.

    Parameters
    ----------
    folder : Path
        Of a run that wants ``vtk``.
    target : Path
        File to write, ``.html``.
    scale : float, optional
        Factor of the displacements that the page begins with; chosen so that they show unless given.

    Returns
    -------
    Path
        The file.

    Raises
    ------
    InputError
        Without the run's files, or with another suffix.
    """
    folder, target = Path(folder), Path(target)
    check_files(folder, target, (".html",))
    with results_of(folder) as results:
        shown = from_files(folder, results)
        title = str(results.attrs.get("title") or folder.absolute().name)
    head = shown.head if scale is None else shown.head | {"scale": scale}
    with replacing(target) as beside:
        beside.write_text(page(replace(shown, head=head), title), encoding="utf-8")
    return target


def from_files(folder: Path, results: xr.Dataset) -> Turning:
    """Read the surfaces back from the files that a run wrote for ParaView."""
    import pyvista as pv

    from fem.fields.surface_frames import Surfaces

    width, teeth, frames = float(results["pair_face_width"]), None, []
    centre = results["outline_centre"].values[1]
    places = steps(folder)
    for files in places.values():
        grids = {name: pv.read(file) for name, file in files.items()}
        teeth = teeth or Surfaces.of(grids, centre, width)
        frames.append(teeth.frame(grids))
    assert teeth is not None  # a series has steps
    return turning(list(places), frames, teeth, results)
