"""Points of an optimisation: how the best came about, or how objectives trade off."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from flankfilm.figures.style import COLOURS, figure, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]


def optimum(
    objectives: Array, best: NDArray[np.intp], fine: NDArray[np.bool_], units: Mapping[str, str]
) -> Figure:
    """Draw every point: one objective over the evaluations, or each two of several against each other.

    Parameters
    ----------
    objectives : ndarray, shape (points, m)
        NaN where a point failed.
    best : ndarray of int
        The optimum, or the front.
    fine : ndarray of bool, shape (points,)
        Points of the second phase, at the scene's own tolerance.
    units : mapping
        Names of the objectives to their units.
    """
    names = [_words(name, unit) for name, unit in units.items()]
    pairs = list(itertools.combinations(range(len(names)), 2))
    with styled():
        drawn = figure(7.0 if len(pairs) < 2 else 3.6 * min(3, len(pairs)), 3.6)
        panels = np.atleast_1d(drawn.subplots(1, max(1, len(pairs))))
        if not pairs:
            axes, order = panels[0], np.arange(1, len(objectives) + 1)
            for mask, colour, label in _phases(fine):
                axes.plot(order[mask], objectives[mask, 0], ".", color=colour, markersize=3, label=label)
            axes.plot(order[best], objectives[best, 0], "*", color=COLOURS[1], markersize=11, label="best")
            axes.set(xlabel="evaluation", ylabel=names[0])
        for axes, (i, j) in zip(panels, pairs, strict=False):
            for mask, colour, label in _phases(fine):
                axes.plot(
                    objectives[mask, i], objectives[mask, j], ".", color=colour, markersize=3, label=label
                )
            by_first = best[np.argsort(objectives[best, i])]
            style = "o-" if len(pairs) == 1 else "o"
            axes.plot(
                objectives[by_first, i],
                objectives[by_first, j],
                style,
                color=COLOURS[1],
                markersize=4,
                label="front",
            )
            axes.set(xlabel=names[i], ylabel=names[j])
        drawn.legend(*panels[0].get_legend_handles_labels(), loc="outside upper left", ncols=3)
    return drawn


def _phases(fine: NDArray[np.bool_]) -> tuple[tuple[NDArray[np.bool_], str, str], ...]:
    return (~fine, "#aaaaaa", "coarse tolerance"), (fine, COLOURS[0], "the scene's tolerance")


def _words(name: str, unit: str) -> str:
    return name if unit == "1" else f"{name} [{unit}]"
