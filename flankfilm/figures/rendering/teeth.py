"""Draws the loaded teeth with VTK, in a separate process: ``python -m flankfilm.figures.rendering.teeth``.

A machine without OpenGL ends the process that draws, with a signal rather than an exception; `animation` starts
this one, and reports what happened to it.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from flankfilm.figures.rendering.face import draw_face
from flankfilm.figures.rendering.view import INK, PAPER, View, bar_of, nearest, note_scale, steps, titled
from flankfilm.processes.current_folder import load_matplotlib

UNREADABLE = 2
"""Exit status where a file that is drawn cannot be read."""

COLOURS = 160
"""Colours of the scale in a GIF, which can hold 256 in all."""


def frames(view: View) -> Iterator[Any]:
    """Draw the positions, each as an array of pixels."""
    plotter = plotter_of(view, off_screen=True)
    for at in steps(Path(view.folder)) if view.seconds else [view.only]:
        draw(plotter, view, at)
        yield plotter.screenshot(return_img=True)
    plotter.close()


def plotter_of(view: View, **options: Any) -> Any:
    """Empty picture, seen from the front."""
    load_matplotlib()
    import pyvista as pv

    lights = "light kit" if view.face_width else "none"
    plotter = pv.Plotter(window_size=list(view.size), lighting=lights, **options)
    plotter.set_background(PAPER)
    plotter.enable_parallel_projection()
    return plotter


def show(view: View) -> None:
    """Open a window with a slider over the positions."""
    plotter, places = plotter_of(view), list(steps(Path(view.folder)))
    plotter.add_slider_widget(
        lambda value: draw(plotter, view, value), [places[0], places[-1]], value=nearest(places, view.only),
        title="base pitches from A", color=PAPER,
        pointa=(0.65, 0.93), pointb=(0.97, 0.93), title_height=0.02, fmt="%.3f",
    )  # fmt: skip
    plotter.show(title="flankfilm")


def draw(plotter: Any, view: View, at: float) -> None:
    """The position nearest to `at`: a field on the deformed teeth, and their outlines; replaces the one before."""
    if view.face_width:
        draw_face(plotter, view, at)
        return
    load_matplotlib()
    import pyvista as pv

    chosen = steps(Path(view.folder))
    at = nearest(chosen, at)
    files = chosen[at]
    words, unit, factor = titled(view.field)
    # the pinion turns ahead by the deflection, as much exaggerated as the displacements
    turn = view.scale * float(np.interp(at, view.position, view.error)) / view.base_radius
    for name, angle in (("pinion", turn), ("wheel", 0.0)):
        gear = pv.read(files[name])
        near = np.linalg.norm(gear.cell_centers().points[:, :2] - view.centre, axis=1) < 1.7 * view.reach
        gear = gear.extract_cells(np.flatnonzero(near))
        ahead = angle * np.column_stack([-gear.points[:, 1], gear.points[:, 0], np.zeros(gear.n_points)])
        gear.points = gear.points + view.scale * gear["displacement_m"] + ahead
        values = np.asarray(gear[view.field])
        gear["shown"] = factor * (values if values.ndim == 1 else np.linalg.norm(values, axis=1))
        surface = gear.extract_surface(nonlinear_subdivision=1, algorithm="dataset_surface")
        bar = bar_of(view, f"{words}{unit}", PAPER)
        plotter.add_mesh(
            surface, scalars="shown", cmap="viridis", clim=(0.0, factor * view.greatest), lighting=False, name=name,
            show_scalar_bar=name == "pinion", scalar_bar_args=bar if name == "pinion" else None,
        )  # fmt: skip
        edges = _outline(surface)
        if edges.n_cells:
            width = view.size[1] / 400
            plotter.add_mesh(edges, color=INK, line_width=width, lighting=False, name=f"{name} outline")
    note_scale(plotter, view, PAPER)
    x, y = view.centre
    plotter.camera_position = [(x, y, 1.0), (x, y, 0.0), (0.0, 1.0, 0.0)]
    plotter.camera.parallel_scale = view.reach * view.size[1] / view.size[0]


def _outline(surface: Any) -> Any:
    """Edges of a gear's outline: those of one cell alone, without the ones between cells of different sizes.

    Along the cuts between sectors, and where cells were split towards a contact, edges of one cell lie on longer or
    shorter ones of others; on the outline they touch others at their ends alone.
    """
    joined = surface.clean(tolerance=1e-7, absolute=True)
    edges = joined.extract_feature_edges(feature_edges=False, manifold_edges=False, non_manifold_edges=False)
    ends = edges.points[edges.lines.reshape(-1, 3)[:, 1:], :2]
    start, along = ends[:, 0], ends[:, 1] - ends[:, 0]
    square = np.maximum(np.sum(along**2, axis=1), 1e-30)
    alone = np.ones(len(ends), dtype=bool)
    for i, middle in enumerate(ends.mean(axis=1)):
        share = np.clip(np.sum((middle - start) * along, axis=1) / square, 0.0, 1.0)
        distance = np.sum((middle - start - share[:, None] * along) ** 2, axis=1)
        distance[i] = np.inf
        alone[i] = distance.min() > 0.04 * square[i]
    return edges.extract_cells(np.flatnonzero(alone))


def write(view: View) -> None:
    """Write the picture or the animation."""
    from PIL import Image

    pictures = [Image.fromarray(np.asarray(pixels)) for pixels in frames(view)]
    target = Path(view.target)
    if not view.seconds:
        pictures[0].save(target)
        return
    wait = round(1e3 * view.seconds / len(pictures))
    options: dict[str, Any] = {"quality": 80, "method": 4}
    if target.suffix == ".gif":
        palette, options = _palette(), {"optimize": True}
        pictures = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    first, *rest = pictures
    first.save(target, append_images=rest, save_all=True, duration=wait, loop=0, **options)


def _palette() -> Any:
    """One palette for all frames, so that colours do not flicker: the scale, and greys for text and outlines."""
    from matplotlib import colormaps
    from PIL import Image

    scale = colormaps["viridis"](np.linspace(0.0, 1.0, COLOURS))[:, :3]
    greys = np.repeat(np.linspace(0.1, 1.0, 256 - COLOURS)[:, None], 3, axis=1)
    holder = Image.new("P", (1, 1))
    holder.putpalette(np.rint(255 * np.concatenate([scale, greys])).astype(np.uint8).ravel().tolist())
    return holder


if __name__ == "__main__":
    asked = View(**json.load(sys.stdin))
    try:
        show(asked) if asked.window else write(asked)
    except (OSError, KeyError, ValueError, ElementTree.ParseError) as fault:
        print(f"{type(fault).__name__}: {fault}", file=sys.stderr)
        sys.exit(UNREADABLE)
