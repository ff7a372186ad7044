"""Measured and worn flanks."""

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
    """Draw deviations of the flanks over the active profile, of each tooth and in the mean, and what wear has left.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run with ``deviations`` or ``wear`` of a gear.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    drawn = [gear for gear in GEARS if f"flank_{gear}_diameter" in results] or GEARS[:1]
    need(results, "run a scene that has deviations or wear of a gear", f"flank_{drawn[0]}_diameter")
    with sheet(style, 1, len(drawn), height=3.0, legend=0) as (found, panels):
        for gear, axes in zip(drawn, panels, strict=True):
            _of_gear(axes, results, gear)
            legend_over(axes, 2)
    return found


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
