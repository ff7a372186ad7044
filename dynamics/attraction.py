"""Basins of attraction on a grid of starting states."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from dynamics.cost import Cost
from dynamics.errors import Faults
from dynamics.flow import Tables, period_map, tables
from dynamics.oscillator import GearOscillator
from dynamics.shooting import Orbit, find_orbit
from dynamics.sweeps import APERIODIC, repeat_after, settling_periods

__all__ = ["Attractor", "BasinResult", "basins"]

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
UNDECIDED, UNBOUNDED, UNSETTLED = -1, -2, -3
SEEDS = 48  # starts that are followed to the end first, so that the rest need not be


@dataclass(frozen=True, eq=False)
class Attractor:
    """An attractor and its share of the starts.

    Parameters
    ----------
    label : str
        n-p-q, or "aperiodic".
    states : ndarray, shape (n, 2)
        Its points at tau = 0 mod the excitation period; samples of them if it is aperiodic.
    orbit : Orbit or None
        The periodic orbit, polished by Newton's method; None if aperiodic.
    share : float
        Part of the starts that come to it.
    share_error : float
        Standard error of the share if the starts are taken for a sample.
    """

    label: str
    states: FloatArray
    orbit: Orbit | None
    share: float
    share_error: float


@dataclass(frozen=True, eq=False)
class BasinResult:
    """Which attractor every start comes to.

    Parameters
    ----------
    x, v : ndarray, shape (nx,) and (nv,)
        Starting values.
    labels : ndarray of int, shape (nx, nv)
        Index into `attractors`; -1 undecided, -2 unbounded. X runs along the first axis.
    attractors : tuple of Attractor
        In the order in which they were found; all aperiodic motion counts as one.
    error : float
        Part of the starts undecided plus the largest standard error of a share.
    cost : Cost
        Effort.
    converged : bool
        Whether every start was decided.
    message : str
        What was found, with a remedy if some starts were not decided.
    """

    x: FloatArray
    v: FloatArray
    labels: IntArray
    attractors: tuple[Attractor, ...]
    error: float
    cost: Cost
    converged: bool
    message: str

    def __array__(
        self, dtype: npt.DTypeLike | None = None, copy: bool | None = None
    ) -> npt.NDArray[np.generic]:
        """Return the labels."""
        return self.labels.astype(dtype if dtype is not None else np.int64)


def basins(
    oscillator: GearOscillator,
    x: tuple[float, float, int],
    v: tuple[float, float, int],
    *,
    limit: int | None = None,
    radius: float = 1e-4,
    max_period: int = 16,
    progress: Callable[[int, int], None] | None = None,
) -> BasinResult:
    """Find the attractors that a grid of starts comes to, and which start comes to which.

    Each start is followed until it is near a point of a known attractor and no farther from it one round later. A
    start that comes to none is followed on; if it repeats, Newton's method makes it a new attractor.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    x, v : tuple
        First value, last value and number of starting values of X and of V.
    limit : int, optional
        Periods after which a start without a known attractor is looked at. Left out: as the transient of `sweep`.
    radius : float
        Nearness to an attractor, over the size of the attractor.
    max_period : int
        Longest period that is recognised; longer ones count as aperiodic.
    progress : callable, optional
        Called with the number of starts decided and the number of all.

    Returns
    -------
    BasinResult
        Labels and attractors.

    Raises
    ------
    DynamicsError
        If an argument is out of range.
    """
    began = time.perf_counter()
    faults = Faults()
    xs, vs = (_axis(faults, name, axis) for name, axis in (("x", x), ("v", v)))
    near = faults.number("radius", radius, "between 0 and 0.1", "1e-4 is usual", lambda r: 0.0 < r < 0.1)
    longest = faults.whole("max_period", max_period, 1, 1000, "16 is usual")
    wait = (
        settling_periods(oscillator) if limit is None else faults.whole("limit", limit, 1, 10**7, "give more")
    )
    faults.raise_if_any()
    table = tables(oscillator)
    starts = np.stack(np.meshgrid(xs, vs, indexing="ij"), axis=-1).reshape(-1, 2)
    labels = np.full(len(starts), UNDECIDED, dtype=np.int64)
    found = _Found(oscillator, table, longest, near)
    sample = np.unique(np.linspace(0, len(starts) - 1, min(len(starts), SEEDS)).astype(np.int64))
    for i in sample:
        labels[i] = found.follow(starts[i], wait)
        if progress is not None:
            progress(int(np.sum(labels != UNDECIDED)), len(labels))
    for part in np.array_split(np.arange(len(starts)), min(len(starts), 50)):
        mine, there = labels[part], starts[part]
        found.settle(there, wait, mine)
        if any(orbit is not None for orbit in found.orbits):
            found.settle(there, 2 * wait, mine)  # transient chaos outlives damping
        for i in np.flatnonzero(mine == UNDECIDED):
            mine[i] = found.follow(there[i], 0)
        labels[part] = mine
        if progress is not None:
            progress(int(part[-1]) + 1, len(labels))
    labels[labels == UNSETTLED] = UNDECIDED
    attractors = found.attractors(labels)
    lost = float(np.mean(labels == UNDECIDED))
    error = lost + max((a.share_error for a in attractors), default=0.0)
    message = f"{len(attractors)} attractors"
    if np.any(labels == UNBOUNDED):
        message += f"; {np.mean(labels == UNBOUNDED):.3g} of the starts grow without bound"
    if lost:
        message += f"; {lost:.3g} of the starts undecided: raise limit"
    cost = Cost(time.perf_counter() - began, 2, found.iterations, found.periods)
    return BasinResult(
        xs, vs, labels.reshape(len(xs), len(vs)), attractors, error, cost, lost == 0.0, message
    )


class _Found:
    """Attractors found so far."""

    def __init__(self, oscillator: GearOscillator, table: Tables, longest: int, near: float) -> None:
        self.oscillator, self.table, self.longest, self.near = oscillator, table, longest, near
        self.orbits: list[Orbit | None] = []
        self.points: list[FloatArray] = []
        self.periods = self.iterations = 0

    def follow(self, state: FloatArray, wait: int) -> int:
        """Attractor that one state comes to, noted if it is new; or one of the negative labels."""
        kept = 4 * self.longest
        image = period_map(self.table, state, kept, skip=wait)
        self.periods += kept + wait
        if image.message:
            return UNBOUNDED
        n = repeat_after(image.states, self.longest)
        if n == 0:
            return self.note(None, image.states)
        orbit = find_orbit(self.oscillator, image.state, periods=n)
        self.periods += orbit.cost.periods
        self.iterations += orbit.cost.iterations
        size = max(float(np.max(np.abs(image.states))), 1e-300)
        if not (orbit.converged and orbit.stable and _apart(orbit.state, image.states) < 1e-3 * size):
            return UNSETTLED
        return self.note(orbit, period_map(self.table, orbit.state, orbit.periods).states)

    def note(self, orbit: Orbit | None, states: FloatArray) -> int:
        """Index of an attractor, known or new; all aperiodic motion counts as one."""
        for i, (other, points) in enumerate(zip(self.orbits, self.points, strict=True)):
            if orbit is None or other is None:
                if orbit is other:
                    return i
            elif len(points) == len(states) and _apart(orbit.state, points) < 1e-6 * max(
                np.max(np.abs(points)), 1e-300
            ):
                return i
        self.orbits.append(orbit)
        self.points.append(states)
        return len(self.orbits) - 1

    def settle(self, starts: FloatArray, limit: int, labels: IntArray) -> None:
        """Follow all undecided starts until they arrive at a known periodic attractor."""
        from dynamics.kernels.searching import settle

        rows = [
            np.column_stack([p, np.full(len(p), i), np.full(len(p), len(p))])
            for i, (orbit, p) in enumerate(zip(self.orbits, self.points, strict=True))
            if orbit is not None
        ]
        homes = np.vstack(rows) if rows else np.zeros((0, 4))
        radius = self.near * float(np.max(np.abs(homes[:, :2]), initial=0.0))
        self.periods += int(settle(self.table.arrays, starts, homes, radius, limit, labels))

    def attractors(self, labels: IntArray) -> tuple[Attractor, ...]:
        """Records with their shares."""
        records = []
        for i, (orbit, states) in enumerate(zip(self.orbits, self.points, strict=True)):
            share = float(np.mean(labels == i))
            scatter = float(np.sqrt(share * (1.0 - share) / len(labels)))
            records.append(Attractor(orbit.label if orbit else APERIODIC, states, orbit, share, scatter))
        return tuple(records)


def _apart(state: FloatArray, states: FloatArray) -> float:
    """Distance of a state to the nearest of several, in the largest norm."""
    return float(np.min(np.max(np.abs(states - state), axis=1)))


def _axis(faults: Faults, name: str, given: tuple[float, float, int]) -> FloatArray:
    """Starting values of one axis."""
    if len(given) != 3:
        faults.add(name, given, "(first, last, number)", "give three numbers")
        return np.zeros(1)
    low, high = (faults.number(f"{name}[{i}]", given[i]) for i in range(2))
    count = faults.whole(f"{name}[2]", given[2], 1, 100_000, "give the number of values")
    return np.linspace(low, high, count) if np.isfinite(low + high) else np.zeros(1)
