"""Gears in mesh, and the stress in their teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.style import COLOURS, figure, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

    from fem.fields import GearField
    from flankfilm.stages.fields import FieldsStage
    from gears import GearPair

_SHADES = ("#dce9f5", "#f8e6d8")


def mesh(pair: GearPair) -> Figure:
    """Draw both gears with a pair at the pitch point: the whole, and the path of contact enlarged."""
    from gears.outline import outline

    placed = pair.placement(pair.points.C)
    shapes = [
        1e3 * place(outline(tooth, points_per_part=24))
        for place, tooth in zip((placed.pinion, placed.wheel), pair.teeth_profiles, strict=True)
    ]
    with styled():
        drawn = figure(height=4.4)
        whole, close = drawn.subplots(1, 2, width_ratios=(2, 3))
        for axes in (whole, close):
            for shape, colour, shade in zip(shapes, COLOURS, _SHADES, strict=False):
                axes.fill(*shape.T, facecolor=shade, edgecolor=colour, linewidth=0.8)
            axes.set_aspect("equal")
            axes.grid(visible=False)
            axes.set(xlabel="x [mm]")
        for centre, radius, colour in zip(
            (np.zeros(2), placed.wheel_centre), pair.bore_radii, COLOURS, strict=False
        ):
            turn = np.linspace(0, 2 * np.pi, 181)
            circle = 1e3 * (centre + radius * np.column_stack([np.cos(turn), np.sin(turn)]))
            whole.fill(*circle.T, facecolor="white", edgecolor=colour, linewidth=0.8)
        whole.set(ylabel="y [mm]")
        _path(close, pair)
    return drawn


def _path(axes: Axes, pair: GearPair) -> None:
    """Enlarge the mesh with the path of contact and its points."""
    points = {name: 1e3 * pair.placement(getattr(pair.points, name)).contact_point for name in "ABCDE"}
    line = np.array([points["A"], points["E"]])
    axes.plot(*line.T, color="black", linewidth=1.2)
    for name, at in points.items():
        axes.plot(*at, "o", color="black", markersize=3)
        axes.annotate(name, (float(at[0]), float(at[1])), xytext=(4, 4), textcoords="offset points")
    middle, reach = points["C"], 1.1 * float(np.linalg.norm(line[1] - line[0])) + 1e3 * pair.module
    axes.set(
        xlim=(middle[0] - reach, middle[0] + reach), ylim=(middle[1] - 0.8 * reach, middle[1] + 0.8 * reach)
    )


def von_mises(stage: FieldsStage) -> Figure:
    """Draw the von Mises stress of both gears around the mesh."""
    from matplotlib.tri import Triangulation

    fields = (stage.pinion, stage.wheel)
    focus, reach = _loaded_region(stage)
    top = max(_stress_of_nearly_all(field, focus, reach) for field in fields)
    with styled():
        drawn = figure(height=5.2)
        axes = drawn.subplots()
        painted = None
        for field in fields:
            near = np.linalg.norm(field.points[field.cells[:, 0]] - focus, axis=1) < 1.6 * reach
            corners = _quarters(field.cells[near])
            used, numbers = np.unique(corners, return_inverse=True)
            x, y = 1e3 * field.points[used].T
            grid = Triangulation(x, y, numbers.reshape(-1, 3))
            painted = axes.tripcolor(
                grid, 1e-6 * field.von_mises_Pa[used], shading="gouraud", cmap="viridis", vmin=0, vmax=1e-6 * top,
                rasterized=True,
            )  # fmt: skip
        assert painted is not None
        drawn.colorbar(painted, ax=axes, label="von Mises stress [MPa]", extend="max")
        axes.set_aspect("equal")
        axes.grid(visible=False)
        x, y = 1e3 * focus
        axes.set(
            xlim=(x - 1e3 * reach, x + 1e3 * reach),
            ylim=(y - 750 * reach, y + 750 * reach),
            xlabel="x [mm]",
            ylabel="y [mm]",
        )
    return drawn


def _loaded_region(stage: FieldsStage) -> tuple[NDArray[np.float64], float]:
    """Centre and half-width of the picture [m]: about three pitches around the highest stress."""
    field = stage.pinion
    focus = field.points[int(np.nanargmax(field.von_mises_Pa))]
    radius = float(np.linalg.norm(field.points, axis=1).max())
    teeth = np.unique(field.tooth).size
    return focus, 1.7 * 2 * np.pi * radius / teeth


def _stress_of_nearly_all(field: GearField, focus: NDArray[np.float64], reach: float) -> float:
    """Stress that 99.7 % of the pictured area stays below: the fillets count, the contacts do not."""
    corners = field.points[field.cells[:, :3]]
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    near = np.linalg.norm(corners[:, 0] - focus, axis=1) < reach
    area = np.where(near, np.abs(ux * vy - uy * vx), 0.0)
    stress = field.von_mises_Pa[field.cells].mean(axis=1)
    order = np.argsort(stress)
    below = np.cumsum(area[order])
    return float(stress[order][np.searchsorted(below, 0.997 * below[-1])])


def _quarters(cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """Split second-order triangles into four linear ones at their mid-side nodes."""
    a, b, c, ab, bc, ca = cells.T
    parts = ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))
    return np.concatenate([np.column_stack(part) for part in parts])
