"""Basins of attraction on a grid of starting states."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from base import Array, Cost, Faults, InputError, Integers, Stopwatch, part, quantity, record
from dynamics.attraction.covers import Cover
from dynamics.attraction.known_attractors import KnownAttractors
from dynamics.flow.protocol import Flow
from dynamics.model.arrays import AsArray
from dynamics.model.limits import LONGEST_PERIOD, PATIENT, RADIUS, checked_axis
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import Oscillator, settling_periods
from dynamics.model.reasons import OF_A_GRID
from dynamics.model.states import apart, checked_state
from dynamics.motion.exponents import stretch_rate
from dynamics.motion.sweeps import APERIODIC, creeping, long_flow, orbit_tolerance, repeat_after
from dynamics.orbits.shooting import Orbit, find_orbit

UNDECIDED, UNBOUNDED, UNSETTLED = -1, -2, -3
SOME = 5  # part of that after which a motion of a train that did not creep to an orbit is looked at again
SIEVE = 64, 1  # cells along each side of a chaotic attractor and around it, which a motion on it stays in


@record
class Attractor:
    """An attractor and its share of the starts."""

    no_error = OF_A_GRID

    headline = ("label", "share", "share_error")

    label: str = quantity("", "n-p-q, or aperiodic")
    states: Array = quantity(
        "1",
        "its points at tau = 0 mod the excitation period; samples of them if it is aperiodic",
        "point coordinate",
    )
    orbit: Orbit | None
    """The periodic orbit, polished by Newton's method; None if aperiodic."""
    share: float = quantity("1", "part of the starts that reach it")
    share_error: float = quantity("1", "standard error of the share if the starts are taken for a sample")


@record
class BasinResult(AsArray):
    """Which attractor every start reaches."""

    no_error = OF_A_GRID

    x: Array = quantity("1", "starting values of X, or along the first direction of the plane", "x")
    v: Array = quantity("1", "starting values of V, or along the second direction of the plane", "v")
    labels: Integers = quantity("1", "index into the attractors; -1 unsettled, -2 unbounded", "x v")
    attractors: tuple[Attractor, ...] = part(
        "in the order in which they were found; all aperiodic motion counts as one"
    )
    error: float = quantity("1", "part of the starts unsettled plus the largest standard error of a share")
    cost: Cost
    converged: bool = quantity("1", "whether every start has settled")
    message: str = quantity("", "what was found, with a remedy if some starts have not settled")

    def columns(self) -> Integers:
        """Return the labels."""
        return self.labels


def basins(
    oscillator: Oscillator,
    x: tuple[float, float, int],
    v: tuple[float, float, int],
    *,
    plane: npt.ArrayLike | None = None,
    through: npt.ArrayLike | None = None,
    limit: int | None = None,
    radius: float = 1e-4,
    max_period: int = 16,
    tolerance: float | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> BasinResult:
    """Find the attractors that a grid of starts reaches, and which start reaches which.

    Each start is followed until it is near a point of a known attractor and no farther from it one round later. A
    start that reaches none is followed on; if it repeats, Newton's method makes it a new attractor. One that does not
    repeat is aperiodic if it stays on a set where a motion of 20 limits has a positive Lyapunov exponent, by three
    standard errors; else it is followed for 20 limits, and what then has not reached an orbit is unsettled: chaos
    may be a transient, and a creeping motion is no chaos. (Without damping nothing settles: all that does not repeat
    is aperiodic.)

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    x, v : tuple
        First value, last value and number of starting values of X and of V; in several freedoms, of how far starts
        are from `through` along the two directions of `plane`.
    plane : array_like, shape (2, dimension), optional
        Directions of the starts. Left out: those of X and V; in several freedoms as y and its rate move alone.
    through : array_like, shape (dimension,), optional
        State that the plane of the starts passes. Left out: 0; in several freedoms the state at rest.
    limit : int, optional
        Periods after which a start without a known attractor is looked at. Left out: as the transient of `sweep`.
    radius : float
        Nearness to an attractor, over the size of the attractor.
    max_period : int
        Longest period that is recognised; longer ones count as aperiodic.
    tolerance : float, optional
        Of the flow, as of `period_map`; 1e-9 for steps, rounding for the exact flow.
    progress : callable, optional
        Called with the number of starts decided and the number of all.

    Returns
    -------
    BasinResult
        Labels and attractors.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator
    >>> oscillator = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> [attractor.label for attractor in basins(oscillator, x=(-1, 1, 6), v=(-1, 1, 6)).attractors]
    ['1-1-1', '1-0-0']
    """
    watch = Stopwatch()
    with Faults() as faults:
        xs, vs = (checked_axis(faults, name, axis) for name, axis in (("x", x), ("v", v)))
        near = faults.number("radius", radius, RADIUS)
        longest = faults.whole("max_period", max_period, *LONGEST_PERIOD)
        wait = settling_periods(oscillator) if limit is None else faults.whole("limit", limit, *PATIENT)
    flow = long_flow(oscillator, tolerance)
    starts = starting_states(
        oscillator, np.stack(np.meshgrid(xs, vs, indexing="ij"), axis=-1), plane, through
    )
    labels = np.full(len(starts), UNDECIDED, dtype=np.int64)
    search = _Found(oscillator, flow, longest, near, wait)
    sample = np.unique(np.linspace(0, len(starts) - 1, min(len(starts), OPTIONS.seeds)).astype(np.int64))
    for i in sample:
        labels[i] = search.follow(starts[i], wait)
        if progress is not None:
            progress(int(np.sum(labels != UNDECIDED)), len(labels))
    for chunk in np.array_split(np.arange(len(starts)), min(len(starts), 16)):
        mine, there = labels[chunk], starts[chunk]
        search.settle(there, wait, mine)
        if any(orbit is not None for orbit in search.orbits):
            search.settle(there, 2 * wait, mine)  # transient chaos outlives damping
        for i in np.flatnonzero(mine == UNDECIDED):
            mine[i] = search.follow(there[i], 0)
        if any(orbit is not None for orbit in search.orbits):
            search.settle(there, OPTIONS.patience * wait, mine, UNSETTLED)
        labels[chunk] = mine
        if progress is not None:
            progress(int(chunk[-1]) + 1, len(labels))
    last = labels == UNSETTLED  # of the first starts: there were fewer known attractors
    if np.any(last) and any(orbit is not None for orbit in search.orbits):
        mine, there = labels[last], starts[last]
        search.settle(there, (OPTIONS.patience + 1) * wait, mine, UNSETTLED)
        labels[last] = mine
    labels[labels == UNSETTLED] = UNDECIDED
    attractors = search.attractors(labels)
    lost = float(np.mean(labels == UNDECIDED))
    error = lost + max((a.share_error for a in attractors), default=0.0)
    message = f"{len(attractors)} attractors"
    if np.any(labels == UNBOUNDED):
        message += f"; {np.mean(labels == UNBOUNDED):.3g} of the starts grow without bound"
    if lost:
        message += f"; {lost:.3g} of the starts unsettled: raise limit"
    cost = Cost(watch.seconds, 2, search.iterations, search.periods)
    return BasinResult(
        xs, vs, labels.reshape(len(xs), len(vs)), attractors, error, cost, lost == 0.0, message
    )


def starting_states(
    oscillator: Oscillator, grid: Array, plane: npt.ArrayLike | None, through: npt.ArrayLike | None
) -> Array:
    """Starting states, shape (k, dimension), of distances along two directions, shape (any, 2).

    Parameters
    ----------
    oscillator : Oscillator
        The oscillator.
    grid : ndarray, shape (any, 2)
        Distances from `through` along the two directions.
    plane, through : array_like, optional
        As of `basins`.

    Raises
    ------
    InputError
        If the directions are not independent, or of another length than a state.
    """
    along, centre = oscillator.start_plane()
    if plane is not None:
        along = np.array(plane, dtype=np.float64)
        if along.shape != (2, oscillator.dimension) or np.linalg.matrix_rank(along) != 2:
            allowed = f"must be two independent directions of {oscillator.dimension} numbers"
            raise InputError.at(
                "plane", np.asarray(plane).tolist(), allowed, "give one row for x and one for v"
            )
    if through is not None:
        centre = checked_state(through, "through", oscillator.dimension)
    return np.asarray(centre + grid.reshape(-1, 2) @ along)


class _Found:
    """Attractors found so far."""

    def __init__(self, oscillator: Oscillator, flow: Flow, longest: int, near: float, limit: int) -> None:
        self.oscillator, self.flow, self.longest, self.near = oscillator, flow, longest, near
        self.orbits: list[Orbit | None] = []
        self.points: list[Array] = []
        self.periods = self.iterations = self.trials = 0
        self.patience = OPTIONS.patience * limit
        self.chaos: list[Cover] = []

    def follow(self, state: Array, wait: int) -> int:
        """Attractor that one state reaches, noted if it is new; or one of the negative labels."""
        kept = 4 * self.longest
        image = self.flow.follow(state, kept, wait, derivatives=False)
        self.periods += kept + wait
        if image.message:
            return UNBOUNDED
        n = repeat_after(image.states, self.longest, self.flow.tolerance)
        return self.polish(image.states, n) if n else self.wandering(image.states)

    def wandering(self, states: Array) -> int:
        """Label of a motion that does not repeat: chaotic, on its way to an orbit after all, or unsettled."""
        late = self.oscillator.in_plane(states[len(states) // 2 :])
        if self.oscillator.decay == 0.0 or not all(np.any(cover.outside(late)) for cover in self.chaos):
            return self.note(None, states)
        several = self.oscillator.dimension > 2
        if several and (label := self.creep(states)) >= 0:
            return label
        if self.trials == OPTIONS.chaos_trials:
            return UNSETTLED
        if several and (label := self.creep(self.later(states))) >= 0:
            return label
        self.trials += 1
        motion, exponent, error = stretch_rate(self.flow, states[-1], self.patience)
        self.periods += self.patience
        if not np.all(np.isfinite(motion)):
            return UNBOUNDED
        end = motion[-4 * self.longest :]
        n = repeat_after(end, self.longest, self.flow.tolerance)
        if n:
            return self.polish(end, n)
        if exponent > OPTIONS.sure * error:
            self.chaos.append(Cover.of(self.oscillator.in_plane(motion), *SIEVE))
            return self.note(None, states)
        n, _, more = creeping(self.oscillator, self.flow, end, self.longest)
        return self.polish(end, n) if n and more else UNSETTLED

    def later(self, states: Array) -> Array:
        """States of a motion after a part of the patience."""
        waited = self.patience // SOME
        self.periods += waited + len(states)
        return self.flow.follow(states[-1], len(states), waited, derivatives=False).states

    def creep(self, states: Array) -> int:
        """Label of a motion that comes nearer to a stable orbit: slow modes of a train take thousands of periods.

        Exponents over so many periods in so many directions would cost a hundred times as much.
        """
        n, _, more = creeping(self.oscillator, self.flow, states, self.longest)
        if not (n and more):
            return UNSETTLED
        orbit = find_orbit(self.oscillator, states[-1], periods=n, tolerance=orbit_tolerance(self.flow))
        self.iterations += orbit.cost.iterations
        return self.note(orbit, self.flow.follow(orbit.state, orbit.periods, derivatives=False).states)

    def polish(self, states: Array, n: int) -> int:
        """Label of a motion that nearly repeats after n periods, if Newton's method finds its orbit."""
        orbit = find_orbit(self.oscillator, states[-1], periods=n, tolerance=orbit_tolerance(self.flow))
        self.periods += orbit.cost.periods
        self.iterations += orbit.cost.iterations
        size = max(float(np.max(np.abs(states))), 1e-300)
        if not (orbit.converged and orbit.stable and apart(orbit.state, states) < OPTIONS.same_motion * size):
            return UNSETTLED
        return self.note(orbit, self.flow.follow(orbit.state, orbit.periods, derivatives=False).states)

    def note(self, orbit: Orbit | None, states: Array) -> int:
        """Index of an attractor, known or new; all aperiodic motion counts as one."""
        for i, (other, points) in enumerate(zip(self.orbits, self.points, strict=True)):
            if orbit is None or other is None:
                if orbit is other:
                    return i
            elif len(points) == len(states) and apart(orbit.state, points) < 1e-6 * max(
                np.max(np.abs(points)), 1e-300
            ):
                return i
        self.orbits.append(orbit)
        self.points.append(states)
        return len(self.orbits) - 1

    def settle(self, starts: Array, limit: int, labels: Integers, which: int = UNDECIDED) -> None:
        """Follow all starts with the label `which` until they arrive at a known periodic attractor."""
        if which != UNDECIDED:
            rows = labels == which
            if np.any(rows):
                mine, there = np.full(int(np.sum(rows)), UNDECIDED, dtype=np.int64), starts[rows]
                self.settle(there, limit, mine)
                mine[mine == UNDECIDED] = which
                labels[rows], starts[rows] = mine, there
            return
        known = [None if orbit is None else p for orbit, p in zip(self.orbits, self.points, strict=True)]
        homes = KnownAttractors(self.flow, known, self.near)
        homes.settle(starts, limit, labels)
        self.periods += homes.periods

    def attractors(self, labels: Integers) -> tuple[Attractor, ...]:
        """Records with their shares."""
        records = []
        for i, (orbit, states) in enumerate(zip(self.orbits, self.points, strict=True)):
            share = float(np.mean(labels == i))
            scatter = float(np.sqrt(share * (1.0 - share) / len(labels)))
            records.append(Attractor(orbit.label if orbit else APERIODIC, states, orbit, share, scatter))
        return tuple(records)
