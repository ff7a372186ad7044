"""Outputs of a study against the keys that vary; points of an optimisation."""

from __future__ import annotations

import itertools
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from base import Array
from flankfilm.figures.reading import key_title, need, titled
from flankfilm.figures.style import COLOURS, DASHES, Style, colours, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

FAMILY = 18
"""Most curves of one family; beyond that rows are drawn as points, coloured by the second number."""


def study(
    found: xr.Dataset,
    keys: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    style: Style | None = None,
) -> Figure:
    """Draw every output against the first varied number; the other keys make a family of curves.

    Parameters
    ----------
    found : xarray.Dataset
        What ``study.nc`` holds.
    keys : sequence of str, optional
        Varied keys in the order wished, the first along the axis; all of them unless given.
    outputs : sequence of str, optional
        What is drawn, a panel each; all of them unless given.
    style : mapping, optional
        rcParams that overrule the house's.

    Raises
    ------
    ValueError
        Where no number varies.
    """
    keys = [str(k) for k in found.coords] if keys is None else keys
    outputs = (
        [str(n) for n in found.data_vars if n not in ("seconds", "fault")] if outputs is None else outputs
    )
    numbers = varied_numbers(found, keys)
    if not numbers:
        raise ValueError(
            f"no number varies among {', '.join(keys)}: there is nothing to draw the outputs against"
        )
    others = [k for k in keys if k != numbers[0]]
    columns = min(2, len(outputs))
    lines = -(-len(outputs) // columns)
    width, height = 3.6 * columns, 2.5 * lines + 0.7
    with sheet(style, lines, columns, width=width, height=height, legend=0, sharex=False) as (drawn, panels):
        for axes, name in zip(panels, outputs, strict=False):
            _panel(axes, found, numbers[0], others, name)
        for axes in panels[len(outputs) :]:
            axes.set_visible(False)
        handles, labels = panels[0].get_legend_handles_labels()
        if handles:
            title = ", ".join(key_title(key) for key in others)
            drawn.legend(handles, labels, loc="outside upper left", ncols=4, title=title, alignment="left")
    return drawn


def varied_numbers(found: xr.Dataset, keys: Sequence[str]) -> list[str]:
    """Keys among `keys` that are numbers and vary."""
    return [k for k in keys if np.issubdtype(found[k].dtype, np.number) and np.ptp(found[k].values) > 0]


def _panel(axes: Any, found: xr.Dataset, across: str, others: Sequence[str], name: str) -> None:
    x, y = found[across].values, found[name].values
    rows = list(zip(*(found[key].values.tolist() for key in others), strict=True)) or [()] * x.size
    family = sorted(set(rows), key=str) if others else [()]
    if len(family) > FAMILY:
        shade = found[others[0]].values
        if np.issubdtype(shade.dtype, np.number):
            points = axes.scatter(x, y, c=shade, s=8, cmap="viridis")
            axes.figure.colorbar(points, ax=axes, label=key_title(others[0]))
        else:
            axes.plot(x, y, ".", color=colours(1)[0])
    else:
        firsts = list(dict.fromkeys(member[:1] for member in family))
        rests = list(dict.fromkeys(member[1:] for member in family))
        for member in family:
            mine = np.flatnonzero([row == member for row in rows])
            mine = mine[np.argsort(x[mine], kind="stable")]
            axes.plot(
                x[mine],
                y[mine],
                color=colours(len(COLOURS))[firsts.index(member[:1]) % len(COLOURS)],
                linestyle=DASHES[rests.index(member[1:]) % len(DASHES)],
                marker=".",
                label=", ".join(v if isinstance(v, str) else f"{v:.5g}" for v in member) or None,
            )
    axes.set(xlabel=key_title(across), ylabel=titled(found, name))


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
    best = np.flatnonzero(found["best"].values)
    if len(names) == 1:
        (name,) = names
        order, y = np.arange(1.0, found["best"].size + 1.0), found[name].values
        with sheet(style, height=3.6) as (drawn, (axes,)):
            _points(axes, found, order, y)
            axes.plot(order[best], y[best], "*", color=colours(2)[1], markersize=11, label="best")
            axes.set(xlabel="evaluation", ylabel=titled(found, name))
        return drawn
    pairs = list(itertools.combinations(names, 2))
    width = 7.0 if len(pairs) < 2 else 3.6 * min(3, len(pairs))
    with sheet(style, 1, len(pairs), width=width, height=3.6) as (drawn, panels):
        for axes, pair in zip(panels, pairs, strict=True):
            first, second = (found[name].values for name in pair)
            _points(axes, found, first, second)
            front, line = best[np.argsort(first[best])], "o-" if len(pairs) == 1 else "o"
            axes.plot(first[front], second[front], line, color=colours(2)[1], markersize=4, label="front")
            axes.set(xlabel=titled(found, pair[0]), ylabel=titled(found, pair[1]))
    return drawn


def _points(axes: Axes, found: xr.Dataset, x: Array, y: Array) -> None:
    fine = found["fine"].values.astype(bool)
    for mask, colour, label in (
        (~fine, "#aaaaaa", "coarse tolerance"),
        (fine, colours(1)[0], "the scene's tolerance"),
    ):
        if mask.any():
            axes.plot(x[mask], y[mask], ".", color=colour, markersize=3, label=label)
