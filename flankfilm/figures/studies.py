"""Outputs of a study against the keys that vary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from flankfilm.figures.reading import key_title, titled
from flankfilm.figures.style import COLOURS, DASHES, Style, colours, is_narrow, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

FAMILY = 18
"""Most curves of one family; beyond that rows are drawn as points, coloured by the second number."""


def study(
    results: xr.Dataset,
    keys: Sequence[str] | None = None,
    outputs: Sequence[str] | None = None,
    *,
    style: Style | None = None,
) -> Figure:
    """Draw every output against the first varied number; the other keys make a family of curves.

    Parameters
    ----------
    results : xarray.Dataset
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
    keys = [str(k) for k in results.coords] if keys is None else keys
    outputs = (
        [str(n) for n in results.data_vars if n not in ("seconds", "fault")] if outputs is None else outputs
    )
    numbers = varied_numbers(results, keys)
    if not numbers:
        raise ValueError(
            f"no number varies among {', '.join(keys)}: there is nothing to draw the outputs against"
        )
    others = [k for k in keys if k != numbers[0] and not _follows(results, k, numbers[0])]
    columns = 1 if is_narrow() else min(2, len(outputs))
    lines = -(-len(outputs) // columns)
    width, height = 3.6 * columns, 2.5 * lines + 0.7
    with sheet(style, lines, columns, width=width, height=height, legend=0, sharex=False) as (drawn, panels):
        for axes, name in zip(panels, outputs, strict=False):
            _panel(axes, results, numbers[0], others, name)
        for axes in panels[len(outputs) :]:
            axes.set_visible(False)
        handles, labels = panels[0].get_legend_handles_labels()
        if handles:
            title = (",\n" if is_narrow() else ", ").join(key_title(key) for key in others)
            ncols = 2 if is_narrow() else 4
            drawn.legend(
                handles, labels, loc="outside upper left", ncols=ncols, title=title, alignment="left"
            )
    return drawn


def varied_numbers(results: xr.Dataset, keys: Sequence[str]) -> list[str]:
    """Keys among `keys` that are numbers and vary."""
    return [k for k in keys if np.issubdtype(results[k].dtype, np.number) and np.ptp(results[k].values) > 0]


def _follows(results: xr.Dataset, key: str, number: str) -> bool:
    """Whether a key changes with a number along a straight line, as one that follows it does: no family then."""
    x, y = results[number].values, results[key].values
    if not np.issubdtype(y.dtype, np.number):
        return False
    about = x - x.mean(), y - y.mean()
    slope = (about[0] @ about[1]) / (about[0] @ about[0])
    return bool(np.max(np.abs(about[1] - slope * about[0])) <= 1e-9 * np.max(np.abs(y)))


def _panel(axes: Any, results: xr.Dataset, across: str, others: Sequence[str], name: str) -> None:
    x, y = results[across].values, results[name].values
    rows = list(zip(*(results[key].values.tolist() for key in others), strict=True)) or [()] * x.size
    family = sorted(set(rows), key=lambda row: [(isinstance(v, str), v) for v in row])
    if len(family) > FAMILY:
        shade = results[others[0]].values
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
    axes.set(xlabel=key_title(across), ylabel=titled(results, name))
