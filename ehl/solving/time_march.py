"""A film followed over time, by steps that a tolerance chooses or through instants that another grid chose."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from base import Array
from ehl.discrete.contact import LineContact
from ehl.solving.levels import Figures, Level, spike_of
from ehl.solving.stepping import Laying, Moment, advance, extrapolated, steady

FIRST = 1e-3
"""First step, and the shortest, in the time in which oil goes the film's scale."""

LONGEST = 0.5
"""Longest step, likewise."""

JUMP = 0.2
"""Change of ln(load) in a shortest step that is no ramp but a jump."""

MOST_STEPS = 20000

BREAKS = "under a load that falls faster than the bodies part the oil breaks, which is not computed"

_NARROWEST = 5e-6  # width of spikes at the pressures where they can still be resolved [half-widths]
_CELLS = 3.0  # across a spike that a grid resolves
_GROWTH = 1.6
_SAFETY = 0.85
_TRANSIT = 2.0  # times it, after which what a step did wrong has left the contact


class JumpError(Exception):
    """The load jumps; the argument is the time."""


@dataclass(frozen=True)
class Shot:
    """What is kept of one moment."""

    time: float
    unit: float  # time in which oil goes once the film's scale [s]
    contact: LineContact
    figures: Figures
    x: Array
    pressure: Array
    thickness: Array
    balance: float  # net flux into a node that is left, over the flux
    halvings: float  # of the cells at the spike until they resolve the narrowest one; 0 where they do

    @classmethod
    def of(cls, moment: Moment) -> Shot:
        """Keep the curves and figures, not the matrices."""
        level = moment.level
        x = level.grid.nodes * level.groups.length
        solution = level.solution
        curves = (x, moment.pressure, moment.film)
        halvings = halvings_left(level)
        return cls(
            moment.time, moment.unit, level.contact, moment.figures, *curves, solution.flux_error, halvings
        )


def halvings_left(level: Level) -> float:
    """How often the cells at the pressure spike would have to be halved to resolve it; 0 without one or resolved."""
    tip = spike_of(level)
    if tip is None:
        return 0.0
    X = level.grid.nodes * level.grid.ratio
    cell = float(np.diff(X)[min(int(np.searchsorted(X, tip.position)), X.size - 2)])
    return 0.0 if tip.width > _CELLS * cell else max(math.log2(cell / _NARROWEST), 0.0)


@dataclass
class TimeMarch:
    """A film's way through time so far.

    Attributes
    ----------
    contact_at : callable
        Contact at a time.
    laying : Laying
        Of the nodes.
    moments : list of Moment
        The last three.
    shots : list of Shot
        All.
    errors : list of float
        Local error of each step, relative.
    """

    contact_at: Callable[[float], LineContact]
    laying: Laying
    moments: list[Moment]
    shots: list[Shot] = field(default_factory=list)
    errors: list[float] = field(default_factory=list)
    iterations: int = 0
    rejected: int = 0
    message: str = ""

    @classmethod
    def begin(
        cls, time: float, level: Level, contact_at: Callable[[float], LineContact], laying: Laying
    ) -> TimeMarch:
        """Begin with the steady film of a level."""
        first = steady(time, level)
        return cls(contact_at, laying, [first], [Shot.of(first)], [0.0])

    @property
    def unit(self) -> float:
        """Time in which oil goes once the film's scale, b of loaded contacts, now [s]."""
        return self.moments[-1].unit

    def try_step(self, time: float) -> Moment | None:
        """Solve the film at a later time."""
        moment = advance(self.moments, time, self.contact_at(time), self.laying)
        self.iterations += 1 if moment is None else moment.level.solution.iterations
        return moment

    def take(self, moment: Moment, error: float) -> None:
        """Go on from a moment."""
        self.moments = [*self.moments[-2:], moment]
        self.shots.append(Shot.of(moment))
        self.errors.append(error)

    def through(self, instants: Array) -> bool:
        """Go through given instants; False where a film is not found."""
        for time in instants.tolist():
            moment = self.try_step(time)
            if moment is None:
                self.message = f"no film was found at t = {time:.6g} s ({BREAKS})"
                return False
            self.take(moment, self.local_error(moment))
        return True

    def to(self, times: Array, allowed: float) -> bool:
        """Go through times by steps whose local errors are at most those allowed; False where none is found."""
        step = FIRST * self.unit
        for target in times.tolist():
            while self.moments[-1].time < target:
                remaining = target - self.moments[-1].time
                step = min(step, LONGEST * self.unit)
                count = max(1, math.ceil(remaining / step - 1e-9))
                step = remaining / count
                wanted = self._next(target if count == 1 else self.moments[-1].time + step, allowed)
                if not wanted:
                    return False
                step = wanted
        return True

    def _next(self, time: float, allowed: float) -> float:
        """Take one step, shorter ones until its error is allowed; return the next step, 0 where none is found."""
        start = self.moments[-1].time
        while True:
            step = time - start
            shortest = step <= 1.01 * FIRST * self.unit
            jump = abs(math.log(self.contact_at(time).load / self.moments[-1].level.contact.load)) > JUMP
            if jump and shortest:
                raise JumpError(start)
            moment = None if jump else self.try_step(time)
            if moment is not None:
                error = self.local_error(moment)
                free = len(self.moments) < 3
                factor = 1.0 if free else min(_GROWTH, _SAFETY * (allowed / max(error, 1e-300)) ** (1 / 3))
                if free or error <= allowed or shortest:
                    self.take(moment, 0.0 if free else error)
                    return max(factor * step, FIRST * self.unit)
            else:
                factor = 0.4
            self.rejected += 1
            if moment is None and not jump and shortest:
                self.message = (
                    f"no film was found at t = {time:.6g} s, {step:.2g} s after the one before ({BREAKS})"
                )
                return 0.0
            if len(self.shots) + self.rejected > MOST_STEPS:
                self.message = f"more than {MOST_STEPS} steps of time"
                return 0.0
            time = start + max(min(factor, 0.7) * step, FIRST * self.unit)

    def local_error(self, new: Moment) -> float:
        """Relative error of the film that the last step alone made, by how far the parabola in time misses it.

        The formula's error is the third derivative times s^3 (1+r)^2/[6 r (1+2r)], the parabola's times
        s (s+s1) (s+s1+s2)/6; s the step, s1 and s2 the ones before, r = s/s1.
        """
        if len(self.moments) < 3:
            return 0.0
        three = self.moments[-3:]
        guess = extrapolated(three, new.time, [np.log(moment.film) for moment in three])
        level = new.level
        at = np.abs(level.grid.nodes) * level.grid.ratio <= 1.0
        weights = np.where(at, level.grid.weights, 0.0)
        miss = np.log(new.film) - guess
        lowest = int(np.argmin(level.solution.H))
        middle = int(np.argmin(np.abs(level.grid.nodes)))
        # of a rigid cylinder the dry contact may lie between two nodes
        profile = math.sqrt(float(weights @ miss**2 / weights.sum())) if weights.any() else 0.0
        worst = max(profile, abs(float(miss[lowest])), abs(float(miss[middle])))
        s, s1, s2 = (float(step) for step in np.diff([*(moment.time for moment in three), new.time])[::-1])
        r = s / s1
        own = s**3 * (1.0 + r) ** 2 / (6.0 * r * (1.0 + 2.0 * r))
        return worst * own / (own + s * (s + s1) * (s + s1 + s2) / 6.0)

    @property
    def error(self) -> float:
        """Local errors added over the time that oil takes through the contact, at most."""
        times = np.array([shot.time for shot in self.shots])
        sums = np.cumsum(self.errors)
        transits = _TRANSIT * np.array([shot.unit for shot in self.shots])
        before = np.interp(times - transits, times, sums, left=0.0)
        return float(np.max(sums - before))

    @property
    def times(self) -> Array:
        """All instants [s]."""
        return np.array([shot.time for shot in self.shots])
