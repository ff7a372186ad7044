"""Branches gathered for a diagram: each followed once, and from its period doublings on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.branch import MEETS, Branch
from dynamics.conditions import Condition, special_orbit
from dynamics.continuation import continue_branch
from dynamics.corrector import OrbitProblem
from dynamics.flow import period_map
from dynamics.oscillator import GearOscillator
from dynamics.shooting import Orbit
from dynamics.switching import doubled_orbit

__all__ = ["Gathering", "Origin"]

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Origin:
    """How a branch was come by.

    Parameters
    ----------
    parent : int or None
        Branch whose period doubling it leaves; None if a search found it.
    value : float
        Parameter at the period doubling or of the search.
    """

    parent: int | None
    value: float

    def __str__(self) -> str:
        """In words."""
        if self.parent is None:
            return f"found at {self.value:.6g}"
        return f"period doubling of branch {self.parent} at {self.value:.10g}"


class Gathering:
    """Branches so far, how each was come by, and what was left out."""

    def __init__(
        self, oscillator: GearOscillator, parameter: str, bounds: tuple[float, float], longest: int, most: int,
        max_step: float, progress: Callable[[int, str], None] | None,
    ) -> None:  # fmt: skip
        self.oscillator, self.parameter, self.bounds = oscillator, parameter, bounds
        self.longest, self.most, self.max_step, self.progress = longest, most, max_step, progress
        self.branches: list[Branch] = []
        self.origins: list[Origin] = []
        self.left_out: list[str] = []
        self.ends: list[tuple[int, float]] = []
        self.periods = 0

    def follow(self, orbit: Orbit, origin: Origin) -> None:
        """Follow an orbit, and then the branches that its period doublings lead to."""
        waiting = [(orbit, origin)]
        while waiting:
            start, source = waiting.pop(0)
            value = start.oscillator.get(self.parameter)
            if source.parent is not None and self._taken(start.periods, source.value):
                continue
            if self.holds(start, value):
                continue
            if len(self.branches) >= self.most:
                self.left_out.append(
                    f"{start.label} at {value:.10g}: {self.most} branches, raise max_branches"
                )
                continue
            if self.progress is not None:
                self.progress(len(self.branches), f"{start.label} {source}")
            branch = continue_branch(start, self.parameter, self.bounds, max_step=self.max_step)
            self.periods += branch.cost.periods
            self.branches.append(branch)
            self.origins.append(source)
            mine = len(self.branches) - 1
            self._note_ends(branch)
            for point in branch.special("period-doubling"):
                if self._taken(2 * point.periods, point.parameter):
                    continue
                if 2 * point.periods > self.longest:
                    self.left_out.append(
                        f"period doubling of {point.label} at {point.parameter:.10g}: beyond max_period"
                    )
                    continue
                doubled = doubled_orbit(self.oscillator, self.parameter, point, self.bounds)
                if doubled is None:
                    self.left_out.append(
                        f"period doubling of {point.label} at {point.parameter:.10g}: no doubled orbit found"
                    )
                else:
                    waiting.append((doubled, Origin(mine, point.parameter)))

    def _note_ends(self, branch: Branch) -> None:
        """Note the period doublings at which a branch ends, so that it is not followed from its other end."""
        low, high = (np.array([b]) for b in self.bounds)
        n = branch.periods // 2
        for k in (0, -1):
            if branch.ended[k] != MEETS:
                continue
            state, value = branch.states[k], float(branch.values[k])
            half = period_map(self.oscillator.with_parameter(self.parameter, value), state, n).state
            scale = max(float(np.max(np.abs(state))), self.oscillator.half_backlash, 1e-300)
            problem = OrbitProblem(self.oscillator, (self.parameter,), n, low, high, scale)
            guess = problem.unknowns(0.5 * (state + half), value)
            point = special_orbit(problem, Condition("period-doubling"), guess)
            if point is not None:
                value = point.value
            else:  # a corner next to a grazing: the nearest of those known
                known = [
                    p.parameter for b in self.branches if b.periods == n for p in b.special("period-doubling")
                ]
                value = min(known, key=lambda at: abs(at - value), default=value)
            self.ends.append((branch.periods, value))

    def _taken(self, periods: int, value: float) -> bool:
        """Tell whether a branch of this period ends at the value by meeting that of half its period."""
        near = 1e-7 * (self.bounds[1] - self.bounds[0])
        return any(periods == n and abs(end - value) < near for n, end in self.ends)

    def holds(self, orbit: Orbit, value: float) -> bool:
        """Tell whether an orbit lies on one of the branches."""
        points = period_map(orbit.oscillator, orbit.state, orbit.periods).states
        return any(
            self._on(branch, points, value) for branch in self.branches if branch.periods == orbit.periods
        )

    def _on(self, branch: Branch, points: FloatArray, value: float) -> bool:
        """Tell whether a branch passes through one of the points of an orbit at a value."""
        off = branch.values - value
        scale = max(float(np.max(np.abs(branch.states))), 1e-300)
        low, high = (np.array([b]) for b in self.bounds)
        problem = OrbitProblem(self.oscillator, (self.parameter,), branch.periods, low, high, scale)
        for i in np.flatnonzero(off[:-1] * off[1:] <= 0.0):
            share = off[i] / (off[i] - off[i + 1]) if off[i] != off[i + 1] else 0.5
            guess = branch.states[i] + share * (branch.states[i + 1] - branch.states[i])
            chord = float(np.max(np.abs(branch.states[i + 1] - branch.states[i])))
            near = float(np.min(np.max(np.abs(points - guess), axis=1)))
            if near > 2.0 * chord + 1e-3 * scale:
                continue
            there = problem.correct(problem.unknowns(guess, value), np.array([0.0, 0.0, 1.0]))
            if (
                there is not None
                and float(np.min(np.max(np.abs(points - there.state), axis=1))) < 1e-7 * scale
            ):
                return True
        return False
