"""Branches gathered for a diagram: each followed once, and from its period doublings on."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from dynamics.branches.branch import MEETS, Branch
from dynamics.branches.continuation import continue_branch, doubled_orbit, orbits_over
from dynamics.model.options import OPTIONS
from dynamics.model.states import apart
from dynamics.orbits.shooting import Orbit


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


@dataclass
class BranchTree:
    """Branches so far, how each was come by, and what was left out.

    Parameters
    ----------
    oscillator : GearOscillator
        What moves; its value of the parameter is not used.
    parameter : str
        What is varied.
    bounds : tuple of float
        Its range.
    longest, most : int
        Longest period and number of branches that are followed.
    max_step, max_points : float, int
        Largest step along a branch, and its points in each direction.
    progress : callable, optional
        Called with the number of branches and what is done next.
    """

    oscillator: Any
    parameter: str
    bounds: tuple[float, float]
    longest: int
    most: int
    max_step: float
    max_points: int = 5000
    progress: Callable[[int, str], None] | None = None
    branches: list[Branch] = field(default_factory=list)
    origins: list[Origin] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    ends: list[tuple[int, float]] = field(default_factory=list)
    periods: int = 0

    def follow(self, orbit: Orbit, origin: Origin) -> None:
        """Follow an orbit, and then the branches that its period doublings lead to."""
        waiting = [(orbit, origin)]
        while waiting:
            start, source = waiting.pop(0)
            value = start.oscillator.get(self.parameter)
            taken = source.parent is not None and self._taken(start.periods, source.value)
            if taken or self.holds(start):
                continue
            if len(self.branches) >= self.most:
                self._leave_out(start.label, value, f"{self.most} branches, raise max_branches")
                continue
            if self.progress is not None:
                self.progress(len(self.branches), f"{start.label} {source}")
            branch = continue_branch(
                start, self.parameter, self.bounds, max_step=self.max_step, max_points=self.max_points
            )
            self.periods += branch.cost.periods
            self.branches.append(branch)
            self.origins.append(source)
            mine = len(self.branches) - 1
            self._note_ends(branch)
            waiting += [(o, Origin(mine, value)) for o, value in self._doubled(branch)]

    def _doubled(self, branch: Branch) -> Iterator[tuple[Orbit, float]]:
        """Orbits of twice the period that leave a branch, with the parameters of their period doublings."""
        for point in branch.special("period-doubling"):
            if self._taken(2 * point.periods, point.parameter):
                continue
            name = f"period doubling of {point.label}"
            if 2 * point.periods > self.longest:
                self._leave_out(name, point.parameter, "beyond max_period")
                continue
            orbit = doubled_orbit(self.oscillator, self.parameter, point, self.bounds)
            if orbit is None:
                self._leave_out(name, point.parameter, "no doubled orbit found")
            else:
                yield orbit, point.parameter

    def _leave_out(self, name: str, value: float, why: str) -> None:
        self.left_out.append(f"{name} at {value:.10g}: {why}")

    def _note_ends(self, branch: Branch) -> None:
        """Note the period doublings at which a branch ends, so that it is not followed from its other end."""
        for k in (0, -1):
            if branch.ended[k] == MEETS:
                point = branch.meetings[k]
                value = float(branch.values[k]) if point is None else point.parameter
                self.ends.append((branch.periods, value))

    def _taken(self, periods: int, value: float) -> bool:
        """Whether a branch of this period ends at the value by meeting that of half its period."""
        near = 1e-7 * (self.bounds[1] - self.bounds[0])
        return any(periods == n and abs(end - value) < near for n, end in self.ends)

    def holds(self, orbit: Orbit) -> bool:
        """Whether an orbit lies on one of the branches."""
        return any(lies_on(branch, orbit, self.bounds) for branch in self.branches)


def lies_on(branch: Branch, orbit: Orbit, bounds: tuple[float, float]) -> bool:
    """Whether a branch passes through an orbit, perhaps from another period on.

    Parameters
    ----------
    branch : Branch
        The branch.
    orbit : Orbit
        The orbit, at its own value of the branch's parameter.
    bounds : tuple of float
        Range of that parameter.
    """
    if branch.periods != orbit.periods:
        return False
    value, points = orbit.oscillator.get(branch.parameter), orbit.points
    off = branch.values - value
    scale = max(float(np.max(np.abs(branch.states))), 1e-300)
    problem = orbits_over(orbit.oscillator, branch.parameter, branch.periods, bounds, scale)
    for i in np.flatnonzero(off[:-1] * off[1:] <= 0.0):
        share = off[i] / (off[i] - off[i + 1]) if off[i] != off[i + 1] else 0.5
        chord = branch.states[i + 1] - branch.states[i]
        guess = branch.states[i] + share * chord
        if apart(guess, points) > 2.0 * float(np.max(np.abs(chord))) + 1e-3 * scale:
            continue
        there = problem.correct(problem.unknowns(guess, value), problem.flat)
        if there is not None and apart(there.u[: problem.size] * scale, points) < OPTIONS.same_orbit * scale:
            return True
    return False
