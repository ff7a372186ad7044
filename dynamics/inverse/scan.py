"""Trials: one parameter from one event, exactly; the others tried."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from typing import NamedTuple

from dynamics.inverse.catalogue import CONTACT, DOUBLED, EVERY, Catalogue
from dynamics.inverse.events import Event, Problem, Ranged
from dynamics.inverse.reduction import FORCE
from dynamics.model.oscillator import GearOscillator
from dynamics.orbits.shooting import find_orbit

ORDER = ("saddle-node", "period-doubling", "grazing")  # grazings are often printed late: they come last
GRID = 8  # values of the solved parameter at which orbits of the anchor's label are searched for


class Trial(NamedTuple):
    """Parameters that meet one event exactly."""

    misfit: float
    """Sum of the losses of the events that were looked at."""
    oscillator: GearOscillator


def solved_name(problem: Problem) -> str | None:
    """Unknown that is solved from an event: the mean force, or the first that has a range; None if all are chosen."""
    ranged = [name for name, unknown in problem.unknowns.items() if unknown.continuous]
    return FORCE if FORCE in ranged else ranged[0] if ranged else None


def ranked(problem: Problem) -> list[int]:
    """Fitted events, those first that are trusted, of short period, and no grazings."""
    events = problem.events
    return sorted(
        problem.fitted,
        key=lambda i: (-events[i].trust, events[i].periods or math.inf, ORDER.index(events[i].kind), i),
    )


def anchored(catalogue: Catalogue, here: GearOscillator, event: Event, name: str) -> list[GearOscillator]:
    """Oscillators that have an event exactly at its value, by the choice of one parameter.

    At the event's value that parameter is what a branch is followed in: the branch of the motion in contact at
    either end of the range, or else those of orbits with the event's label.

    Parameters
    ----------
    catalogue : Catalogue
        Follows branches.
    here : GearOscillator
        All other parameters.
    event : Event
        The event.
    name : str
        The parameter.
    """
    problem = catalogue.problem
    unknown = problem.unknowns[name]
    span = (unknown.low, unknown.high)
    start = here.with_parameter(problem.parameter, event.value)
    values: list[float] = []
    if event.periods in (1, None):
        for end in (span[1], span[0]):
            there = start.with_parameter(name, end)
            values += catalogue.values_along(find_orbit(there, there.rest_state()), name, span, event)
            if values:
                break
    if not values and event.periods != 1:
        for value in Ranged(*span, trials=GRID).values:
            for orbit in catalogue.orbits_of(start.with_parameter(name, value), event, event.value):
                values += catalogue.values_along(orbit, name, span, event)
    distinct: list[float] = []
    for value in values:
        if not any(abs(value - other) <= 1e-9 * (span[1] - span[0]) for other in distinct):
            distinct.append(value)
    return [here.with_parameter(name, value) for value in distinct]


def scan(
    catalogue: Catalogue, anchor: int, name: str | None, progress: Callable[[int, int], None] | None = None
) -> list[Trial]:
    """All combinations of trial values, each completed by the anchor, the better first.

    Parameters
    ----------
    catalogue : Catalogue
        Its problem says what is tried.
    anchor : int
        Event that is met exactly.
    name : str or None
        Parameter that is solved from it.
    progress : callable, optional
        Called with the number of combinations done and of all.
    """
    problem = catalogue.problem
    tried = [n for n in problem.unknowns if n != name]
    combinations = list(itertools.product(*(problem.unknowns[n].values for n in tried)))
    depth, looked_at = _depth(problem, anchor)
    trials: list[Trial] = []
    for done, values in enumerate(combinations, start=1):
        here = problem.oscillator
        for n, value in zip(tried, values, strict=True):
            here = here.with_parameter(n, float(value))
        event = problem.events[anchor]
        for there in [here] if name is None else anchored(catalogue, here, event, name):
            trials.append(Trial(catalogue.misfit(there, depth, looked_at), there))
        if progress is not None:
            progress(done, len(combinations))
    return sorted(trials, key=lambda trial: trial.misfit)


def _depth(problem: Problem, anchor: int) -> tuple[int, list[int]]:
    """How far branches are followed in every trial, and the events that may lie there.

    As far as gives one event for every unknown, the anchor among them, or three: trials need only be distinguished.
    """
    wanted = min(len(problem.unknowns) - 1, 2)
    for depth, periods in ((CONTACT, (1,)), (DOUBLED, (1, 2, 4))):
        rows = [i for i in problem.fitted if problem.events[i].periods in periods and i != anchor]
        if len(rows) >= wanted:
            return depth, rows
    return EVERY, [i for i in problem.fitted if i != anchor]
