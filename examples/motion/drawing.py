"""Figures of a scan: diagram, exponents, portraits with Poincare maps, basins with manifolds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from dynamics import BasinResult, Diagram, Manifold, MultiSweep, Trajectory

MARKS = {"saddle-node": ("o", "tab:red"), "period-doubling": ("s", "tab:purple"), "grazing": ("x", "black")}
DIRECTIONS = {
    frozenset({"up"}): "tab:red", frozenset({"down"}): "tab:blue", frozenset({"up", "down"}): "tab:green",
}  # fmt: skip
UNSTABLE, LINES = ("^", "v", "s", "D", "x", "+"), ("-", "--", "-.", ":")
SHADES = ("#9ecae1", "#fdae6b", "#a1d99b", "#bcbddc", "#fc9272", "#d9d9d9", "#fee391", "#c7e9b4")


def diagram_figure(diagram: Diagram, met: MultiSweep, symbol: str) -> Figure:
    """Branches (stable solid, unstable dashed), special points, and what sweeps from many starts met behind them."""
    figure = Figure(figsize=(9, 5.2), layout="constrained")
    axes = figure.subplots()
    for wanted, colour in DIRECTIONS.items():
        motions = [
            m for here in met.motions for m in here if m.directions == wanted and m.label != "diverged"
        ]
        if motions:
            x = np.concatenate([np.full(len(m.states), m.value) for m in motions])
            y = np.concatenate([m.states[:, 0] for m in motions])
            axes.plot(x, y, ".", color=colour, markersize=1.5, markeredgewidth=0.0, rasterized=True)
        axes.plot([], [], ".", color=colour, label=" and ".join(sorted(wanted, reverse=True)))
    for branch in diagram.branches:
        for wanted_stability, style in ((True, "-"), (False, "--")):
            x = where_stable(branch.stable, branch.states[:, 0], wanted_stability)
            axes.plot(branch.values, x, style, color="black", linewidth=0.9 if wanted_stability else 0.5)
        for point in branch.points:
            mark, colour = MARKS[point.kind]
            axes.plot(point.parameter, point.state[0], mark, color=colour, markersize=3.0)
    for kind, (mark, colour) in MARKS.items():
        axes.plot([], [], mark, color=colour, label=kind)
    axes.plot([], [], "-", color="black", label="stable")
    axes.plot([], [], "--", color="black", linewidth=0.7, label="unstable")
    axes.set(xlabel=symbol, ylabel="X at tau = 0", xlim=diagram.bounds, ylim=_span(met))
    figure.legend(fontsize=7, ncols=8, loc="outside upper center")
    return figure


def where_stable(stable: np.ndarray, values: np.ndarray, wanted: bool) -> np.ndarray:
    """Values of the stable, or the unstable, part of a branch up to the neighbours beyond; nan elsewhere."""
    keep = stable == wanted
    keep[1:] |= stable[:-1] == wanted
    return np.where(keep, values, np.nan)


def _span(met: MultiSweep) -> tuple[float, float]:
    """Range of X that all but the largest motions keep to: branches that grow without bound would hide the rest."""
    x = np.concatenate([m.states[:, 0] for here in met.motions for m in here if m.label != "diverged"])
    low, high = np.quantile(x, [0.005, 0.995])
    return float(low - 0.1 * (high - low)), float(high + 0.1 * (high - low))


def exponent_figure(spectra: Sequence[tuple[str, np.ndarray]], symbol: str) -> Figure:
    """Both Lyapunov exponents of the motions that the sweeps met, the larger with its standard error."""
    figure = Figure(figsize=(9, 3.4), layout="constrained")
    axes = figure.subplots()
    for (name, rows), colour in zip(spectra, ("tab:red", "tab:blue"), strict=True):
        value, first, second, error = rows.T
        axes.errorbar(
            value, first, error, color=colour, linewidth=0.8, elinewidth=0.5, label=f"larger, {name}"
        )
        axes.plot(value, second, ":", color=colour, linewidth=0.8, label=f"smaller, {name}")
    axes.axhline(0.0, color="grey", linewidth=0.7)
    axes.set(xlabel=symbol, ylabel="Lyapunov exponents", xlim=(value.min(), value.max()))
    figure.legend(fontsize=7, ncols=4, loc="outside upper center")
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
    for axes in grid.ravel()[max(len(motions) - columns, 0) : len(motions)]:
        axes.set_xlabel("X", fontsize=7)
    for axes in grid[:, 0]:
        axes.set_ylabel("V", fontsize=7)
    return figure


def basin_figure(
    result: BasinResult, unstable: Sequence[tuple[str, np.ndarray]], manifolds: Sequence[Manifold], title: str
) -> Figure:
    """Basins, attractors, unstable orbits, and the stable manifolds that bound the basins."""
    figure = Figure(figsize=(6.6, 5), layout="constrained")
    axes = figure.subplots()
    box = (result.x[0], result.x[-1], result.v[0], result.v[-1])
    shown = [i for i, a in enumerate(result.attractors) if a.share > 0.0]
    colours = ListedColormap([SHADES[i % len(SHADES)] for i in range(len(result.attractors))])
    axes.imshow(
        np.ma.masked_less(result.labels.T, 0), origin="lower", extent=box, aspect="auto", cmap=colours,
        vmin=-0.5, vmax=len(result.attractors) - 0.5, interpolation="nearest",
    )  # fmt: skip
    for i in shown:
        attractor = result.attractors[i]
        periodic = attractor.orbit is not None
        axes.plot(
            *attractor.states.T, "o" if periodic else ".", color=SHADES[i % len(SHADES)], markeredgecolor="black",
            markersize=6.0 if periodic else 2.5, markeredgewidth=0.8 if periodic else 0.2,
            label=f"{attractor.label}, {100 * attractor.share:.1f} %",
        )  # fmt: skip
    for k, (label, states) in enumerate(unstable[:10]):
        axes.plot(*states.T, UNSTABLE[k % len(UNSTABLE)], color="black", markersize=4.5, label=label)
    if len(unstable) > 10:
        axes.plot([], [], " ", label=f"and {len(unstable) - 10} more unstable")
    for k, manifold in enumerate(manifolds):
        for j, curve in enumerate(manifold.curves):
            label = f"stable manifold of {manifold.orbit.label}" if j == 0 else None
            line = axes.plot(*curve.T, LINES[k % len(LINES)], color="black", linewidth=0.5, label=label)
            line[0].set_rasterized(len(curve) > 5000)
    axes.set(xlim=box[:2], ylim=box[2:], xlabel="X at tau = 0", ylabel="V at tau = 0")
    axes.set_title(title, fontsize=9)
    figure.legend(fontsize=7, loc="outside right upper")
    return figure


def save(figure: Figure, folder: Path, name: str, ending: str) -> Path:
    """Write a figure; what has very many points is an image of 150 dpi within a vector file."""
    path = folder / f"{name}.{ending}"
    figure.savefig(path, dpi=150)
    return path
