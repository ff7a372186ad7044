"""The special points that an oscillator has on the branches on which events may lie."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.attraction.branch_tree import BranchTree, Origin
from dynamics.branches.branch import SpecialPoint
from dynamics.branches.continuation import continue_branch
from dynamics.branches.moved_special_points import marked
from dynamics.flow.motions import period_map
from dynamics.inverse.events import Event, Problem
from dynamics.inverse.matching import Line, match
from dynamics.inverse.refinement import Fit
from dynamics.model.options import OPTIONS
from dynamics.model.oscillator import GearOscillator
from dynamics.orbits.finding import find_orbits
from dynamics.orbits.shooting import Orbit, find_orbit

SETTLED = 2000  # periods in which the motion at the upper bound is taken to have settled
STEP, MAX_POINTS, MOST = 0.05, 1500, 10**6  # largest step along a branch, its points, and branches at most
CAPTURE = 0.02  # of the range: a point of the kind and label so near makes a search around the event needless
BESIDE = (0.002, 0.015)  # of the range: how far beside an event its orbit is searched for
LONGEST = 4  # period searched for where an event does not say
CONTACT, DOUBLED, EVERY = 0, 1, 2


@dataclass
class Tally:
    """What the searches took."""

    branches: int = 0
    periods: int = 0


@dataclass(frozen=True)
class Catalogue:
    """Builds branches, and counts what they take.

    Parameters
    ----------
    problem : Problem
        What is sought.
    tally : Tally
        Where it is counted.
    """

    problem: Problem
    tally: Tally

    def lines(self, here: GearOscillator, depth: int) -> list[Line]:
        """Special points, branch by branch.

        Parameters
        ----------
        here : GearOscillator
            The oscillator.
        depth : int
            CONTACT: the branch of the motion that is in contact at the lower bound. DOUBLED: that of the motion at the
            upper bound too, and the doubled branches of both that events ask for. EVERY: where an event still has no
            partner near it, also the branches of the orbits of its label that a search around it finds.
        """
        problem = self.problem
        asked_for = max((e.periods or LONGEST for e in problem.events), default=1)
        longest = asked_for if depth >= DOUBLED else 1
        gathered = BranchTree(here, problem.parameter, problem.bounds, longest, MOST, STEP, MAX_POINTS)
        lowest = here.with_parameter(problem.parameter, problem.bounds[0])
        self._gather(gathered, [find_orbit(lowest, lowest.rest_state())])
        if depth >= DOUBLED:
            self._gather(gathered, self._upper(here, problem.bounds[1]))
        gathered.longest = (
            1  # branches that a search around an event finds, but not those that double from them
        )
        for event in problem.events if depth == EVERY else ():
            self._around(gathered, event)
        self.tally.branches += len(gathered.branches)
        self.tally.periods += gathered.periods
        lines: list[Line] = []
        known: list[SpecialPoint] = []
        for branch in gathered.branches:
            new = tuple(p for p in branch.points if not any(_same(p, q, self.problem.width) for q in known))
            lines += [new] if new else []
            known += new
        return lines

    def partners(
        self, here: GearOscillator, depth: int
    ) -> tuple[list[Line], tuple[SpecialPoint | None, ...]]:
        """Special points and those that the events are."""
        lines = self.lines(here, depth)
        return lines, match(lines, self.problem.events, self.problem.width)

    def misfit(self, here: GearOscillator, depth: int, rows: Sequence[int] | None = None) -> float:
        """Sum of the losses of these events, of the fitted ones if none are named."""
        _, partners = self.partners(here, depth)
        return self.problem.misfit([math.nan if p is None else p.parameter for p in partners], rows)

    def start(self, here: GearOscillator, depth: int) -> tuple[list[Line], Fit]:
        """Special points, and the events' among them to fit to."""
        lines, partners = self.partners(here, depth)
        marks = (None if p is None else marked(here, self.problem.parameter, p) for p in partners)
        return lines, Fit(self.problem, here, tuple(marks))

    def values_along(self, orbit: Orbit, name: str, bounds: tuple[float, float], event: Event) -> list[float]:
        """Values of another parameter at which the branch through an orbit has a point like an event."""
        if not orbit.converged:
            return []
        branch = continue_branch(orbit, name, bounds, max_step=STEP, max_points=MAX_POINTS)
        self.tally.branches += 1
        self.tally.periods += branch.cost.periods
        return [p.parameter for p in branch.points if event.fits(p)]

    def orbits_of(self, here: GearOscillator, event: Event, value: float) -> list[Orbit]:
        """Orbits with the label of an event."""
        there = here.with_parameter(self.problem.parameter, value)
        periods = range(1, LONGEST + 1) if event.periods is None else (event.periods,)
        orbit_set = find_orbits(there, tuple(periods))
        self.tally.periods += orbit_set.cost.periods
        return [orbit for orbit in orbit_set.orbits if event.names(orbit.label)]

    def _gather(self, gathered: BranchTree, orbits: Iterable[Orbit]) -> None:
        """Follow orbits that lie on no branch yet."""
        for orbit in orbits:
            if orbit.converged:
                gathered.follow(orbit, Origin(None, orbit.oscillator.get(self.problem.parameter)))

    def _upper(self, here: GearOscillator, value: float) -> list[Orbit]:
        """Motion at the upper bound; where that is chaos, from which Newton's method may go anywhere, all orbits."""
        there = here.with_parameter(self.problem.parameter, value)
        motion = period_map(there, there.rest_state(), skip=SETTLED)
        if not motion.message:
            orbit = find_orbit(there, motion.state)
            near = OPTIONS.same_motion * float(np.max(np.abs(motion.state)))
            if orbit.converged and float(np.max(np.abs(orbit.state - motion.state))) <= near:
                return [orbit]
        orbit_set = find_orbits(there, (1,))
        self.tally.periods += orbit_set.cost.periods
        return list(orbit_set.orbits)

    def _around(self, gathered: BranchTree, event: Event) -> None:
        """Follow the orbits of an event's label to either side of it, until one has such a point."""
        (low, high), width = self.problem.bounds, self.problem.width
        for beside in (0.0, *BESIDE):
            if any(self._near(p, event) for branch in gathered.branches for p in branch.points):
                break
            for value in (event.value - beside * width, event.value + beside * width):
                if beside and low < value < high:
                    self._gather(gathered, self.orbits_of(gathered.oscillator, event, value))

    def _near(self, point: SpecialPoint, event: Event) -> bool:
        return event.fits(point) and abs(point.parameter - event.value) < CAPTURE * self.problem.width


def _same(a: SpecialPoint, b: SpecialPoint, width: float) -> bool:
    """Whether two points are one: the states may be those of different phases of one orbit."""
    near = abs(a.parameter - b.parameter) < 1e-9 * width
    touch = math.isnan(a.acceleration) or abs(a.acceleration - b.acceleration) <= 1e-6 * abs(a.acceleration)
    multipliers = np.allclose(a.multipliers, b.multipliers, rtol=1e-5, atol=1e-5)
    return near and a.kind == b.kind and a.periods == b.periods and touch and bool(multipliers)
