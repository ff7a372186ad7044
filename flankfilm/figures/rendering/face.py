"""Draws the loaded teeth in three dimensions: flanks with what they bear, both gears turning."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from flankfilm.figures.rendering.view import INK, View, bar_of, nearest, note_scale, steps, titled
from flankfilm.processes.current_folder import load_matplotlib

STEEL = "#c3c9cf"
BEHIND = 0.16
"""Opacity of the wheel, through which the pinion's flanks are seen."""

TOWARDS = np.array([-0.75, 0.42, 0.51])
"""From the pitch point to the eye: the pinion's loaded flanks, to the left of its teeth, are in view."""


IN_FRONT, LOWER = 0.005, 0.08
"""How far flanks are drawn before their teeth, and the middle of the picture below the pitch point, in reaches."""

OF_LOADS = ("pressure_Pa", "hertz_pressure_Pa", "line_load_N_per_m")
"""Fields that are zero where nothing bears, which stays bare."""


def draw_face(plotter: Any, view: View, at: float) -> None:
    """The position nearest to `at`: the pinion with a field on its flanks, the wheel as glass; replaces the one before.

    Parameters
    ----------
    plotter : pyvista.Plotter
    view : View
    at : float
        [base pitches]
    """
    load_matplotlib()
    import pyvista as pv

    chosen = steps(Path(view.folder))
    at = nearest(chosen, at)
    files = chosen[at]
    words, unit, factor = titled(view.field)
    # the pinion turns ahead by the deflection, as much exaggerated as the displacements
    turn = view.scale * float(np.interp(at, view.position, view.error)) / view.base_radius
    for name, angle, opacity in (("pinion", turn, 1.0), ("wheel", 0.0, BEHIND)):
        teeth = _moved(pv.read(files[name]), view.scale, angle)
        surface = teeth.extract_surface(algorithm="dataset_surface")
        plotter.add_mesh(
            surface, color=STEEL, opacity=opacity, name=name, smooth_shading=True, split_sharp_edges=True
        )
        edges = surface.extract_feature_edges(
            feature_angle=40, boundary_edges=False, non_manifold_edges=False
        )
        if edges.n_cells:
            width = view.size[1] / (700 if name == "pinion" else 1400)
            plotter.add_mesh(edges, color=INK, line_width=width, lighting=False, name=f"{name} outline")
    flanks = _moved(pv.read(files["pinion_flanks"]), view.scale, turn)
    away = TOWARDS / np.linalg.norm(TOWARDS)
    # along the line of sight, so that nothing but the order changes
    flanks.points = flanks.points + IN_FRONT * view.reach * away
    values = np.asarray(flanks[view.field])
    values = factor * (values if values.ndim == 1 else np.linalg.norm(values, axis=1))
    bare = (values == 0.0) & (view.field in OF_LOADS)
    flanks["shown"] = np.where(bare, np.nan, values)
    bar = bar_of(view, f"{words}{unit}", INK)
    plotter.add_mesh(
        flanks, scalars="shown", cmap="viridis", clim=(0.0, factor * view.greatest), lighting=False, name="flanks",
        nan_color=STEEL, scalar_bar_args=bar,
    )  # fmt: skip
    note_scale(plotter, view, INK)
    focus = np.array([*view.centre, 0.0]) - LOWER * view.reach * np.array([0.0, 1.0, 0.0])
    plotter.camera_position = [focus + 20.0 * view.face_width * away, focus, (0.0, 1.0, 0.0)]
    plotter.camera.parallel_scale = view.reach * view.size[1] / view.size[0]
    plotter.reset_camera_clipping_range()


def _moved(grid: Any, scale: float, angle: float) -> Any:
    """Move a grid by its displacements and ahead by an angle."""
    x, y = grid.points[:, 0], grid.points[:, 1]
    ahead = angle * np.column_stack([-y, x, np.zeros(grid.n_points)])
    grid.points = grid.points + scale * grid["displacement_m"] + ahead
    return grid
