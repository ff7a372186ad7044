"""Gears in mesh, and the stress in their teeth and at their roots."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.panels import curves, over_path
from flankfilm.figures.reading import Reading, need, read, text, travel
from flankfilm.figures.style import Style, colours, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PAIR = "run a scene with a section [pair]"
VTK = 'run a scene that wants "vtk"'
FIELDS = ("field_point", "field_von_mises", "field_triangles", "field_centre", "field_reach")

SLIDING_SHOWN = 8.0
"""Largest specific sliding that the drawing shows."""

SHADES = ("#dce9f5", "#f8e6d8")


BODY = tuple(
    f"pair_{name}"
    for name in ("bore_radii", "root_radii", "rim_thicknesses", "web_thicknesses", "face_width")
)
"""What the drawing of a body takes."""


def gears_in_mesh(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw both gears with a pair at the pitch point: the whole, and the path of contact enlarged.

    The inside of a rim on a web is dashed.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has a pair of gears.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, PAIR, "outline_pinion", "outline_wheel", "path_point_place", *BODY)
    outlines = [read(results, f"outline_{name}") for name in ("pinion", "wheel")]
    centres, bores = (read(results, name).values for name in ("outline_centre", BODY[0]))
    with sheet(style, 2, width=3.9, height=5.6, sharex=False, height_ratios=(11, 9)) as (drawn, panels):
        whole, close = panels
        lines = colours(2)
        middle, reach = _path(close, results)
        for shape, colour, shade in zip(outlines, lines, SHADES, strict=True):
            look: dict[str, Any] = {
                "facecolor": shade,
                "edgecolor": colour,
                "linestyle": "-",
                "linewidth": 0.7,
            }
            _fill(whole, shape.values, **look)
            _fill(close, _nearby(shape.values, middle, reach), **look)
        turn = np.linspace(0, 2 * np.pi, 181)
        around = np.column_stack([np.cos(turn), np.sin(turn)])
        roots, rims, webs, width = (read(results, name).values for name in BODY[1:])
        for k, (centre, radius, colour) in enumerate(zip(centres, bores, lines, strict=True)):
            circle = centre + radius * around
            whole.fill(*circle.T, facecolor="#ffffff", edgecolor=colour, linestyle="-", linewidth=0.7)
            if webs[k] < width:
                inside = centre + (roots[k] - rims[k]) * around
                whole.plot(*inside.T, color=colour, linestyle="--", linewidth=0.7)
        for axes in (whole, close):
            axes.set_aspect("equal")
            axes.grid(visible=False)
            axes.set(ylabel=shape.named("y"))
        close.set(xlabel=shape.named("x"))
    return drawn


def _fill(axes: Axes, outline: Array, **look: Any) -> None:
    """Fill a closed outline; ``Axes.fill`` seeks limits among its sides one by one, as if they were curved."""
    from matplotlib.patches import Polygon

    axes.add_artist(Polygon(outline, closed=True, **look))
    axes.update_datalim(outline)
    axes.autoscale_view()


def _path(axes: Axes, results: xr.Dataset) -> tuple[Array, float]:
    """Draw the path of contact with its points; return middle and half-width of the picture [mm]."""
    names = results["path_point"].values.tolist()
    places = dict(zip(names, read(results, "path_point_place").values, strict=True))
    ends = np.array([places["A"], places["E"]])
    axes.plot(*ends.T, color="#000000", linewidth=1.2, zorder=3)
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    across = 10 * np.array([along[1], -along[0]])
    # B and D stand on the other side, drawn apart: the points may lie close together
    apart = 5 * along * (1 if (places["D"] - places["B"]) @ along >= 0 else -1)
    sides = {"B": -across - apart, "D": -across + apart}
    for name, at in places.items():
        axes.plot(*at, "o", color="#000000", markersize=3, zorder=3)
        side = sides.get(name, across)
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
    """Draw curvature radii and specific sliding along the path, and the flanks' velocities where the speed is known.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has a pair of gears.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, PAIR, "path_rho1", "path_rho2", "path_radius")
    at = travel(results, "path_rho1")
    speeds, slides = (f"path_{name}" in results for name in ("sliding", "specific_sliding"))
    radii = {"pinion, R1": "path_rho1", "wheel, R2": "path_rho2", "reduced, R": "path_radius"}
    rows = 1 + speeds + slides
    with sheet(style, rows, height=0.6 + 2.0 * rows) as (drawn, panels):
        curves(
            panels[0], at, {label: read(results, name) for label, name in radii.items()}, "curvature radius"
        )
        if speeds:
            mean, sliding = read(results, "path_entrainment"), read(results, "path_sliding")
            flanks = {"pinion, u1": 0.5, "wheel, u2": -0.5}
            velocities = {
                n: replace(mean, values=mean.values + part * sliding.values) for n, part in flanks.items()
            }
            velocities |= {mean.meaning: mean, sliding.meaning: sliding}
            curves(panels[1], at, velocities, "velocity")
            legend_over(panels[1], 4)
        if slides:
            _specific_sliding(panels[-1], at, read(results, "path_specific_sliding"))
        over_path(results, *panels)
    return drawn


def _specific_sliding(axes: Axes, at: Array, sliding: Reading) -> None:
    """Draw the specific sliding of both flanks."""
    names = "pinion, (u1 - u2)/u1", "wheel, (u2 - u1)/u2"
    flanks = {
        name: replace(sliding, values=values) for name, values in zip(names, sliding.values.T, strict=True)
    }
    curves(axes, at, flanks)
    # unbounded where a flank stands still, on its base circle
    axes.set_ylim(bottom=max(-SLIDING_SHOWN, 1.08 * float(sliding.values.min())))
    legend_over(axes, 2)


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

    need(results, VTK, *FIELDS)
    points, stress, centre, reach = (
        read(results, f"field_{name}") for name in ("point", "von_mises", "centre", "reach")
    )
    cells, half = results["field_triangles"].values, float(reach.values)
    with sheet(style, height=4.3) as (drawn, (axes,)):
        top = stress_of_nearly_all(results)
        x, y = points.values.T
        painted = axes.tripcolor(
            Triangulation(x, y, cells), stress.values, shading="gouraud", vmin=0.0, vmax=top, rasterized=True
        )
        # it ends at the panel's edge, and its limits take half the time of the picture
        painted.set_in_layout(False)
        drawn.colorbar(painted, ax=axes, label=stress.label, extend="max")
        axes.set_aspect("equal")
        axes.grid(visible=False)
        x, y = centre.values.tolist()
        axes.set(xlim=(x - half, x + half), ylim=(y - 0.75 * half, y + 0.75 * half))
        axes.set(xlabel=points.named("x"), ylabel=points.named("y"))
    return drawn


def root_stress(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw tension and compression at the roots of one tooth of each gear while it passes through the mesh.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``root-stress``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, 'run a scene that wants "root-stress"', "root_pinion_tension", "root_wheel_tension")
    with sheet(style, height=3.6) as (drawn, (axes,)):
        for i, (name, colour) in enumerate(zip(("pinion", "wheel"), colours(2), strict=True)):
            travel = read(results, f"root_{name}_travel")
            for what, dash in (("tension", "-"), ("compression", "--")):
                stress = {f"{name}, {what}": read(results, f"root_{name}_{what}")}
                curves(axes, travel.values, stress, "stress along the fillet", color=colour, linestyle=dash)
            if "iso6336_3_stresses" in results:
                nominal = float(read(results, "iso6336_3_stresses").values[i])
                # the outer point of single contact: of the wheel the travel runs the other way
                at = "the tip" if text(results, "iso6336_3_load_at") == "tip" else "DB"[i]
                axes.axhline(nominal, color=colour, linestyle=":", label=f"{name}, ISO 6336-3 at {at}")
        axes.axhline(0.0, color="black", linewidth=0.6)
        axes.set(xlabel=travel.label)
    return drawn


def stress_of_nearly_all(results: xr.Dataset) -> float:
    """Von Mises stress that 99.7 % of the pictured area stays below [MPa]."""
    need(results, VTK, *FIELDS)
    points, cells = results["field_point"].values, results["field_triangles"].values
    a, b, c = (points[cells[:, i]] for i in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    near = np.linalg.norm(a - results["field_centre"].values, axis=1) < float(results["field_reach"])
    area = np.where(near, np.abs(ux * vy - uy * vx), 0.0)
    mean = read(results, "field_von_mises").values[cells].mean(axis=1)
    return float(np.quantile(mean, 0.997, weights=area, method="inverted_cdf"))
