"""Measured and worn flanks, and measured leads."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flankfilm.figures.reading import need, read
from flankfilm.figures.style import MARK, Style, colours, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

GEARS = ("pinion", "wheel")


def flanks(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw deviations of the flanks over the active profile, of each tooth and in the mean, wear, and leads.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``deviations`` or ``wear`` of a gear.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    drawn = [
        (draw, gear)
        for draw, along in ((_of_gear, "diameter"), (_lead, "face_place"))
        for gear in GEARS
        if f"flank_{gear}_{along}" in results
    ]
    if not drawn:
        need(results, "run a scene that has deviations or wear of a gear", f"flank_{GEARS[0]}_diameter")
    rows, columns = (len(drawn) + 1) // 2, min(len(drawn), 2)
    with sheet(style, rows, columns, height=3.0 * rows, legend=0, sharex=False) as (figure, panels):
        for (draw, gear), axes in zip(drawn, panels, strict=False):
            draw(axes, results, gear)
            legend_over(axes, 2)
        for axes in panels[len(drawn) :]:
            axes.remove()
    return figure


def _lead(axes: Axes, results: xr.Dataset, gear: str) -> None:
    """Draw the measured lead of a gear."""
    place, lead = (read(results, f"flank_{gear}_{name}") for name in ("face_place", "lead"))
    axes.plot(place.values, lead.values, color=colours(1)[0], linestyle="-", label="lead of all teeth")
    axes.set(xlabel=place.label, ylabel=lead.named(f"material in excess, {gear}"))


def _of_gear(axes: Axes, results: xr.Dataset, gear: str) -> None:
    """Draw the flanks of a gear: material in excess, and less what is worn."""
    prefix = f"flank_{gear}"
    diameter = read(results, f"{prefix}_diameter")
    looks = dict(zip(("material", "wear"), colours(2), strict=True))
    for name, sign, label in (("material", 1.0, "deviation, mean"), ("wear", -1.0, "wear, mean")):
        if f"{prefix}_mean_{name}" not in results:
            continue
        if f"{prefix}_{name}" in results:
            each = sign * read(results, f"{prefix}_{name}").values.T
            axes.plot(diameter.values, each, color=MARK, linestyle="-", linewidth=0.4)
        mean = read(results, f"{prefix}_mean_{name}")
        axes.plot(diameter.values, sign * mean.values, color=looks[name], linestyle="-", label=label)
        axes.set(ylabel=mean.named(f"material in excess, {gear}"))
    axes.set(xlabel=diameter.label)
