"""Lines of contact of a helical pair in the plane of action: where they lie, how long they are, what they carry."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from base import Array
from flankfilm.figures.face import TIMES_LEAST
from flankfilm.figures.panels import over_path
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import colours, from_zero, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flankfilm.figures.style import Style

HELICAL = "run a scene whose pair has a helix angle"
HELICAL_FILM = "run a scene with a film whose pair has a helix angle"
NAMES = ("length", "position", "mean", "shown_position", "shown_travel", "shown_face")

LEVEL = 1e-9
"""Change of the total length over its mean below which it is level, as at a whole overlap ratio."""

PREFIX = "dry_lines"
"""Prefix of what the lines of contact carry without a film."""

MAPS = ("line_load", "hertz_pressure")
"""Figures of the cells that are painted."""

GRID = (240, 120)
"""Points of the map along path and face."""


def lines_of_contact(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the lines of contact over path and face at some positions, and their total length over the mesh cycle.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that has a helical pair.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, HELICAL, *(f"contact_lines_{name}" for name in NAMES), "pair_face_width")
    position, length, mean = (
        read(results, f"contact_lines_{name}") for name in ("position", "length", "mean")
    )
    shown = np.unique(read(results, "contact_lines_shown_position").values)
    with sheet(style, 2, height=5.2, sharex=False, height_ratios=(3, 2)) as (drawn, panels):
        plane, cycle = panels
        _plane(plane, results, shown)
        over_path(results, plane)
        cycle.plot(position.values, length.values, **looks(1)[0] | {"color": "#000000"})
        cycle.axhline(float(mean.values), color="#000000", linestyle=":", linewidth=0.8)
        for at, colour in zip(shown.tolist(), colours(len(shown)), strict=True):
            there = float(np.interp(at, position.values, length.values))
            cycle.plot(at, there, "o", color=colour, markersize=5, zorder=3, clip_on=False)
        cycle.annotate(
            "mean", (1.0, float(mean.values)), xytext=(4, 0), textcoords="offset points", va="center",
            annotation_clip=False,
        )  # fmt: skip
        cycle.set(xlabel=position.label, ylabel=length.label, xlim=(0.0, 1.0))
        if np.ptp(length.values) < LEVEL * float(mean.values):  # no scale of rounding
            cycle.set_ylim(0.95 * float(mean.values), 1.05 * float(mean.values))
    return drawn


def _plane(axes: Axes, results: xr.Dataset, shown: np.ndarray) -> None:
    """Draw the plane of action with the lines of each position in a colour."""
    at = read(results, "contact_lines_shown_position").values
    travel, face = (read(results, f"contact_lines_shown_{name}") for name in ("travel", "face"))
    half = 0.5 * float(read(results, "pair_face_width").values)
    for place, look in zip(shown.tolist(), looks(len(shown)), strict=True):
        for number in np.flatnonzero(at == place):
            label = f"position {place:g}" if number == np.flatnonzero(at == place)[0] else None
            axes.plot(travel.values[number], face.values[number], label=label, **look)
    axes.axhline(-half, color="#000000", linewidth=0.8)
    axes.axhline(half, color="#000000", linewidth=0.8)
    axes.set(ylabel="place along the face [mm]", ylim=(-1.06 * half, 1.06 * half))


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


def film_line_map(results: xr.Dataset, *, prefix: str = "film_lines", style: Style | None = None) -> Figure:
    """Draw minimum film and Hertz pressure with films over path and face, of all positions together.

    Films of cells that bear little are many times as thick: colours end half as thick again as the smallest. At ends
    of lines of contact, which the smallest leaves out, films may be thinner.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with a film whose pair has a helix angle.
    prefix : str
        Of the variables of ``flankfilm.coupling.LineFilms``.
    style : mapping, optional
        rcParams that overrule the house's; ``image.cmap`` is the scale of colours.
    """
    names = ("travel", "z", "minimum_thickness", "hertz_pressure", "least_film")
    needed = [f"{prefix}_{name}" for name in names]
    need(results, HELICAL_FILM, *needed, "path_point_rho1")
    travel, z, film, pressure, least = (read(results, name) for name in needed)
    half, thin = float(np.nanmax(np.abs(z.values))), float(least.values)
    most = min(TIMES_LEAST * thin, float(np.nanmax(film.values)))
    with sheet(style, 2, height=5.2, legend=0) as (drawn, panels):
        for axes, shown, span in (
            (panels[0], film.named("minimum film"), (thin, most)),
            (panels[1], pressure.named("Hertz pressure"), None),
        ):
            values = film.values if span is not None else pressure.values
            _paint(axes, travel.values.ravel(), z.values.ravel(), values.ravel(), shown, half, span)
        over_path(results, *panels)
    return drawn


def _paint(
    axes: Axes,
    travel: Array,
    z: Array,
    values: Array,
    label: str,
    half: float,
    span: tuple[float, float] | None = None,
) -> None:
    """Paint cells of lines of all positions, between which values are interpolated; white where flanks stand clear.

    Over a span that counts, if there is one.
    """
    from scipy.interpolate import griddata

    known = np.isfinite(values)
    size = np.array([np.ptp(travel[known]), 2.0 * half])
    places = np.column_stack([travel[known], z[known]]) / size
    along = np.linspace(travel[known].min(), travel[known].max(), GRID[0])
    face = np.linspace(-half, half, GRID[1])
    asked = np.stack(np.meshgrid(along / size[0], face / size[1]), axis=-1)
    painted = griddata(places, values[known], asked, method="nearest")
    low, high = (0.0, None) if span is None else span
    shown = axes.pcolormesh(
        along,
        face,
        np.where(painted > 0.0, painted, np.nan),
        vmin=low,
        vmax=high,
        shading="nearest",
        rasterized=True,
    )
    figure = axes.get_figure()
    assert figure is not None
    figure.colorbar(shown, ax=axes, label=label, extend="neither" if span is None else "both")
    axes.grid(visible=False)
    axes.set(ylabel="place on the\nface [mm]", ylim=(-half, half))


def load_centre(results: xr.Dataset, *, prefix: str = PREFIX, style: Style | None = None) -> Figure:
    """Draw the centre of the load and the line-load factor over the mesh cycle.

    Parameters
    ----------
    results, prefix, style
        As of `line_load_map`.
    """
    need(results, HELICAL, *(f"{prefix}_{name}" for name in ("position", "load_centre", "line_load_factor")))
    centre, factor = (read(results, f"{prefix}_{name}") for name in ("load_centre", "line_load_factor"))
    position = read(results, f"{prefix}_position")
    with sheet(style, 2, height=4.0, legend=0) as (drawn, (above, below)):
        above.plot(position.values, centre.values, **looks(1)[0])
        above.axhline(0.0, color="#000000", linewidth=0.8)
        above.set(ylabel=f"centre of\nthe load [{centre.unit}]")
        below.plot(position.values, factor.values, **looks(1)[0])
        below.set(xlabel=position.label, ylabel="maximum line load\nover the mean [-]", xlim=(0.0, 1.0))
        from_zero(below)
    return drawn
