"""Steps along a curve of orbits, whatever singles the orbits out, until a reason to end."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import Any, ClassVar, TypeVar

import numpy as np

from base import Array
from dynamics.branches.branch import UNBOUNDED
from dynamics.branches.branch_problem import MapPoint, Steps
from dynamics.branches.sizes import LARGE
from dynamics.model.options import OPTIONS

T = TypeVar("T")
W = TypeVar("W", bound="Tracer")


class Tracer(ABC):
    """Steps from a start in one direction; `points` are what they met, `ended` says why there are no more.

    Parameters
    ----------
    problem : BranchProblem
        The orbits.
    start : MapPoint
        The first point.
    steps : Steps
        How far to step.
    """

    flat: ClassVar = 0.0
    """Slope of a parameter along the curve below which it is not aimed at the end of its range."""
    least = 0.0
    """Size over the scale below which a motion is measured by a smaller one."""
    tangent: Array

    def __init__(self, problem: Any, start: Any, steps: Steps) -> None:
        self.problem, self.steps, self.step = problem, steps, steps.first
        self.points = [start]
        self.phases = problem.phases(start)
        self.size = max(problem.scale, problem.oscillator.floor)
        self.ended = ""

    def run(self) -> None:
        """Step until the curve ends."""
        while not self.ended:
            remaining = self.steps.points + 1 - len(self.points)
            if remaining < 1:
                self.ended = f"{self.steps.points} points: raise max_points"
                return
            if self.stride(remaining):
                continue
            reached = self.attempt(self.points[-1])
            if reached is None:
                self.step *= 0.5
                if self.step < self.steps.least and not self.ended:
                    self.ended = self.why(self.points[-1])
                continue
            last = self.points[-1]
            self.accept(last, reached)
            new = self.points[-1]
            if len(self.points) > 3 and passes(last.u, new.u, self.phases):  # however small the loop
                self.ended = "closed"
            elif not {0.0, 1.0}.isdisjoint(new.u[new.size :].tolist()):
                self.ended = "bound"

    def stride(self, remaining: int) -> bool:
        """Take steps between which nothing happens, so many at most; False if the next is to be an attempt."""
        return False

    @abstractmethod
    def attempt(self, last: Any) -> Any:
        """A step that may be taken; None if it is too long, or if `ended` has been set."""

    @abstractmethod
    def accept(self, last: Any, reached: Any) -> None:
        """Take a step: add its point, choose the next tangent and step."""

    @abstractmethod
    def why(self, last: Any) -> str:
        """Why no step was possible."""

    def measured(self, last: MapPoint) -> Any:
        """The last point, by the present size of the motion as scale, of which steps and tolerances are shares.

        None, and `ended` set, if the motion grows without bound; the point as it is if it is not met again.
        """
        factor = self.problem.size_of(last.u)
        if factor * self.problem.scale > OPTIONS.unbounded * self.size:
            self.ended = UNBOUNDED
            return None
        if self.least <= factor <= LARGE:
            return last
        larger = self.problem.magnified(factor)
        shrink = np.append(np.full(last.size, 1.0 / factor), np.ones(len(last.values)))
        again = self.met_again(larger, last, self.tangent * shrink)
        if again is None:
            return last
        self.problem, self.points[-1] = larger, again
        self.phases = (np.array(self.phases) * shrink).tolist()
        self.rescale(again, self.tangent * shrink, factor)
        return again

    @abstractmethod
    def met_again(self, larger: Any, last: Any, along: Array) -> Any:
        """The last point in a problem of another scale, `along` the tangent there; None if it is not met."""

    @abstractmethod
    def rescale(self, again: Any, along: Array, factor: float) -> None:
        """Measure by the other scale what is kept besides the point."""

    def aimed(self, last: MapPoint, guess: Array) -> tuple[Array, Array] | None:
        """A guess and the row across which it is corrected: at the end of a range that end; None if that is reached."""
        row = self.tangent
        for k in range(last.size, len(guess)):
            bound = min(max(float(guess[k]), 0.0), 1.0)
            if guess[k] == bound:
                continue
            if last.u[k] == bound or abs(self.tangent[k]) < self.flat:
                self.ended = "bound"
                return None
            guess = last.u + (bound - last.u[k]) / self.tangent[k] * self.tangent
            guess[k] = bound
            row = np.eye(len(guess))[k]
        return guess, row


def both_ways(tracer: Callable[[float], W]) -> list[W]:
    """Tracers that have run in both directions, -1 and 1; one alone if its curve closes."""
    traced = []
    for sign in (-1.0, 1.0):
        traced.append(tracer(sign))
        traced[-1].run()
        if traced[-1].ended == "closed":
            break
    return traced


def joined(parts: Sequence[Sequence[T]], shared: int = 0) -> list[T]:
    """What one or two tracers met in its order along the curve; the first `shared` of the second are left out."""
    return [*parts[0][::-1], *(item for part in parts[1:] for item in part[shared:])]


def passes(last: Array, new: Array, places: list[list[float]]) -> bool:
    """Whether the step from one place to another in the space of unknowns passes one of several."""
    start = last.tolist()
    chord = [b - a for a, b in zip(start, new.tolist(), strict=True)]
    square = sum(c * c for c in chord)
    for place in places:
        if (place[-1] - start[-1]) ** 2 > 1.02 * square:
            continue  # too far to look closer
        back = [p - u for p, u in zip(place, start, strict=True)]
        along = sum(b * c for b, c in zip(back, chord, strict=True)) / square
        if 0.0 < along <= 1.0:
            beside = sum((b - along * c) ** 2 for b, c in zip(back, chord, strict=True))
            if beside < 0.01 * square:
                return True
    return False
