"""Brackets about the events of a mesh cycle, and the pieces of it that are being resolved into arcs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import chebyshev

from base import Array, quantity, record
from gears.sharing.arc_series import lobatto, to_series
from gears.sharing.arcs import Arc, graded

BESIDE = 1e-11
"""Distance from a corner of the geometry at which curves are sampled on either side [base pitches]."""

AT_END = 1e-9
"""Reserve at the end of an arc below which its switch turns there."""

LOCATED = 1e-9
"""Width of the bracket in which an event is left [base pitches]; steps of a curve there count by that much."""

SPREAD = np.concatenate([-(10.0 ** -np.arange(1.0, 8.0)), [0.0], 10.0 ** -np.arange(7.0, 0.0, -1.0)])
"""Places asked for about a foreseen event, over the bracket's width."""


@record
class Sampled:
    """Curves at some positions, and what decides where they are smooth."""

    no_error = "what the estimates of a cycle are made of: MeshFigures has the errors"

    curves: Array = quantity("", "values", "curve position")
    reserve: Array = quantity(
        "1",
        "force over the whole force where a pair bears, else minus the gap that is left over the deflection; likewise "
        "any other switch between two laws. Its sign alone decides; nan where it cannot switch",
        "position switch",
    )
    pairs: Array | None = quantity(
        "",
        "of every pair what `Arc.pairs` holds; no arc is divided for it",
        "position pair kind",
        default=None,
    )


@dataclass(frozen=True)
class End:
    """A boundary of arcs: last position before it, first one after it, the switch that makes it.

    ``rises``: whether a contact begins there, that is, bears after it: 1; -1 where it ends, 0 at corners.
    """

    before: float
    after: float
    switch: int = -1
    rises: int = 0

    @classmethod
    def at(cls, position: float) -> End:
        """Boundary at a corner of the geometry or where an arc is divided, with samples on either side."""
        return cls(position - BESIDE, position + BESIDE)


@dataclass
class Piece:
    """An arc that is being resolved."""

    low: End
    high: End
    curves: Array
    reserve: Array
    degree: int = 0
    halvings: int = 0
    pairs: Array | None = None

    @classmethod
    def between(cls, low: End, high: End, halvings: int = 0) -> Piece:
        """Piece that has no samples yet."""
        return cls(low, high, np.empty((0, 0)), np.empty((0, 0)), 0, halvings)

    @property
    def ends(self) -> tuple[float, float]:
        """First and last position [base pitches]."""
        return self.low.after, self.high.before

    @property
    def towards(self) -> int:
        """End towards which points crowd: where a contact begins or ends that bears on the piece; 0 for neither."""
        return -1 if self.low.rises > 0 else 1 if self.high.rises < 0 else 0

    def at(self, unit: Array) -> Array:
        """Positions at arguments of the series, both ends exactly: beyond them another law holds."""
        first, last = self.ends
        return np.clip(first + (last - first) * graded(unit, self.towards)[0], first, last)

    def place(self, degree: int) -> Array:
        """Chebyshev points; of a higher degree than before only the new ones."""
        return self.at(lobatto(degree) if self.degree == 0 else lobatto(degree)[1::2])

    def add(self, degree: int, sampled: Sampled) -> None:
        """Take samples at `place` of a degree."""
        if self.degree == 0:
            self.curves, self.reserve, self.pairs = sampled.curves, sampled.reserve, sampled.pairs
        else:
            self.curves = _interleaved(self.curves.T, sampled.curves.T).T
            self.reserve = _interleaved(self.reserve, sampled.reserve)
            if self.pairs is not None and sampled.pairs is not None:
                self.pairs = _interleaved(self.pairs, sampled.pairs)
        self.degree = degree

    @property
    def positions(self) -> Array:
        """Where the samples are [base pitches]."""
        return self.at(lobatto(self.degree))

    def brackets(self) -> list[Bracket]:
        """Neighbours between which a switch turns; one that turns at the very end of the arc has its event there."""
        bears, place = self.reserve >= 0.0, self.positions
        known = np.isfinite(self.reserve)
        known[[0, -1]] &= np.abs(self.reserve[[0, -1]]) > AT_END
        return [
            Bracket(switch, place, self.reserve[:, switch], node)
            for node, switch in np.argwhere((bears[1:] != bears[:-1]) & known[1:] & known[:-1]).tolist()
            if place[node + 1] - place[node] > LOCATED
        ]

    def missed(self) -> float | None:
        """Where a switch may turn for a moment between two samples; None where none does."""
        unit = np.linspace(lobatto(self.degree)[1], lobatto(self.degree)[-2], 8 * self.degree + 1)
        for values in self.reserve.T:
            if not np.all(np.isfinite(values)) or np.ptp(values) < 1e-9:
                continue
            series = to_series(self.degree) @ values
            between = chebyshev.chebval(unit, series) * (1.0 if values[self.degree // 2] >= 0.0 else -1.0)
            lowest = int(np.argmin(between))
            # crowded points leave room for waves at the other end, which reach to where the reserve is small
            waves = np.max(np.abs(series[-2:])) if self.towards else 0.0
            if between[lowest] < -waves - 1e-9 * np.max(np.abs(values)):
                return float(self.at(unit[lowest : lowest + 1])[0])
        return None

    def arc(self, low: float | None = None, high: float | None = None) -> Arc:
        """Curves on the piece, as an arc between two events; between its own ends unless given."""
        first, last = self.ends
        ends = first if low is None else low, last if high is None else high
        return Arc(*ends, self.curves, self.towards, self.pairs)


def _interleaved(old: Array, new: Array) -> Array:
    """Rows of old and new, in turn."""
    rows = np.empty((len(old) + len(new), *old.shape[1:]))
    rows[::2], rows[1::2] = old, new
    return rows


class Bracket:
    """Neighbouring positions between which a switch turns, with what is known about it nearby.

    The gap that is left is smooth up to the event, where a force begins steeply: the event is foreseen from the side
    of negative reserve by inverse interpolation, and asked for with places close about it on both sides.
    """

    def __init__(self, switch: int, place: Array, reserve: Array, node: int) -> None:
        self.switch = switch
        self.place, self.reserve, self.node = place, reserve, node

    @property
    def low(self) -> float:
        """Last known position before the switch turns."""
        return float(self.place[self.node])

    @property
    def high(self) -> float:
        """First known position after it."""
        return float(self.place[self.node + 1])

    @property
    def width(self) -> float:
        """Room for the event [base pitches]."""
        return self.high - self.low

    def end(self) -> End:
        """The event, as a boundary of arcs."""
        rises = 1 if self.reserve[self.node + 1] >= 0.0 else -1
        return End(self.low, self.high, self.switch, rises)

    def foreseen(self) -> float:
        """Where the reserve vanishes, from up to four places on its negative side; else the middle."""
        middle = 0.5 * (self.low + self.high)
        left = bool(self.reserve[self.node] < 0.0)
        chosen = self.node - np.arange(4) if left else self.node + 1 + np.arange(4)
        chosen = chosen[(chosen >= 0) & (chosen < len(self.place))]
        values = self.reserve[chosen]
        good = np.logical_and.accumulate((values < 0.0) & np.isfinite(values))
        good &= np.logical_and.accumulate(np.diff(values, prepend=1.0) < 0.0)
        places, values = self.place[chosen[good]], values[good]
        if len(places) < 2:
            return middle
        weights = np.array(
            [np.prod(np.delete(values, i) / (np.delete(values, i) - value)) for i, value in enumerate(values)]
        )
        crossing = float(weights @ places)
        return crossing if self.low < crossing < self.high else middle

    def asked(self) -> Array:
        """Places inside the bracket, closest about the foreseen one."""
        near = self.foreseen() + self.width * SPREAD
        least = 0.25 * LOCATED
        inside = near[(near > self.low + least) & (near < self.high - least)]
        return np.unique(np.append(inside, 0.5 * (self.low + self.high)))

    def add(self, place: Array, reserve: Array) -> None:
        """Take in what was asked for; the bracket becomes the closest one in which the switch turns."""
        first, last = self.node, self.node + 1
        self.place = np.concatenate([self.place[:last], place, self.place[last:]])
        self.reserve = np.concatenate([self.reserve[:last], reserve, self.reserve[last:]])
        bears = self.reserve[first : last + len(place) + 1] >= 0.0
        self.node = first + int(np.flatnonzero(bears[1:] != bears[:-1])[0])
