"""Round values, where they cost less than their roundness is worth."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from base import quantity, record
from dynamics.inverse.events import Unknown
from dynamics.inverse.refinement import Fit, moved, refit
from dynamics.model.reasons import FITTED

DIGITS = 5  # significant digits up to which a value counts as round
PLAIN = 0.05  # a value so near to a round one by chance more often than this says nothing


@record
class Rounding:
    """A value made round."""

    no_error = FITTED

    headline = ("parameter", "before", "after", "cost", "worth")

    parameter: str = quantity("", "name of the parameter")
    before: float = quantity("1", "value before, the other unknowns refined")
    after: float = quantity("1", "value taken, the other unknowns refined again")
    digits: int = quantity("1", "significant digits kept; 0 if it is one of the values given")
    cost: float = quantity("1", "rise of the misfit, natural logarithm")
    worth: float = quantity(
        "1",
        "minus the logarithm of the probability that a value lies so near to one as round by chance; the distance is "
        "at least what the events leave open",
    )


def rounded(
    start: Fit, names: Sequence[str], left_open: Mapping[str, float], rows: Sequence[int]
) -> tuple[Fit, tuple[Rounding, ...]]:
    """Make values round one after another, refining the others each time.

    A value given as one of several goes to the nearest of these, whatever it costs. Any other is rounded to the fewest
    digits that cost less than they are worth; the most significant first.

    Parameters
    ----------
    start : Fit
        Refined.
    names : sequence of str
        Unknowns.
    left_open : mapping
        What the events leave open of each unknown.
    rows : sequence of int
        Events that are refined with.
    """
    now, done = start, []
    remaining = list(names)
    for name in names:
        unknown = start.problem.unknowns[name]
        if unknown.continuous:
            continue
        remaining.remove(name)
        value, worth = _nearest(unknown, now.oscillator.get(name))
        taken = _with(now, name, value, 0, worth, remaining, rows)
        if taken is not None:
            done.append(taken[0])
            now = taken[1]
    while remaining:
        candidates = [
            _roundest(now, name, [n for n in remaining if n != name], left_open[name], rows)
            for name in remaining
        ]
        best = max((f for f in candidates if f is not None), key=lambda f: f[0].worth, default=None)
        if best is None:
            break
        done.append(best[0])
        now = best[1]
        remaining.remove(best[0].parameter)
    return now, tuple(done)


def _roundest(
    now: Fit, name: str, others: list[str], left_open: float, rows: Sequence[int]
) -> tuple[Rounding, Fit] | None:
    """Value of fewest digits that is worth its cost."""
    value = now.oscillator.get(name)
    if value == 0.0 or not math.isfinite(left_open):
        return None
    for digits in range(1, DIGITS + 1):
        near = float(f"{value:.{digits - 1}e}")
        spacing = 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1)
        chance = min(1.0, 2.0 * max(abs(near - value), left_open) / spacing)
        if chance > PLAIN:
            continue
        taken = _with(now, name, near, digits, -math.log(chance), others, rows)
        if taken is not None and taken[0].cost <= taken[0].worth:
            return taken
    return None


def _nearest(unknown: Unknown, value: float) -> tuple[float, float]:
    """Nearest of the values given, and what that is worth."""
    values = np.array(sorted(unknown.values), dtype=np.float64)
    at = int(np.argmin(np.abs(values - value)))
    gap = float(np.min(np.diff(values))) if len(values) > 1 else math.inf
    off = abs(float(values[at]) - value)
    return float(values[at]), -math.log(min(1.0, max(2.0 * off / gap, 1e-12))) if math.isfinite(gap) else 0.0


def _with(
    now: Fit, name: str, value: float, digits: int, worth: float, others: Sequence[str], rows: Sequence[int]
) -> tuple[Rounding, Fit] | None:
    """What one value held costs, and the fit with the others refined; None if the events are lost."""
    there = moved(now, (name,), np.array([value]))
    if there is None:
        return None
    if others:
        there = refit(there, others, rows, limit=8)
    return Rounding(name, now.oscillator.get(name), value, digits, there.misfit - now.misfit, worth), there
