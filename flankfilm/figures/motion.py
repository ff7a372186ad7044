"""Bifurcation sweeps, phase portraits with Poincaré points, bifurcation diagram and dynamic factor."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.reading import Reading, need, read
from flankfilm.figures.style import COLOURS, MARK, Style, colours, legend_over, sheet

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SMOOTH = 5000
"""Most points of a curve that is drawn as a curve; longer ones become pixels, so that files stay small."""

MARKS = {"saddle-node": ("o", COLOURS[5]), "period-doubling": ("s", COLOURS[1]), "grazing": ("x", "#555555")}
"""Mark and colour of each kind of special point."""

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
    with sheet(style, 2, height=3.8 + below, height_ratios=(2.6, below)) as (drawn, (upper, lower)):
        pair = colours(6)[5], colours(1)[0]
        # the larger dots lie below, so that both show where the sweeps agree
        for direction, colour, size in zip(rows, pair, (3.4, 1.3), strict=True):
            points = results[f"sweep_{direction}"].values
            x, y = np.repeat(parameter.values, points.shape[1]), points[:, :, 0].ravel()
            upper.plot(x, y, ".", color=colour, markersize=size, rasterized=True)
            upper.plot([], [], ".", color=colour, markersize=8, label=direction)
        upper.set(ylabel="displacement at tau = 0 [-]")
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
    count, edge = results["portrait_motion"].size, float(results["sweep_half_backlash"])
    columns = max(2, min(3, count))
    rows = -(-count // columns)
    of_sample, of_point = results["portrait_of_sample"].values, results["portrait_of_point"].values
    x, v = (read(results, f"portrait_{name}") for name in ("displacement", "velocity"))
    with sheet(style, rows, columns, height=2.6 * rows + 0.3) as (drawn, panels):
        for axes in panels[count:]:
            axes.set_axis_off()
        first, second = colours(2)
        for i, axes in enumerate(panels[:count]):
            mine = of_sample == i
            many = int(mine.sum()) > SMOOTH
            axes.plot(x.values[mine], v.values[mine], color=first, linewidth=0.8, rasterized=many)
            section = results["portrait_section"].values[of_point == i]
            axes.plot(section[:, 0], section[:, 1], "o", color=second, markersize=3.5)
            for at in (-edge, edge):
                axes.axvline(at, color=MARK, linewidth=0.8, linestyle=":")
            motion, direction, frequency = (
                results[f"portrait_{name}"].values[i] for name in ("motion", "direction", "frequency")
            )
            axes.set_title(f"{motion} at ω = {frequency:.4g}, {direction}", fontsize=8.5)
            axes.set(xlabel=x.label, ylabel=v.label)
    return drawn


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
    with sheet(style, 1 + forces, height=5.6 if forces else 3.6) as (drawn, panels):
        _branches(panels[0], results)
        if forces:
            _forces(panels[1], results)
        panels[-1].set(xlabel=over_speed(results, "diagram").label)
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
    label = "stable motions, periods 1 and 2"
    axes.plot(at, factor.values, ".", markersize=2.5, color=first, label=label)
    standard = results["force_factor_iso6336"].values
    if np.any(np.isfinite(standard)):
        order = np.argsort(at)
        axes.plot(at[order], standard[order], color=second, label="K_v of ISO 6336-1, method B")
    axes.set(ylabel=factor.label)
    legend_over(axes, 2)


def over_speed(results: xr.Dataset, prefix: str) -> Reading:
    """Places of motions: the pinion's speed where the scene has one, else the frequency."""
    return read(results, f"{prefix}_{'speed' if f'{prefix}_speed' in results else 'frequency'}")


def _most_frequent(labels: Sequence[str], limit: int) -> list[str]:
    names, counts = np.unique(np.asarray(labels), return_counts=True)
    return sorted(str(n) for n in names[np.argsort(-counts, kind="stable")][:limit])
