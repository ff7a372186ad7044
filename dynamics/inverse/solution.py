"""From fits to the record of what was found."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from base import Cost
from dynamics.inverse.catalogue import EVERY, Catalogue
from dynamics.inverse.events import Problem
from dynamics.inverse.refinement import Fit, agreement
from dynamics.inverse.report import Candidate, Identification
from dynamics.inverse.rounding import Rounding, rounded
from dynamics.inverse.scoring import by_chance, directions, left_out, probabilities, spread, unseen
from dynamics.model.options import OPTIONS
from dynamics.model.oscillator import GearOscillator

ALIKE = 1e-3  # relative difference below which two oscillators are the same candidate


@dataclass(frozen=True, eq=False)
class Solution:
    """Parameters with all events looked for.

    Parameters
    ----------
    catalogue : Catalogue
        Of its problem.
    fit : Fit
        Parameters and points.
    candidate : Candidate
        The record.
    """

    catalogue: Catalogue
    fit: Fit
    candidate: Candidate

    @property
    def rows(self) -> list[int]:
        """Fitted events that agree."""
        candidate = self.candidate
        return [i for i in self.fit.problem.fitted if i in candidate.matched and i not in candidate.outliers]

    @property
    def good(self) -> bool:
        """Whether more events agree than there are unknowns, those not fitted included, and not by chance."""
        scored = [i for i in self.candidate.matched if not self.fit.problem.events[i].fitted]
        unknowns = len(self.candidate.values)
        enough = len(self.rows) >= unknowns and len(self.rows) + len(scored) > unknowns
        return enough and self.candidate.by_chance < OPTIONS.chance


def solution(catalogue: Catalogue, here: GearOscillator, trials: int) -> Solution:
    """Look for all events at the parameters of a fit, and record what is there."""
    problem = catalogue.problem
    names = tuple(problem.unknowns)
    lines, fit = catalogue.start(here, EVERY)
    there = [i for i in problem.fitted if fit.marks[i] is not None]
    weights = agreement(fit, there)
    chance = probabilities(problem, lines, fit.off)
    matched = tuple(i for i, p in enumerate(chance) if p < OPTIONS.chance)
    rows = [i for i in there if i in matched and weights[i] >= OPTIONS.outlier_weight]
    candidate = Candidate(
        oscillator=here,
        values={n: here.get(n) for n in names},
        spread=spread(fit, names, rows),
        found=tuple(fit.values.tolist()),
        off=tuple(fit.off.tolist()),
        weights=tuple(weights.tolist()),
        left_out=left_out(fit, names, rows),
        matched=matched,
        outliers=tuple(i for i in problem.fitted if weights[i] < OPTIONS.outlier_weight),
        misfit=fit.misfit,
        by_chance=by_chance(problem, chance, len(names), trials),
    )
    return Solution(catalogue, fit, candidate)


def distinct(oscillators: Sequence[GearOscillator], names: Sequence[str]) -> list[GearOscillator]:
    """Those that differ from all before them."""
    kept: list[GearOscillator] = []
    for here in oscillators:
        if not any(_alike(here, other, names) for other in kept):
            kept.append(here)
    return kept


def identification(
    problem: Problem, reduction: str, solutions: Sequence[Solution], trials: int, cost: Cost
) -> Identification:
    """Record of all solutions, the best of them rounded."""
    if not solutions:
        message = f"{trials} trials, none has one of the events that were tried: widen the ranges, or try more values"
        return Identification(problem.events, trials, reduction, cost, message)
    first = solutions[0]
    names = tuple(first.candidate.values)
    kept = distinct([s.candidate.oscillator for s in solutions], names)
    others = [s.candidate for s in solutions[1:] if any(s.candidate.oscillator is here for here in kept[1:])]
    best, roundings = _rounded(first, trials)
    seen = directions(best.fit, tuple(problem.unknowns), best.rows)
    candidate, by_chance = best.candidate, first.candidate.by_chance
    off = [abs(candidate.off[i]) for i in best.rows]
    error = float(np.median(off)) if off else math.nan
    message = (
        f"{trials} trials; {len(candidate.matched)} of {len(problem.events)} events matched, {len(best.rows)} of "
        f"{len(problem.fitted)} fitted ones agree ({error:.3g} units of the last decimal in the median); "
        f"{by_chance:.1e} such trials by chance"
    )
    if not first.good:
        message += ": not identified; give more events, finer trial values or wider ranges"
    return Identification(
        problem.events, trials, reduction, cost, message, first.good, candidate, first.candidate, roundings,
        tuple(others), by_chance, seen, unseen(best.fit, best.rows, seen), error,
    )  # fmt: skip


def _rounded(first: Solution, trials: int) -> tuple[Solution, tuple[Rounding, ...]]:
    """The solution with round values; the same if that would lose an event."""
    names = tuple(first.candidate.values)
    fit, roundings = rounded(first.fit, names, first.candidate.spread, first.rows)
    if not roundings:
        return first, ()
    best = solution(first.catalogue, fit.oscillator, trials)
    if not set(best.candidate.matched) >= set(first.candidate.matched):
        return first, ()
    return best, roundings


def _alike(a: GearOscillator, b: GearOscillator, names: Sequence[str]) -> bool:
    return all(abs(a.get(n) - b.get(n)) <= ALIKE * abs(b.get(n)) for n in names)
