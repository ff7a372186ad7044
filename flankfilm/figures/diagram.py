"""Bifurcation diagram and dynamic factor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from flankfilm.figures.style import COLOURS, figure, legend_above, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from flankfilm.stages.diagram import DiagramStage

MARKS = {"saddle-node": ("o", COLOURS[5]), "period-doubling": ("s", COLOURS[1]), "grazing": ("x", "#555555")}


def branches(stage: DiagramStage) -> Figure:
    """Draw branches, stable solid and unstable dashed, with their special points; under them the forces.

    Parameters
    ----------
    stage : DiagramStage
        The diagram; over rpm where there is a scale, else over the dimensionless frequency.
    """
    unit = stage.rpm_per_frequency or 1.0
    forces = len(stage.factor) > 0
    with styled():
        drawn = figure(height=5.6 if forces else 3.6)
        grid = drawn.subplots(1 + forces, 1, sharex=True, squeeze=False).ravel()
        for branch in stage.diagram.branches:
            for wanted, style, width in ((True, "-", 1.4), (False, "--", 0.6)):
                keep = branch.stable == wanted
                keep[1:] |= branch.stable[:-1] == wanted
                shown = np.where(keep, branch.states[:, 0], np.nan)
                grid[0].plot(unit * branch.values, shown, style, color=COLOURS[0], linewidth=width)
            for point in branch.points:
                mark, colour = MARKS[point.kind]
                grid[0].plot(unit * point.parameter, point.state[0], mark, color=colour, markersize=3)
        for kind, (mark, colour) in MARKS.items():
            grid[0].plot([], [], mark, color=colour, markersize=4, label=kind)
        grid[0].set(ylabel="displacement at tau = 0 [-]")
        legend_above(drawn, grid[0])
        if forces:
            grid[1].plot(unit * stage.factor[:, 0], stage.factor[:, 1], ".", markersize=2.5, color=COLOURS[0])
            if np.any(np.isfinite(stage.factor[:, 2])):
                order = np.argsort(stage.factor[:, 0])
                standard = stage.factor[order]
                grid[1].plot(unit * standard[:, 0], standard[:, 2], color=COLOURS[1], label="ISO 6336-1, B")
                grid[1].legend(fontsize=7)
            grid[1].set(ylabel="greatest force over mean [-]")
        name = (
            "pinion speed [rpm]" if stage.rpm_per_frequency else "mesh frequency over natural frequency [-]"
        )
        grid[-1].set(xlabel=name)
    return drawn
