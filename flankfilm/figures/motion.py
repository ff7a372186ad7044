"""Bifurcation sweeps, phase portraits and Poincaré points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import MARK, Style, colours, figure, legend_above, styled

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.figure import Figure

SMOOTH = 5000
"""Most points of a curve that is drawn as a curve; longer ones become pixels, so that files stay small."""

SWEEP = 'run a scene that wants "sweep"'


def sweep(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw the states at tau = 0 of the sweeps up and down, and under them the label of each motion.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``sweep``; over rpm where the scene has a scale, else over the frequency.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(results, SWEEP, "sweep_frequency", "sweep_up", "sweep_down")
    parameter = over_speed(results, "sweep")
    rows = {d: [str(n) for n in results[f"sweep_{d}_label"].values] for d in ("up", "down")}
    names = _most_frequent([label for row in rows.values() for label in row], 8)
    rest = ["other"] if any(label not in names for row in rows.values() for label in row) else []
    below = 0.19 * max(4, len(names) + len(rest))
    with styled(style):
        drawn = figure(height=3.8 + below)
        upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(2.6, below))
        pair = colours(6)[5], colours(1)[0]
        # the larger dots lie below, so that both show where the sweeps agree
        for direction, colour, size in zip(rows, pair, (3.4, 1.3), strict=True):
            points = results[f"sweep_{direction}"].values
            x, y = np.repeat(parameter.values, points.shape[1]), points[:, :, 0].ravel()
            upper.plot(x, y, ".", color=colour, markersize=size, rasterized=True)
            upper.plot([], [], ".", color=colour, markersize=8, label=direction)
        upper.set(ylabel="displacement at tau = 0 [-]")
        legend_above(drawn, upper)
        for row, colour, shift in zip(rows.values(), pair, (0.12, -0.12), strict=True):
            height = np.array([names.index(label) if label in names else len(names) for label in row])
            lower.plot(parameter.values, height + shift, ".", color=colour, markersize=2, rasterized=True)
        lower.set_yticks(range(len(names) + len(rest)), [*names, *rest])
        lower.margins(y=0.15)
        lower.set(xlabel=parameter.label, ylabel="motion n-p-q")
        lower.invert_yaxis()
    return drawn


def portraits(results: xr.Dataset, *, style: Style | None = None) -> Figure:
    """Draw phase portraits with their Poincaré points and the edges of the backlash.

    Parameters
    ----------
    results : xarray.Dataset
        Of a run that wants ``sweep``.
    style : mapping, optional
        rcParams that overrule the house's.
    """
    need(
        results, SWEEP, "portrait_motion", "portrait_displacement", "portrait_section", "sweep_half_backlash"
    )
    count = results["portrait_motion"].size
    columns = max(2, min(3, count))
    rows = -(-count // columns)
    edge = float(results["sweep_half_backlash"])
    of_sample, of_point = results["portrait_of_sample"].values, results["portrait_of_point"].values
    with styled(style):
        drawn = figure(height=2.6 * rows + 0.3)
        grid = drawn.subplots(rows, columns, squeeze=False)
        for axes in grid.ravel()[count:]:
            axes.set_axis_off()
        first, second = colours(2)
        for i, axes in zip(range(count), grid.ravel(), strict=False):
            mine = of_sample == i
            x, v = (read(results, f"portrait_{name}") for name in ("displacement", "velocity"))
            many = int(mine.sum()) > SMOOTH
            axes.plot(x.values[mine], v.values[mine], color=first, linewidth=0.8, rasterized=many)
            section = results["portrait_section"].values[of_point == i]
            axes.plot(section[:, 0], section[:, 1], "o", color=second, markersize=3.5)
            for at in (-edge, edge):
                axes.axvline(at, color=MARK, linewidth=0.8, linestyle=":")
            motion, direction = (
                str(results[f"portrait_{name}"].values[i]) for name in ("motion", "direction")
            )
            axes.set_title(
                f"{motion} at ω = {float(results['portrait_frequency'][i]):.4g}, {direction}", fontsize=8.5
            )
            axes.set(xlabel=x.label, ylabel=v.label)
    return drawn


def over_speed(results: xr.Dataset, prefix: str) -> Reading:
    """Places of motions: the pinion's speed where the scene has one, else the frequency."""
    return read(results, f"{prefix}_{'speed' if f'{prefix}_speed' in results else 'frequency'}")


def _most_frequent(labels: Sequence[str], limit: int) -> list[str]:
    names, counts = np.unique(np.asarray(labels), return_counts=True)
    return sorted(str(n) for n in names[np.argsort(-counts, kind="stable")][:limit])
