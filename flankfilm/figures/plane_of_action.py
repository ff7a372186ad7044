"""Lines of contact of a helical pair in the plane of action, and their total length over the mesh cycle."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.panels import over_path
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import colours, looks, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from flankfilm.figures.style import Style

HELICAL = "run a scene whose pair has a helix angle"
NAMES = ("length", "position", "mean", "shown_position", "shown_travel", "shown_face")

LEVEL = 1e-9
"""Change of the total length over its mean below which it is level, as at a whole overlap ratio."""


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
