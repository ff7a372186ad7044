"""Gears in mesh, and the stress in their teeth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.reading import PATH_LABEL, mark_path, need, travel
from flankfilm.figures.style import Style, colours, figure, legend_above, looks, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]

SHADES = ("#dce9f5", "#f8e6d8")


def gears_in_mesh(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw both gears with a pair at the pitch point: the whole, and the path of contact enlarged.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has a pair of gears.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "run a scene with a section [pair]", "outline_pinion", "outline_wheel", "path_point_place")
    outlines = [1e3 * results[f"outline_{name}"].values for name in ("pinion", "wheel")]
    with styled(style):
        drawn = figure(height=4.4)
        whole, close = drawn.subplots(1, 2, width_ratios=(2, 3))
        lines = colours(2)
        middle, reach = _path(close, results)
        for shape, colour, shade in zip(outlines, lines, SHADES, strict=True):
            look = {"facecolor": shade, "edgecolor": colour, "linestyle": "-", "linewidth": 0.7}
            whole.fill(*shape.T, **look)
            close.fill(*_nearby(shape, middle, reach).T, **look)
        for centre, radius, colour in zip(
            1e3 * results["gear_centre"].values, 1e3 * results["bore_radius"].values, lines, strict=True
        ):
            turn = np.linspace(0, 2 * np.pi, 181)
            circle = centre + radius * np.column_stack([np.cos(turn), np.sin(turn)])
            whole.fill(*circle.T, facecolor="#ffffff", edgecolor=colour, linestyle="-", linewidth=0.7)
        for axes in (whole, close):
            axes.set_aspect("equal")
            axes.grid(visible=False)
            axes.set(xlabel="x [mm]")
        whole.set(ylabel="y [mm]")
    return drawn


def _path(axes: Axes, results: xr.Dataset) -> tuple[Array, float]:
    """Draw the path of contact with its points; return middle and half-width of the picture [mm]."""
    names = [str(name) for name in results["path_point_name"].values]
    places = dict(zip(names, 1e3 * results["path_point_place"].values, strict=True))
    ends = np.array([places["A"], places["E"]])
    axes.plot(*ends.T, color="#000000", linewidth=1.2, zorder=3)
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = 10 * np.array([along[1], -along[0]])
    for name, at in places.items():
        axes.plot(*at, "o", color="#000000", markersize=3, zorder=3)
        # B and D stand on the other side: the points may lie close together
        side = across if name in "ACE" else -across
        axes.annotate(
            name, (float(at[0]), float(at[1])), xytext=(float(side[0]), float(side[1])),
            textcoords="offset points", ha="center", va="center", color="#000000", zorder=4,
        )  # fmt: skip
    middle = places["C"]
    reach = 0.75 * float(np.linalg.norm(ends[1] - ends[0])) + 0.1 * float(np.ptp(ends))
    axes.set(
        xlim=(middle[0] - reach, middle[0] + reach), ylim=(middle[1] - 0.8 * reach, middle[1] + 0.8 * reach)
    )
    return middle, reach


def _nearby(shape: Array, middle: Array, reach: float) -> Array:
    """Part of a closed outline around the enlarged picture, closed through a point behind it."""
    near = np.linalg.norm(shape - middle, axis=1) < 2.0 * reach
    if near.all():
        return shape
    start = int(np.flatnonzero(near & ~np.roll(near, 1))[0])
    kept = np.roll(shape, -start, axis=0)[np.roll(near, -start)]
    behind = 2.0 * reach * np.sign(shape.mean(axis=0)[1] - middle[1])
    corners = np.array([[kept[-1][0], middle[1] + behind], [kept[0][0], middle[1] + behind]])
    return np.concatenate([kept, corners])


def kinematics(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw curvature radii along the path of contact, and the velocities of the flanks where the speed is known.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has a pair of gears.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "run a scene with a section [pair]", "kinematic_rho1", "path_point_rho1")
    at, known = travel(results, "kinematic_rho1"), "kinematic_sliding" in results
    radii = {"rho1": "pinion, R1", "rho2": "wheel, R2", "radius": "reduced, R"}
    mean, sliding = (
        (results["kinematic_entrainment"].values, results["kinematic_sliding"].values) if known else (at, at)
    )
    velocities = {
        "pinion, u1": mean + sliding / 2,
        "wheel, u2": mean - sliding / 2,
        "entrainment, (u1 + u2)/2": mean,
        "sliding, u1 - u2": sliding,
    }
    with styled(style):
        drawn = figure(height=4.8 if known else 2.6)
        panels = drawn.subplots(1 + known, 1, sharex=True, squeeze=False).ravel().tolist()
        for (name, label), look in zip(radii.items(), looks(3), strict=True):
            panels[0].plot(at, 1e3 * results[f"kinematic_{name}"].values, label=label, **look)
        panels[0].set(ylabel="curvature radius [mm]")
        legend_above(drawn, panels[0])
        if known:
            for (label, speed), look in zip(velocities.items(), looks(4), strict=True):
                panels[1].plot(at, speed, label=label, **look)
            panels[1].set(ylabel="velocity [m/s]")
            panels[1].legend(
                loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=4, borderaxespad=0.2, handlelength=2.6
            )
        panels[-1].set(xlabel=PATH_LABEL)
        mark_path(results, panels, panels[0])
    return drawn


def tooth_stress(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the von Mises stress of both gears around the mesh, with a pair at the pitch point.

    The scale ends at the stress that 99.7 % of the pictured area stays below: fillets count, contacts do not.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``vtk``.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    from matplotlib.tri import Triangulation

    need(results, 'run a scene that wants "vtk"', "field_point", "field_von_mises", "field_triangles")
    points, cells = 1e3 * results["field_point"].values, results["field_triangles"].values
    stress, centre = 1e-6 * results["field_von_mises"].values, 1e3 * results["field_centre"].values
    reach = 1e3 * float(results["field_reach"])
    with styled(style):
        drawn = figure(height=4.3)
        axes = drawn.subplots()
        top = stress_of_nearly_all(results)
        x, y = points.T
        painted = axes.tripcolor(
            Triangulation(x, y, cells), stress, shading="gouraud", vmin=0.0, vmax=top, rasterized=True
        )
        drawn.colorbar(painted, ax=axes, label="von Mises stress [MPa]", extend="max")
        axes.set_aspect("equal")
        axes.grid(visible=False)
        x, y = centre.tolist()
        axes.set(xlim=(x - reach, x + reach), ylim=(y - 0.75 * reach, y + 0.75 * reach))
        axes.set(xlabel="x [mm]", ylabel="y [mm]")
    return drawn


def stress_of_nearly_all(results: xr.Dataset) -> float:
    """Von Mises stress that 99.7 % of the pictured area stays below [MPa]."""
    need(results, 'run a scene that wants "vtk"', "field_point", "field_von_mises", "field_triangles")
    points, cells = results["field_point"].values, results["field_triangles"].values
    a, b, c = (points[cells[:, i]] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    near = np.linalg.norm(a - results["field_centre"].values, axis=1) < float(results["field_reach"])
    area = np.where(near, np.abs(ux * vy - uy * vx), 0.0)
    mean = results["field_von_mises"].values[cells].mean(axis=1)
    order = np.argsort(mean)
    below = np.cumsum(area[order])
    return 1e-6 * float(mean[order][np.searchsorted(below, 0.997 * below[-1])])
