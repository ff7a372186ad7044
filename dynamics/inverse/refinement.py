"""Parameters from events: Newton's method on all of them at once, robust against misprints."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.inverse.events import Problem
from dynamics.inverse.matching import loss
from dynamics.inverse.tracking import Mark
from dynamics.oscillator import GearOscillator

__all__ = ["OUTLIER", "Fit", "agreement", "difference", "fit", "misfit", "moved", "refit", "sensitivity"]

FloatArray = npt.NDArray[np.float64]
LEFT_OUT = 2  # events that are left out together when a fit of all is no good
TRIED = 6  # such choices that are followed up
CLOSE = 10.0  # units of the last decimal within which an event is met
OUTLIER = 0.1  # weight below which an event counts as an outlier: three times the scale of the differences
LONGEST = 0.3  # largest step, over the size of each parameter


@dataclass(frozen=True, eq=False)
class Fit:
    """Parameters and the events' points there.

    Parameters
    ----------
    oscillator : GearOscillator
        The parameters.
    marks : tuple of Mark or None
        Point of each event.
    weights : ndarray, shape (events,)
        Weight of each event in the last step; 0 for those that were not used.
    misfit : float
        Sum of the losses of the fitted events.
    """

    oscillator: GearOscillator
    marks: tuple[Mark | None, ...]
    weights: FloatArray
    misfit: float


def fit(problem: Problem, names: Sequence[str], start: GearOscillator, marks: Sequence[Mark | None]) -> Fit:
    r"""Fit parameters to the fitted events that have a mark.

    Least squares of the differences in units of the last decimal by Gauss and Newton, then reweighted (`refit`). If
    more than `CLOSE` units are left anywhere, it is repeated without one event or two, as long as one event more than
    unknowns is left; those first without which the linearised equations of the first fit have the least misfit. The
    least misfit of all events wins.

    Parameters
    ----------
    problem : Problem
        Events and ranges.
    names : sequence of str
        Unknowns.
    start : GearOscillator
        Where to start.
    marks : sequence of Mark or None
        Points of the events there.
    """
    rows = [i for i in problem.fitted if marks[i] is not None]
    first = Fit(start, tuple(marks), np.zeros(len(marks)), misfit(problem, marks))
    if len(rows) < len(names) or not names:
        return first
    middle = _least_squares(problem, names, first, rows)
    best = min((first, refit(problem, names, middle, rows)), key=lambda f: f.misfit)
    if _met(problem, best, rows):
        return best
    for out in _suspects(problem, names, middle, rows)[:TRIED]:
        kept = [i for i in rows if i not in out]
        trimmed = _least_squares(problem, names, middle, kept)
        if trimmed.misfit >= best.misfit and not _met(problem, trimmed, kept):
            continue
        found = refit(problem, names, trimmed, rows)
        if found.misfit < best.misfit:
            best = found
        if _met(problem, found, kept):
            break
    return best


def _met(problem: Problem, found: Fit, rows: Sequence[int]) -> bool:
    return all(abs(difference(problem, found.marks, i)) <= CLOSE for i in rows)


def _suspects(problem: Problem, names: Sequence[str], now: Fit, rows: Sequence[int]) -> list[tuple[int, ...]]:
    """Events and pairs of them, in the order of the misfit that the linearised equations have without them."""
    matrix = sensitivity(problem, names, now.marks, rows)
    size = np.maximum(np.abs([now.oscillator.get(n) for n in names]), 1e-3)
    off = np.array([difference(problem, now.marks, i) for i in rows])
    usable = np.all(np.isfinite(matrix), axis=1) & np.isfinite(off)
    trust = np.array([problem.events[i].trust for i in rows])
    ranked = []
    for number in range(1, min(LEFT_OUT, int(np.sum(usable)) - len(names) - 1) + 1):
        for out in itertools.combinations(np.flatnonzero(usable).tolist(), number):
            kept = usable.copy()
            kept[list(out)] = False
            step = np.linalg.lstsq(matrix[kept] * size, -off[kept], rcond=1e-12)[0]
            rest = np.abs(off + (matrix * size) @ step)[usable]
            ranked.append((float(trust[usable] @ np.log1p(rest)), tuple(rows[i] for i in out)))
    return [out for _, out in sorted(ranked)]


def refit(problem: Problem, names: Sequence[str], start: Fit, rows: Sequence[int], limit: int = 20) -> Fit:
    """Reweighted least squares on some events, from a fit that is near: the events that agree come to decide alone.

    Parameters
    ----------
    problem, names
        As in `fit`.
    start : Fit
        Where to start.
    rows : sequence of int
        Events that are used; those without a mark are left out.
    limit : int
        Steps.
    """
    trust = np.array([e.trust for e in problem.events])
    now = best = start
    for _ in range(limit):
        used = [i for i in rows if now.marks[i] is not None]
        if len(used) < len(names):
            break
        after, size = _step(problem, names, now, trust * _sharp(problem, now.marks, used), patient=False)
        if after is None:
            break
        now = after
        if misfit(problem, now.marks, rows) < misfit(problem, best.marks, rows):
            best = now
        if size < 1e-12:
            break
    return best


def moved(problem: Problem, names: Sequence[str], now: Fit, values: FloatArray) -> Fit | None:
    """The same points at other values of the parameters, in one step or two; None if one that counts is lost."""
    for parts in (1, 2, 4, 8):
        after: Fit | None = now
        for part in range(1, parts + 1):
            if after is None:
                break
            old = np.array([after.oscillator.get(n) for n in names])
            start = np.array([now.oscillator.get(n) for n in names])
            after = _at(problem, names, after, start + part / parts * (values - start), old)
        if after is not None:
            return after
    return None


def difference(problem: Problem, marks: Sequence[Mark | None], i: int) -> float:
    """Difference of an event in units of its last decimal; nan without a mark."""
    mark, event = marks[i], problem.events[i]
    return math.nan if mark is None else (mark.value - event.value) / event.unit


def sensitivity(
    problem: Problem, names: Sequence[str], marks: Sequence[Mark | None], rows: Sequence[int]
) -> FloatArray:
    """Change of the events with the parameters, in units of their last decimals, shape (rows, names)."""
    matrix = np.full((len(rows), len(names)), math.nan)
    for row, i in zip(matrix, rows, strict=True):
        mark = marks[i]
        if mark is not None:
            row[:] = mark.slopes(names)[2] / problem.events[i].unit
    return matrix


def _sharp(problem: Problem, marks: Sequence[Mark | None], rows: Sequence[int]) -> FloatArray:
    """Weights under which least squares lowers the sum of ln(1 + |r|): 1 / (|r| (1 + |r|)), flat below one unit."""
    weights = np.zeros(len(marks))
    off = np.abs([difference(problem, marks, i) for i in rows])
    weights[list(rows)] = 1.0 / (np.maximum(off, 1.0) * (1.0 + off))
    return weights


def _least_squares(problem: Problem, names: Sequence[str], start: Fit, rows: Sequence[int]) -> Fit:
    """Gauss and Newton's method on these events, weighted by their trust."""
    weights = np.zeros(len(start.marks))
    weights[list(rows)] = [problem.events[i].trust for i in rows]
    now = start
    for _ in range(12):
        after, size = _step(problem, names, now, weights, patient=True)
        if after is None:
            break
        now = after
        if size < 1e-8:
            break
    return now


def agreement(problem: Problem, marks: Sequence[Mark | None], rows: Sequence[int]) -> FloatArray:
    r"""Weight of each event without its trust, :math:`1 / (1 + (r / s)^2)`, shape (events,); 0 for all but the rows.

    The scale of the differences, s, is at least one unit.
    """
    weights = np.zeros(len(marks))
    if len(rows):
        off = np.array([difference(problem, marks, i) for i in rows])
        scale = max(1.0, 1.4826 * float(np.median(np.abs(off))))
        weights[list(rows)] = 1.0 / (1.0 + (off / scale) ** 2)
    return weights


def _step(
    problem: Problem, names: Sequence[str], now: Fit, weights: FloatArray, patient: bool
) -> tuple[Fit | None, float]:
    """One step of Gauss and Newton, and its relative size.

    None if events that count are lost or, where one is patient, no part of the step helps.
    """
    rows = [i for i in np.flatnonzero(weights).tolist() if now.marks[i] is not None]
    slopes = {i: mark.slopes(names) for i, mark in enumerate(now.marks) if mark is not None}
    rows = [i for i in rows if np.all(np.isfinite(slopes[i]))]
    if len(rows) < len(names):
        return None, 0.0
    values = np.array([now.oscillator.get(n) for n in names])
    size = np.maximum(np.abs(values), 1e-3)
    root = np.sqrt(weights[rows])
    units = np.array([problem.events[i].unit for i in rows])
    matrix = np.array([slopes[i][2] for i in rows]) * size * (root / units)[:, None]
    gaps = -np.array([difference(problem, now.marks, i) for i in rows]) * root
    step = np.linalg.lstsq(matrix, gaps, rcond=1e-12)[0]
    step *= min(1.0, LONGEST / max(float(np.max(np.abs(step))), 1e-300))
    before = float(gaps @ gaps)
    for share in (1.0, 0.5, 0.25, 0.1, 0.03):
        there = _within(problem, names, values + share * step * size)
        here = _placed(now.oscillator, names, there)
        marks = tuple(
            None if mark is None else mark.moved(here, slopes[i] @ (there - values))
            for i, mark in enumerate(now.marks)
        )
        if any(marks[i] is None for i in rows):
            continue
        off = np.array([difference(problem, marks, i) for i in rows]) * root
        if not patient or off @ off < before:
            moved = float(np.max(np.abs(there - values) / size))
            return Fit(here, marks, weights, misfit(problem, marks)), moved
    return None, 0.0


def _at(problem: Problem, names: Sequence[str], now: Fit, values: FloatArray, old: FloatArray) -> Fit | None:
    here = _placed(now.oscillator, names, values)
    marks = tuple(None if m is None else m.moved(here, m.slopes(names) @ (values - old)) for m in now.marks)
    if any(marks[i] is None for i in problem.fitted if now.marks[i] is not None):
        return None
    return Fit(here, marks, now.weights, misfit(problem, marks))


def _within(problem: Problem, names: Sequence[str], values: FloatArray) -> FloatArray:
    """Values in their ranges."""
    low = np.array([problem.unknowns[n].low for n in names])
    high = np.array([problem.unknowns[n].high for n in names])
    return np.clip(values, low, high)


def _placed(here: GearOscillator, names: Sequence[str], values: FloatArray) -> GearOscillator:
    for name, value in zip(names, values, strict=True):
        here = here.with_parameter(name, float(value))
    return here


def misfit(problem: Problem, marks: Sequence[Mark | None], rows: Sequence[int] | None = None) -> float:
    """Sum of the losses of these events, of the fitted ones if none are named."""
    total = 0.0
    for i in problem.fitted if rows is None else rows:
        mark = marks[i]
        total += loss(problem.events[i], math.nan if mark is None else mark.value, problem.width)
    return total
