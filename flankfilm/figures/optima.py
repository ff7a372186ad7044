"""Points of an optimisation: how the best came about, or how objectives trade off."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.reading import need, titled
from flankfilm.figures.style import Style, colours, figure, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def optimum(found: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw every point: one objective over the evaluations, or each two of several against each other.

    Parameters
    ----------
    found : xarray.Dataset
        What ``optimum.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(found, "give the optimum.nc of an optimisation", "best", "fine")
    names = [str(name) for name in json.loads(found.attrs["objectives_json"])]
    pairs = list(itertools.combinations(names, 2))
    with styled(style):
        drawn = figure(7.0 if len(pairs) < 2 else 3.6 * min(3, len(pairs)), 3.6)
        panels = np.atleast_1d(drawn.subplots(1, max(1, len(pairs))))
        if not pairs:
            order = np.arange(1.0, found["best"].size + 1.0)
            _points(panels[0], found, order, found[names[0]].values)
            best = found["best"].values.astype(bool)
            panels[0].plot(
                order[best],
                found[names[0]].values[best],
                "*",
                color=colours(2)[1],
                markersize=11,
                label="best",
            )
            panels[0].set(xlabel="evaluation", ylabel=titled(found, names[0]))
        for axes, (first, second) in zip(panels, pairs, strict=False):
            _points(axes, found, found[first].values, found[second].values)
            _front(axes, found, first, second, "o-" if len(pairs) == 1 else "o")
            axes.set(xlabel=titled(found, first), ylabel=titled(found, second))
        drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3)
    return drawn


def _points(axes: Axes, found: xr.Dataset, x: NDArray[np.float64], y: NDArray[np.float64]) -> None:
    fine = found["fine"].values.astype(bool)
    for mask, colour, label in (
        (~fine, "#aaaaaa", "coarse tolerance"),
        (fine, colours(1)[0], "the scene's tolerance"),
    ):
        if mask.any():
            axes.plot(x[mask], y[mask], ".", color=colour, markersize=3, label=label)


def _front(axes: Axes, found: xr.Dataset, first: str, second: str, line: str) -> None:
    best = np.flatnonzero(found["best"].values)
    best = best[np.argsort(found[first].values[best])]
    axes.plot(
        found[first].values[best],
        found[second].values[best],
        line,
        color=colours(2)[1],
        markersize=4,
        label="front",
    )
