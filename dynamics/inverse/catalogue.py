"""The special points that an oscillator has on the branches on which events may lie."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.branch import Branch
from dynamics.continuation import continue_branch
from dynamics.finding import find_orbits
from dynamics.gathering import lies_on
from dynamics.inverse.events import Event, Problem
from dynamics.inverse.matching import Line, match
from dynamics.inverse.refinement import Fit
from dynamics.oscillator import GearOscillator
from dynamics.shooting import Orbit, find_orbit
from dynamics.special import SpecialPoint
from dynamics.sweeps import rest_state
from dynamics.switching import doubled_orbit
from dynamics.tracking import marked

__all__ = ["CONTACT", "DOUBLED", "EVERY", "Catalogue", "Tally"]

SETTLED = 2000  # periods in which the motion at the upper bound is taken to have settled
STEP = 0.05  # largest step along a branch
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
        bounds, events = self.problem.bounds, self.problem.events
        found = self._new(self._settled(here, bounds[0], 0), [])
        if depth >= DOUBLED:
            for orbit in self._upper(here, bounds[1]):
                found += self._new(orbit, found)
            longest = max((e.periods or LONGEST for e in events), default=1)
            found += self._doubled(here, found, longest)
        for event in events if depth == EVERY else ():
            if not any(self._near(p, event) for branch in found for p in branch.points):
                found += self._around(here, event, found)
        lines: list[Line] = []
        known: list[SpecialPoint] = []
        for branch in found:
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

    def follow(
        self, orbit: Orbit | None, name: str | None = None, bounds: tuple[float, float] | None = None
    ) -> Branch | None:
        """Branch through an orbit, in the parameter of the events if no other is named."""
        if orbit is None or not orbit.converged:
            return None
        branch = continue_branch(
            orbit,
            name or self.problem.parameter,
            bounds or self.problem.bounds,
            max_step=STEP,
            max_points=1500,
        )
        self.tally.branches += 1
        self.tally.periods += branch.cost.periods
        return branch

    def orbits_of(self, here: GearOscillator, event: Event, value: float) -> list[Orbit]:
        """Orbits with the label of an event."""
        there = here.with_parameter(self.problem.parameter, value)
        periods = range(1, LONGEST + 1) if event.periods is None else (event.periods,)
        found = find_orbits(there, tuple(periods))
        self.tally.periods += found.cost.periods
        return [orbit for orbit in found.orbits if event.names(orbit.label)]

    def _new(self, orbit: Orbit, known: list[Branch]) -> list[Branch]:
        """Branch through an orbit, if it lies on none of those known."""
        if not orbit.converged or any(lies_on(branch, orbit, self.problem.bounds) for branch in known):
            return []
        branch = self.follow(orbit)
        return [] if branch is None else [branch]

    def _settled(self, here: GearOscillator, value: float, transient: int) -> Orbit:
        start = here.with_parameter(self.problem.parameter, value)
        return find_orbit(start, rest_state(start), transient=transient)

    def _upper(self, here: GearOscillator, value: float) -> list[Orbit]:
        """Motion at the upper bound; where that is chaos, from which Newton's method may go anywhere, all orbits."""
        settled = self._settled(here, value, SETTLED)
        if settled.converged:
            return [settled]
        found = find_orbits(settled.oscillator, (1,))
        self.tally.periods += found.cost.periods
        return list(found.orbits)

    def _doubled(self, here: GearOscillator, branches: list[Branch], longest: int) -> list[Branch]:
        waiting, found = list(branches), []
        seen: list[SpecialPoint] = []
        while waiting:
            for point in waiting.pop(0).special("period-doubling"):
                if 2 * point.periods > longest or any(_same(point, p, self.problem.width) for p in seen):
                    continue
                seen.append(point)
                orbit = doubled_orbit(here, self.problem.parameter, point, self.problem.bounds)
                branch = self.follow(orbit)
                if branch is not None:
                    found.append(branch)
                    waiting.append(branch)
        return found

    def _around(self, here: GearOscillator, event: Event, known: list[Branch]) -> list[Branch]:
        """Branches not yet known of the orbits of an event's label to either side of it, until one has such a point."""
        low, high = self.problem.bounds
        found: list[Branch] = []
        for beside in BESIDE:
            for value in (event.value - beside * (high - low), event.value + beside * (high - low)):
                if low < value < high:
                    for orbit in self.orbits_of(here, event, value):
                        found += self._new(orbit, [*known, *found])
            if any(self._near(p, event) for branch in found for p in branch.points):
                break
        return found

    def _near(self, point: SpecialPoint, event: Event) -> bool:
        return event.fits(point) and abs(point.parameter - event.value) < CAPTURE * self.problem.width


def _same(a: SpecialPoint, b: SpecialPoint, width: float) -> bool:
    """Tell whether two points are one: the states may be those of different phases of one orbit."""
    near = abs(a.parameter - b.parameter) < 1e-9 * width
    touch = math.isnan(a.acceleration) or abs(a.acceleration - b.acceleration) <= 1e-6 * abs(a.acceleration)
    multipliers = np.allclose(a.multipliers, b.multipliers, rtol=1e-5, atol=1e-5)
    return near and a.kind == b.kind and a.periods == b.periods and touch and bool(multipliers)
