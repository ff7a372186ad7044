"""Films without heat on finer and finer grids, until two of them agree as asked."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

from base.results import WORST
from ehl.discrete.method import METHOD
from ehl.films.result import GridSolution, above, film_error, remedy, spike_error
from ehl.solving.grid_search import GridSearch
from ehl.solving.levels import Level
from ehl.solving.options import Options
from ehl.solving.refinement import doubled, refine

_SHARP_NODES = 257
_SETTLING = 0.7  # the spike's error has to fall by this factor from grid to grid


def refined(run: GridSearch, coarse: Level, fine: Level, options: Options) -> GridSolution:
    """Double the grid until the estimates meet what is asked, then report."""
    inlet = run.plan.inlet_error
    judge = _Judge(options, inlet)
    if options.sharp and coarse.solution.converged and fine.solution.converged:
        if options.nodes is None and options.spike is None and judge.compared(coarse, fine).enough:
            return GridSolution(run, coarse, fine, film_error(coarse, fine) + inlet, inlet)
        n = _SHARP_NODES if options.nodes is None else fine.grid.nodes.size
        coarse = run.sharpened(fine, (n + 1) // 2)
        fine = run.sharpened(coarse, n)
    if not coarse.solution.converged:
        return GridSolution(run, coarse, fine, math.nan, inlet, coarse.solution.message)
    nearest = refine(doubled(_levels(run, coarse, fine, options), judge.compared))
    if run.failed is not None or nearest is None:
        failed = run.failed or fine
        return GridSolution(run, coarse, failed, math.nan, inlet, failed.solution.message)
    return nearest.reported(run, inlet, options)


def _levels(run: GridSearch, coarse: Level, fine: Level, options: Options) -> Iterator[Level | None]:
    """Give two grids and ever finer ones, each from the last that gave in; None for one that is passed over."""
    yield coarse
    while True:
        n, gave_in = 2 * fine.grid.nodes.size - 1, fine.solution.converged
        yield fine if gave_in else None
        if options.nodes is None and gave_in and n <= METHOD.most_nodes:
            coarse, fine = fine, run.sharpened(fine, n) if options.sharp else run.warm(fine, None, n)
        elif options.nodes is None and not gave_in and n <= run.most_cold and not run.exhausted:
            fine = run.warm(coarse, None, n)
        else:
            run.failed = None if gave_in else fine
            return


class _Judge:
    """Compares grids with what is asked; those that are prescribed have no tolerance to meet."""

    def __init__(self, options: Options, inlet: float) -> None:
        self.options, self.inlet, self.off = options, inlet, math.inf

    def compared(self, coarse: Level, fine: Level) -> _Pair:
        """Compare two; a spike whose error does not fall from grid to grid ends the search."""
        options, before = self.options, self.off
        error, self.off = film_error(coarse, fine) + self.inlet, spike_error(coarse, fine)
        sharp = options.spike is None or self.off <= options.spike
        enough = options.nodes is not None or (error <= options.tolerance and sharp)
        settles = options.spike is None or not _SETTLING * before < self.off < math.inf
        return _Pair(coarse, fine, error, self.off, enough or not settles, settles or enough)


@dataclass(frozen=True)
class _Pair:
    """Two grids and what they differ by."""

    coarse: Level
    fine: Level
    error: float  # of central and minimum film
    off: float  # likewise of the spike's pressure
    enough: bool
    settles: bool  # whether the spike's error falls from grid to grid

    def reported(self, run: GridSearch, inlet: float, options: Options) -> GridSolution:
        """Say what was found, and what of the error is left."""
        report = GridSolution(run, self.coarse, self.fine, self.error, inlet)
        if not self.settles:
            return replace(report, failure=f"error {self.off:.2g} of the spike, which does not settle")
        if self.enough:
            return report
        nodes = self.fine.grid.nodes.size
        if options.spike is None and self.error < WORST:
            note = f"{above(self.error, options.tolerance, nodes)}: {remedy(run, self.fine.plan)}"
            return replace(report, note=note, supply=run.supply)
        above_tolerance = self.error > options.tolerance
        remaining = f"error {self.error:.2g}" if above_tolerance else f"error {self.off:.2g} of the spike"
        return replace(report, failure=f"{remaining} left on {nodes} nodes")
