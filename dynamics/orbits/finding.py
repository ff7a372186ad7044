"""All the periodic orbits of a region: deflated Newton searches, and a count that shows what is missing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from base import Array, Cost, Faults, InputError, Stopwatch, quantity, record
from dynamics.flow.flows import flow_of
from dynamics.flow.protocol import propagated
from dynamics.model.limits import SEARCHED, whole_numbers
from dynamics.model.options import OPTIONS
from dynamics.model.protocol import PeriodicOscillator, periodic_only
from dynamics.model.reasons import OF_A_SEARCH
from dynamics.model.states import Region, checked_region
from dynamics.orbits.hunting import hunted
from dynamics.orbits.index import index_at_infinity
from dynamics.orbits.shooting import Orbit, find_orbit
from dynamics.orbits.starting import around, grid_of, long_motions

BESIDE = (1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2)  # of the size of the region
PLAIN = 25  # Newton iterations from a start without deflation
PASSED = 6  # periods that every second batch has gone on for, at most
GOLDEN = (
    0.7548776662466927,
    0.5698402909980532,
)  # shifts of a sequence that fills the plane evenly, after Roberts
WHOLE = 40  # periods of long motions that are looked at all the time, by so many samples
SAMPLES = 32
SHARES = tuple(k / 10 for k in range(1, 10))  # of the way from one orbit to the next
RECURRENT = 120  # points of long motions that are tried as starts: chaos passes near its unstable orbits


@record
class IndexCount:
    """Sum of the indices of the fixed points of the n-period map, against what it must be."""

    no_error = OF_A_SEARCH

    headline = ("periods", "points", "found", "expected")

    periods: int = quantity("1", "n")
    points: int = quantity("1", "fixed points found, those of shorter periods included")
    found: int = quantity(
        "1", "sum of their indices, the sign of (1 - m1)(1 - m2)... of each, over all multipliers"
    )
    expected: int | None = quantity("1", "index of the map on a large circle; None if it is not known")
    starts: int = quantity("1", "starts of the search without deflation", default=0)
    once: int = quantity("1", "orbits that only one of those starts led to", default=0)
    unseen: float = quantity(
        "1",
        "orbits that are probably missing, by how many were met once and how many twice: the index cannot see pairs "
        "of opposite sign; 0 where no such search was made",
        default=0.0,
    )


@record
class OrbitSet:
    """Orbits found.

    Where the indices found and expected of a period differ, orbits are missing, or lie on a bifurcation. Where they
    agree pairs of opposite index may be missing. Those are estimated by how often single starts lead to the same orbit:
    as long as some are met once, others are likely not to be met at all.
    """

    no_error = OF_A_SEARCH

    headline = ("message",)

    orbits: tuple[Orbit, ...] = quantity("", "orbits by period, then by X at tau = 0")
    counts: tuple[IndexCount, ...] = quantity("", "sum of the indices, one for each period asked for")
    region: Region = quantity("1", "where the searches started, ((x0, x1), (v0, v1))", "state bound")
    error: float = quantity("1", "largest estimated relative error of an orbit")
    cost: Cost
    converged: bool = quantity(
        "1", "whether all sums of indices are as expected, and no orbit was met by one start alone"
    )
    message: str

    def __len__(self) -> int:
        """Number of orbits."""
        return len(self.orbits)


@periodic_only
def find_orbits(
    oscillator: PeriodicOscillator,
    periods: int | Sequence[int] = (1, 2, 3, 4),
    region: Region | None = None,
    *,
    starts: int = 10,
    batches: int = 48,
) -> OrbitSet:
    r"""Find the periodic orbits, stable and unstable, that Newton's method reaches from a region.

    Starts lie on a grid and on long motions. Orbits found are deflated, so that later searches are pushed away from
    them. The fixed points of the n-period map have indices, the sign of (1 - m1)(1 - m2), whose sum is the index of
    the map on a large circle (`dynamics.orbits.index`). Where the sum differs the search is repeated with a finer grid,
    twice.

    Orbits of opposite index may still be missing in pairs. So Newton's method without deflation follows, from batches
    of starts spread over the region, until no orbit has been met by one start alone and the last half of them found
    none. With :math:`f_1` orbits met once and :math:`f_2` met twice, about :math:`f_1 (f_1 - 1) / (2 f_2 + 2)` have not
    been met (Chao 1984, Scandinavian Journal of Statistics 11, 265-270).

    In several freedoms starts lie on the plane through the state at rest in which y and its rate move alone, on long
    motions and between orbits; that plane need not pass near an orbit, so that more may be missing than the estimate
    says.

    Parameters
    ----------
    oscillator : GearOscillator or DriveOscillator
        The oscillator.
    periods : int or sequence of int
        Periods, in excitation periods.
    region : ((x0, x1), (v0, v1)), optional
        Starts; of a drive train y and its rate, from the state at rest. Left out: somewhat more than what long motions
        cover, at all times of the period and not at tau = 0 alone; it grows, and the search is repeated, while orbits
        found reach beyond it.
    starts : int
        Starts along each side of the region.
    batches : int
        Most batches without deflation, each of as many starts as the grid has; 0 leaves pairs of opposite index to
        chance.

    Returns
    -------
    OrbitSet
        Orbits and the counts of their indices.

    Raises
    ------
    InputError
        If an argument is out of range.

    Examples
    --------
    >>> from dynamics import FourierStiffness, GearOscillator, find_orbits
    >>> osc = GearOscillator(FourierStiffness(1.0, (0.18,), (0.0,)), 0.05, 0.1, 0.2, 0.6, half_backlash=0.2)
    >>> [orbit.label for orbit in find_orbits(osc, (1,)).orbits]
    ['1-0-0', 'U1-1-0', '1-1-1']
    """
    watch = Stopwatch()
    with Faults() as faults:
        wanted = whole_numbers(faults, "periods", periods, SEARCHED)
        side = faults.whole("starts", starts, 1, 1000, "10 is usual")
        most = faults.whole("batches", batches, 0, 100_000, "48 is usual")
        if region is not None:
            region = checked_region(faults, region)
    search = _Search(oscillator, region)
    for _ in range(OPTIONS.region_growths):
        counts = [search.all_of(n, side, most) for n in wanted]
        beyond = search.grows()
        if not beyond:
            break
    orbits = tuple(sorted(search.orbits, key=lambda o: (o.periods, float(o.state[0]))))
    good = all(c.found == c.expected and c.once == 0 for c in counts) and not beyond
    said = [f"{len(orbits)} orbits"]
    said += [
        f"the indices of period {c.periods} add up to {c.found}, not {c.expected}: search more starts"
        for c in counts
        if c.expected is not None and c.found != c.expected
    ]
    said += [
        f"{c.once} of period {c.periods} were met once, about {math.ceil(c.unseen)} more may be there: raise starts"
        for c in counts
        if c.once
    ]
    if beyond:
        said.append("orbits reach beyond the region that was searched: give a larger region")
    if any(c.expected is None for c in counts):
        said.append("the sum of the indices is not known for this oscillator")
    cost = Cost(watch.seconds, oscillator.dimension, 0, search.periods)
    error = max((o.error for o in orbits), default=0.0)
    return OrbitSet(orbits, tuple(counts), search.region, error, cost, good, "; ".join(said))


class _Search:
    """Orbits found so far, and where to start."""

    def __init__(self, oscillator: PeriodicOscillator, region: Region | None) -> None:
        self.oscillator, self.flow = oscillator, flow_of(oscillator)
        self.along, self.centre = oscillator.start_plane()
        self.orbits: list[Orbit] = []
        self.places, self.owners = (
            self.centre[None][:0],
            list[int](),
        )  # states of all orbits, and whose they are
        self.motion, self.periods = long_motions(oscillator, self.flow)
        self.grown, self.seen = region is None, 0
        self.region = region if region is not None else around(self._reach(self.motion[-3:], WHOLE))
        self.scale = self._scale()
        met = around(np.max(self._off_centre(np.zeros(len(self.motion)), self.motion), axis=0, initial=1e-9))
        self.inner = self.region if region is not None else met

    def _off_centre(self, tau: Array, states: Array) -> Array:
        """Distances in X and V of states at some times from the middle of the region at tau = 0, shape (k, 2)."""
        middle = self.oscillator.in_plane(self.centre[None])
        return np.abs(np.column_stack(self.oscillator.contact_motion(tau, states)) - middle)

    def _starts(self, places: Array) -> Array:
        """States of places in the plane of X and V, shape (k, dimension)."""
        return np.asarray(self.centre + places @ self.along)

    def _scale(self) -> float:
        """Largest entry of a state at the corners of the region."""
        corners = np.stack(np.meshgrid(*self.region), axis=-1).reshape(-1, 2)
        return float(np.max(np.abs(self._starts(corners))))

    def all_of(self, n: int, side: int, most: int) -> IndexCount:
        """Search for orbits of so many periods, with a finer grid as long as indices are missing, twice."""
        for fineness in (1, 2, 4):
            self.run(n, side * fineness)
            self.twins(n)
            self.between(n)
            met = self.spread(n, side * fineness, most)
            self.twins(n)
            count = replace(self.count(n), **met)
            if count.expected is None or count.found == count.expected:
                break
        return count

    def grows(self) -> bool:
        """Whether an orbit reaches beyond the region, which grows then; not if the region was given."""
        if not self.grown:
            return False
        new, self.seen = self.orbits[self.seen :], len(self.orbits)
        reach = [self._reach(orbit.state[None], orbit.periods) for orbit in new]
        size = np.max([np.array(self.region)[:, 1], *reach], axis=0)
        if np.all(size <= np.array(self.region)[:, 1]):
            return False
        self.region = around(size)
        self.scale = self._scale()
        return True

    def _reach(self, states: Array, periods: int) -> Array:
        """Largest X and V of motions from some states at tau = 0, at all times; of those that can be followed."""
        size = np.max(self._off_centre(np.zeros(len(states)), states), axis=0, initial=1e-9)
        tau = np.arange(periods * SAMPLES + 1, dtype=np.float64) * (self.oscillator.period / SAMPLES)
        for state in states:
            with suppress(InputError):
                samples = self.flow.sampled(state, periods, SAMPLES)[0]
                size = np.maximum(size, np.max(self._off_centre(tau, samples), axis=0))
            self.periods += periods
        return np.asarray(size)

    def run(self, n: int, side: int) -> None:
        """Search for fixed points of the n-period map from a grid and from long motions."""
        grids = [grid_of(self.inner, side)]
        if self.region != self.inner:
            grids.append(grid_of(self.region, max(side // 2, 1)))
        starts = np.concatenate([self.motion[-RECURRENT:], *(self._starts(grid) for grid in grids)])
        deflated = [orbit.points for orbit in self.orbits if n % orbit.periods == 0]
        self._hunt(starts, n, 40, np.concatenate([self.centre[None][:0], *deflated]))

    def spread(self, n: int, side: int, most: int) -> dict[str, Any]:
        """Newton's method without deflation from batches of starts, until no orbit was met by one of them alone.

        Returns the starts and what they say of orbits that none of them met.
        """
        boxes = [(self.inner, side**2)]
        if self.region != self.inner:
            boxes.append((self.region, max(side**2 // 2, 1)))
        met: list[int] = [0] * len(self.orbits)
        point, none = np.empty((n, len(self.centre))), 0
        once, unseen, used, last_new = 0, 0.0, 0, 0
        for batch in range(most):
            parts = []
            for region, number in boxes:
                at = (0.5 + np.outer(np.arange(used + 1, used + number + 1), GOLDEN)) % 1.0
                low, high = np.array(region).T
                parts.append(low + at * (high - low))
                used += number
            starts = self._starts(np.concatenate(parts))
            if batch % 2:  # what has gone on for a while lies nearer to orbits
                starts = propagated(self.flow, starts, batch // 2 % PASSED + 1)
            known = len(self.orbits)
            for k in range(len(starts)):
                last, periods = hunted(self.flow, starts[k : k + 1], n, PLAIN, self.scale, point, none)
                self.periods += periods
                if last:
                    self._meet(point[0].copy(), n, met)
            seen = [hits for hits, orbit in zip(met, self.orbits, strict=True) if n % orbit.periods == 0]
            once = seen.count(1)
            unseen = once * (once - 1) / (2.0 * seen.count(2) + 2.0)
            last_new = batch if len(self.orbits) > known else last_new
            if batch + 1 >= max(OPTIONS.least_batches, 2 * (last_new + 1)) and once == 0:
                break
        return {"starts": used, "once": once, "unseen": unseen}

    def _meet(self, point: Array, n: int, met: list[int]) -> None:
        """Count that a start has reached a point of an orbit, which may be new."""
        k = self._known(point)
        if k is not None:
            met[k] += 1
            return
        self._keep(find_orbit(self.oscillator, point, periods=n))
        if len(self.orbits) > len(met):
            met.append(1)

    def twins(self, n: int) -> None:
        """Search beside orbits close to a bifurcation for their partners, which deflation pushes away.

        Those are the other orbit of a saddle node and the doubled orbit of a period doubling.
        """
        starts = []
        for orbit in self.orbits:
            critical = {n: 1.0, n / 2: -1.0}.get(orbit.periods)
            if critical is None:
                continue
            values, vectors = np.linalg.eig(orbit.jacobian)
            k = int(np.argmin(np.abs(values - critical)))
            if abs(values[k] - critical) < 0.5:
                along = self.scale * np.real(vectors[:, k])
                starts += [orbit.state + sign * size * along for size in BESIDE for sign in (1, -1)]
        if starts:
            self._hunt(np.array(starts), n, 20, self.centre[None][:0])

    def between(self, n: int) -> None:
        """Search between neighbouring orbits where the plane of the starts leaves directions of the states out.

        What parts two attractors lies between them, and is seldom reached from a plane.
        """
        if len(self.along) == len(self.centre):
            return
        states = sorted(
            (o.state for o in self.orbits if n % o.periods == 0), key=lambda state: float(state[0])
        )
        starts = [a + share * (b - a) for a, b in pairwise(states) for share in SHARES]
        if starts:
            self._hunt(np.array(starts), n, 40, np.array(states))

    def _hunt(self, starts: Array, n: int, limit: int, deflated: Array) -> None:
        """Keep the orbits that Newton's method, pushed away from some points, reaches from starts."""
        points = np.empty((4096, len(self.centre)))
        points[: len(deflated)] = deflated
        last, used = hunted(self.flow, starts, n, limit, self.scale, points, len(deflated))
        self.periods += used
        for point in points[len(deflated) : last]:
            if self._known(point) is None:
                self._keep(find_orbit(self.oscillator, point, periods=n))

    def count(self, n: int) -> IndexCount:
        """Sum of indices of the fixed points of the n-period map."""
        total = number = 0
        for orbit in self.orbits:
            if n % orbit.periods == 0:
                product = float(np.real(np.prod(1.0 - np.asarray(orbit.multipliers) ** (n // orbit.periods))))
                total += orbit.periods * int(np.sign(product))
                number += orbit.periods
        return IndexCount(n, number, total, index_at_infinity(self.oscillator, n))

    def _keep(self, orbit: Orbit) -> None:
        if orbit.converged and self._known(orbit.state) is None:
            self.orbits.append(orbit)
            self.places = np.vstack([self.places, orbit.points])
            self.owners += [len(self.orbits) - 1] * orbit.periods

    def _known(self, state: Array) -> int | None:
        """Which of the orbits a state lies on."""
        if not self.owners:
            return None
        gaps = np.max(np.abs(self.places - state), axis=1)
        nearest = int(gaps.argmin())
        return self.owners[nearest] if gaps[nearest] < OPTIONS.same_orbit * self.scale else None
