"""The meniscus of an oil layer on one grid: nodes and film move with it until the flow is that of the layer.

How pressures and separation follow the meniscus is known, first from the Newton matrix of the film to start from, then
from the last two films. So each place is solved from what is expected there, and by no more of Newton's steps than the
next place needs: about one for each move of the nodes, as if the place were one more unknown. Films with heat, whose
matrix leaves out most of what the oil does, begin with a separate step.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Generic, Protocol, TypeVar

import numpy as np

from base import Array
from ehl.discrete.equations import Grid
from ehl.solving.levels import Level, transfer
from ehl.solving.meniscus import MeniscusSearch
from ehl.solving.plan import Plan
from ehl.solving.response import by_distance, moved_grid

_TRIES = 40
_NEAR = 0.3  # change of ln(distance) within which slopes say what the film becomes
_FOLLOWED = 0.1  # Newton step over the step of the meniscus after which the next place is tried,
_ROUGH = 3e-3  # and the largest such step

L = TypeVar("L", bound=Level)


class Films(Protocol[L]):
    """Films of one contact, with heat or without, and the effort so far."""

    restarts: int

    @property
    def finest(self) -> float:
        """Last Newton step of a film that is solved to its end."""

    @property
    def exhausted(self) -> bool:
        """Whether the call has had its Newton steps."""

    def near(self, old: L, plan: Plan, grid: Grid, start: tuple[Array, float], done: float) -> L:
        """Solve from pressures and separation on a grid, the film of another grid being known."""


class LayerSupply(Generic[L]):
    """Films of a contact behind one meniscus after another."""

    def __init__(self, films: Films[L], level: L, layer: float, enough: float | None = None) -> None:
        self.films = films
        self.level = level
        self.layer = layer  # [m]
        self.lead: tuple[Array, float] | None = None  # of pressures and separation by ln(distance)
        about = {} if enough is None else {"enough": enough}
        if level.oil is None:
            lead = by_distance(level)
            self.lead, about["slope"] = (lead.P, lead.H0), lead.flow / level.flow
        self.search = MeniscusSearch.at(-1.0 - level.plan.domain[0], self.miss(level), **about)

    def miss(self, level: L) -> float:
        """Ln of the flow over the layer."""
        return math.log(level.flow / self.layer)

    def solve(self) -> L:
        """Give the film that carries away what the layer brings, or one that says that there is none."""
        search = self.search
        for _ in range(_TRIES):
            if search.done or search.stuck:
                if not search.rough:
                    break
                self.polish()
            elif self.films.exhausted:
                break
            else:
                self.move()
        if search.done and not search.rough:
            return self.level
        message = f"the meniscus that lets a layer of {self.layer:.3g} m pass was not found"
        failed = replace(self.level.solution, converged=False, message=message)
        return replace(self.level, solution=failed)

    def polish(self) -> None:
        """Solve to the end at the place of the last film."""
        level = self.level
        self.level = self.plainly(level.plan, level.grid)
        self.search.corrected(self.miss(self.level))

    def plainly(self, plan: Plan, grid: Grid) -> L:
        """Solve to the end from the last film as it is."""
        start = transfer(self.level, self.level.contact, plan, grid)
        return self.films.near(self.level, plan, grid, start, self.films.finest)

    def move(self) -> None:
        """Solve at the place to be tried."""
        search, old, step, finest = self.search, self.level.solution, self.search.step, self.films.finest
        plan = self.level.plan.with_inlet(-1.0 - search.distance)
        done = min(max(_FOLLOWED * abs(step), finest), max(_ROUGH, finest))
        trial = self.expected(plan, step, done) if abs(step) < _NEAR else None
        rough = trial is not None and done > finest
        if trial is None:
            trial = self.plainly(plan, plan.grid(old.P.size))
        if not trial.solution.converged:
            self.films.restarts += 1
            search.failed()
            return
        self.lead = (trial.solution.P - old.P) / step, (trial.solution.H0 - old.H0) / step
        self.level = trial
        search.solved(self.miss(trial), rough=rough)

    def expected(self, plan: Plan, step: float, done: float) -> L | None:
        """Solve from what a step of the meniscus is expected to change; None where that does not converge."""
        if self.lead is None:
            return None
        old = self.level.solution
        P = np.maximum(old.P + step * self.lead[0], 0.0)
        P[-1] = 0.0
        start = P, old.H0 + step * self.lead[1]
        trial = self.films.near(self.level, plan, moved_grid(self.level, plan), start, done)
        return trial if trial.solution.converged else None
