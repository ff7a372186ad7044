"""Load along the lines of contact of a helical pair: flanks developed into the plane of action, centre of the load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.panels import over_path
from flankfilm.figures.plane_of_action import HELICAL
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import from_zero, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flankfilm.figures.style import Style

PREFIX = "dry_lines"
"""Prefix of what the lines of contact carry without a film."""

MAPS = ("line_load", "hertz_pressure")
"""Figures of the cells that are painted."""

GRID = (240, 120)
"""Points of the map along path and face."""


def line_load_map(results: xr.Dataset, *, prefix: str = PREFIX, style: Style | None = None) -> Figure:
    """Draw line load and Hertz pressure over path and face, of all positions together.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has the mesh cycle of a helical pair.
    prefix : str
        Of the variables of ``fem.LineLoads``.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    names = [f"{prefix}_{name}" for name in ("travel", "z", *MAPS)]
    need(results, HELICAL, *names, "pair_face_width", "path_point_rho1")
    travel, z = (read(results, name).values.ravel() for name in names[:2])
    half = 0.5 * float(read(results, "pair_face_width").values)
    with sheet(style, len(MAPS), height=2.6 * len(MAPS), legend=0) as (drawn, panels):
        for name, axes in zip(MAPS, panels, strict=True):
            shown = read(results, f"{prefix}_{name}")
            _paint(axes, travel, z, shown.values.ravel(), shown.label, half)
        over_path(results, *panels)
    return drawn


def _paint(axes: Axes, travel: Array, z: Array, values: Array, label: str, half: float) -> None:
    """Paint cells of lines of all positions, between which values are interpolated; white where flanks stand clear."""
    from scipy.interpolate import griddata

    known = np.isfinite(values)
    size = np.array([np.ptp(travel[known]), 2.0 * half])
    places = np.column_stack([travel[known], z[known]]) / size
    along = np.linspace(travel[known].min(), travel[known].max(), GRID[0])
    face = np.linspace(-half, half, GRID[1])
    asked = np.stack(np.meshgrid(along / size[0], face / size[1]), axis=-1)
    painted = griddata(places, values[known], asked, method="nearest")
    shown = axes.pcolormesh(
        along, face, np.where(painted > 0.0, painted, np.nan), vmin=0.0, shading="nearest", rasterized=True
    )
    figure = axes.get_figure()
    assert figure is not None
    figure.colorbar(shown, ax=axes, label=label)
    axes.grid(visible=False)
    axes.set(ylabel="place on the\nface [mm]", ylim=(-half, half))


def load_centre(results: xr.Dataset, *, prefix: str = PREFIX, style: Style | None = None) -> Figure:
    """Draw the centre of the load and the line-load factor over the mesh cycle.

    Parameters
    ----------
    results, prefix, style
        As of `line_load_map`.
    """
    need(results, HELICAL, *(f"{prefix}_{name}" for name in ("load_centre", "line_load_factor")))
    centre, factor = (read(results, f"{prefix}_{name}") for name in ("load_centre", "line_load_factor"))
    position = read(results, "dry_position" if "dry_position" in results else f"{prefix}_position")
    with sheet(style, 2, height=4.0, legend=0) as (drawn, (above, below)):
        above.plot(position.values, centre.values, **looks(1)[0])
        above.axhline(0.0, color="#000000", linewidth=0.8)
        above.set(ylabel=f"centre of\nthe load [{centre.unit}]")
        below.plot(position.values, factor.values, **looks(1)[0])
        below.set(xlabel=position.label, ylabel="maximum line load\nover the mean", xlim=(0.0, 1.0))
        from_zero(below)
    return drawn
