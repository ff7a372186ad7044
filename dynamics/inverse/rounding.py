"""Round values, where they cost less than their roundness is worth."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from dynamics.inverse.events import OneOf, Problem
from dynamics.inverse.refinement import Fit, moved, refit

__all__ = ["Rounding", "rounded"]

DIGITS = 5  # significant digits up to which a value counts as round
PLAIN = 0.05  # a value so near to a round one by chance more often than this says nothing


@dataclass(frozen=True)
class Rounding:
    """A value made round.

    Parameters
    ----------
    parameter : str
        Name.
    before, after : float
        Values, the other unknowns refined again.
    digits : int
        Significant digits kept; 0 if it is one of the values given.
    cost : float
        Rise of the misfit, natural logarithm.
    worth : float
        Minus the logarithm of the probability that a value lies so near to one as round by chance; the distance is at
        least what the events leave open.
    """

    parameter: str
    before: float
    after: float
    digits: int
    cost: float
    worth: float


def rounded(
    problem: Problem, names: Sequence[str], start: Fit, open_: Mapping[str, float], rows: Sequence[int]
) -> tuple[Fit, tuple[Rounding, ...]]:
    """Make values round one after another, refining the others each time.

    A value given as one of several goes to the nearest of these, whatever it costs. Any other is rounded to the fewest
    digits that cost less than they are worth; the most telling first.

    Parameters
    ----------
    problem : Problem
        Events.
    names : sequence of str
        Unknowns.
    start : Fit
        Refined.
    open_ : mapping
        What the events leave open of each unknown.
    rows : sequence of int
        Events that are refined with.
    """
    now, done = start, []
    left = list(names)
    for name in names:
        unknown = problem.unknowns[name]
        if not isinstance(unknown, OneOf):
            continue
        left.remove(name)
        before = now.oscillator.get(name)
        value, worth = _nearest(unknown, before)
        there = _with(problem, name, value, now, left, rows)
        if there is None:
            continue
        done.append(Rounding(name, before, value, 0, there.misfit - now.misfit, worth))
        now = there
    while left:
        best: tuple[Rounding, Fit] | None = None
        for name in left:
            found = _roundest(problem, name, now, [n for n in left if n != name], open_[name], rows)
            if found is not None and (best is None or found[0].worth > best[0].worth):
                best = found
        if best is None:
            break
        done.append(best[0])
        now = best[1]
        left.remove(best[0].parameter)
    return now, tuple(done)


def _roundest(
    problem: Problem, name: str, now: Fit, others: list[str], open_: float, rows: Sequence[int]
) -> tuple[Rounding, Fit] | None:
    """Value of fewest digits that is worth its cost."""
    value = now.oscillator.get(name)
    if value == 0.0 or not math.isfinite(open_):
        return None
    for digits in range(1, DIGITS + 1):
        near = float(f"{value:.{digits - 1}e}")
        spacing = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
        chance = min(1.0, 2.0 * max(abs(near - value), open_) / spacing)
        if chance > PLAIN:
            continue
        there = _with(problem, name, near, now, others, rows)
        if there is not None and there.misfit - now.misfit <= -math.log(chance):
            return Rounding(name, value, near, digits, there.misfit - now.misfit, -math.log(chance)), there
    return None


def _nearest(unknown: OneOf, value: float) -> tuple[float, float]:
    """Nearest of the values given, and what that is worth."""
    values = np.array(sorted(unknown.values), dtype=np.float64)
    at = int(np.argmin(np.abs(values - value)))
    gap = float(np.min(np.diff(values))) if len(values) > 1 else math.inf
    off = abs(float(values[at]) - value)
    return float(values[at]), -math.log(min(1.0, max(2.0 * off / gap, 1e-12))) if math.isfinite(gap) else 0.0


def _with(
    problem: Problem, name: str, value: float, now: Fit, others: Sequence[str], rows: Sequence[int]
) -> Fit | None:
    """Fit with one value held and the others refined."""
    there = moved(problem, (name,), now, np.array([value]))
    if there is None or not others:
        return there
    return refit(problem, others, there, rows, limit=8)
