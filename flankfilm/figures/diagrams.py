"""Bifurcation diagram and dynamic factor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.motion import over_speed
from flankfilm.figures.reading import need, read
from flankfilm.figures.style import COLOURS, Style, colours, figure, legend_above, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MARKS = {"saddle-node": ("o", COLOURS[5]), "period-doubling": ("s", COLOURS[1]), "grazing": ("x", "#555555")}


def diagram(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw branches, stable solid and unstable dashed, with their special points; under them the forces.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``diagram``; over rpm where there is a scale, else over the frequency.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results, 'run a scene that wants "diagram"', "diagram_branch", "special_kind", "special_displacement"
    )
    forces = results["force_frequency"].size > 0
    with styled(style):
        drawn = figure(height=5.6 if forces else 3.6)
        grid = drawn.subplots(1 + forces, 1, sharex=True, squeeze=False).ravel()
        _branches(grid[0], results)
        if forces:
            _forces(grid[1], results)
        legend_above(drawn, grid[0])
        grid[-1].set(xlabel=over_speed(results, "diagram").label)
    return drawn


def _branches(axes: Axes, results: xr.Dataset) -> None:
    colour = colours(1)[0]
    number, stable = (results[f"diagram_{name}"].values for name in ("branch", "stable"))
    values, x = over_speed(results, "diagram").values, read(results, "diagram_displacement")
    for branch in np.unique(number):
        mine = number == branch
        for wanted, dash, width in ((True, "-", 1.4), (False, "--", 0.6)):
            keep = stable[mine].astype(bool) == wanted
            keep[1:] |= keep[:-1].copy()
            height = np.where(keep, x.values[mine], np.nan)
            axes.plot(values[mine], height, dash, color=colour, linewidth=width)
    kinds = results["special_kind"].values
    for kind, (mark, shade) in MARKS.items():
        mine = kinds == kind
        at = over_speed(results, "special").values[mine]
        height = results["special_displacement"].values[mine]
        axes.plot(at, height, mark, color=shade, markersize=3.5, linestyle="none", label=kind)
    axes.set(ylabel=x.label)


def _forces(axes: Axes, results: xr.Dataset) -> None:
    at, factor = over_speed(results, "force").values, read(results, "force_factor")
    first, second = colours(2)
    axes.plot(
        at,
        factor.values,
        ".",
        markersize=2.5,
        color=first,
        label="stable motions, periods 1 and 2",
    )
    standard = results["force_factor_iso6336"].values
    if np.any(np.isfinite(standard)):
        order = np.argsort(at)
        axes.plot(at[order], standard[order], color=second, label="K_v of ISO 6336-1, method B")
    axes.set(ylabel=factor.label)
    # above the panel: the curves leave no corner free for certain
    axes.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=2, borderaxespad=0.2)
