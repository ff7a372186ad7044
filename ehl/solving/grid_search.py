"""One call of the solver: grids one after another, with what is tried where Newton's method fails."""

from __future__ import annotations

import math
from dataclasses import replace

from base import Array, Cost, Stopwatch, unclocked
from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Grid, Groups
from ehl.discrete.grid import clusters
from ehl.discrete.method import METHOD
from ehl.discrete.newton import newton
from ehl.discrete.supply import OilLayer, Supply
from ehl.solving.layer_supply import LayerSupply
from ehl.solving.levels import Level, State, cold, spike_of, warm
from ehl.solving.plan import Plan

_STEP_NODES = 257

_STARTS = (2.0, 8.0)  # films to start from, over the expected one
_MOST_COLD_NODES = 1025
_MOST_COLD_NODES_DRY = 257  # a film that such a grid does not resolve is as good as none
_SPIKE_ROUNDS = 5
_SPIKE_LEAST = 1e-7  # narrowest cluster of nodes [half-widths]
_SPIKE_FOR_FILM = 0.02  # narrowest cluster where the film alone is asked for, over the outlet zone
_SPIKE_CELL = 0.5  # width of the cluster of nodes over that of the spike
_SPIKE_SETTLED = 1.5  # factor of the spike's width that needs no new grid
_SPIKE_SHRINK = 8.0  # most that the cluster narrows at once: a spike narrower than its cells is not located


class GridSearch:
    """Counts what it does; ``plan`` is how the next grid is laid, ``own`` how this contact alone would have it."""

    finest = METHOD.newton_done

    def __init__(
        self,
        contact: LineContact,
        plan: Plan,
        supply: Supply | None,
        *,
        whole_spike: bool = False,
        flooded: State | None = None,
        spent: Cost | None = None,
    ) -> None:
        self.contact = contact
        self.plan = self.own = plan
        self.supply = supply
        self.whole_spike = whole_spike
        self.most_cold = _MOST_COLD_NODES_DRY if plan.H_c < METHOD.dry else _MOST_COLD_NODES
        self.narrowest = _SPIKE_LEAST if whole_spike else _SPIKE_FOR_FILM * clusters(plan.H_c)[1]
        with unclocked():
            import ehl.kernels.film_kernels  # noqa: F401  numba

        self.watch = Stopwatch()
        self.iterations = self.most_nodes = self.restarts = 0
        self.spent = spent
        self.flooded = flooded  # of this contact, or of one like it
        self.work = 0.0
        self.failed: Level | None = None  # finest grid, where it did not give in

    @property
    def exhausted(self) -> bool:
        """Whether the call has had its Newton steps."""
        return self.work >= METHOD.newton_steps

    def count(self, level: Level) -> Level:
        """Add a level to the cost."""
        self.iterations += level.solution.iterations
        self.work += level.solution.iterations * level.grid.nodes.size / _STEP_NODES
        self.most_nodes = max(self.most_nodes, level.grid.nodes.size)
        return level

    def cold(self, n: int) -> Level:
        """Solve from nothing; where that fails, from a thicker film, then by continuation in the load."""
        return self.fed(self._cold(n))

    def _cold(self, n: int) -> Level:
        grid = self.plan.grid(n)
        for thickness in _STARTS:
            level = self.count(cold(self.contact, self.plan, grid, thickness * self.plan.H_c))
            if level.solution.converged:
                return level
            self.restarts += 1
            if self.exhausted:
                return self.out_of_steps(level)
        return self.descend(level)

    def pair(self, half: int, n: int) -> tuple[Level, Level]:
        """Solve a coarse and a fine grid from nothing, the one that gives in first before the other."""
        coarse = self.cold(half)
        if coarse.solution.converged:
            return coarse, self.warm(coarse, None, n)
        fine = self.cold(n)
        return (self.warm(fine, None, half) if fine.solution.converged else coarse), fine

    def descend(self, failed: Level) -> Level:
        """Continue in the load, from a contact soft enough to be solved from cold, on the failed grid."""
        plan, grid = failed.plan, failed.grid
        for factor in (0.5, 0.2, 0.05):
            load = factor * self.contact.load
            easier = replace(self.contact, load=load)
            level = self.count(cold(easier, plan, grid, _STARTS[-1] * plan.H_c / factor))
            step = 1.5
            while (
                level.solution.converged and load < self.contact.load and step > 1.01 and not self.exhausted
            ):
                target = min(self.contact.load, step * load)
                trial = self.count(warm(level, replace(self.contact, load=target), plan, grid))
                if trial.solution.converged:
                    level, load = trial, target
                else:
                    step = math.sqrt(step)
            if level.solution.converged and load == self.contact.load:
                return replace(level, contact=self.contact)
            self.restarts += 1
            if self.exhausted:
                return self.out_of_steps(failed)
        return failed

    def out_of_steps(self, level: Level) -> Level:
        """Return a level that says why nothing more was tried."""
        message = f"no solution within {self.iterations} Newton steps"
        return replace(level, solution=replace(level.solution, converged=False, message=message))

    def warm(self, old: Level, grid_of: Level | None, n: int) -> Level:
        """Solve from another level, on its grid if one is given; from cold where that fails."""
        plan, grid = (self.plan, self.plan.grid(n)) if grid_of is None else (grid_of.plan, grid_of.grid)
        level = self.count(warm(old, self.contact, plan, grid))
        if level.solution.converged:
            return self.fed(level)
        self.restarts += 1
        if self.plan.spike is not None:
            self.plan = replace(self.plan, spike=None)
            return self.warm(old, None, n)
        if (
            self.plan != self.own and not self.plan.fixed
        ):  # grids laid for a neighbour need not suit this contact
            self.plan = self.own
            return self.warm(old, None, n)
        if n > self.most_cold or self.exhausted:
            return level
        self.plan = self.own
        return self.cold(n)

    def near(
        self, old: Level, plan: Plan, grid: Grid, start: tuple[Array, float], done: float = METHOD.newton_done
    ) -> Level:
        """Solve from pressures and separation on a grid."""
        solution = newton(grid, Groups.on(self.contact, grid), *start, done=done)
        return self.count(Level(self.contact, plan, grid, solution))

    def fed(self, level: Level) -> Level:
        """Move the meniscus until the film carries away what the layer brings; the plan is left at the one found."""
        if not (isinstance(self.supply, OilLayer) and self.plan.fixed and level.solution.converged):
            return level
        supplied = LayerSupply(self, level, self.supply.thickness).solve()
        if supplied.solution.converged:
            self.plan = self.own = replace(supplied.plan, spike=self.plan.spike)
        return supplied

    def sharpened(self, level: Level, n: int) -> Level:
        """Lay the grid around the spike that was found, until its width no longer changes the grid."""
        if level.grid.nodes.size != n:
            level = self.warm(level, None, n)
        for _ in range(_SPIKE_ROUNDS):
            tip = spike_of(level) if level.solution.converged else None
            if tip is None:
                return level
            old = self.plan.spike
            width = max(_SPIKE_CELL * tip.width, self.narrowest)
            if old is not None:
                width = max(width, old[1] / _SPIKE_SHRINK)
                moved = abs(tip.position - old[0])
                if moved < 2.0 * width and max(width / old[1], old[1] / width) < _SPIKE_SETTLED:
                    return level
            before = self.plan
            self.plan = replace(before, spike=(tip.position, width))
            trial = self.count(warm(level, self.contact, self.plan, self.plan.grid(n)))
            if not trial.solution.converged:
                self.plan = before
                return level
            level = self.fed(trial)
        return level

    def cost(self) -> Cost:
        """Return what was spent."""
        own = Cost(
            self.watch.seconds,
            unknowns=self.most_nodes - 1,
            iterations=self.iterations,
            counts={"restarts": self.restarts},
        )
        return own if self.spent is None else self.spent + own
