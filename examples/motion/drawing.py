"""Figures of a scan: diagram, exponents, portraits with Poincare maps, basins with manifolds."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure

from dynamics import BasinResult, Diagram, Manifold, MultiSweep, Trajectory
from flankfilm.figures.motion import MARKS
from flankfilm.figures.orbits import OF_ONE
from flankfilm.figures.style import COLOURS, MARK, colours, sheet, styled

AT_ZERO = "displacement X at τ = 0 [-]", "velocity dX/dτ at τ = 0 [-]"
DIRECTIONS = {
    frozenset({"up"}): COLOURS[4], frozenset({"down"}): COLOURS[3], frozenset({"up", "down"}): MARK,
}  # fmt: skip
INK = COLOURS[6]
UNSTABLE, LINES = ("^", "v", "s", "D", "x", "+"), ("-", "--", "-.", ":")
SHADES = ("#8fc1e0", "#fbe8c4", "#59b598", "#ecd3e0", "#e59a6a", "#dddddd", "#c9e6f7", "#b9a06a")
"""Light colours of basins, on which black lines show; neighbours differ in grey."""


def diagram_figure(diagram: Diagram, met: MultiSweep, symbol: str) -> Figure:
    """Branches (stable solid, unstable dashed), special points, and what sweeps from many starts met behind them."""
    with sheet(height=4.4, legend=4) as (figure, (axes,)):
        for wanted, colour in DIRECTIONS.items():
            motions = [
                m for here in met.motions for m in here if m.directions == wanted and m.label != "diverged"
            ]
            if motions:
                x = np.concatenate([np.full(len(m.states), m.value) for m in motions])
                y = np.concatenate([m.states[:, 0] for m in motions])
                axes.plot(x, y, ".", color=colour, markersize=2.2, markeredgewidth=0.0, rasterized=True)
            axes.plot(
                [], [], ".", color=colour, markersize=8, label=f"met {' and '.join(sorted(wanted)[::-1])}"
            )
        for branch in diagram.branches:
            for wanted_stability, dash, width in ((True, "-", 1.1), (False, "--", 0.6)):
                x = where_stable(branch.stable, branch.states[:, 0], wanted_stability)
                axes.plot(branch.values, x, dash, color=INK, linewidth=width)
        points = [point for branch in diagram.branches for point in branch.points]
        for kind, (mark, colour) in MARKS.items():
            at = [(point.parameter, point.state[0]) for point in points if point.kind == kind]
            if at:
                line = colour if mark == "x" else INK
                axes.plot(
                    *np.transpose(at), mark, color=colour, markersize=4.0, label=kind, zorder=3,
                    markeredgecolor=line, markeredgewidth=1.0 if mark == "x" else 0.4,
                )  # fmt: skip
        axes.plot([], [], "-", color=INK, linewidth=1.1, label="stable")
        axes.plot([], [], "--", color=INK, linewidth=0.6, label="unstable")
        axes.set(xlabel=f"{symbol} [-]", ylabel=AT_ZERO[0], xlim=diagram.bounds, ylim=_span(met))
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
    with sheet(height=3.2, legend=4) as (figure, (axes,)):
        for (name, rows), colour in zip(spectra, colours(2), strict=True):
            value, first, second, error = rows.T
            axes.errorbar(
                value,
                first,
                error,
                color=colour,
                linestyle="-",
                linewidth=0.9,
                elinewidth=0.5,
                label=f"larger, {name}",
            )
            axes.plot(value, second, ":", color=colour, linewidth=0.9, label=f"smaller, {name}")
        axes.axhline(0.0, color=MARK, linestyle="-", linewidth=0.8)
        axes.set(xlabel=f"{symbol} [-]", ylabel="Lyapunov exponents [-]", xlim=(value.min(), value.max()))
    return figure


def portrait_figure(motions: Sequence[tuple[str, Trajectory]], play: float) -> Figure:
    """Phase portraits with Poincare points; grey lines are the edges of the backlash."""
    columns = min(3, len(motions))
    rows = -(-len(motions) // columns)
    with sheet(None, rows, columns, height=0.3 + 2.3 * rows, sharex=False) as (figure, panels):
        for axes in panels[len(motions) :]:
            axes.set_axis_off()
        orbit, points = colours(2)
        for axes, (title, motion) in zip(panels, motions, strict=False):
            label, bracket, rest = title.partition(" (")
            axes.plot(motion.x, motion.v, color=orbit, linestyle="-", linewidth=0.6, rasterized=True)
            axes.plot(
                *motion.poincare.T,
                "o",
                color=points,
                markersize=2.5,
                rasterized=True,
                label="Poincaré points",
            )
            for edge in (-play, play):
                axes.axvline(edge, color=MARK, linestyle="-", linewidth=0.8)
            axes.set_title(f"{label}\n{(bracket + rest).strip()}".strip(), fontsize=8)
        for axes in panels[max(len(motions) - columns, 0) : len(motions)]:
            axes.set_xlabel(OF_ONE[0])
        for axes in panels[::columns]:
            axes.set_ylabel(OF_ONE[1])
    return figure


def basin_figure(
    result: BasinResult, unstable: Sequence[tuple[str, np.ndarray]], manifolds: Sequence[Manifold], title: str
) -> Figure:
    """Basins, attractors, unstable orbits, and the stable manifolds that bound the basins."""
    box = (result.x[0], result.x[-1], result.v[0], result.v[-1])
    count = len(result.attractors)
    shades = [SHADES[i % len(SHADES)] for i in range(count)]
    with sheet(width=6.2, height=5.6, legend=3) as (figure, (axes,)):
        axes.imshow(
            np.ma.masked_less(result.labels.T, 0), origin="lower", extent=box, aspect="auto",
            cmap=ListedColormap(shades), vmin=-0.5, vmax=count - 0.5, interpolation="nearest",
        )  # fmt: skip
        for attractor, shade in zip(result.attractors, shades, strict=True):
            if attractor.share == 0.0:
                continue
            periodic = attractor.orbit is not None
            axes.plot(
                *attractor.states.T, "o" if periodic else ".", color=shade, markeredgecolor=INK,
                markersize=6.0 if periodic else 2.5, markeredgewidth=0.8 if periodic else 0.2,
                label=f"{attractor.label}, {100 * attractor.share:.1f} %",
            )  # fmt: skip
        for k, (label, states) in enumerate(unstable[:10]):
            axes.plot(*states.T, UNSTABLE[k % len(UNSTABLE)], color=INK, markersize=4.5, label=label)
        if len(unstable) > 10:
            axes.plot([], [], " ", label=f"and {len(unstable) - 10} more unstable")
        for k, manifold in enumerate(manifolds):
            for j, curve in enumerate(manifold.curves):
                name = f"stable manifold of {manifold.orbit.label}" if j == 0 else None
                line = axes.plot(*curve.T, LINES[k % len(LINES)], color=INK, linewidth=0.6, label=name)
                line[0].set_rasterized(len(curve) > 5000)
        axes.set(xlim=box[:2], ylim=box[2:], xlabel=AT_ZERO[0], ylabel=AT_ZERO[1])
        axes.set_title(title, fontsize=9)
        axes.grid(visible=False)
    return figure


def save(figure: Figure, folder: Path, name: str, ending: str) -> Path:
    """Write a figure; what has very many points is an image of 150 dpi within a vector file."""
    path = folder / f"{name}.{ending}"
    with styled():
        figure.savefig(path, dpi=150)
    return path
