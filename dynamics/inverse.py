"""The inverse problem: which parameters have special points at given values."""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.continuation import KINDS, Branch, continue_branch
from dynamics.cost import Cost
from dynamics.errors import Faults
from dynamics.oscillator import GearOscillator
from dynamics.robustness import special_sensitivities
from dynamics.shooting import find_orbit
from dynamics.special import SpecialPoint
from dynamics.sweeps import rest_state
from dynamics.switching import doubled_orbit

__all__ = ["Candidate", "Event", "Identification", "identify"]

FloatArray = npt.NDArray[np.float64]
REFINED = 5  # best trials that are refined
SETTLED = 2000  # periods in which the motion at the upper bound is taken to have settled
LATE = 1e3  # units of the last digit beyond which an event is an outlier of a refined trial


@dataclass(frozen=True)
class Event:
    """A special point that somebody reports.

    Parameters
    ----------
    kind : str
        "saddle-node", "period-doubling" or "grazing".
    label : str
        Motion n-p-q at the point.
    value : float
        Parameter value as printed.
    digits : int
        Decimals printed.
    fitted : bool
        Whether it may be used to find parameters; the others are only scored.
    """

    kind: str
    label: str
    value: float
    digits: int
    fitted: bool = True

    @property
    def unit(self) -> float:
        """One unit of the last decimal."""
        return float(10.0**-self.digits)


@dataclass(frozen=True, eq=False)
class Candidate:
    """Parameters that explain events.

    Parameters
    ----------
    oscillator : GearOscillator
        With the parameters found.
    values : dict
        Parameter to value.
    spread : dict
        Parameter to what one unit of the last decimal of every event leaves open, to first order.
    found : tuple of float
        Where each event lies with these parameters; nan if it has no partner.
    off : tuple of float
        Difference to the printed value, in units of its last decimal.
    matched, unmatched : tuple of int
        Events within a thousand units, and the others.
    """

    oscillator: GearOscillator
    values: dict[str, float]
    spread: dict[str, float]
    found: tuple[float, ...]
    off: tuple[float, ...]
    matched: tuple[int, ...]
    unmatched: tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Identification:
    """What the events say about the parameters.

    Parameters
    ----------
    best : Candidate or None
        Refined and snapped to round values; None if no trial has the first event.
    refined : Candidate or None
        The same before snapping.
    competitors : tuple of Candidate
        Other refined trials, the better first, that are not the same parameters.
    trials : int
        Trials scanned.
    by_chance : float
        Trials that would match as many fitted events within the scatter of the best one if events lay at random.
    unseen : tuple of str
        Parameters of the oscillator on which no matched event depends.
    error : float
        Largest difference of a matched event, in units of its last decimal.
    cost : Cost
        Effort.
    converged : bool
        Whether all fitted events are matched and by_chance is below 0.01.
    message : str
        What was found.
    """

    best: Candidate | None
    refined: Candidate | None
    competitors: tuple[Candidate, ...]
    trials: int
    by_chance: float
    unseen: tuple[str, ...]
    error: float
    cost: Cost
    converged: bool
    message: str


def identify(
    oscillator: GearOscillator,
    parameter: str,
    events: Sequence[Event],
    trials: Mapping[str, Sequence[float]],
    solved: str,
    solved_bounds: tuple[float, float],
    bounds: tuple[float, float],
    *,
    progress: Callable[[int, int], None] | None = None,
) -> Identification:
    """Find parameters from special points, first of all on the branch of the motion that never leaves contact.

    For every combination of trial values the first event is met exactly: at its value the branch is followed in one
    parameter more, `solved`, to where the point of that kind and label lies. The branch over `parameter` then has
    the other events or not. The best trials are refined by Newton's method on the events, with their exact
    derivatives, and snapped to round values within what the printed digits leave open. Only then events on other
    branches are looked for: that of the motion at the upper bound, and doubled branches.

    Motions that do not touch the back flank do not see D, and their size scales with mean force and error together:
    with `one_sided=True` and the error amplitude fixed that is one unknown fewer of each.

    Parameters
    ----------
    oscillator : GearOscillator
        Fixed parameters; those of `trials`, `solved` and `parameter` are replaced.
    parameter : str
        Parameter in which the events are given.
    events : sequence of Event
        The first fitted one is met exactly in every trial: give one that is trusted.
    trials : mapping
        Parameter to values that are tried, round ones for instance.
    solved : str
        Parameter found from the first event; at the upper bound the motion must be in contact all the time.
    solved_bounds, bounds : tuple of float
        Ranges of `solved` and of `parameter`.
    progress : callable, optional
        Called with the number of trials done and of all.

    Returns
    -------
    Identification
        The best parameters, competitors, and how far chance would have gone.

    Raises
    ------
    DynamicsError
        If an argument is out of range.
    """
    began = time.perf_counter()
    faults = Faults()
    for i, event in enumerate(events):
        if event.kind not in KINDS:
            faults.add(f"events[{i}].kind", event.kind, ", ".join(KINDS), "name one of these")
        if not bounds[0] < event.value < bounds[1]:
            faults.add(f"events[{i}].value", event.value, "within bounds", "widen the bounds")
    fitted = [i for i, event in enumerate(events) if event.fitted]
    if len(fitted) < len(trials) + 1:
        faults.add(
            "events", len(fitted), f"{len(trials) + 1} fitted ones or more", "give one for each unknown"
        )
    faults.raise_if_any()
    search = _Search(
        oscillator, parameter, tuple(events), fitted, tuple(trials), solved, solved_bounds, bounds
    )
    names, combinations = tuple(trials), list(itertools.product(*trials.values()))
    scored: list[tuple[float, GearOscillator]] = []
    for done, values in enumerate(combinations, start=1):
        here = oscillator
        for name, value in zip(names, values, strict=True):
            here = here.with_parameter(name, float(value))
        for anchored in search.anchored(here):
            branch = search.branch(anchored)
            if branch is not None:
                scored.append((search.score(branch), anchored))
        if progress is not None:
            progress(done, len(combinations))
    scored.sort(key=lambda pair: pair[0])
    refined = [c for c in (search.refine(o) for _, o in scored[:REFINED]) if c is not None]
    refined.sort(key=lambda c: (-len(c.matched), search.misfit(c)))
    distinct: list[Candidate] = []
    for candidate in refined:
        if not any(search.same(candidate, other) for other in distinct):
            distinct.append(candidate)
    cost = Cost(time.perf_counter() - began, len(names) + 1, search.branches, search.periods)
    if not distinct:
        message = f"{len(combinations)} trials, none has the first event: widen solved_bounds"
        return Identification(None, None, (), len(combinations), math.nan, (), math.nan, cost, False, message)
    first = distinct[0]
    best = search.snapped(first)
    chance = search.chance(best, len(combinations))
    error = max((abs(best.off[i]) for i in best.matched), default=math.nan)
    good = all(i in best.matched for i in fitted) and chance < 0.01
    message = (
        f"{len(combinations)} trials; {len(best.matched)} of {len(events)} events matched within {error:.3g} units of "
        f"the last decimal, {chance:.1e} trials by chance"
    )
    return Identification(
        best,
        first,
        tuple(distinct[1:]),
        len(combinations),
        chance,
        search.unseen(best),
        error,
        cost,
        good,
        message,
    )


class _Search:
    """Trials, their scores and their refinement."""

    def __init__(
        self, oscillator: GearOscillator, parameter: str, events: tuple[Event, ...], fitted: list[int],
        names: tuple[str, ...], solved: str, solved_bounds: tuple[float, float], bounds: tuple[float, float],
    ) -> None:  # fmt: skip
        self.oscillator, self.parameter, self.events, self.fitted = oscillator, parameter, events, fitted
        self.solved, self.solved_bounds, self.bounds = solved, solved_bounds, bounds
        self.unknowns = (*names, solved)
        self.branches = self.periods = 0

    def anchored(self, here: GearOscillator) -> list[GearOscillator]:
        """Oscillators that have the first fitted event exactly."""
        event = self.events[self.fitted[0]]
        start = here.with_parameter(self.parameter, event.value).with_parameter(
            self.solved, self.solved_bounds[1]
        )
        branch = self._follow(start, self.solved, self.solved_bounds)
        points = [] if branch is None else [p for p in branch.points if _fits(p, event)]
        return [here.with_parameter(self.solved, p.parameter) for p in points]

    def branch(self, here: GearOscillator) -> Branch | None:
        """Branch of the motion in contact over the parameter."""
        return self._follow(here.with_parameter(self.parameter, self.bounds[0]), self.parameter, self.bounds)

    def points(self, here: GearOscillator) -> tuple[SpecialPoint, ...]:
        """Special points of the branch in contact, of the motion at the upper bound, and of doubled branches of both.

        The latter two are followed only if an event asks for them.
        """
        first = self.branch(here)
        branches = [] if first is None else [first]
        if any(self._partner(branches, e) is None for e in self.events):
            top = self._follow(
                here.with_parameter(self.parameter, self.bounds[1]), self.parameter, self.bounds, SETTLED
            )
            branches += [] if top is None else [top]
        if any(e.label.startswith("2-") for e in self.events):
            for point in [p for b in branches for p in b.special("period-doubling")]:
                orbit = doubled_orbit(here, self.parameter, point, self.bounds)
                if orbit is not None:
                    branches.append(continue_branch(orbit, self.parameter, self.bounds, max_step=0.05))
        return tuple(p for b in branches for p in b.points)

    def _partner(self, branches: list[Branch], event: Event) -> SpecialPoint | None:
        """Special point within a fiftieth of the range."""
        near = 0.02 * (self.bounds[1] - self.bounds[0])
        points = [p for b in branches for p in b.points if _fits(p, event)]
        return next((p for p in points if abs(p.parameter - event.value) < near), None)

    def _follow(
        self, start: GearOscillator, name: str, bounds: tuple[float, float], transient: int = 0
    ) -> Branch | None:
        orbit = find_orbit(start, rest_state(start), transient=transient)
        if not orbit.converged:
            return None
        branch = continue_branch(orbit, name, bounds, max_step=0.05, max_points=1500)
        self.branches += 1
        self.periods += branch.cost.periods
        return branch

    def partner(self, points: Sequence[SpecialPoint], event: Event) -> SpecialPoint | None:
        """Nearest special point of the event's kind and label."""
        return min(
            (p for p in points if _fits(p, event)), key=lambda p: abs(p.parameter - event.value), default=None
        )

    def score(self, branch: Branch) -> float:
        """Sum of the logarithms of the differences; one event far off, or missing, costs a bounded amount."""
        width = self.bounds[1] - self.bounds[0]
        total = 0.0
        for i in self.fitted[1:]:
            point = self.partner(branch.points, self.events[i])
            off = width if point is None else min(abs(point.parameter - self.events[i].value), width)
            total += math.log(max(off, self.events[i].unit) / width)
        return total

    def refine(self, here: GearOscillator) -> Candidate | None:
        """Newton's method on the fitted events, least squares if they are more than the unknowns."""
        best: Candidate | None = None
        for _ in range(12):
            branch = self.branch(here)
            if branch is None:
                return best
            found = self.candidate(here, branch.points)
            if best is None or self.misfit(found) < self.misfit(best):
                best = found
            rows, gaps = self._equations(here, branch.points)
            if len(gaps) < len(self.unknowns):
                return best
            step = np.linalg.lstsq(rows, gaps, rcond=1e-12)[0]
            values = np.array([here.get(n) for n in self.unknowns])
            step *= min(
                1.0, 0.3 / max(float(np.max(np.abs(step) / np.maximum(np.abs(values), 1e-3))), 1e-300)
            )
            for name, value in zip(self.unknowns, values + step, strict=True):
                here = here.with_parameter(name, max(float(value), 1e-9))
            if float(np.max(np.abs(step) / np.abs(values))) < 1e-13:
                break
        return best

    def _equations(
        self, here: GearOscillator, points: Sequence[SpecialPoint]
    ) -> tuple[FloatArray, FloatArray]:
        """Derivatives and differences of the fitted events, over their units."""
        rows, gaps = [], []
        for i in self.fitted:
            event = self.events[i]
            point = self.partner(points, event)
            if point is None or abs(point.parameter - event.value) > 0.1 * (self.bounds[1] - self.bounds[0]):
                continue
            slopes = special_sensitivities(here, self.parameter, point, self.unknowns)
            row = np.array([slopes[n] for n in self.unknowns])
            if np.all(np.isfinite(row)):
                rows.append(row / event.unit)
                gaps.append((event.value - point.parameter) / event.unit)
        return np.array(rows).reshape(-1, len(self.unknowns)), np.array(gaps)

    def candidate(self, here: GearOscillator, points: Sequence[SpecialPoint]) -> Candidate:
        """Record of a trial."""
        partners = [self.partner(points, e) for e in self.events]
        found = tuple(math.nan if p is None else p.parameter for p in partners)
        off = tuple((x - e.value) / e.unit for x, e in zip(found, self.events, strict=True))
        matched = tuple(i for i, x in enumerate(off) if abs(x) <= LATE)
        rows, _ = self._equations(here, points)
        spread = np.full(len(self.unknowns), math.nan)
        if len(rows) >= len(self.unknowns):
            spread = np.sum(np.abs(np.linalg.pinv(rows)), axis=1)
        return Candidate(
            here, {n: here.get(n) for n in self.unknowns}, dict(zip(self.unknowns, spread.tolist(), strict=True)),
            found, off, matched, tuple(i for i in range(len(off)) if i not in matched),
        )  # fmt: skip

    def misfit(self, candidate: Candidate) -> float:
        """Sum of the logarithms of the fitted events' differences in units."""
        off = [abs(candidate.off[i]) for i in self.fitted]
        return math.fsum(math.log(1.0 + (x if math.isfinite(x) else 1e12)) for x in off)

    def same(self, a: Candidate, b: Candidate) -> bool:
        """Tell whether two candidates are the same parameters to a thousandth."""
        return all(abs(a.values[n] - b.values[n]) <= 1e-3 * abs(b.values[n]) for n in self.unknowns)

    def snapped(self, candidate: Candidate) -> Candidate:
        """Round values within the spread, where they fit no worse than a few units."""
        here = candidate.oscillator
        for name in self.unknowns:
            room = 5.0 * candidate.spread[name]
            value = candidate.values[name]
            for digits in range(1, 8):
                rounded = float(f"{value:.{digits - 1}e}")
                if abs(rounded - value) <= room:
                    here = here.with_parameter(name, rounded)
                    break
        new = self.candidate(here, self.points(here))
        return new if set(new.matched) >= set(candidate.matched) else candidate

    def chance(self, best: Candidate, trials: int) -> float:
        """Trials expected to match the same events as well, the exact one excepted, were points spread evenly."""
        width = self.bounds[1] - self.bounds[0]
        points = self.points(best.oscillator)
        expected = float(trials)
        spare = sorted((i for i in best.matched if i in self.fitted), key=lambda i: abs(best.off[i]))
        for i in spare[len(self.unknowns) :] + [i for i in best.matched if i not in self.fitted]:
            event = self.events[i]
            number = sum(_fits(p, event) for p in points)
            expected *= min(1.0, 2.0 * number * max(abs(best.off[i]), 1.0) * event.unit / width)
        return expected

    def unseen(self, best: Candidate) -> tuple[str, ...]:
        """Parameters on which no matched event depends."""
        points = self.points(best.oscillator)
        strongest: dict[str, float] = {}
        for i in best.matched:
            point = self.partner(points, self.events[i])
            assert point is not None
            for name, slope in special_sensitivities(best.oscillator, self.parameter, point).items():
                strongest[name] = max(strongest.get(name, 0.0), abs(slope))
        return tuple(name for name, slope in strongest.items() if slope < 1e-9)


def _fits(point: SpecialPoint, event: Event) -> bool:
    return point.kind == event.kind and point.label.removeprefix("U") == event.label
