"""Films without heat on finer and finer grids, until two of them agree as asked."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from base.results import WORST
from ehl.discrete.method import METHOD
from ehl.films.result import GridSolution, above, film_error, remedy, spike_error
from ehl.solving.grid_search import GridSearch
from ehl.solving.levels import Level
from ehl.solving.options import Options
from ehl.solving.refinement import doubled, doublings, refine

_SHARP_NODES = 257
_SETTLING = 0.7  # the spike's error has to fall by this factor from grid to grid


def refined(run: GridSearch, coarse: Level, fine: Level, options: Options) -> GridSolution:
    """Double the grid until the estimates meet what is asked, then report."""
    inlet = run.plan.inlet_error
    films = _Films(run, options, inlet)
    if options.sharp and coarse.solution.converged and fine.solution.converged:
        if options.nodes is None and options.spike is None and films.compared(coarse, fine).enough:
            return GridSolution(run, coarse, fine, film_error(coarse, fine) + inlet, inlet)
        n = _SHARP_NODES if options.nodes is None else fine.grid.nodes.size
        coarse = run.sharpened(fine, (n + 1) // 2)
        fine = run.sharpened(coarse, n)
    if not coarse.solution.converged:
        return GridSolution(run, coarse, fine, math.nan, inlet, coarse.solution.message)
    films.first = coarse, fine
    half, n = coarse.grid.nodes.size, fine.grid.nodes.size
    finer = doublings(n, METHOD.most_nodes) if options.nodes is None else ()
    nearest = refine(doubled(films, (half, n, *finer)))
    if run.failed is not None or nearest is None:
        failed = run.failed or fine
        return GridSolution(run, coarse, failed, math.nan, inlet, failed.solution.message)
    return nearest.reported(run, inlet, options)


class _Films:
    """Films of one call; grids that are prescribed have no tolerance to meet."""

    def __init__(self, run: GridSearch, options: Options, inlet: float) -> None:
        self.run, self.options, self.inlet, self.off = run, options, inlet, math.inf
        self.first: tuple[Level, ...] = ()  # levels that are solved already

    def on(self, nodes: int, near: Level | None) -> Level | None:
        """Give the first two grids, and ever finer ones from the last that gave in."""
        run = self.run
        level = next((known for known in self.first if known.grid.nodes.size == nodes), None)
        if level is None:
            assert near is not None  # the first grid is solved already
            if run.failed is not None and (nodes > run.most_cold or run.exhausted):
                return None
            sharp = self.options.sharp and run.failed is None
            level = run.sharpened(near, nodes) if sharp else run.warm(near, None, nodes)
        run.failed = None if level.solution.converged else level
        return level if run.failed is None else None

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
