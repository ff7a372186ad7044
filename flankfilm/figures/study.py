"""Outputs of a study against the keys that vary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures.style import COLOURS, DASHES, figure, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

FAMILY = 7
"""Most curves of one family; beyond that rows are drawn as points in colour."""


def study(found: xr.Dataset, keys: Sequence[str], outputs: Sequence[str]) -> Figure | None:
    """Draw every output against the first varied number; the second one makes a family of curves or colours.

    Returns
    -------
    Figure or None
        None where no number varies.
    """
    numbers = [k for k in keys if np.issubdtype(found[k].dtype, np.number) and np.ptp(found[k].values) > 0]
    words = [k for k in keys if not np.issubdtype(found[k].dtype, np.number)]
    if not numbers:
        return None
    across = numbers[0]
    split = (numbers[1:] + words)[:1]
    columns = min(2, len(outputs))
    lines = -(-len(outputs) // columns)
    with styled():
        drawn = figure(3.6 * columns, 2.5 * lines + 0.5)
        panels = drawn.subplots(lines, columns, squeeze=False).ravel()
        for axes, name in zip(panels, outputs, strict=False):
            _panel(axes, found, across, split, name)
        for axes in panels[len(outputs) :]:
            axes.set_visible(False)
        handles, labels = panels[0].get_legend_handles_labels()
        if handles:
            drawn.legend(
                handles, labels, loc="outside upper left", ncols=4, title=split[0] if split else None
            )
    return drawn


def _panel(axes: Any, found: xr.Dataset, across: str, split: Sequence[str], name: str) -> None:
    x, y = found[across].values, found[name].values
    members = np.unique(found[split[0]].values) if split else np.zeros(1)
    if not split:
        order = np.argsort(x, kind="stable")
        marker = ".-" if np.unique(x).size == x.size else "."
        axes.plot(x[order], y[order], marker, color=COLOURS[0])
    elif members.size <= FAMILY:
        for member, colour, dash in zip(members, COLOURS, DASHES, strict=False):
            mine = np.flatnonzero(found[split[0]].values == member)
            mine = mine[np.argsort(x[mine], kind="stable")]
            label = member if isinstance(member, str) else f"{member:.5g}"
            axes.plot(x[mine], y[mine], color=colour, linestyle=dash, marker=".", label=label)
    else:
        drawn = axes.scatter(x, y, c=found[split[0]].values, s=8, cmap="viridis")
        axes.figure.colorbar(drawn, ax=axes, label=split[0])
    unit = found[name].attrs["units"]
    told = name.replace("_", " ")
    axes.set(xlabel=across, ylabel=told if unit == "1" else f"{told}\n[{unit}]")
