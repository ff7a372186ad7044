"""Parameters from events: Newton's method on all of them at once, robust against misprints."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from base import Array
from dynamics.branches.moved_special_points import Mark
from dynamics.inverse.events import Problem
from dynamics.model.options import OPTIONS
from dynamics.model.oscillator import GearOscillator

LEFT_OUT = 2  # events that are left out together when a fit of all is no good
TRIED = 6  # such choices that are followed up
LONGEST = 0.3  # largest step, over the size of each parameter


@dataclass(frozen=True, eq=False)
class Fit:
    """Parameters and the events' points there.

    Parameters
    ----------
    problem : Problem
        Events and ranges.
    oscillator : GearOscillator
        The parameters.
    marks : tuple of Mark or None
        Point of each event.
    """

    problem: Problem
    oscillator: GearOscillator
    marks: tuple[Mark | None, ...]

    @cached_property
    def values(self) -> Array:
        """Where each event lies, shape (events,); nan without a mark."""
        return np.array([math.nan if mark is None else mark.value for mark in self.marks])

    @cached_property
    def off(self) -> Array:
        """Difference of each event in units of its last decimal, shape (events,); nan without a mark."""
        return np.asarray((self.values - self.problem.printed) / self.problem.units)

    @cached_property
    def misfit(self) -> float:
        """Sum of the losses of the fitted events."""
        return self.problem.misfit(self.values)

    def parameters(self, names: Sequence[str]) -> Array:
        """Values of parameters."""
        return np.array([self.oscillator.get(name) for name in names])

    def slopes(self, names: Sequence[str]) -> list[Array | None]:
        """Change of each mark with parameters, as of `Mark.slopes`."""
        return [None if mark is None else mark.slopes(names) for mark in self.marks]

    def sensitivity(self, names: Sequence[str], rows: Sequence[int]) -> Array:
        """Change of events with parameters, in units of their last decimals, shape (rows, names); nan if unknown."""
        lost = np.full((3, len(names)), math.nan)
        marks = [self.marks[i] for i in rows]
        slopes = [lost if mark is None else mark.slopes(names) for mark in marks]
        matrix = np.array([slope[2] for slope in slopes]).reshape(len(rows), len(names))
        return np.asarray(matrix / self.problem.units[list(rows), None])

    def meets(self, rows: Sequence[int]) -> bool:
        """Whether these events are met."""
        return bool(np.all(np.abs(self.off[list(rows)]) <= OPTIONS.event_units))

    def shifted(self, names: Sequence[str], values: Array, slopes: Sequence[Array | None]) -> Fit:
        """The same points at other values of parameters; None in the place of those that are lost."""
        here = self.oscillator
        for name, value in zip(names, values, strict=True):
            here = here.with_parameter(name, float(value))
        change = values - self.parameters(names)
        marks = zip(self.marks, slopes, strict=True)
        moved = (None if m is None or s is None else m.moved(here, s @ change) for m, s in marks)
        return Fit(self.problem, here, tuple(moved))


def fit(start: Fit, names: Sequence[str]) -> Fit:
    r"""Fit parameters to the fitted events that have a mark.

    Least squares of the differences in units of the last decimal by Gauss and Newton, then reweighted (`refit`). If
    more than `OPTIONS.event_units` are left anywhere, it is repeated without one event or two, as long as one event
    more than unknowns is left; those first without which the linearised equations of the first fit have the smallest
    misfit. The smallest misfit of all events wins.

    Parameters
    ----------
    start : Fit
        Where to start.
    names : sequence of str
        Unknowns.
    """
    rows = [i for i in start.problem.fitted if start.marks[i] is not None]
    if len(rows) < len(names) or not names:
        return start
    middle = _least_squares(start, names, rows)
    best = min((start, refit(middle, names, rows)), key=lambda f: f.misfit)
    if best.meets(rows):
        return best
    for out in _suspects(middle, names, rows)[:TRIED]:
        kept = [i for i in rows if i not in out]
        trimmed = _least_squares(middle, names, kept)
        if trimmed.misfit >= best.misfit and not trimmed.meets(kept):
            continue
        refitted = refit(trimmed, names, rows)
        if refitted.misfit < best.misfit:
            best = refitted
        if refitted.meets(kept):
            break
    return best


def _suspects(now: Fit, names: Sequence[str], rows: Sequence[int]) -> list[tuple[int, ...]]:
    """Events and pairs of them, in the order of the misfit that the linearised equations have without them."""
    matrix = now.sensitivity(names, rows) * _sizes(now, names)
    off, trust = now.off[list(rows)], now.problem.trust[list(rows)]
    usable = np.all(np.isfinite(matrix), axis=1) & np.isfinite(off)
    ranked = []
    for number in range(1, min(LEFT_OUT, int(np.sum(usable)) - len(names) - 1) + 1):
        for out in itertools.combinations(np.flatnonzero(usable).tolist(), number):
            kept = usable.copy()
            kept[list(out)] = False
            step = np.linalg.lstsq(matrix[kept], -off[kept], rcond=1e-12)[0]
            rest = np.abs(off + matrix @ step)[usable]
            ranked.append((float(trust[usable] @ np.log1p(rest)), tuple(rows[i] for i in out)))
    return [out for _, out in sorted(ranked)]


def refit(start: Fit, names: Sequence[str], rows: Sequence[int], limit: int = 20) -> Fit:
    """Reweighted least squares on some events, from a fit that is near: in the end the events that agree decide alone.

    Parameters
    ----------
    start : Fit
        Where to start.
    names : sequence of str
        Unknowns.
    rows : sequence of int
        Events that are used; those without a mark are left out.
    limit : int
        Steps.
    """
    problem = start.problem
    now = best = start
    for _ in range(limit):
        used = [i for i in rows if now.marks[i] is not None]
        if len(used) < len(names):
            break
        after, size = _step(now, names, problem.trust * _sharp(now, used), patient=False)
        if after is None:
            break
        now = after
        if problem.misfit(now.values, rows) < problem.misfit(best.values, rows):
            best = now
        if size < 1e-12:
            break
    return best


def moved(start: Fit, names: Sequence[str], values: Array) -> Fit | None:
    """The same points at other values of parameters, in one step or up to eight; None if one that counts is lost."""
    first = start.parameters(names)
    for parts in (1, 2, 4, 8):
        now = start
        for part in range(1, parts + 1):
            after = now.shifted(names, first + part / parts * (values - first), now.slopes(names))
            if any(after.marks[i] is None and now.marks[i] is not None for i in start.problem.fitted):
                break
            now = after
        else:
            return now
    return None


def _sizes(now: Fit, names: Sequence[str]) -> Array:
    """What the steps of parameters are measured by."""
    return np.maximum(np.abs(now.parameters(names)), 1e-3)


def _sharp(now: Fit, rows: Sequence[int]) -> Array:
    """Weights under which least squares lowers the sum of ln(1 + |r|): 1 / (|r| (1 + |r|)), flat below one unit."""
    weights = np.zeros(len(now.marks))
    off = np.abs(now.off[list(rows)])
    weights[list(rows)] = 1.0 / (np.maximum(off, 1.0) * (1.0 + off))
    return weights


def _least_squares(start: Fit, names: Sequence[str], rows: Sequence[int]) -> Fit:
    """Gauss and Newton's method on these events, weighted by their trust."""
    weights = np.zeros(len(start.marks))
    weights[list(rows)] = start.problem.trust[list(rows)]
    now = start
    for _ in range(12):
        after, size = _step(now, names, weights, patient=True)
        if after is None:
            break
        now = after
        if size < 1e-8:
            break
    return now


def agreement(now: Fit, rows: Sequence[int]) -> Array:
    r"""Weight of each event without its trust, :math:`1 / (1 + (r / s)^2)`, shape (events,); 0 for all but the rows.

    The scale of the differences, s, is at least one unit.
    """
    weights = np.zeros(len(now.marks))
    if len(rows):
        off = now.off[list(rows)]
        scale = max(1.0, 1.4826 * float(np.median(np.abs(off))))
        weights[list(rows)] = 1.0 / (1.0 + (off / scale) ** 2)
    return weights


def _step(now: Fit, names: Sequence[str], weights: Array, patient: bool) -> tuple[Fit | None, float]:
    """One step of Gauss and Newton, and its relative size.

    None if events that count are lost or, where one is patient, no part of the step helps.
    """
    slopes = now.slopes(names)
    usable = [s is not None and bool(np.all(np.isfinite(s))) for s in slopes]
    rows = [i for i in np.flatnonzero(weights).tolist() if usable[i]]
    if len(rows) < len(names):
        return None, 0.0
    values, size = now.parameters(names), _sizes(now, names)
    low, high = ([getattr(now.problem.unknowns[n], end) for n in names] for end in ("low", "high"))
    root = np.sqrt(weights[rows])
    change = np.array([s[2] for i, s in enumerate(slopes) if i in rows and s is not None])
    matrix = change * size * (root / now.problem.units[rows])[:, None]
    gaps = -now.off[rows] * root
    step = np.linalg.lstsq(matrix, gaps, rcond=1e-12)[0]
    step *= min(1.0, LONGEST / max(float(np.max(np.abs(step))), 1e-300))
    before = float(gaps @ gaps)
    for share in (1.0, 0.5, 0.25, 0.1, 0.03):
        there = np.clip(values + share * step * size, low, high)
        after = now.shifted(names, there, slopes)
        off = after.off[rows] * root
        if np.any(np.isnan(off)):
            continue
        if not patient or off @ off < before:
            return after, float(np.max(np.abs(there - values) / size))
    return None, 0.0
