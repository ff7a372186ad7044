"""The inverse problem from events to parameters: reduce, scan, refine, complete, round, report."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from base import Cost, Faults, Stopwatch
from dynamics.inverse.catalogue import CONTACT, DOUBLED, EVERY, Catalogue, Tally
from dynamics.inverse.events import Event, Problem, Unknown, checked
from dynamics.inverse.reduction import PLAY, Reduction, reduced, scaled
from dynamics.inverse.refinement import Fit, fit
from dynamics.inverse.report import Identification
from dynamics.inverse.scan import Trial, anchored, ranked, scan, solved_name
from dynamics.inverse.scoring import by_chance, probabilities
from dynamics.inverse.solution import Solution, distinct, identification, solution
from dynamics.model.oscillator import GearOscillator

REFINED = 5  # best trials that are refined
CLEAR = 1e-9  # trials expected by chance below which nothing else is looked at
COMPLETED = 2  # best of these that all events are looked for with
PLAYS = 3  # events that touch the back flank tried as the exact one, for the backlash
ROUNDS = 4  # of matching and fitting


def identify(
    oscillator: GearOscillator,
    parameter: str,
    events: Sequence[Event],
    unknowns: Mapping[str, Unknown],
    bounds: tuple[float, float],
    *,
    solved: str | None = None,
    anchors: int = 3,
    progress: Callable[[int, int], None] | None = None,
) -> Identification:
    """Find parameters from special points that somebody reports.

    What the events cannot see is left out first. For every combination of trial values one event is met exactly, by the
    choice of one unknown more; the special points that the oscillator then has are matched with the events by kind,
    label and order along the branch. The best trials are refined by Newton's method on all events at once, with exact
    derivatives and weights that misprints lose. If the result is no better than chance, another event is taken as the
    exact one. Then all branches are searched for the other events, everything is refined together, and values are made
    round where that costs less than it is worth.

    Parameters
    ----------
    oscillator : GearOscillator
        Fixed parameters; its values of `parameter` and of the unknowns are not used.
    parameter : str
        Parameter in which the events are given.
    events : sequence of Event
        At least one fitted event more than unknowns that they can see.
    unknowns : mapping
        Parameter, named as in `GearOscillator.with_parameter`, to `Ranged` or `OneOf`.
    bounds : tuple of float
        Range of `parameter` within which branches are followed; with more than one event outside the usual motion in
        contact, the shorter the better.
    solved : str, optional
        Unknown that is solved from one event. Left out: the mean force, or the first that has a range.
    anchors : int
        Events tried one after another as the exact one while the result is no better than chance: as many as may be
        wrong, and one more.
    progress : callable, optional
        Called with the number of combinations done and of all, anew for each exact event.

    Returns
    -------
    Identification
        Parameters, competitors, and how far chance would have gone.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> from dynamics.inverse import Event, OneOf, identify
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.2, 0.2, 0.6, half_backlash=0.2)
    >>> events = [Event("grazing", "1-0-0", 0.6335, digits=4), Event("saddle-node", "1-1-0", 0.6556, digits=4)]
    >>> identified = identify(osc, "frequency", events, {"mean_force": OneOf((0.1,))}, (0.62, 0.67))
    >>> identified.converged, identified.best.values
    (True, {'mean_force': 0.1})
    """
    watch = Stopwatch()
    problem = checked(oscillator, parameter, events, unknowns, bounds)
    reduction = reduced(problem)
    first = reduction.first
    with Faults() as faults:
        if solved is not None and solved not in first.unknowns:
            faults.add(
                "solved",
                solved,
                f"must be one of {', '.join(first.unknowns)}",
                "name an unknown that the events see",
            )
        most = faults.whole("anchors", anchors, 1, 1000, "one more than events that may be wrong")
    name = solved if solved is not None else solved_name(first)
    catalogue = Catalogue(first, Tally())
    trials = 0
    solutions: list[Solution] = []
    for anchor in ranked(first)[:most]:
        scanned = scan(catalogue, anchor, name, progress)
        trials += len(scanned)
        fits = _refined(catalogue, scanned, trials)
        starts = distinct([f.oscillator for f in fits], tuple(first.unknowns))
        for start in starts[:COMPLETED]:
            solutions.append(_completed(catalogue, reduction, start, trials))
            if solutions[-1].candidate.by_chance < CLEAR:
                break
        solutions.sort(key=lambda s: s.fit.misfit)
        if (solutions and solutions[0].good) or name is None:
            break
    tally = catalogue.tally
    cost = Cost(watch.seconds, len(unknowns), tally.branches, tally.periods)
    return identification(problem, reduction.message, solutions, trials, cost)


def _refined(catalogue: Catalogue, scanned: Sequence[Trial], trials: int) -> list[Fit]:
    """Fits of the best trials, the better first; no more are made once one is beyond doubt."""
    problem = catalogue.problem
    periods = {problem.events[i].periods for i in problem.fitted}
    depth = CONTACT if periods == {1} else DOUBLED
    fits: list[Fit] = []
    for trial in scanned[:REFINED]:
        fits.append(_settled(catalogue, trial.oscillator, depth))
        chance = probabilities(problem, [], fits[-1].off)
        if by_chance(problem, chance, len(problem.unknowns), trials) < CLEAR:
            break
    return sorted(fits, key=lambda f: f.misfit)


def _settled(catalogue: Catalogue, start: GearOscillator, depth: int) -> Fit:
    """Match and fit in turn until the partners stay the same."""
    names = tuple(catalogue.problem.unknowns)
    here, best = start, None
    before = np.empty(0)
    for _ in range(ROUNDS):
        fitted = fit(catalogue.start(here, depth)[1], names)
        if best is None or fitted.misfit < best.misfit:
            best = fitted
        now = np.round(fitted.values, 10)
        if np.array_equal(now, before, equal_nan=True):
            break
        here, before = fitted.oscillator, now
    assert best is not None
    return best


def _completed(catalogue: Catalogue, reduction: Reduction, start: GearOscillator, trials: int) -> Solution:
    """From the reduced problem to the whole: backlash, all branches, all events, all unknowns."""
    here = start
    if reduction.play is not None:
        here = _with_play(catalogue, reduction, here)
    here = reduction.whole(here)
    unknowns = {n: reduction.problem.unknowns[n] for n in reduction.names}
    problem = dataclasses.replace(reduction.problem, oscillator=here, unknowns=unknowns)
    whole = Catalogue(problem, catalogue.tally)
    return solution(whole, _settled(whole, here, EVERY).oscillator, trials)


def _with_play(catalogue: Catalogue, reduction: Reduction, start: GearOscillator) -> GearOscillator:
    """The backlash from the events that touch the back flank; the start if none of them can be met."""
    assert reduction.play is not None
    whole = reduction.problem
    events = tuple(e for e in whole.events if e.fitted and not e.one_sided)
    here = dataclasses.replace(start, one_sided=False)
    problem = Problem(here, whole.parameter, events, {PLAY: reduction.play}, whole.bounds)
    search = Catalogue(problem, catalogue.tally)
    tried: list[Trial] = []
    for anchor in ranked(problem)[:PLAYS]:
        met = anchored(search, here, events[anchor], PLAY)
        tried += [Trial(search.misfit(there, EVERY), there) for there in met]
        if tried and len(events) == 1:
            break
    oscillator = min(tried, key=lambda trial: trial.misfit).oscillator if tried else here
    return (
        scaled(oscillator, whole.oscillator.half_backlash / oscillator.half_backlash)
        if reduction.rescaled
        else oscillator
    )
