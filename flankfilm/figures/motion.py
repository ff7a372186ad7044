"""Bifurcation sweeps, phase portraits and Poincaré points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import COLOURS, figure, legend_above, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.stages.sweep import SweepStage

Array = NDArray[np.float64]


_DIRECTIONS = (COLOURS[5], COLOURS[0])


def sweeps(
    parameter: Array, states: Mapping[str, Array], labels: Mapping[str, Sequence[str]], name: str
) -> Figure:
    """Draw the states at tau = 0 of sweeps, and under them the label of each motion.

    Parameters
    ----------
    parameter : ndarray, shape (values,)
        What was swept, in the unit of `name`.
    states : mapping
        Direction to states, shape (values, kept, 2).
    labels : mapping
        Direction to labels n-p-q, one a value.
    name : str
        Axis title with unit.
    """
    with styled():
        drawn = figure(height=4.6)
        upper, lower = drawn.subplots(2, 1, sharex=True, height_ratios=(3, 1.3))
        # the larger dots lie below, so that both show where the sweeps agree
        for (direction, points), colour, size in zip(states.items(), _DIRECTIONS, (3.4, 1.3), strict=False):
            x = np.repeat(parameter, points.shape[1])
            upper.plot(
                x,
                points[:, :, 0].ravel(),
                ".",
                color=colour,
                markersize=size,
                label=direction,
                rasterized=True,
            )
        upper.set(ylabel="displacement at tau = 0 [-]")
        legend_above(drawn, upper)
        names = _most_frequent([label for row in labels.values() for label in row], 8)
        for row, colour, shift in zip(labels.values(), _DIRECTIONS, (0.12, -0.12), strict=False):
            height = [names.index(label) if label in names else len(names) for label in row]
            lower.plot(
                parameter, np.asarray(height) + shift, ".", color=colour, markersize=2, rasterized=True
            )
        rest = ["other"] if any(label not in names for row in labels.values() for label in row) else []
        lower.set_yticks(range(len(names) + len(rest)), [*names, *rest])
        lower.margins(y=0.15)
        lower.set(xlabel=name, ylabel="motion n-p-q")
        lower.invert_yaxis()
    return drawn


def portraits(stage: SweepStage) -> Figure:
    """Draw phase portraits with their Poincaré points and the edges of the backlash."""
    motions = stage.portraits
    columns = min(3, max(1, len(motions)))
    rows = -(-len(motions) // columns)
    with styled():
        drawn = figure(height=2.6 * rows + 0.3)
        grid = drawn.subplots(rows, columns, squeeze=False)
        for axes in grid.ravel()[len(motions) :]:
            axes.set_axis_off()
        for axes, motion in zip(grid.ravel(), motions, strict=False):
            axes.plot(motion.displacement, motion.velocity, color=COLOURS[0], linewidth=0.8, rasterized=True)
            axes.plot(motion.section[:, 0], motion.section[:, 1], "o", color=COLOURS[1], markersize=3.5)
            for edge in (-stage.half_backlash, stage.half_backlash):
                axes.axvline(edge, color="#999999", linewidth=0.8, linestyle=":")
            axes.set_title(f"{motion.label} at ω = {motion.frequency:.4g}, {motion.direction}", fontsize=8.5)
            axes.set(xlabel="displacement X [-]", ylabel="velocity dX/dτ [-]")
    return drawn


def _most_frequent(labels: Sequence[str], limit: int) -> list[str]:
    names, counts = np.unique(np.asarray(labels), return_counts=True)
    return sorted(str(n) for n in names[np.argsort(-counts, kind="stable")][:limit])
