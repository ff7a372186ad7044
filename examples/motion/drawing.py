"""Figures of a scan: diagram, exponents, portraits with Poincare maps, basins with manifolds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from dynamics import BasinResult, Diagram, Manifold, SweepResult, Trajectory

MARKS = {"saddle-node": ("o", "tab:red"), "period-doubling": ("s", "tab:purple"), "grazing": ("x", "black")}
SHADES = ("#9ecae1", "#fdae6b", "#a1d99b", "#bcbddc", "#fc9272", "#d9d9d9", "#fee391", "#c7e9b4")


def diagram_figure(diagram: Diagram, sweeps: Sequence[SweepResult], symbol: str) -> Figure:
    """Branches (stable solid, unstable dashed), special points, and the sweeps behind them."""
    figure = Figure(figsize=(9, 5), layout="constrained")
    axes = figure.subplots()
    for sweep, colour in zip(sweeps, ("tab:red", "tab:blue"), strict=True):
        x = np.repeat(sweep.values, sweep.states.shape[1])
        axes.plot(x, sweep.states[:, :, 0].ravel(), ",", color=colour, alpha=0.5, rasterized=True)
        axes.plot([], [], ".", color=colour, label=f"{sweep.direction}")
    for branch in diagram.branches:
        for wanted, style in ((True, "-"), (False, "--")):
            keep = branch.stable == wanted
            keep[1:] |= branch.stable[:-1] == wanted
            x = np.where(keep, branch.states[:, 0], np.nan)
            axes.plot(branch.values, x, style, color="black", linewidth=1.1 if wanted else 0.5)
        for point in branch.points:
            mark, colour = MARKS[point.kind]
            axes.plot(point.parameter, point.state[0], mark, color=colour, markersize=3.5)
    for kind, (mark, colour) in MARKS.items():
        axes.plot([], [], mark, color=colour, label=kind)
    axes.set(xlabel=symbol, ylabel="X at tau = 0", xlim=diagram.bounds)
    axes.legend(fontsize=7, ncols=5, loc="upper left")
    return figure


def exponent_figure(
    values: np.ndarray, exponents: Mapping[str, np.ndarray], errors: Mapping[str, np.ndarray], symbol: str
) -> Figure:
    """Largest Lyapunov exponent of the motions that the sweeps met, with its standard error."""
    figure = Figure(figsize=(9, 3), layout="constrained")
    axes = figure.subplots()
    for (name, found), colour in zip(exponents.items(), ("tab:red", "tab:blue"), strict=True):
        axes.errorbar(values, found, errors[name], color=colour, linewidth=0.8, elinewidth=0.5, label=name)
    axes.axhline(0.0, color="grey", linewidth=0.7)
    axes.set(xlabel=symbol, ylabel="largest Lyapunov exponent")
    axes.legend(fontsize=7)
    return figure


def portrait_figure(motions: Sequence[tuple[str, Trajectory]], play: float) -> Figure:
    """Phase portraits with Poincare points; the edges of the backlash dotted."""
    columns = min(4, len(motions))
    rows = -(-len(motions) // columns)
    figure = Figure(figsize=(2.6 * columns, 2.3 * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    for axes in grid.ravel()[len(motions) :]:
        axes.set_axis_off()
    for axes, (title, motion) in zip(grid.ravel(), motions, strict=False):
        axes.plot(motion.x, motion.v, linewidth=0.6, rasterized=True)
        axes.plot(*motion.poincare.T, "o", color="tab:red", markersize=2.5, rasterized=True)
        for edge in (-play, play):
            axes.axvline(edge, color="grey", linestyle=":", linewidth=0.8)
        axes.set_title(title, fontsize=7)
        axes.tick_params(labelsize=6)
    return figure


def basin_figure(
    result: BasinResult, unstable: Sequence[tuple[str, np.ndarray]], manifolds: Sequence[Manifold], title: str
) -> Figure:
    """Basins, attractors, unstable orbits, and the stable manifolds that bound the basins."""
    figure = Figure(figsize=(5.4, 5), layout="constrained")
    axes = figure.subplots()
    box = (result.x[0], result.x[-1], result.v[0], result.v[-1])
    colours = ListedColormap([SHADES[i % len(SHADES)] for i in range(len(result.attractors))])
    axes.imshow(
        np.ma.masked_less(result.labels.T, 0), origin="lower", extent=box, aspect="auto", cmap=colours,
        vmin=-0.5, vmax=len(result.attractors) - 0.5, interpolation="nearest",
    )  # fmt: skip
    for attractor in result.attractors:
        size = 3.0 if attractor.orbit is not None else 0.8
        name = f"{attractor.label}, {100 * attractor.share:.1f} %"
        axes.plot(*attractor.states.T, "o", markersize=size, label=name)
    for label, states in unstable:
        axes.plot(*states.T, "^", color="black", markersize=4, label=label)
    for manifold in manifolds:
        for curve in manifold.curves:
            axes.plot(*curve.T, color="black", linewidth=0.5)
    axes.set(xlim=box[:2], ylim=box[2:], xlabel="X at tau = 0", ylabel="V at tau = 0", title=title)
    axes.legend(fontsize=6, loc="upper right")
    return figure


def save(figure: Figure, folder: Path, name: str) -> Path:
    """Write a figure as PNG."""
    path = folder / f"{name}.png"
    figure.savefig(path, dpi=150)
    return path
