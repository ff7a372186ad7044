"""The meniscus of an oil layer on one grid: nodes and film move with it until the flow is that of the layer.

How pressures and separation follow the meniscus is known, first from the Newton matrix of the film to start from, then
from the last two films. So each place is solved from what is expected there, and by no more of Newton's steps than the
next place needs: about one for each move of the nodes, as if the place were one more unknown.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

import numpy as np

from ehl.discrete.contact import LineContact
from ehl.discrete.equations import Groups
from ehl.discrete.newton import STEP_DONE, newton
from ehl.solving.levels import Level, warm
from ehl.solving.meniscus import MeniscusSearch
from ehl.solving.plan import Plan
from ehl.solving.response import by_distance, moved_grid

_TRIES = 40
_NEAR = 0.3  # change of ln(distance) within which slopes say what the film becomes
_FOLLOWED = 0.1  # Newton step over the step of the meniscus after which the next place is tried,
_ROUGH = 3e-3  # and the largest such step


class Counting(Protocol):
    """The contact of a call of the solver, and its effort so far."""

    contact: LineContact
    restarts: int

    @property
    def exhausted(self) -> bool:
        """Whether the call has had its Newton steps."""

    def count(self, level: Level) -> Level:
        """Add a level to the cost."""


class LayerSupply:
    """Films of a contact behind one meniscus after another."""

    def __init__(self, run: Counting, level: Level, layer: float) -> None:
        self.run = run
        self.level = level
        self.layer = layer  # [m]
        lead = by_distance(level)
        self.lead = lead.P, lead.H0  # by ln(distance)
        self.search = MeniscusSearch.at(-1.0 - level.plan.domain[0], self.miss(level), lead.flow / level.flow)

    def miss(self, level: Level) -> float:
        """Ln of the flow over the layer."""
        return math.log(level.flow / self.layer)

    def solve(self) -> Level:
        """Give the film that carries away what the layer brings, or one that says that there is none."""
        search = self.search
        for _ in range(_TRIES):
            if search.done or search.stuck:
                if not search.rough:
                    break
                self.polish()
            elif self.run.exhausted:
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
        self.level = self.run.count(warm(level, self.run.contact, level.plan, level.grid))
        self.search.corrected(self.miss(self.level))

    def move(self) -> None:
        """Solve at the place to be tried."""
        search, old, step = self.search, self.level.solution, self.search.step
        plan = self.level.plan.with_inlet(-1.0 - search.distance)
        done = min(max(_FOLLOWED * abs(step), STEP_DONE), _ROUGH)
        trial = self.expected(plan, step, done) if abs(step) < _NEAR else None
        rough = trial is not None and done > STEP_DONE
        if trial is None:
            trial = self.run.count(warm(self.level, self.run.contact, plan, plan.grid(old.P.size)))
        if not trial.solution.converged:
            self.run.restarts += 1
            search.failed()
            return
        self.lead = (trial.solution.P - old.P) / step, (trial.solution.H0 - old.H0) / step
        self.level = trial
        search.solved(self.miss(trial), rough=rough)

    def expected(self, plan: Plan, step: float, done: float) -> Level | None:
        """Solve from what a step of the meniscus is expected to change; None where that does not converge."""
        contact, old = self.run.contact, self.level.solution
        grid = moved_grid(self.level, plan)
        P = np.maximum(old.P + step * self.lead[0], 0.0)
        P[-1] = 0.0
        solution = newton(grid, Groups.on(contact, grid), P, old.H0 + step * self.lead[1], done=done)
        level = self.run.count(Level(contact, plan, grid, solution))
        return level if solution.converged else None
