"""The exact flow: its tables, the motion that they carry, its extrema and impacts."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from base import Array, Cost, Faults, Integers, Stopwatch
from dynamics.flow.protocol import MapResult, PartedFlow, Stretches, lost_motion
from dynamics.model.limits import POSITIVE, REFINEMENT, TAYLOR_DEGREE
from dynamics.model.oscillator import GearOscillator
from dynamics.model.protocol import EPS

# of the Taylor tables; a quarter of a radian to each side of the middle leaves less than rounding
DEGREE = 13
REASONS = {1: "the motion grew beyond 1e150", 2: "a cell held more than 10 000 impacts"}


@dataclass(frozen=True, eq=False)
class ExactFlow(PartedFlow):
    """The exact flow of an oscillator, tabulated for the compiled kernels.

    Parameters
    ----------
    packed : ndarray, shape (any,)
        Parameters as of `GearOscillator.packed`.
    coef, edge : ndarray
        See `dynamics.kernels`.
    made : callable, optional
        Makes tables of packed parameters with other cells, and of a degree; `tabulated` unless it is given.
    """

    tolerance = EPS
    noise = 64.0 * EPS

    packed: Array
    coef: Array
    edge: Array
    made: Callable[[Array, int, int], ExactFlow] | None = None

    @property
    def arrays(self) -> tuple[Array, Array, Array]:
        """What the kernels take."""
        return self.packed, self.coef, self.edge

    def space(self) -> tuple[Array, Array, Array, Integers]:
        """Work space for the kernels, one for each motion at the same time."""
        from dynamics.kernels.flow import space_of

        return space_of(self.coef.shape[2] - 1)

    @property
    def cells(self) -> int:
        """Cells per period."""
        return len(self.edge) // 2

    def finer(self) -> ExactFlow:
        """Tables with half the cell."""
        return (self.made or tabulated)(self.packed, 2 * self.cells, DEGREE)

    def follow(self, state: Array, periods: int = 1, skip: int = 0, derivatives: bool = True) -> MapResult:
        """Follow a state; the Jacobian covers the periods skipped, too."""
        from dynamics.kernels.flow import iterate

        watch = Stopwatch()
        states, counts, frame = np.empty((periods, 2)), np.zeros((periods, 2), dtype=np.int64), np.eye(4, 2)
        at = np.array(state, dtype=np.float64)
        flag = int(
            iterate(
                self.arrays, self.space(), 0, self.cells, at, skip, int(derivatives), frame, states, counts
            )
        )
        jacobian = frame[:2]
        if flag:
            states[:], jacobian[:] = np.nan, np.nan
        contact = self._time(frame[3, 0]) if derivatives else math.nan
        decay = -self.damped(contact, periods + skip)
        cost = Cost(watch.seconds, periods=periods + skip)
        return MapResult(states, jacobian, decay, counts, REASONS.get(flag, ""), cost)

    def part(self, first: int, number: int, state: Array, counts: Integers) -> tuple[Array, Array, float]:
        """State after some cells, its derivative by the state before, time in contact if asked for; `counts` grow.

        All nan if the motion is lost.
        """
        from dynamics.kernels.flow import iterate

        end, frame = np.array(state, dtype=np.float64), np.eye(4, 2)
        last, met = np.empty((1, 2)), np.zeros((1, 2), dtype=np.int64)
        if iterate(self.arrays, self.space(), first, number, end, 0, 1, frame, last, met):
            end[:] = np.nan
        counts += met[0]
        return end, frame[:2], self._time(frame[3, 0])

    def damped(self, contact: float, periods: int) -> float:
        """Integral of the trace of all damping, by the time in contact, which it asks for where damping jumps."""
        pressed, free = 2.0 * self.packed[[1, 9]]
        whole = free * (2.0 * math.pi / self.packed[4]) * periods
        return float(whole + (pressed - free) * contact if pressed != free else whole)

    def _time(self, cells: float) -> float:
        """Time that so many cells take."""
        return float(2.0 * math.pi / self.packed[4] / self.cells * cells)

    def sampled(self, state: Array, periods: int, points: int) -> tuple[Array, Array, Array]:
        """Samples, extrema and impacts; repeated with more room if the last two did not fit."""
        from dynamics.kernels.walking import walk

        room = 64 * periods
        while True:
            samples = np.empty((periods * points + 1 if points else 0, 2))
            turns, events = np.empty((room, 5)), np.empty((room, 4))
            flag, turned, happened = walk(
                self.arrays, self.space(), state.copy(), periods, points, samples, turns, events
            )
            if flag:
                raise lost_motion(state, REASONS[int(flag)])
            if turned <= room and happened <= room:
                return samples, turns[:turned], events[:happened]
            room = max(turned, happened)

    def stretches(self, state: Array, sizes: Sequence[int], keep: bool = False) -> Stretches:
        """Growth of two directions, made orthonormal every eight cells."""
        from dynamics.kernels.flow import iterate

        frame, at = np.eye(4, 2), np.array(state, dtype=np.float64)
        logs, kept, damped, flag = np.zeros((len(sizes), 2)), [], np.zeros(len(sizes)), 0
        for k, (row, size) in enumerate(zip(logs, sizes, strict=True)):
            part = np.empty((size if keep else min(size, 1), 2))
            frame[2:] = 0.0
            if size:
                unseen = np.zeros((len(part), 2), dtype=np.int64)
                flag = flag or int(
                    iterate(
                        self.arrays, self.space(), 0, self.cells, at, size - len(part), 2, frame, part, unseen
                    )
                )
            row[:], damped[k] = frame[2], self.damped(self._time(frame[3, 0]), size)
            kept.append(part)
        return Stretches(logs, np.vstack(kept) if keep else at[None], damped, REASONS.get(flag, ""))

    def calm(self, state: Array, limit: int, longest: int) -> tuple[Array, int, str]:
        """State after `limit` periods or when the motion repeats to rounding, periods followed, message."""
        from dynamics.kernels.flow import iterate
        from dynamics.kernels.searching import repeats

        states, counts = np.empty((2 * longest, 2)), np.zeros((2 * longest, 2), dtype=np.int64)
        at, unseen, used = np.array(state, dtype=np.float64), np.eye(4, 2), 0
        table, period = (self.arrays, self.space()), (0, self.cells)
        while used + len(states) <= limit:
            if flag := int(iterate(*table, *period, at, 0, 0, unseen, states, counts)):
                return at, flag, REASONS[flag]
            used += len(states)
            if repeats(states, 1e-13):
                return at, used, ""
        flag = 0
        if limit > used:
            flag = int(iterate(*table, *period, at, limit - used, 0, unseen, states[:0], counts[:0]))
        return at, flag or limit, REASONS.get(flag, "")

    def settle_block(self, starts: Array, homes: Array, radius: float, limit: int, labels: Integers) -> int:
        """As of `settle`, on one core."""
        from dynamics.kernels.searching import settle

        return int(settle(self.arrays, self.space(), starts, homes, radius, limit, labels))


def sufficient_degree(oscillator: GearOscillator, tolerance: float) -> int:
    """Degree of the Taylor tables that leaves less than a tolerance, at most the usual one.

    A cell is half a radian of the fastest time scale, so that the series of the speeds are cut at (1/4)^n/n!; a period
    adds at most as many of these as it has cells. The factor 4 is for the three series together.
    """
    remainder, degree = 4.0 * oscillator.cells * 0.25**6 / math.factorial(6), 6
    while remainder > tolerance and degree < DEGREE:
        degree += 1
        remainder *= 0.25 / degree
    return degree


def exact_flow(
    oscillator: GearOscillator,
    refinement: int = 1,
    degree: int | None = None,
    *,
    tolerance: float | None = None,
) -> ExactFlow:
    """Tabulate an oscillator.

    Parameters
    ----------
    oscillator : GearOscillator
        The oscillator.
    refinement : int
        Factor on the number of cells.
    degree : int, optional
        Of the Taylor polynomials, 6 or more. Left out: what `tolerance` asks for, or 13, which leaves rounding alone.
    tolerance : float, optional
        Error allowed in one period's map, over the size of the motion and the stretch of the map. A loose one makes
        impacts cheaper, by a fifth at 1e-6.

    Raises
    ------
    InputError
        If an argument is out of range, or both degree and tolerance are given.
    """
    with Faults() as faults:
        faults.whole("refinement", refinement, *REFINEMENT)
        if degree is not None:
            faults.whole("degree", degree, *TAYLOR_DEGREE)
        if tolerance is not None:
            faults.number("tolerance", tolerance, POSITIVE)
            if degree is not None:
                faults.add(
                    "tolerance", tolerance, "must be left out where the degree is given", "leave one out"
                )
    if degree is None:
        degree = DEGREE if tolerance is None else sufficient_degree(oscillator, tolerance)
    return tabulated(oscillator.packed(), math.ceil(oscillator.cells) * refinement, degree)


def tabulated(packed: Array, cells: int, degree: int = DEGREE) -> ExactFlow:
    """Tables of a packed oscillator, with so many cells per period."""
    from dynamics.kernels.tables import fill, room_of, tables_of

    coef, edge = tables_of(cells, degree)
    fill(packed, coef, edge, room_of(cells, degree), 0)
    return ExactFlow(packed, coef, edge)
