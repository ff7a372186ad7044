"""Points of an optimisation, and the map of its objectives where two keys vary."""

from __future__ import annotations

import itertools
import json
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from base import Array
from flankfilm.figures.reading import key_title, need, titled
from flankfilm.figures.style import Style, colours, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.tri import Triangulation

WORST = 0.9
"""Quantile of the objective up to which a map is coloured: far from the best it would take all the colours."""

LEVELS = 12
"""Most steps of a map's colours."""


def optimum(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw every point: one objective over the evaluations, or each two of several against each other.

    Parameters
    ----------
    results : xarray.Dataset
        What ``optimum.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, "give the optimum.nc of an optimisation", "best", "fine")
    names = [str(name) for name in json.loads(results.attrs["objectives_json"])]
    best = np.flatnonzero(results["best"].values)
    if len(names) == 1:
        (name,) = names
        order, y = np.arange(1.0, results["best"].size + 1.0), results[name].values
        with sheet(style, height=3.6) as (drawn, (axes,)):
            _points(axes, results, order, y)
            axes.plot(order[best], y[best], "*", color=colours(2)[1], markersize=11, label="best")
            axes.set(xlabel="evaluation", ylabel=titled(results, name))
        return drawn
    pairs = list(itertools.combinations(names, 2))
    width = 7.0 if len(pairs) < 2 else 3.6 * min(3, len(pairs))
    with sheet(style, 1, len(pairs), width=width, height=3.6) as (drawn, panels):
        for axes, pair in zip(panels, pairs, strict=True):
            first, second = (results[name].values for name in pair)
            _points(axes, results, first, second)
            front, line = best[np.argsort(first[best])], "o-" if len(pairs) == 1 else "o"
            axes.plot(first[front], second[front], line, color=colours(2)[1], markersize=4, label="front")
            axes.set(xlabel=titled(results, pair[0]), ylabel=titled(results, pair[1]))
    return drawn


def _points(axes: Axes, evaluations: xr.Dataset, x: Array, y: Array) -> None:
    fine = evaluations["fine"].values.astype(bool)
    for mask, colour, label in (
        (~fine, "#aaaaaa", "coarse tolerance"),
        (fine, colours(1)[0], "the scene's tolerance"),
    ):
        if mask.any():
            axes.plot(x[mask], y[mask], ".", color=colour, markersize=3, label=label)


def can_be_mapped(evaluations: xr.Dataset) -> bool:
    """Whether two keys vary, and the points lie spread over them."""
    return len(json.loads(evaluations.attrs["vary_json"])) == 2 and _grid(evaluations).size > 0


def optimum_map(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw every objective over the two keys that vary, with the limits, the start, the best, and what ties.

    The colours lie between the points that were computed (linear over Delaunay's triangles), at either tolerance.

    Parameters
    ----------
    results : xarray.Dataset
        What ``optimum.nc`` holds.
    style : mapping, optional
        rcParams that overrule the house's.

    Raises
    ------
    ValueError
        Where not two keys vary, or no three points span a triangle.
    """
    need(results, "give the optimum.nc of an optimisation", "best", "fine", "allowed", "tied")
    if not can_be_mapped(results):
        raise ValueError("a map needs two keys that vary, and points that do not lie on one line")
    names = [str(name) for name in json.loads(results.attrs["objectives_json"])]
    signs = json.loads(results.attrs["signs_json"])
    height = 4.2 * len(names) + 0.5
    with sheet(style, len(names), legend=3, sharex=False, width=6.4, height=height) as (drawn, panels):
        for axes, name, sign in zip(panels, names, signs, strict=True):
            _map(axes, results, name, sign)
    return drawn


def _places(evaluations: xr.Dataset) -> tuple[dict[str, list[float]], Array]:
    """Ranges of both keys, and the points in parts of them."""
    ranges = json.loads(evaluations.attrs["vary_json"])
    places = [
        (evaluations[key].values.astype(float) - low) / (high - low) for key, (low, high) in ranges.items()
    ]
    return ranges, np.stack(places, axis=-1)


def _grid(evaluations: xr.Dataset) -> NDArray[np.intp]:
    """Triangles between the points that could be computed, by their numbers; none where they lie on a line."""
    from scipy.spatial import Delaunay, QhullError

    objectives = json.loads(evaluations.attrs["objectives_json"])
    _, places = _places(evaluations)
    known = np.flatnonzero(np.all([np.isfinite(evaluations[name].values) for name in objectives], axis=0))
    # of a point at both tolerances the finer one counts
    known = known[np.argsort(-evaluations["fine"].values[known], kind="stable")]
    _, first = np.unique(np.round(places[known], 6), axis=0, return_index=True)
    kept = known[first]
    try:
        return np.asarray(kept[Delaunay(places[kept]).simplices], dtype=np.intp)
    except (QhullError, ValueError):  # fewer than three points, or all on one line
        return np.zeros((0, 3), dtype=np.intp)


def _map(axes: Axes, evaluations: xr.Dataset, name: str, sign: float) -> None:
    """Colours of an objective, the part that the limits forbid, and the points."""
    from matplotlib.ticker import MaxNLocator
    from matplotlib.tri import Triangulation

    ranges, _ = _places(evaluations)
    (first, across), (second, up) = ranges.items()
    x, y, z = (evaluations[column].values.astype(float) for column in (first, second, name))
    triangles = _grid(evaluations)
    used = np.unique(triangles)
    low, high = np.min(z[used]), np.max(z[used])
    if sign > 0:
        high = np.quantile(z[used], WORST)
    else:
        low = np.quantile(z[used], 1.0 - WORST)
    mesh = Triangulation(x, y, triangles)
    levels = MaxNLocator(nbins=LEVELS).tick_values(low, high)
    # numbers that are missing belong to points of no triangle
    colours_of = np.where(np.isfinite(z), z, low)
    extend = "max" if sign > 0 else "min"
    filled = axes.tricontourf(
        mesh,
        colours_of,
        levels=levels,
        cmap="cividis" if sign < 0 else "cividis_r",
        extend=extend,
    )
    assert axes.figure is not None
    axes.figure.colorbar(filled, ax=axes, label=titled(evaluations, name))
    _forbid(axes, evaluations, mesh)
    _mark(axes, evaluations, x, y, (first, second))
    axes.set(xlabel=key_title(first), ylabel=key_title(second), xlim=across, ylim=up)
    axes.grid(visible=False)


def _forbid(axes: Axes, evaluations: xr.Dataset, mesh: Triangulation) -> None:
    """Hatch the part that the limits forbid."""
    limits = json.loads(evaluations.attrs["limits_json"])
    beyond = [sign * (evaluations[name].values - bound) / (abs(bound) or 1.0) for name, sign, bound in limits]
    if not beyond:
        return
    worst = np.max(beyond, axis=0)
    worst = np.where(np.isfinite(worst), worst, 1.0)
    if np.max(worst) <= 0.0:
        return
    axes.tricontourf(
        mesh,
        worst,
        levels=[0.0, 2.0 * float(np.max(worst))],
        colors="none",
        hatches=["////"],
    )
    axes.tricontour(mesh, worst, levels=[0.0], colors="#000000", linewidths=1.0)
    nowhere = [np.nan] * 3
    axes.fill(
        nowhere, nowhere, facecolor="none", edgecolor="#000000", hatch="////", label="beyond the limits"
    )


def _mark(axes: Axes, evaluations: xr.Dataset, x: Array, y: Array, keys: tuple[str, str]) -> None:
    """Points that were computed, those that tie, the best, and the scene as it stands."""
    fine, best, tied = (evaluations[flag].values.astype(bool) for flag in ("fine", "best", "tied"))
    failed = ~np.isfinite(evaluations[str(json.loads(evaluations.attrs["objectives_json"])[0])].values)
    tied &= ~best
    whole = json.loads(evaluations.attrs["objectives_json"])
    style: dict[str, Any] = {
        "linestyle": "none",
        "markeredgecolor": "#000000",
        "markeredgewidth": 0.5,
        "clip_on": False,
    }
    for mask, marker, size, colour, label in (
        (~fine & ~failed, "o", 2.5, "#bbbbbb", "computed, coarse"),
        (fine & ~failed & ~tied & ~best, "o", 3, "#ffffff", "computed, fine"),
        (failed, "x", 4, "#000000", "not to be computed"),
        (tied, "o", 4.5, colours(5)[4], "ties with the best" if len(whole) < 2 else "ties with the front"),
        (best, "*", 13 if len(whole) < 2 else 8, colours(2)[1], "best" if len(whole) < 2 else "front"),
    ):
        if mask.any():
            axes.plot(x[mask], y[mask], marker=marker, markersize=size, color=colour, label=label, **style)
    start = [float(evaluations.get(f"start_{key}", np.nan)) for key in keys]
    if np.all(np.isfinite(start)):
        axes.plot(*start, marker="D", markersize=6, color=colours(3)[2], label="scene as it stands", **style)
