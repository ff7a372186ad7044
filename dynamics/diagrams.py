"""Whole bifurcation diagrams: every branch that searches and period doublings lead to."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.conditions import Condition, special_orbit
from dynamics.continuation import KINDS, MEETS, Branch, continue_branch
from dynamics.corrector import OrbitProblem
from dynamics.cost import Cost
from dynamics.errors import Faults
from dynamics.finding import find_orbits
from dynamics.flow import period_map
from dynamics.oscillator import GearOscillator
from dynamics.shooting import Orbit
from dynamics.special import SpecialPoint
from dynamics.switching import doubled_orbit

__all__ = ["Diagram", "Origin", "diagram"]

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


@dataclass(frozen=True, eq=False)
class Diagram:
    """Branches of periodic orbits over one parameter.

    Parameters
    ----------
    oscillator : GearOscillator
        What moves; its value of the parameter is not used.
    parameter : str
        What is varied.
    bounds : tuple of float
        Its range.
    branches : tuple of Branch
        In the order in which they were found.
    origins : tuple of Origin
        How each was found.
    left_out : tuple of str
        Period doublings that were not followed, and why.
    unsure : tuple of float
        Parameter values of searches at which the indices of the orbits do not add up: something may be missing.
    error : float
        Largest estimated relative error of a special point.
    cost : Cost
        Effort.
    converged : bool
        Whether every branch ended for a good reason and every search's indices add up.
    message : str
        What was found.
    """

    oscillator: GearOscillator
    parameter: str
    bounds: tuple[float, float]
    branches: tuple[Branch, ...]
    origins: tuple[Origin, ...]
    left_out: tuple[str, ...]
    unsure: tuple[float, ...]
    error: float
    cost: Cost
    converged: bool
    message: str

    def special(self, kind: str) -> list[SpecialPoint]:
        """Special points of one kind on all branches, by parameter.

        Parameters
        ----------
        kind : str
            "saddle-node", "period-doubling" or "grazing".

        Raises
        ------
        DynamicsError
            If there is no such kind.
        """
        return sorted((p for b in self.branches for p in b.special(kind)), key=lambda p: p.parameter)

    def table(self) -> list[tuple[int, str, float, str, float, float]]:
        """Rows branch, kind, parameter, label, X, V of every special point, branch by branch."""
        return [
            (i, p.kind, p.parameter, p.label, float(p.state[0]), float(p.state[1]))
            for i, branch in enumerate(self.branches)
            for p in branch.points
        ]

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Columns branch, parameter, X, V, stable (0 or 1) of all points: what a plot needs."""
        rows = [
            np.column_stack([np.full(len(b.values), i), b.values, b.states, b.stable])
            for i, b in enumerate(self.branches)
        ]
        return (np.concatenate(rows) if rows else np.empty((0, 5))).astype(
            dtype if dtype is not None else np.float64
        )


def diagram(
    oscillator: GearOscillator,
    parameter: str = "frequency",
    bounds: tuple[float, float] = (0.1, 2.1),
    *,
    periods: Sequence[int] = (1, 2, 3),
    searches: int = 9,
    max_period: int = 8,
    max_branches: int = 100,
    max_step: float = 0.02,
    progress: Callable[[int, str], None] | None = None,
) -> Diagram:
    """Build the bifurcation diagram of periodic orbits over one parameter.

    Orbits are searched for at several values of the parameter; each that lies on no branch known so far is followed
    both ways. From every period doubling the branch of twice the period is followed, and so on. A branch ends at a
    bound, where it closes, or where it meets the branch of half its period.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator; its value of the parameter is not used.
    parameter : str
        As in `GearOscillator.with_parameter`.
    bounds : tuple of float
        Range of the parameter.
    periods : sequence of int
        Periods searched for.
    searches : int
        Values of the parameter at which orbits are searched for, at the middles of equal intervals. A branch that
        exists between two of them only, and that no period doubling leads to, is missed.
    max_period : int
        Longest period followed.
    max_branches : int
        Branches followed at most.
    max_step : float
        Largest step along a branch, as in `continue_branch`.
    progress : callable, optional
        Called with the number of branches and what is done next.

    Returns
    -------
    Diagram
        Branches, special points, and what was left out.

    Raises
    ------
    DynamicsError
        If an argument is out of range.
    """
    began = time.perf_counter()
    faults = Faults()
    low, high = (faults.number(f"bounds[{i}]", bounds[i]) for i in range(2))
    if not low < high:
        faults.add("bounds", bounds, "the lower value first", "give (low, high)")
    number = faults.whole("searches", searches, 1, 10_000, "9 is usual")
    longest = faults.whole("max_period", max_period, 1, 1000, "8 shows three doublings")
    most = faults.whole("max_branches", max_branches, 1, 100_000, "100 is usual")
    faults.raise_if_any()
    builder = _Builder(oscillator, parameter, (low, high), longest, most, max_step, progress)
    unsure = []
    for k in range(number):
        value = low + (k + 0.5) / number * (high - low)
        found = find_orbits(oscillator.with_parameter(parameter, value), periods)
        builder.periods += found.cost.periods
        if not found.converged and any(c.expected is not None for c in found.counts):
            unsure.append(value)
        for orbit in found.orbits:
            if not builder.holds(orbit, value):
                builder.follow(orbit, Origin(None, value))
    return builder.result(tuple(unsure), began)


class _Builder:
    """Branches so far."""

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

    def result(self, unsure: tuple[float, ...], began: float) -> Diagram:
        """Assemble the record."""
        branches = tuple(self.branches)
        bad = [i for i, b in enumerate(branches) if not b.converged]
        tally = ", ".join(f"{sum(len(b.special(kind)) for b in branches)} {kind}s" for kind in KINDS)
        message = f"{len(branches)} branches; {tally}"
        if bad:
            message += f"; branch {bad[0]} did not end well: {branches[bad[0]].message}"
        if unsure:
            message += f"; orbits may be missing near {self.parameter} = {unsure[0]:.6g}: more searches"
        iterations = sum(b.cost.iterations for b in branches)
        return Diagram(
            self.oscillator, self.parameter, self.bounds, branches, tuple(self.origins), tuple(self.left_out), unsure,
            max((b.error for b in branches), default=0.0),
            Cost(time.perf_counter() - began, 3, iterations, self.periods), not (bad or unsure), message,
        )  # fmt: skip
